/* options.hpp: the command line of grrl-experiment. */
#ifndef GRRL_EXPERIMENT_OPTIONS_HPP
#define GRRL_EXPERIMENT_OPTIONS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "cli/options.h"
#include "policies.hpp"
#include "transport.hpp"

namespace grrl_experiment
{

struct Options {
    std::string object;
    std::vector<const Policy *> policies; /* empty: those of the figure, or learn */
    int trials = 50;
    int experiments = 20;
    uint64_t seed = 1;
    int jobs = 0; /* 0: one per core */
    std::string out;
    std::string pretrain; /* object; empty: none */
    int pretrain_trials = 0;
    std::string figure;
    Transport transport = Transport::MEMQ;
    int cap = 100;
    double noise_mm = 0.7;
    std::string command; /* as typed, for the report */
};

grrl_options_result parse_options(int argc, char **argv, Options &options);

} // namespace grrl_experiment

#endif
