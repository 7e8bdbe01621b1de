/*
 * random.hpp: the library's random numbers, with the distributions that a simulation needs.
 *
 * Each purpose has its own stream, so that drawing more numbers for one does not shift another.
 */
#ifndef GRRL_SIM_RANDOM_HPP
#define GRRL_SIM_RANDOM_HPP

#include <cstdint>
#include <utility>
#include <vector>

#include "grrl/base/random.h"

namespace grrl_sim
{

enum class Stream : uint64_t { OBJECT = 1, PUSH = 2, NOISE = 3, SAMPLE = 4 };

class Random
{
public:
    Random(uint64_t seed, Stream stream)
    {
        grrl_random_init(&state_, seed, static_cast<uint64_t>(stream));
    }

    double uniform() { return static_cast<double>(grrl_random_uniform(&state_)); }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /* 0 .. count - 1 */
    int below(int count)
    {
        return static_cast<int>(grrl_random_below(&state_, static_cast<uint32_t>(count)));
    }

    /* Mean 0, variance 1: a sum of twelve uniforms, two from each number drawn. Unlike Box-Muller
     * it is the same on every machine: summed as integers, so it is exact. */
    double normal()
    {
        uint64_t both = 0; /* of the high halves, times 65536, and the low ones */
        uint32_t low = 0;
        for (int i = 0; i < 6; i++) {
            uint32_t two = grrl_random_next(&state_);
            both += two;
            low += two & 0xffffu;
        }
        uint32_t sum = static_cast<uint32_t>((both - low) >> 16) + low;
        return (static_cast<double>(sum) - 6.0 * 65535.0) / 65536.0;
    }

    template <typename T> void shuffle(std::vector<T> &items)
    {
        for (size_t i = items.size(); i > 1; i--)
            std::swap(items[i - 1], items[static_cast<size_t>(below(static_cast<int>(i)))]);
    }

private:
    grrl_random state_;
};

/* Each trial of a seed has its own object pose, noise and friction. */
inline uint64_t trial_seed(uint64_t seed, int32_t trial)
{
    grrl_random random;
    grrl_random_init(&random, seed, static_cast<uint64_t>(trial));
    uint64_t high = grrl_random_next(&random);
    return high << 32 | grrl_random_next(&random);
}

} // namespace grrl_sim

#endif
