/*
 * The course of a trial: frames are taken in until they settle, the model goes out, the supervisor
 * judges it, the agent learns and commands the next push.
 *
 * Everything that is taken in is taken in once, in an order that messages lost or repeated do not
 * change; so a run over a network, in one process, and from a log all learn the same.
 */
#include <string.h>

#include "agent_internal.h"
#include "grrl/base/settling.h"

/* Between answers to frames that need none: at the camera's rate nobody waits for one. */
enum { RESEND_US = 50000 };

static void begin_trial(struct grrl_agent *agent, int32_t trial_id)
{
    agent->trial_id = trial_id;
    agent->cmd_seq = 0;
    agent->adopted = false;
    agent->rest_frames = 0;
    agent->rest_ack = 0;
    agent->stage = STAGE_WATCHING;
    memset(&agent->status, 0, sizeof agent->status);
    memset(&agent->decision, 0, sizeof agent->decision);
    memset(&agent->update, 0, sizeof agent->update);
    grrl_learner_begin_trial(&agent->learner, (uint32_t)trial_id);
}

void agent_abandon(struct grrl_agent *agent)
{
    if (agent->stage != STAGE_NONE)
        grrl_learner_abandon_trial(&agent->learner);
    agent->stage = STAGE_NONE;
}

static void learn(struct grrl_agent *agent, bool ended)
{
    if (agent->cmd_seq == 0 || !agent->adopted)
        return;
    enum grrl_status status = grrl_learner_learn(&agent->learner, ended, &agent->update);
    if (status != GRRL_OK)
        agent_note(agent, grrl_status_text(status));
    else
        agent_event(agent, GRRL_AGENT_LEARNED);
    agent->adopted = false; /* a push is learned once */
}

static void next_push(struct grrl_agent *agent)
{
    agent->cmd_seq++;
    agent->adopted = true;
    agent->stage = STAGE_COMMANDED;
}

/*
 * Takes over the decision seen on the wire if it is that of push cmd_seq. A choice made from
 * experience counts as a use of it, as it does for the agent that chose: what is evicted later, and
 * the file, depend on it.
 */
static bool adopt(struct grrl_agent *agent, int32_t cmd_seq)
{
    const grrl_decision_t *seen = &agent->decision;
    uint8_t direction = 0;
    while (direction < GRRL_DIRECTIONS && grrl_direction_deg[direction] != seen->direction_deg)
        direction++;
    struct grrl_decision decision;
    bool exploited = seen->reason == GRRL_DECISION_T_EXPLOIT;
    return seen->trial_id == agent->trial_id && seen->cmd_seq == cmd_seq &&
           grrl_learner_adopt(&agent->learner, (uint16_t)seen->link_number, direction, exploited,
                              &decision) == GRRL_OK;
}

/* It looks again, perhaps at every frame: once is enough. */
static void tell_blind(struct grrl_agent *agent, enum grrl_status status)
{
    if (!agent->blind)
        agent_note(agent, status == GRRL_ERR_NONE ? "no link is seen that could be pushed"
                                                  : grrl_status_text(status));
    agent->blind = true;
}

static void choose(struct grrl_agent *agent)
{
    struct grrl_decision decision;
    agent->stage = STAGE_CHOOSING;
    if (agent->config.observe) {
        if (adopt(agent, agent->cmd_seq + 1))
            next_push(agent);
        return;
    }
    enum grrl_status status = grrl_learner_choose(&agent->learner, &decision);
    if (status != GRRL_OK) {
        tell_blind(agent, status);
        return;
    }
    agent->blind = false;
    next_push(agent);
    agent_make_decision(agent, &decision);
    agent_event(agent, GRRL_AGENT_DECIDED);
}

static void end_trial(struct grrl_agent *agent)
{
    agent_abandon(agent); /* after learning, this forgets the object only */
    agent_event(agent, GRRL_AGENT_TRIAL_END);
}

/* The model after push cmd_seq was judged: learn, and go on or not. */
static void judged(struct grrl_agent *agent)
{
    bool discovered = agent->trial.outcome == GRRL_TRIAL_T_DISCOVERED;
    bool running = agent->trial.phase == GRRL_TRIAL_T_RUNNING;
    learn(agent, !running && discovered);
    if (running)
        choose(agent);
    else
        end_trial(agent);
}

static void judge_if_told(struct grrl_agent *agent)
{
    bool alone = agent->trial_id == 0; /* nobody judges */
    if (agent->stage == STAGE_JUDGING && (alone || agent->trial.judged_cmd_seq == agent->cmd_seq))
        judged(agent);
}

void agent_take_trial(struct grrl_agent *agent, const grrl_trial_t *trial)
{
    if (trial->revision <= agent->trial.revision) {
        agent->counts.repeated++;
        if (trial->revision == agent->trial.revision)
            agent_answer(agent);
        return;
    }
    agent->trial = *trial;
    bool same = agent->stage != STAGE_NONE && trial->trial_id == agent->trial_id;
    bool running = trial->phase == GRRL_TRIAL_T_RUNNING;
    if (!same) {
        agent_abandon(agent);
        /* Under way already: joined in the middle, the beginning was missed. */
        if (running && trial->judged_cmd_seq < 0)
            begin_trial(agent, trial->trial_id);
    } else if (!running && trial->outcome == GRRL_TRIAL_T_ABORTED) {
        end_trial(agent);
    } else {
        judge_if_told(agent);
    }
    agent_answer(agent);
    agent->finished = agent->finished || trial->phase == GRRL_TRIAL_T_FINISHED;
}

