/*
 * policies.h: the policies of the library, one row each.
 *
 * Programs offer every policy listed here. Firmware names the policy it uses (`&grrl_policy_learn`)
 * and links no other. A new policy is a source file that defines its type, and a row here.
 */
#ifndef GRRL_POLICIES_H
#define GRRL_POLICIES_H

#include "grrl/base/api.h"
#include "grrl/learner/policy.h"

GRRL_API_BEGIN

/* The first row is the default. */
#define GRRL_POLICIES(ROW)                                                                         \
    ROW(learn)                                                                                     \
    ROW(paper)                                                                                     \
    ROW(greedy)                                                                                    \
    ROW(random)

#define GRRL_DECLARE_POLICY(name) extern const struct grrl_policy_type grrl_policy_##name;
GRRL_POLICIES(GRRL_DECLARE_POLICY)
#undef GRRL_DECLARE_POLICY

/* All policies, terminated by NULL. */
extern const struct grrl_policy_type *const grrl_policies[];

/* The policy with this name, or NULL. */
const struct grrl_policy_type *grrl_policy_find(const char *name);

GRRL_API_END

#endif
