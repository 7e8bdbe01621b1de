/* PCG32, and unbiased numbers below a limit. */
#include "grrl/base/random.h"

void grrl_random_init(struct grrl_random *random, uint64_t seed, uint64_t stream)
{
    random->state = 0;
    random->increment = (stream << 1) | 1u;
    (void)grrl_random_next(random);
    random->state += seed;
    (void)grrl_random_next(random);
}

uint32_t grrl_random_below(struct grrl_random *random, uint32_t count)
{
    uint32_t threshold =
        (0u - count) % count; /* 2^32 mod count: values below it would cause a bias */
    uint32_t value;
    do {
        value = grrl_random_next(random);
    } while (value < threshold);
    return value % count;
}

float grrl_random_uniform(struct grrl_random *random)
{
    return (float)(grrl_random_next(random) >> 8) * (1.0f / 16777216.0f);
}
