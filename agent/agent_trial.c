/*
 * The course of a trial: the agent observes frames until they settle, sends its model, the
 * supervisor judges it, and the agent learns and commands the next push.
 *
 * Every input is used once, in an order that lost or repeated messages do not change; so a run over
 * a network, in one process, and from a log all learn the same.
 */
#include <string.h>

#include "agent_internal.h"
#include "grrl/base/settling.h"

/* Time between answers to frames that need none: at the camera's rate nobody waits for them. */
enum { RESEND_US = 50000 };

static void begin_trial(struct grrl_agent *agent, int32_t trial_id)
{
    agent->trial_id = trial_id;
    agent->cmd_seq = 0;
    agent->adopted = false;
    agent->begun = false;
    agent->rest_frames = 0;
    agent->rest_ack = 0;
    agent->in_vain = 0;
    agent->phase = PHASE_WATCHING;
    memset(&agent->status, 0, sizeof agent->status);
    memset(&agent->decision, 0, sizeof agent->decision);
    memset(&agent->update, 0, sizeof agent->update);
    grrl_learner_begin_trial(&agent->learner, (uint32_t)trial_id);
}

void agent_abandon(struct grrl_agent *agent)
{
    if (agent->phase != PHASE_NONE)
        grrl_learner_abandon_trial(&agent->learner);
    agent->phase = PHASE_NONE;
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
    agent->plant.commanded_us = agent_now_us(agent);
    agent->adopted = true;
    agent->phase = PHASE_COMMANDED;
}

/*
 * Adopts the decision seen on the wire if it is for push cmd_seq. A choice based on an entry counts
 * as a use of that entry, as it does for the agent that chose: later evictions, and the file,
 * depend on it.
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

/* Reports once that nothing can be pushed; the agent may try again at every frame. */
static void tell_blind(struct grrl_agent *agent, enum grrl_status status)
{
    const struct grrl_model *model = grrl_perception_model(&agent->learner.perception);
    const char *text = grrl_status_text(status);
    if (status == GRRL_ERR_NONE)
        text = model->n_bodies == 0
                   ? "no link is visible that could be pushed: each needs at least four points"
                   : "no push stays on --table: move the object away from its edge";
    if (!agent->blind)
        agent_note(agent, text);
    agent->blind = true;
}

static void choose(struct grrl_agent *agent)
{
    struct grrl_decision decision;
    agent->phase = PHASE_CHOOSING;
    if (agent->config.observe) {
        if (adopt(agent, agent->cmd_seq + 1))
            next_push(agent);
        return;
    }
    enum grrl_status status = agent_choose(agent, &decision);
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
    agent_abandon(agent); /* after learning, this forgets only the object */
    agent_event(agent, GRRL_AGENT_TRIAL_END);
}

/* The model after push cmd_seq was judged: learn, then choose the next push or end. */
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

/* A joint that has not moved yet does not show up in any pair, so this many pushes per link must
 * have revealed nothing. With none, the first joint found would end the run
 * (tests/processes/test_alone.cpp). */
enum { VAIN_PER_LINK = 3 };

/* Without a supervisor: whether the model is certain enough, or all pushes are done. */
static enum grrl_agent_end end_alone(const struct grrl_agent *agent)
{
    const struct grrl_agent_config *config = &agent->config;
    uint8_t n = grrl_perception_model(&agent->learner.perception)->n_bodies;
    uint8_t a, b;
    if (config->until_sure > 0.0f && agent->in_vain >= VAIN_PER_LINK * n &&
        grrl_agent_sureness(agent, &a, &b) >= config->until_sure)
        return GRRL_AGENT_SURE;
    if (config->max_pushes > 0 && agent->cmd_seq >= config->max_pushes)
        return GRRL_AGENT_PUSHES_DONE;
    return GRRL_AGENT_GOES_ON;
}

