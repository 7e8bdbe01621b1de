/* options.hpp: the command line of grrl-track. */
#ifndef GRRL_TRACK_OPTIONS_HPP
#define GRRL_TRACK_OPTIONS_HPP

#include <string>
#include <vector>

#include "cli/options.h"
#include "table.hpp"

namespace grrl_track
{

struct Options {
    std::string input; /* video, folder or image; empty: none, as for all texts here */
    int camera = -1;   /* -1: none */
    bool lcm = false;
    bool publish = false;
    std::string lcm_url;
    double scale_mm = 0.0; /* per pixel; 0: not given */
    double distortion = 0.0;
    std::vector<PointPair> points;
    Board board; /* columns 0: none */
    std::string calibration;
    double tool_hue = -1.0; /* degrees; -1: no colour */
    double tool_radius_mm = 10.0;
    std::string empty;
    std::string csv;
    std::string draw;
    int frames = 0; /* 0: all */
    bool quiet = false;
};

grrl_options_result parse_options(int argc, char **argv, Options &options);

} // namespace grrl_track

#endif
