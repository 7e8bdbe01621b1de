/* found.h: what the agent knows about the object, as text, kept after the trial. */
#ifndef GRRL_AGENT_FOUND_H
#define GRRL_AGENT_FOUND_H

#include "agent.h"

enum {
    GRRL_FOUND_NODES = 4 * GRRL_MAX_LINKS + 8 * GRRL_MAX_JOINTS + 8,
    GRRL_FOUND_BYTES = 32 * GRRL_FOUND_NODES
};

/* All zero: nothing known yet. */
struct grrl_found {
    bool known;
    int32_t trial_id;
    int32_t pushes;
    float sure; /* grrl_agent_sureness and its pair: n of fn */
    unsigned pair[2];
    char term[GRRL_FOUND_BYTES];
    struct grrl_model model;
};

/* Copies the learner's estimate; call on GRRL_AGENT_PERCEIVED. */
void grrl_found_take(struct grrl_found *found, const struct grrl_agent *agent,
                     const struct grrl_agent_event *event);

/* Prints one line: the term and its least certain pair. */
void grrl_found_print_line(const struct grrl_found *found);

/* Prints the term and a line for each joint. */
void grrl_found_print(const struct grrl_found *found);

#endif