/* Nobody judges, so the agent does so itself. */
static void judge_alone(struct grrl_agent *agent)
{
    learn(agent, false);
    agent->in_vain = agent->update.reward > 0.0f ? 0 : agent->in_vain + (agent->cmd_seq > 0);
    enum grrl_agent_end end = end_alone(agent);
    if (end == GRRL_AGENT_GOES_ON) {
        choose(agent);
        return;
    }
    agent_publish_model(agent); /* no push follows that would carry it */
    end_trial(agent);
    agent->end = end;
}

static void judge_if_told(struct grrl_agent *agent)
{
    if (agent->phase != PHASE_JUDGING)
        return;
    if (agent->trial_id == 0)
        judge_alone(agent);
    else if (agent->trial.judged_cmd_seq == agent->cmd_seq)
        judged(agent);
}

static void tell_supervised(struct grrl_agent *agent)
{
    const struct grrl_agent_config *config = &agent->config;
    if (!agent->supervised && (config->max_pushes > 0 || config->until_sure > 0.0f))
        agent_note(agent, "a supervisor ends the trials: --pushes and --until-sure only work "
                          "without one and are ignored");
    agent->supervised = true;
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
    bool same = agent->phase != PHASE_NONE && trial->trial_id == agent->trial_id;
    bool running = trial->phase == GRRL_TRIAL_T_RUNNING;
    if (!same) {
        agent_abandon(agent);
        /* A trial already in progress is not joined: its beginning was missed. */
        if (running && trial->judged_cmd_seq < 0) {
            tell_supervised(agent);
            begin_trial(agent, trial->trial_id);
        }
    } else if (!running && trial->outcome == GRRL_TRIAL_T_ABORTED) {
        end_trial(agent);
    } else {
        judge_if_told(agent);
    }
    agent_answer(agent);
    if (trial->phase == GRRL_TRIAL_T_FINISHED && agent->end == GRRL_AGENT_GOES_ON)
        agent->end = GRRL_AGENT_TRIALS_DONE;
}

void agent_meet_rival(struct grrl_agent *agent)
{
    bool alone = agent->phase != PHASE_NONE && agent->trial_id == 0;
    if (!alone)
        return; /* with a supervisor, the frames say whose pushes they show */
    agent_abandon(agent);
    agent->end = GRRL_AGENT_GAVE_WAY;
}

/* Whether a frame shows another agent's pushes. It is then ignored, but this agent stays ready: if
 * the other one falls silent, the simulator turns to it. */
static bool shows_rival(struct grrl_agent *agent, const grrl_points_t *points)
{
    int64_t session = points->agent_session_id;
    if (agent->config.observe || session == 0 || session == agent->config.session_id)
        return false;
    if (!agent->rival_seen)
        agent_note(agent, "another agent is in control and this one waits: stop one of the two, or "
                          "give each its own LCM provider (port)");
    agent->rival_seen = true;
    return true;
}

void agent_take_status(struct grrl_agent *agent, const grrl_push_status_t *status)
{
    if (agent->phase != PHASE_NONE && status->trial_id == agent->trial_id)
        agent->status = *status;
}

void agent_take_decision(struct grrl_agent *agent, const grrl_decision_t *decision)
{
    agent->decision = *decision;
    if (agent->phase == PHASE_CHOOSING && adopt(agent, agent->cmd_seq + 1))
        next_push(agent);
    else if (agent->phase == PHASE_WATCHING && agent->cmd_seq > 0 && !agent->adopted)
        agent->adopted = adopt(agent, agent->cmd_seq);
}

/* The phase of a frame and the push it belongs to, from the robot's status if the tracker knows
 * neither. */
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
 * A push started before the observer received the judgement of the previous push, or the decision.
 * That it started implies the judgement.
 */
