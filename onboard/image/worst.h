/* worst.h: what a decision costs at full capacity. */
#ifndef ONBOARD_WORST_H
#define ONBOARD_WORST_H

#include "controller.h"

/*
 * The most, in units of `count`, that a choice and what is learned from it take over 100 structures
 * of GRRL_MAX_LINKS links, once the policy's memory is full. Uses the controller's memory.
 */
uint32_t worst_decision(struct onboard_controller *controller, const struct grrl_policy_type *type,
                        uint32_t (*count)(void));

#endif
