/* greedy_policy.c: the policy `greedy`, like `learn`, but it takes the best estimate instead of the
 * highest bound. The worked example in docs/design.md. */
#include "learner/cases/learn_operations.h"

static void config_default(void *config)
{
    struct grrl_case_config *cases = config;
    grrl_case_config_default(cases);
    cases->bound = 0.0f;
}

static enum grrl_status init(void *self, uint32_t capacity, const void *config)
{
    struct grrl_case_config greedy;
    config_default(&greedy);
    return grrl_learn_init(self, capacity, config != NULL ? config : &greedy);
}

GRRL_POLICY_TYPE grrl_policy_greedy = {
    .name = "greedy",
    .text = "like learn, but the best estimate, without a bound",
    .config_default = config_default,
    .init = init,
    GRRL_LEARN_OPERATIONS,
};
