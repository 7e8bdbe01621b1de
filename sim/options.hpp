/* options.hpp: the command line of grrl-sim. */
#ifndef GRRL_SIM_OPTIONS_HPP
#define GRRL_SIM_OPTIONS_HPP

#include <cstdint>
#include <string>

#include "camera.hpp"
#include "cli/options.h"
#include "tracker.hpp"

namespace grrl_sim
{

struct Options {
    std::string object;
    int trials = 1;
    uint64_t seed = 1;
    int cap = 100;
    TrackerParams tracker;
    bool camera = false; /* pictures instead of points, with this look */
    CameraLook look;
    bool real_time = false;
    bool quiet = false;
    double agent_timeout_s = 0.0; /* 0: wait forever */
    std::string log;              /* empty: none, as for the next two */
    std::string results;
    std::string lcm_url;
};

grrl_options_result parse_options(int argc, char **argv, Options &options);

} // namespace grrl_sim

#endif
