/*
 * closest.h (private): keeps the closest of many states in a fixed number of places. Of equally
 * close states it keeps those with the lowest numbers.
 */
#ifndef GRRL_CLOSEST_H
#define GRRL_CLOSEST_H

#include "grrl/learner/relational_q/experience.h"

/* A heap once it is full, the most distant first. */
struct grrl_closest {
    unsigned n;
    unsigned most; /* 1 to GRRL_RECALL_STATES */
    uint32_t state[GRRL_RECALL_STATES];
    uint8_t distance[GRRL_RECALL_STATES];
};

void grrl_closest_clear(struct grrl_closest *closest, unsigned most);

/* Whether a state would be kept. Cheap, so ask it before more expensive tests. */
static inline bool grrl_closest_accepts(const struct grrl_closest *closest, unsigned distance,
                                        uint32_t state)
{
    return closest->n < closest->most || distance < closest->distance[0] ||
           (distance == closest->distance[0] && state < closest->state[0]);
}

/* Adds an accepted state; when full, it replaces the most distant one. */
void grrl_closest_add(struct grrl_closest *closest, unsigned distance, uint32_t state);

/* Sorts the closest first. Nothing can be added afterwards. */
void grrl_closest_sort(struct grrl_closest *closest);

#endif
