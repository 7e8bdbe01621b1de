/* policy_memory.h: memory for any policy of the library, for tests. */
#ifndef GRRL_POLICY_MEMORY_H
#define GRRL_POLICY_MEMORY_H

#include <stddef.h>

#include "grrl/learner/cases/learn_policy.h"
#include "grrl/learner/relational_q/paper_policy.h"
#include "grrl/policies.h"

/* Memory for this many entries; tests may inspect the policy that was last made there. */
#define POLICY_MEMORY(capacity)                                                                    \
    union {                                                                                        \
        max_align_t aligned;                                                                       \
        unsigned char bytes[GRRL_PAPER_POLICY_BYTES(capacity)];                                    \
        struct grrl_learn_policy learn;                                                            \
        struct grrl_paper_policy paper;                                                            \
    }

#endif
