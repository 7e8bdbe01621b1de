/*
 * learn_policy.h: the policy `learn`, a contextual bandit.
 *
 * It describes each action by its context (context.h), estimates the reward by kernel regression
 * over the cases (case_base.h), and takes the action with the highest upper confidence bound, or
 * estimate where the push was already made on the link as it is.
 * Rewards are immediate: what a push reveals distinguishes good pushes from bad ones without
 * look-ahead.
 */
#ifndef GRRL_LEARN_POLICY_H
#define GRRL_LEARN_POLICY_H

#include "grrl/base/api.h"
#include "grrl/learner/cases/case_base.h"
#include "grrl/learner/cases/context.h"
#include "grrl/learner/policy.h"

GRRL_API_BEGIN

/* The contexts of all actions of a state, as keys: action[link][direction]. */
struct grrl_contexts {
    uint8_t n_links;
    uint32_t action[GRRL_MAX_LINKS][GRRL_DIRECTIONS];
};

/* The policy's memory; the cases follow it. Its configuration is a struct grrl_case_config. */
struct grrl_learn_policy {
    struct grrl_case_config config;
    struct grrl_case_base cases;
    /* private */
    struct grrl_trial_attempts attempts;
    struct grrl_contexts contexts; /* in the state of the last choice */
};

/* Bytes to pass to grrl_policy_make for this policy; a constant expression. */
#define GRRL_LEARN_POLICY_BYTES(capacity)                                                          \
    (sizeof(struct grrl_learn_policy) + (capacity) * sizeof(struct grrl_case))

GRRL_API_END

#endif
