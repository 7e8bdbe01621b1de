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
    std::vector<std::string> objects;     /* or streams of objects, *.stream */
    std::vector<std::string> pretrain;    /* OBJECT:N, one after the other */
    std::string start;                    /* a store that all learners start with; or empty */
    std::vector<const Policy *> policies; /* empty: those of the figure, or learn */
    int trials = 50;
    int experiments = 20;
    uint64_t first_seed = 1;
    uint64_t last_seed = 1;
    int jobs = 0; /* 0: one per core */
    std::string out;
    std::string figure;
    Transport transport = Transport::MEMQ;
    int cap = 100;
    double noise_mm = 0.7;
    std::vector<std::string> worlds; /* see conditions.hpp; empty: the default one */
    int shard = 1; /* of so many: this part of the experiments, without tables and pictures */
    int shards = 1;
    std::vector<std::string> merge; /* folders whose results are merged */
    std::string command;            /* as typed, for the report */
};

grrl_options_result parse_options(int argc, char **argv, Options &options);

/* The arguments, a line each, that all parts of a run share. parse_options understands them. */
std::string shared_arguments(const Options &options);

/* Splits OBJECT:N; false if it is something else. */
bool split_pretrain(const std::string &text, std::string &object, int &trials);

/* The seeds of all experiments, for the world and the policy: of seed S, 1000 S + 1, 1000 S + 2, ..
 */
std::vector<uint64_t> experiment_seeds(const Options &options);

} // namespace grrl_experiment

#endif
