/*
 * trial.hpp: one object on the table, pushed at random until its structure is found.
 *
 * The library and the baseline see the same frames. The pushes follow the random policy: any
 * estimated body, any of the six directions.
 */
#ifndef GRRL_EXPERIMENT_PERCEPTION_TRIAL_HPP
#define GRRL_EXPERIMENT_PERCEPTION_TRIAL_HPP

#include <cstdint>

#include "world.hpp"

namespace grrl_experiment::perception
{

enum Method { OURS, BASELINE, METHODS };

/* Sums over states and trials. */
struct Tally {
    int64_t states = 0; /* after each push until the library is right, or the cap */
    int64_t wrong_joint = 0;
    int64_t false_split = 0;
    int64_t wrong = 0;        /* either of the two */
    int64_t moved_states = 0; /* of these, the states in which every joint was moved enough ... */
    int64_t missed = 0;       /* ... and a joint is missing */
    int64_t features = 0;
    int64_t misplaced = 0;
    int64_t sure = 0; /* joints with a probability of at least 0.95, in all states ... */
    int64_t sure_and_right = 0;
    int64_t six = 0;       /* trials in which every joint was moved enough within six pushes ... */
    int64_t six_exact = 0; /* ... and the structure was exact in one of these states */
    int64_t told =
        0; /* trials in which every joint was moved enough, or the structure was known before ... */
    int64_t told_exact = 0; /* ... and the structure was exact then or before */
    int64_t ended_exact = 0;

    Tally &operator+=(const Tally &other);
};

struct TrialResult {
    int pushes = 0; /* until the library was right */
    bool at_cap = false;
    double update_ms =
        0.0; /* mean over the trial of perception's time for one push with all its frames */
    Tally tally[METHODS];
};

struct TrialParams {
    grrl_sim::WorldParams world;
    int cap = 100;
};

/* A joint has moved enough if its values so far span this range: three and a half, or four, times
 * the library's detection threshold. */
constexpr double enough_rad = grrl_sim::radians(10.0);
constexpr double enough_m = 0.010;

TrialResult run_trial(const grrl_sim::ObjectSpec &object, const TrialParams &params, uint64_t seed);

} // namespace grrl_experiment::perception

#endif
