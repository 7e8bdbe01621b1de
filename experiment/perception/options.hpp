/* options.hpp: the command line of grrl-evaluate. */
#ifndef GRRL_EXPERIMENT_PERCEPTION_OPTIONS_HPP
#define GRRL_EXPERIMENT_PERCEPTION_OPTIONS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "cli/options.h"
#include "trial.hpp"

namespace grrl_experiment::perception
{

struct Options {
    std::string objects; /* empty: all */
    int trials = 50;
    uint64_t seed = 1;
    int jobs = 1;
    std::vector<double> noise{1.0, 2.0}; /* in units of the default */
    TrialParams trial;
    std::string csv; /* empty: none, like the next */
    std::string svg;
    bool quiet = false;
};

grrl_options_result parse_options(int argc, char **argv, Options &options);

/* Describes one study of the program; completes outro, which lists the choices of that study. */
grrl_program describe_study(const char *usage, const char *intro, std::string &outro);

} // namespace grrl_experiment::perception

#endif
