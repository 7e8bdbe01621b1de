/* policies.c: the table of all policies. A program that refers to it links all of them. */
#include "grrl/policies.h"

#include <string.h>

#include "grrl/learner/cases/learn_policy.h"
#include "grrl/learner/learner.h"
#include "grrl/learner/relational_q/paper_policy.h"

/* An agent of 100 entries fits in 256 KiB (checked for the default capacities). */
#if GRRL_MAX_LINKS <= 16 && GRRL_MAX_FEATURES <= 192 && GRRL_MAX_KEYFRAMES <= 48
_Static_assert(sizeof(struct grrl_learner) + GRRL_PAPER_POLICY_BYTES(100) <= (size_t)256 * 1024 &&
                   sizeof(struct grrl_learner) + GRRL_LEARN_POLICY_BYTES(100) <= (size_t)256 * 1024,
               "an agent of 100 entries in 256 KiB");
#endif

#define ADDRESS(name) &grrl_policy_##name,
const struct grrl_policy_type *const grrl_policies[] = {GRRL_POLICIES(ADDRESS) NULL};

const struct grrl_policy_type *grrl_policy_find(const char *name)
{
    for (const struct grrl_policy_type *const *type = grrl_policies; *type != NULL; type++)
        if (strcmp((*type)->name, name) == 0)
            return *type;
    return NULL;
}
