/*
 * remote_learner.h: a learner on a controller, in place of the library's own.
 *
 * The agent's core (agent.h) calls the functions of grrl/learner.h. A program that links
 * remote_learner.c gets these implementations instead of the library's: each asks the controller on
 * the line. The core stays the same, and all choices and all learning happen on the controller.
 */
#ifndef BRIDGE_REMOTE_LEARNER_H
#define BRIDGE_REMOTE_LEARNER_H

#include "line.h"

/* Call it before grrl_agent_init, which opens the controller. The line must outlive its use. */
void bridge_learner_use(struct bridge_line *line);

/* The result of a run, as the controller reports it. */
struct bridge_result {
    uint64_t models;
    uint64_t decisions;
    uint64_t updates;
    uint64_t store;
};

/* Closes the run. On failure it returns false; see line->why. */
bool bridge_learner_close(struct bridge_result *result);

#endif