void agent_meet_rival(struct grrl_agent *agent)
{
    bool alone = agent->stage != STAGE_NONE && agent->trial_id == 0;
    if (!alone)
        return; /* with a supervisor, the frames tell whose pushes they show */
    agent_abandon(agent);
    agent->gave_way = true;
}

/* Whether a frame shows another agent's pushes. Then it teaches nothing here, but this agent stays
 * ready: when the other one is silent, the simulator turns to it. */
static bool shows_rival(struct grrl_agent *agent, const grrl_points_t *points)
{
    int64_t session = points->agent_session_id;
    if (agent->config.observe || session == 0 || session == agent->config.session_id)
        return false;
    if (!agent->rival_seen)
        agent_note(agent, "another agent is obeyed, this one waits: stop one of the two, or give "
                          "each an LCM provider (port) of its own");
    agent->rival_seen = true;
    return true;
}

void agent_take_status(struct grrl_agent *agent, const grrl_push_status_t *status)
{
    if (agent->stage != STAGE_NONE && status->trial_id == agent->trial_id)
        agent->status = *status;
}

void agent_take_decision(struct grrl_agent *agent, const grrl_decision_t *decision)
{
    agent->decision = *decision;
    if (agent->stage == STAGE_CHOOSING && adopt(agent, agent->cmd_seq + 1))
        next_push(agent);
    else if (agent->stage == STAGE_WATCHING && agent->cmd_seq > 0 && !agent->adopted)
        agent->adopted = adopt(agent, agent->cmd_seq);
}

/* The push a frame belongs to and its phase, from the robot's status if the tracker knows neither.
 */
static int8_t phase_of(struct grrl_agent *agent, const grrl_points_t *points, int32_t *ack)
{
    *ack = points->ack_cmd_seq;
    if (points->phase != GRRL_POINTS_T_UNKNOWN)
        return points->phase;
    bool known = agent->status.session_id != 0;
    *ack = known ? agent->status.cmd_seq : 0;
    bool moving = known && agent->status.state == GRRL_PUSH_STATUS_T_MOVING;
    if (moving || *ack != agent->rest_ack)
        agent->rest_frames = 0;
    agent->rest_ack = *ack;
    if (moving)
        return GRRL_POINTS_T_PUSHING;
    agent->rest_frames++;
    return agent->rest_frames >= GRRL_SETTLING_FRAMES ? GRRL_POINTS_T_SETTLED : GRRL_POINTS_T_REST;
}

/*
 * A push went on that the observer was not told of in time: its frames came before the judgement of
 * the push before or before the decision. That it goes on is a judgement, too.
 */
static void catch_up(struct grrl_agent *agent, int32_t ack)
{
    if (ack != agent->cmd_seq + 1 || agent->stage == STAGE_WATCHING) {
        agent_note(agent, "frames are missing, the trial is not learned any further");
        agent_abandon(agent);
        return;
    }
    if (agent->stage == STAGE_JUDGING) {
        learn(agent, false);
        choose(agent);
    }
    if (agent->stage == STAGE_CHOOSING) {
        agent->cmd_seq = ack;
        agent->adopted = false;
        agent->stage = STAGE_COMMANDED;
    }
}

/* At rest after push cmd_seq. */
static void settled(struct grrl_agent *agent)
{
    enum grrl_status status = grrl_learner_perceive(&agent->learner);
    if (status != GRRL_OK)
        tell_blind(agent, status);
    agent_make_model(agent);
    agent->stage = STAGE_JUDGING;
    judge_if_told(agent);
}

static void watch(struct grrl_agent *agent, const grrl_points_t *points)
{
    int32_t ack;
    int8_t phase = phase_of(agent, points, &ack);
    if (agent->config.observe && ack > agent->cmd_seq)
        catch_up(agent, ack);
    if (agent->stage == STAGE_COMMANDED && ack == agent->cmd_seq)
        agent->stage = STAGE_WATCHING;
    bool idle = agent->stage == STAGE_CHOOSING && !agent->config.observe;
    if (idle && phase == GRRL_POINTS_T_SETTLED)
        agent->stage = STAGE_WATCHING; /* nothing was seen that could be pushed: look again */
    if (agent->stage != STAGE_WATCHING || ack != agent->cmd_seq)
        return;
    struct grrl_frame frame = {(uint32_t)points->n_points, points->id, points->x, points->y};
    grrl_learner_observe(&agent->learner, &frame, phase == GRRL_POINTS_T_PUSHING);
    if (phase == GRRL_POINTS_T_SETTLED)
        settled(agent);
}

void agent_take_frame(struct grrl_agent *agent, const grrl_points_t *points)
{
    if (agent->gave_way || shows_rival(agent, points))
        return;
    if (points->trial_id == 0 && agent->stage == STAGE_NONE && agent->trial.revision == 0)
        begin_trial(agent, 0);
    if (agent->stage == STAGE_NONE || points->trial_id != agent->trial_id)
        return; /* the word about this trial has not come yet; it is repeated */
    agent->lock_step = points->mode == GRRL_POINTS_T_LOCK_STEP;
    int before = agent->stage;
    if (points->seq <= agent->seq) {
        agent->counts.repeated++;
        if (points->seq < agent->seq)
            return;
    } else {
        agent->counts.lost += agent->seq > 0 ? points->seq - agent->seq - 1 : 0;
        agent->seq = points->seq;
        watch(agent, points);
    }
    bool waits = agent->stage == STAGE_JUDGING || agent->stage == STAGE_COMMANDED;
    bool due = waits && agent_now_us(agent) - agent->answered_us >= RESEND_US;
    if (agent->lock_step || agent->stage != before || due)
        agent_answer(agent);
}
