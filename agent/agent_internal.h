/* agent_internal.h: the interfaces between the parts of the agent's core. */
#ifndef GRRL_AGENT_INTERNAL_H
#define GRRL_AGENT_INTERNAL_H

#include "agent.h"

/* The agent's phase of a trial. */
enum phase {
    PHASE_NONE,     /* no trial, or not this one: frames are ignored */
    PHASE_WATCHING, /* frames of push cmd_seq are observed until they settle */
    PHASE_JUDGING,  /* the model after cmd_seq is sent; waiting for the supervisor's judgement */
    PHASE_CHOOSING, /* judged, but there is no next push yet */
    PHASE_COMMANDED /* push cmd_seq is sent; no frame of it has arrived yet */
};

/* agent_trial.c: the course of a trial. */
void agent_take_trial(struct grrl_agent *agent, const grrl_trial_t *trial);
void agent_take_frame(struct grrl_agent *agent, grrl_points_t *points);
void agent_take_status(struct grrl_agent *agent, const grrl_push_status_t *status);
void agent_take_decision(struct grrl_agent *agent, const grrl_decision_t *decision);
void agent_abandon(struct grrl_agent *agent);

/* Call when the robot moves for another agent. */
void agent_meet_rival(struct grrl_agent *agent);

/* agent_choice.c: the next push, within the limits. GRRL_ERR_NONE: nothing can be pushed. */
enum grrl_status agent_choose(struct grrl_agent *agent, struct grrl_decision *decision);
bool agent_has_table(const struct grrl_agent *agent);

/* agent_plant.c: mistakes of the tracker and the robot. All are silent when observing. */
/* Checks a frame of the accepted tracker; taken: it belongs to the current trial. */
void agent_watch_frame(struct grrl_agent *agent, const grrl_points_t *points, bool taken);
/* Drops the points off the table; false: the frame must not be used. */
bool agent_admit_frame(struct grrl_agent *agent, grrl_points_t *points);
/* Checks a status of the robot before it is used. */
void agent_watch_status(struct grrl_agent *agent, const grrl_push_status_t *status);
/* Call when another tracker and robot have replaced the known ones. */
void agent_forget_plant(struct grrl_agent *agent);
/* Call when the current push is sent again without a sign that the robot has it. */
void agent_watch_resend(struct grrl_agent *agent);
/* Counts a mistake; true if it is the first, which must be reported. */
bool agent_mistake(struct grrl_agent *agent, enum grrl_agent_mistake mistake, int64_t n);

/* agent_publish.c: outgoing messages. All are silent when observing. */
void agent_make_model(struct grrl_agent *agent);
void agent_make_decision(struct grrl_agent *agent, const struct grrl_decision *decision);

/* Sends everything the other side may be waiting for, from the cache. */
void agent_answer(struct grrl_agent *agent);
void agent_publish_status(struct grrl_agent *agent);
void agent_publish_model(struct grrl_agent *agent);

/* agent.c */
void agent_note(struct grrl_agent *agent, const char *text);
void agent_event(struct grrl_agent *agent, enum grrl_agent_event_kind kind);
int64_t agent_now_us(const struct grrl_agent *agent);

#endif
