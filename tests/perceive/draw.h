/* draw.h: random numbers for tests of recordings, in double precision. */
#ifndef TESTS_PERCEIVE_DRAW_H
#define TESTS_PERCEIVE_DRAW_H

#include "grrl/base/random.h"

static struct grrl_random random_numbers;

static double uniform(double low, double high)
{
    return low + (high - low) * (double)grrl_random_uniform(&random_numbers);
}

/* About normal: the sum of twelve uniform numbers. */
static double normal(void)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++)
        sum += uniform(0.0, 1.0);
    return sum;
}

#endif
