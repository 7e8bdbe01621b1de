/* agent_internal.h: how the parts of the agent's core call one another. */
#ifndef GRRL_AGENT_INTERNAL_H
#define GRRL_AGENT_INTERNAL_H

#include "agent.h"

/* Where the agent stands in a trial. */
enum phase {
    PHASE_NONE,     /* no trial, or not this one: nothing is taken in */
    PHASE_WATCHING, /* frames of push cmd_seq are taken in until they settle */
    PHASE_JUDGING,  /* the model after cmd_seq is out, the supervisor's word is awaited */
    PHASE_CHOOSING, /* judged, but there is no next push yet */
    PHASE_COMMANDED /* push cmd_seq is out, no frame of it has come yet */
};

/* agent_trial.c: the course of a trial. */
void agent_take_trial(struct grrl_agent *agent, const grrl_trial_t *trial);
void agent_take_frame(struct grrl_agent *agent, grrl_points_t *points);
void agent_take_status(struct grrl_agent *agent, const grrl_push_status_t *status);
void agent_take_decision(struct grrl_agent *agent, const grrl_decision_t *decision);
void agent_abandon(struct grrl_agent *agent);

/* The robot moves for another agent. */
void agent_meet_rival(struct grrl_agent *agent);

/* agent_choice.c: the next push, within the limits. GRRL_ERR_NONE: nothing can be pushed. */
enum grrl_status agent_choose(struct grrl_agent *agent, struct grrl_decision *decision);
bool agent_has_table(const struct grrl_agent *agent);

/* agent_plant.c: what the tracker and the robot do wrong. All are silent when observing. */
/* A frame that is new, of a tracker that is obeyed; taken: it belongs to the trial under way. */
void agent_watch_frame(struct grrl_agent *agent, const grrl_points_t *points, bool taken);
/* Drops the points that lie beside the table; false: the frame must not be taken in. */
bool agent_admit_frame(struct grrl_agent *agent, grrl_points_t *points);
/* A status of the robot, before it is taken in. */
void agent_watch_status(struct grrl_agent *agent, const grrl_push_status_t *status);
/* Another tracker and robot took the place of those known. */
void agent_forget_plant(struct grrl_agent *agent);
/* The push under way is sent again and nothing tells that the robot has it. */
void agent_watch_resend(struct grrl_agent *agent);
/* Counts it; true if it is the first, which must be told. */
bool agent_mistake(struct grrl_agent *agent, enum grrl_agent_mistake mistake, int64_t n);

/* agent_publish.c: messages going out. All are silent when observing. */
void agent_make_model(struct grrl_agent *agent);
void agent_make_decision(struct grrl_agent *agent, const struct grrl_decision *decision);

/* Everything the other side may be waiting for, from what is cached. */
void agent_answer(struct grrl_agent *agent);
void agent_publish_status(struct grrl_agent *agent);
void agent_publish_model(struct grrl_agent *agent);

/* agent.c */
void agent_note(struct grrl_agent *agent, const char *text);
void agent_event(struct grrl_agent *agent, enum grrl_agent_event_kind kind);
int64_t agent_now_us(const struct grrl_agent *agent);

#endif
