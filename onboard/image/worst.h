/*
 * worst.h: decisions at full capacity: every case and state in use, states of all links. A run of
 * RPRPRPR comes nowhere near.
 */
#ifndef ONBOARD_WORST_H
#define ONBOARD_WORST_H

#include "controller.h"

/* The most that choose and learn took together, in units of the count, over many states; grounding
 * the push aside. Uses the controller's memory. */
uint32_t worst_of_cases(struct onboard_controller *controller, uint32_t (*count)(void));
uint32_t worst_of_experiences(struct onboard_controller *controller, uint32_t (*count)(void));

#endif
