/* policy.c: makes a policy of any type. */
#include "grrl/learner/policy.h"

enum grrl_status grrl_policy_make(const struct grrl_policy_type *type, void *memory, size_t bytes,
                                  uint32_t capacity, const void *config, struct grrl_policy *policy)
{
    if (type->entries != NULL && capacity == 0)
        return GRRL_ERR_ARGUMENT;
    if (type->bytes(capacity) > bytes)
        return GRRL_ERR_FULL;
    enum grrl_status status = type->init(memory, capacity, config);
    if (status == GRRL_OK)
        *policy = (struct grrl_policy){type, memory};
    return status;
}
