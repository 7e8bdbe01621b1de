/* Outgoing messages: model, decision, command, status. */
#include <string.h>

#include "agent_internal.h"

_Static_assert((int)GRRL_CHOICE_RANDOM == GRRL_DECISION_T_RANDOM &&
                   (int)GRRL_CHOICE_EXPLORE == GRRL_DECISION_T_EXPLORE &&
                   (int)GRRL_CHOICE_EXPLOIT == GRRL_DECISION_T_EXPLOIT &&
                   (int)GRRL_CHOICE_ADOPTED == GRRL_DECISION_T_ADOPTED &&
                   (int)GRRL_CHOICE_RULE == GRRL_DECISION_T_RULE,
               "reasons are the same on the wire");
_Static_assert((int)GRRL_SOURCE_NONE == GRRL_DECISION_T_NONE &&
                   (int)GRRL_SOURCE_EXACT == GRRL_DECISION_T_EXACT &&
                   (int)GRRL_SOURCE_RELAXED == GRRL_DECISION_T_RELAXED &&
                   (int)GRRL_SOURCE_SUBSTRUCTURE == GRRL_DECISION_T_SUBSTRUCTURE &&
                   (int)GRRL_SOURCE_CASES == GRRL_DECISION_T_CASES,
               "and sources");

static void publish(struct grrl_agent *agent, const char *channel, int size,
                    const struct grrl_wire_why *why)
{
    if (size < 0)
        agent_note(agent, why->text);
    else if (lcm_publish(agent->lcm, channel, agent->bytes, (unsigned)size) != 0)
        agent_note(agent, "LCM could not send a message");
}

static void make_links(const struct grrl_model *model, float large_m, struct grrl_wire_model *out)
{
    for (uint8_t i = 0; i < model->n_bodies; i++) {
        const struct grrl_body *body = &model->body[i];
        out->link_number[i] = (int16_t)body->number;
        out->link_x[i] = body->centroid_m.x;
        out->link_y[i] = body->centroid_m.y;
        out->link_angle[i] = grrl_atan2(body->axis.y, body->axis.x);
        out->link_length[i] = body->length_m;
        out->link_width[i] = body->width_m;
        out->link_size[i] = (int8_t)grrl_size_of(body, large_m);
    }
}

static void make_joints(const struct grrl_model *model, struct grrl_wire_model *out)
{
    for (uint8_t i = 0; i < model->n_joints; i++) {
        const struct grrl_joint *joint = &model->joint[i];
        out->joint_a[i] = (int8_t)joint->a;
        out->joint_b[i] = (int8_t)joint->b;
        out->joint_type[i] = (int8_t)joint->type;
        out->joint_probability[i] = joint->probability;
        out->joint_x[i] = joint->point_m.x;
        out->joint_y[i] = joint->point_m.y;
        out->joint_angle[i] = grrl_atan2(joint->axis.y, joint->axis.x);
        out->joint_lower[i] = joint->lower;
        out->joint_upper[i] = joint->upper;
    }
}

static void make_features(const struct grrl_model *model, struct grrl_wire_model *out)
{
    for (uint16_t i = 0; i < model->n_features; i++) {
        uint8_t body = model->feature_body[i];
        out->feature_id[i] = model->feature_id[i];
        if (body == GRRL_FEATURE_BACKGROUND)
            out->feature_link[i] = GRRL_MODEL_T_BACKGROUND;
        else if (body == GRRL_FEATURE_NONE)
            out->feature_link[i] = GRRL_MODEL_T_UNASSIGNED;
        else
            out->feature_link[i] = (int8_t)body;
    }
}

void agent_make_model(struct grrl_agent *agent)
{
    const struct grrl_model *model = grrl_perception_model(&agent->learner.perception);
    grrl_model_t *message = &agent->model.message;
    message->session_id = agent->config.session_id;
    message->trial_id = agent->trial_id;
    message->cmd_seq = agent->cmd_seq;
    message->n_links = model->n_bodies;
    message->n_joints = model->n_joints;
    message->n_features = model->n_features;
    make_links(model, agent->config.learner.large_m, &agent->model);
    make_joints(model, &agent->model);
    make_features(model, &agent->model);
}

static void make_command(struct grrl_agent *agent, const struct grrl_push *push)
{
    grrl_push_command_t *command = &agent->command;
    memset(command, 0, sizeof *command);
    command->kind = GRRL_PUSH_COMMAND_T_PUSH;
    command->start[0] = push->start_m.x;
    command->start[1] = push->start_m.y;
    command->end[0] = push->end_m.x;
    command->end[1] = push->end_m.y;
    command->travel = push->travel_m;
    command->speed = push->speed_m_s;
    command->force = push->force_n;
    command->timeout = push->timeout_s;
}

