/*
 * random.h: the library's random number generator, a small state owned by the caller.
 *
 * PCG32 (O'Neill, 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms
 * for Random Number Generation"). The same seed and stream give the same numbers on every machine.
 */
#ifndef GRRL_RANDOM_H
#define GRRL_RANDOM_H

#include <stdint.h>

#include "grrl/base/api.h"

GRRL_API_BEGIN

struct grrl_random {
    /* private */
    uint64_t state;
    uint64_t increment;
};

/* Streams with the same seed are independent of one another. */
void grrl_random_init(struct grrl_random *random, uint64_t seed, uint64_t stream);

/* Uniform over all 32-bit values. Inline: a simulated tracker draws some 70,000 of them a push. */
static inline uint32_t grrl_random_next(struct grrl_random *random)
{
    uint64_t old = random->state;
    random->state = old * UINT64_C(6364136223846793005) + random->increment;
    uint32_t shifted = (uint32_t)(((old >> 18) ^ old) >> 27);
    uint32_t rotation = (uint32_t)(old >> 59);
    return (shifted >> rotation) | (shifted << ((32u - rotation) & 31u));
}

/* Uniform over 0 .. count - 1, without bias; count >= 1. */
uint32_t grrl_random_below(struct grrl_random *random, uint32_t count);

/* Uniform in [0, 1). */
float grrl_random_uniform(struct grrl_random *random);

GRRL_API_END

#endif
