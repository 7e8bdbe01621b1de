/*
 * remote_learner.h: a learner on a controller in place of the library's own.
 *
 * The agent's core (agent.h) calls the functions of grrl/learner.h. A program that links
 * remote_learner.c with it gets these instead of the library's: each asks the controller on the
 * line. So the core is the same, and what is learned and chosen comes from the controller alone.
 */
#ifndef BRIDGE_REMOTE_LEARNER_H
#define BRIDGE_REMOTE_LEARNER_H

#include "line.h"

/* Before grrl_agent_init, which opens the controller. The line must stay. */
void bridge_learner_use(struct bridge_line *line);

/* What a run came to, as the controller has it. */
struct bridge_result {
    uint64_t models;
    uint64_t decisions;
    uint64_t updates;
    uint64_t store;
};

/* Closes the run. False: line->why. */
bool bridge_learner_close(struct bridge_result *result);

#endif