static void catch_up(struct grrl_agent *agent, int32_t ack)
{
    if (ack != agent->cmd_seq + 1 || agent->phase == PHASE_WATCHING) {
        agent_note(agent, "frames are missing; the rest of the trial is not learned");
        agent_abandon(agent);
        return;
    }
    if (agent->phase == PHASE_JUDGING) {
        learn(agent, false);
        choose(agent);
    }
    if (agent->phase == PHASE_CHOOSING) {
        agent->cmd_seq = ack;
        agent->adopted = false;
        agent->phase = PHASE_COMMANDED;
    }
}

/* At rest after push cmd_seq. */
static void settled(struct grrl_agent *agent)
{
    enum grrl_status status = grrl_learner_perceive(&agent->learner);
    if (status != GRRL_OK)
        tell_blind(agent, status);
    agent_make_model(agent);
    agent_event(agent, GRRL_AGENT_PERCEIVED);
    agent->phase = PHASE_JUDGING;
    judge_if_told(agent);
}

static void watch(struct grrl_agent *agent, grrl_points_t *points)
{
    int32_t ack;
    int8_t phase = phase_of(agent, points, &ack);
    if (agent->config.observe && ack > agent->cmd_seq)
        catch_up(agent, ack);
    if (agent->phase == PHASE_COMMANDED && ack == agent->cmd_seq)
        agent->phase = PHASE_WATCHING;
    bool idle = agent->phase == PHASE_CHOOSING && !agent->config.observe;
    if (idle && phase == GRRL_POINTS_T_SETTLED)
        agent->phase = PHASE_WATCHING; /* nothing could be pushed: observe again */
    if (agent->phase != PHASE_WATCHING || ack != agent->cmd_seq ||
        !agent_admit_frame(agent, points))
        return;
    struct grrl_frame frame = {(uint32_t)points->n_points, points->id, points->x, points->y};
    grrl_learner_observe(&agent->learner, &frame, phase == GRRL_POINTS_T_PUSHING);
    if (phase == GRRL_POINTS_T_SETTLED)
        settled(agent);
}

/* In lock-step a lost frame is sent again, with those behind it: none is taken before. The first of
 * a trial comes alone. */
static bool is_early(const struct grrl_agent *agent, const grrl_points_t *points)
{
    if (points->mode == GRRL_POINTS_T_REAL_TIME || agent->config.observe)
        return false;
    return agent->begun ? points->seq > agent->seq + 1 : points->mode == GRRL_POINTS_T_MORE;
}

/* Takes in a new frame, or not. */
static void take_new(struct grrl_agent *agent, grrl_points_t *points)
{
    agent->counts.lost += agent->seq > 0 ? points->seq - agent->seq - 1 : 0;
    agent->seq = points->seq;
    agent->begun = true;
    watch(agent, points);
}

void agent_take_frame(struct grrl_agent *agent, grrl_points_t *points)
{
    bool over = agent->end != GRRL_AGENT_GOES_ON && agent->end != GRRL_AGENT_TRIALS_DONE;
    if (over || shows_rival(agent, points))
        return;
    if (points->trial_id == 0 && agent->phase == PHASE_NONE && agent->trial.revision == 0)
        begin_trial(agent, 0);
    bool ours = agent->phase != PHASE_NONE && points->trial_id == agent->trial_id;
    agent_watch_frame(agent, points, ours);
    if (!ours)
        return; /* the message about this trial has not arrived yet; it is repeated */
    if (is_early(agent, points))
        return;
    int before = agent->phase;
    if (points->seq <= agent->seq) {
        agent->counts.repeated++;
        if (points->seq < agent->seq)
            return;
    } else {
        take_new(agent, points);
    }
    if (points->mode == GRRL_POINTS_T_MORE)
        return;
    bool waits = agent->phase == PHASE_JUDGING || agent->phase == PHASE_COMMANDED;
    bool due = waits && agent_now_us(agent) - agent->answered_us >= RESEND_US;
    if (before == PHASE_COMMANDED && agent->phase == PHASE_COMMANDED && due)
        agent_watch_resend(agent);
    if (points->mode == GRRL_POINTS_T_LOCK_STEP || agent->phase != before || due)
        agent_answer(agent);
}
