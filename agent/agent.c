/* Life of the agent, incoming messages, sessions. */
#include "agent.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agent_internal.h"

enum { SILENCE_US = 1000000, STATUS_PERIOD_US = 500000 };

int64_t agent_now_us(const struct grrl_agent *agent)
{
    return agent->config.now_us(agent->config.context);
}

static void emit(struct grrl_agent *agent, const struct grrl_agent_event *event)
{
    if (agent->config.on_event != NULL)
        agent->config.on_event(agent->config.context, event);
}

void agent_note(struct grrl_agent *agent, const char *text)
{
    struct grrl_agent_event event = {.kind = GRRL_AGENT_NOTE, .text = text};
    emit(agent, &event);
}

void agent_event(struct grrl_agent *agent, enum grrl_agent_event_kind kind)
{
    struct grrl_agent_event event = {
        .kind = kind,
        .decision = &agent->decision,
        .update = &agent->update,
        .trial_id = agent->trial_id,
        .pushes = agent->cmd_seq,
        .outcome = agent->trial.outcome,
    };
    emit(agent, &event);
}

/* Counts a message; reports the first malformed one and only counts later ones. */
static bool accepted(struct grrl_agent *agent, bool good, const struct grrl_wire_why *why)
{
    agent->counts.received++;
    if (good)
        return true;
    if (agent->counts.rejected++ == 0)
        agent_note(agent, why->text);
    return false;
}

/*
 * Whether a message comes from the known plant. Another session takes over if the known one has
 * been silent: it was restarted. An observer uses the clock of the messages, because a log is read
 * faster than it was written.
 */
static bool known_plant(struct grrl_agent *agent, int64_t session_id, int64_t utime)
{
    int64_t now = agent->config.observe ? utime : agent_now_us(agent);
    if (agent->plant_session_id != 0 && session_id != agent->plant_session_id) {
        if (now - agent->plant_heard_us < SILENCE_US) {
            if (agent->counts.foreign++ == 0)
                agent_note(agent,
                           "another simulator or tracker is sending, too; it is ignored while the "
                           "known one is present: give each its own LCM provider (port)");
            return false;
        }
        agent_note(agent, "the simulator or tracker was restarted; the trial is abandoned");
        agent_abandon(agent);
        memset(&agent->trial, 0, sizeof agent->trial);
        agent->seq = 0;
        agent_forget_plant(agent);
    }
    agent->plant_session_id = session_id;
    agent->plant_heard_us = now;
    agent->heard_us = agent_now_us(agent);
    return true;
}

static void on_points(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct grrl_agent *agent = user;
    struct grrl_wire_why why;
    (void)channel;
    bool good = grrl_wire_decode_points(buffer->data, buffer->data_size, &agent->points, &why);
    grrl_points_t *points = &agent->points.message;
    if (accepted(agent, good, &why) && known_plant(agent, points->session_id, points->utime))
        agent_take_frame(agent, points);
}

static void on_trial(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct grrl_agent *agent = user;
    struct grrl_wire_why why;
    grrl_trial_t trial;
    (void)channel;
    bool good = grrl_wire_decode_trial(buffer->data, buffer->data_size, &trial, &why);
    if (accepted(agent, good, &why) && known_plant(agent, trial.session_id, trial.utime) &&
        agent->end != GRRL_AGENT_STOPPED)
        agent_take_trial(agent, &trial);
}

/*
 * Any message on this channel stops the agent, even one that cannot be decoded: a stop sent by a
 * robot with other message types must not be lost. The only exception is one that names another
 * agent.
 */
static void on_stop(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct grrl_agent *agent = user;
    struct grrl_wire_why why;
    grrl_stop_t stop;
    (void)channel;
    bool good = grrl_wire_decode_stop(buffer->data, buffer->data_size, &stop, &why);
    (void)accepted(agent, good, &why);
    if (good && stop.agent_session_id != 0 && stop.agent_session_id != agent->config.session_id)
        return;
    memset(&agent->stop, 0, sizeof agent->stop);
    if (good)
        agent->stop = stop;
    agent_abandon(agent);
    agent->end = GRRL_AGENT_STOPPED;
}

/* Whether a status names another agent; not if the robot left the field empty or filled in its own
 * or the tracker's session. */
static bool names_an_agent(const struct grrl_agent *agent, const grrl_push_status_t *status)
{
    int64_t named = status->agent_session_id;
    return named != 0 && named != status->session_id && named != agent->plant_session_id;
}

