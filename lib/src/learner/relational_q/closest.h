/*
 * closest.h (private): the closest of many states, of equally close ones those with the lowest
 * numbers, in memory for as many as are wanted.
 */
#ifndef GRRL_CLOSEST_H
#define GRRL_CLOSEST_H

#include "grrl/learner/relational_q/experience.h"

/* A heap once it is full, the farthest first. */
struct grrl_closest {
    unsigned n;
    unsigned most; /* 1 to GRRL_RECALL_STATES */
    uint32_t state[GRRL_RECALL_STATES];
    uint8_t distance[GRRL_RECALL_STATES];
};

void grrl_closest_clear(struct grrl_closest *closest, unsigned most);

/* Whether a state would be kept: asked first, it spares most states a dearer question. */
static inline bool grrl_closest_wants(const struct grrl_closest *closest, unsigned distance,
                                      uint32_t state)
{
    return closest->n < closest->most || distance < closest->distance[0] ||
           (distance == closest->distance[0] && state < closest->state[0]);
}

/* Keeps a state that is wanted, instead of the farthest when full. */
void grrl_closest_add(struct grrl_closest *closest, unsigned distance, uint32_t state);

/* The closest first. Nothing can be added then. */
void grrl_closest_sort(struct grrl_closest *closest);

#endif
