/* found.h: what the agent believes of the object, in words, kept beyond the trial. */
#ifndef GRRL_AGENT_FOUND_H
#define GRRL_AGENT_FOUND_H

#include "agent.h"

enum {
    GRRL_FOUND_NODES = 4 * GRRL_MAX_LINKS + 8 * GRRL_MAX_JOINTS + 8,
    GRRL_FOUND_BYTES = 32 * GRRL_FOUND_NODES
};

/* All zero: nothing is known yet. */
struct grrl_found {
    bool known;
    int32_t trial_id;
    int32_t pushes;
    float sure; /* grrl_agent_sureness, and the pair that it is of: n of fn */
    unsigned pair[2];
    char term[GRRL_FOUND_BYTES];
    struct grrl_model model;
};

/* Takes over what the agent's learner believes; on GRRL_AGENT_PERCEIVED. */
void grrl_found_take(struct grrl_found *found, const struct grrl_agent *agent,
                     const struct grrl_agent_event *event);

/* One line: the term and what it leaves open. */
void grrl_found_print_line(const struct grrl_found *found);

/* The term and a line for each joint. */
void grrl_found_print(const struct grrl_found *found);

#endif
