/* agent_internal.h: how the parts of the agent's core call one another. */
#ifndef GRRL_AGENT_INTERNAL_H
#define GRRL_AGENT_INTERNAL_H

#include "agent.h"

/* Where the agent stands in a trial. */
enum stage {
    STAGE_NONE,     /* no trial, or not this one: nothing is taken in */
    STAGE_WATCHING, /* frames of push cmd_seq are taken in until they settle */
    STAGE_JUDGING,  /* the model after cmd_seq is out, the supervisor's word is awaited */
    STAGE_CHOOSING, /* judged, but there is no next push yet */
    STAGE_COMMANDED /* push cmd_seq is out, no frame of it has come yet */
};

/* agent_trial.c: the course of a trial. */
void agent_take_trial(struct grrl_agent *agent, const grrl_trial_t *trial);
void agent_take_frame(struct grrl_agent *agent, const grrl_points_t *points);
void agent_take_status(struct grrl_agent *agent, const grrl_push_status_t *status);
void agent_take_decision(struct grrl_agent *agent, const grrl_decision_t *decision);
void agent_abandon(struct grrl_agent *agent);

/* The robot moves for another agent. */
void agent_meet_rival(struct grrl_agent *agent);

/* agent_publish.c: messages going out. All are silent when observing. */
void agent_make_model(struct grrl_agent *agent);
void agent_make_decision(struct grrl_agent *agent, const struct grrl_decision *decision);

/* Everything the other side may be waiting for, from what is cached. */
void agent_answer(struct grrl_agent *agent);
void agent_publish_status(struct grrl_agent *agent);

/* agent.c */
void agent_note(struct grrl_agent *agent, const char *text);
void agent_event(struct grrl_agent *agent, enum grrl_agent_event_kind kind);
int64_t agent_now_us(const struct grrl_agent *agent);

#endif