static void on_push_status(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct grrl_agent *agent = user;
    struct grrl_wire_why why;
    grrl_push_status_t status;
    (void)channel;
    bool good = grrl_wire_decode_push_status(buffer->data, buffer->data_size, &status, &why);
    if (!accepted(agent, good, &why))
        return;
    agent_watch_status(agent, &status);
    if (agent->config.observe || status.agent_session_id == agent->config.session_id)
        agent_take_status(agent, &status);
    else if (status.state == GRRL_PUSH_STATUS_T_MOVING && names_an_agent(agent, &status))
        agent_meet_rival(agent);
}

static void on_decision(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct grrl_agent *agent = user;
    struct grrl_wire_why why;
    grrl_decision_t decision;
    (void)channel;
    bool good = grrl_wire_decode_decision(buffer->data, buffer->data_size, &decision, &why);
    if (accepted(agent, good, &why))
        agent_take_decision(agent, &decision);
}

static enum grrl_status subscribe(struct grrl_agent *agent)
{
    const struct {
        const char *channel;
        lcm_msg_handler_t handler;
    } wanted[GRRL_AGENT_SUBSCRIPTIONS] = {
        {GRRL_CHANNEL_POINTS, on_points},
        {GRRL_CHANNEL_TRIAL, on_trial},
        {GRRL_CHANNEL_PUSH_STATUS, on_push_status},
        {GRRL_CHANNEL_DECISION, on_decision},
        {GRRL_CHANNEL_STOP, on_stop},
    };
    for (int i = 0; i < GRRL_AGENT_SUBSCRIPTIONS; i++) {
        if (wanted[i].handler == (agent->config.observe ? on_stop : on_decision))
            continue; /* an observer moves nothing; an agent that acts decides by itself */
        agent->subscriptions[i] =
            lcm_subscribe(agent->lcm, wanted[i].channel, wanted[i].handler, agent);
        if (agent->subscriptions[i] == NULL)
            return GRRL_ERR_IO;
        /* 0 is unbounded; LCM's default of 30 silently drops the newest message. */
        (void)lcm_subscription_set_queue_capacity(agent->subscriptions[i], 0);
    }
    return GRRL_OK;
}

enum grrl_status grrl_agent_init(struct grrl_agent *agent, const struct grrl_agent_config *config,
                                 lcm_t *lcm)
{
    memset(agent, 0, sizeof *agent);
    agent->config = *config;
    agent->lcm = lcm;
    agent->heard_us = agent_now_us(agent);
    grrl_wire_bind_model(&agent->model);
    grrl_wire_bind_points(&agent->points);
    if ((agent_has_table(agent) && config->ground == NULL) ||
        (config->until_sure > 0.0f && config->pair == NULL))
        return GRRL_ERR_ARGUMENT;
    enum grrl_status status = grrl_learner_init(&agent->learner, &config->learner, config->policy);
    if (status != GRRL_OK)
        return status;
    return subscribe(agent);
}

void grrl_agent_tick(struct grrl_agent *agent)
{
    int64_t now = agent_now_us(agent);
    if (agent->status_us != 0 && now - agent->status_us < STATUS_PERIOD_US)
        return;
    agent->status_us = now;
    agent_publish_status(agent);
}

enum grrl_agent_end grrl_agent_end(const struct grrl_agent *agent)
{
    return agent->end;
}

bool grrl_agent_finished(const struct grrl_agent *agent)
{
    return agent->end == GRRL_AGENT_TRIALS_DONE || agent->end == GRRL_AGENT_SURE ||
           agent->end == GRRL_AGENT_PUSHES_DONE;
}

const char *grrl_agent_stop_text(struct grrl_agent *agent)
{
    static const char *const reasons[] = {"OPERATOR", "LIMIT", "COLLISION", "FAULT"};
    if (agent->stop.session_id == 0)
        (void)snprintf(agent->note, sizeof agent->note,
                       "stopped by a message on GRRL_STOP that is not a stop_t of this version");
    else
        (void)snprintf(agent->note, sizeof agent->note,
                       "stopped by GRRL_STOP from session %" PRId64 ", reason %s",
                       agent->stop.session_id, reasons[agent->stop.reason]);
    return agent->note;
}

int64_t grrl_agent_silence_us(const struct grrl_agent *agent)
{
    return agent_now_us(agent) - agent->heard_us;
}

void grrl_agent_close(struct grrl_agent *agent)
{
    agent_abandon(agent);
    for (int i = 0; i < GRRL_AGENT_SUBSCRIPTIONS; i++)
        if (agent->subscriptions[i] != NULL)
            (void)lcm_unsubscribe(agent->lcm, agent->subscriptions[i]);
    memset(agent->subscriptions, 0, sizeof agent->subscriptions);
}