void agent_make_decision(struct grrl_agent *agent, const struct grrl_decision *decision)
{
    const struct grrl_choice *choice = &decision->choice;
    grrl_decision_t *message = &agent->decision;
    memset(message, 0, sizeof *message);
    message->session_id = agent->config.session_id;
    message->trial_id = agent->trial_id;
    message->cmd_seq = agent->cmd_seq;
    message->link_number = (int16_t)decision->body_number;
    message->direction_deg = (int16_t)grrl_direction_deg[choice->direction];
    message->reason = (int8_t)choice->reason;
    message->value = choice->value;
    message->lower = choice->lower;
    message->upper = choice->upper;
    message->source = (int8_t)choice->source.kind;
    message->distance = choice->source.distance;
    message->source_index =
        choice->source.kind == GRRL_SOURCE_NONE ? -1 : (int32_t)choice->source.index;
    message->phi = choice->phi;
    message->last_reward = agent->update.reward;
    message->last_target = agent->update.target;
    make_command(agent, &decision->push);
}

void agent_publish_model(struct grrl_agent *agent)
{
    struct grrl_wire_why why;
    if (agent->config.observe)
        return;
    agent->model.message.utime = agent_now_us(agent);
    publish(agent, GRRL_CHANNEL_MODEL,
            grrl_wire_encode_model(&agent->model.message, GRRL_WIRE_MAX_BYTES, agent->bytes, &why),
            &why);
}

static void publish_decision(struct grrl_agent *agent, int64_t now)
{
    struct grrl_wire_why why;
    agent->decision.utime = now;
    publish(agent, GRRL_CHANNEL_DECISION,
            grrl_wire_encode_decision(&agent->decision, GRRL_WIRE_MAX_BYTES, agent->bytes, &why),
            &why);
}

/* The cached push, or WAIT; either way with the newest frame and revision accepted. */
static void publish_command(struct grrl_agent *agent, int64_t now, bool push)
{
    struct grrl_wire_why why;
    grrl_push_command_t command;
    memset(&command, 0, sizeof command);
    if (push)
        command = agent->command;
    command.utime = now;
    command.session_id = agent->config.session_id;
    command.plant_session_id = agent->plant_session_id;
    command.points_seq = agent->seq;
    command.trial_id = agent->phase == PHASE_NONE ? agent->trial.trial_id : agent->trial_id;
    command.trial_revision = agent->trial.revision;
    command.cmd_seq = agent->phase == PHASE_NONE ? 0 : agent->cmd_seq;
    publish(agent, GRRL_CHANNEL_PUSH_COMMAND,
            grrl_wire_encode_push_command(&command, GRRL_WIRE_MAX_BYTES, agent->bytes, &why), &why);
}

/* Without a supervisor nobody waits for the model and the agent continues at once: the model is
 * sent with the next push. */
static bool unjudged_model(const struct grrl_agent *agent)
{
    return agent->trial_id == 0 &&
           (agent->phase == PHASE_CHOOSING || agent->phase == PHASE_COMMANDED);
}

void agent_answer(struct grrl_agent *agent)
{
    if (agent->config.observe)
        return;
    int64_t now = agent_now_us(agent);
    agent->answered_us = now;
    if (agent->phase == PHASE_JUDGING || unjudged_model(agent))
        agent_publish_model(agent);
    if (agent->phase == PHASE_COMMANDED)
        publish_decision(agent, now);
    publish_command(agent, now, agent->phase == PHASE_COMMANDED);
}

void agent_publish_status(struct grrl_agent *agent)
{
    if (agent->config.observe)
        return;
    struct grrl_wire_why why;
    const struct grrl_usage usage = grrl_learner_usage(&agent->learner);
    grrl_agent_status_t status = {
        .utime = agent_now_us(agent),
        .session_id = agent->config.session_id,
        .plant_session_id = agent->plant_session_id,
        .trial_id = agent->phase == PHASE_NONE ? 0 : agent->trial_id,
        .pushes = agent->phase == PHASE_NONE ? 0 : agent->cmd_seq,
        .entries = (int32_t)usage.n,
        .capacity = (int32_t)usage.capacity,
        .evictions = (int32_t)(usage.evictions & INT32_MAX),
        .received = agent->counts.received,
        .lost = agent->counts.lost,
        .repeated = agent->counts.repeated,
        .rejected = agent->counts.rejected,
        .foreign = agent->counts.foreign,
    };
    publish(agent, GRRL_CHANNEL_AGENT_STATUS,
            grrl_wire_encode_agent_status(&status, GRRL_WIRE_MAX_BYTES, agent->bytes, &why), &why);
}
