/* worst.h: the cost of a decision at full capacity. */
#ifndef ONBOARD_WORST_H
#define ONBOARD_WORST_H

#include "controller.h"

/*
 * The maximum cost, in ticks of `count`, of a choice and the update after it, over 100 structures
 * of GRRL_MAX_LINKS links, with the policy's memory full. Uses the controller's memory.
 */
uint32_t worst_decision(struct onboard_controller *controller, const struct grrl_policy_type *type,
                        uint32_t (*count)(void));

#endif
