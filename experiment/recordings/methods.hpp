/*
 * methods.hpp: the answers of three methods to a recording.
 *
 * Ours is the program grrl-perceive as users run it: a file in, JSON out. The paper's skill
 * (perception/baseline.hpp) and plain merging by BIC (merging.hpp) see frames evenly spaced in
 * time, with at most the 120 longest tracks.
 */
#ifndef GRRL_EXPERIMENT_RECORDINGS_METHODS_HPP
#define GRRL_EXPERIMENT_RECORDINGS_METHODS_HPP

#include <string>
#include <vector>

#include "recording.hpp"
#include "truth.hpp"

namespace grrl_experiment::recordings
{

enum Method { OURS, SKILL, BIC, METHODS };
extern const char *const method_names[METHODS];

/* The failure if the program is missing. */
constexpr const char *cannot_run = "cannot be run";

struct Answer {
    Estimate estimate; /* by the ids of tracks */
    double ms = 0.0;
    bool failed = false; /* no answer; failure says why */
    std::string failure;
};

/* Runs a program in $PATH or by its path: PROGRAM --json --unit UNIT. */
Answer ask_program(const std::string &program, const Recording &recording);

Answer ask_skill(const Recording &recording);
Answer ask_bic(const Recording &recording);

/* Tracks in selected frames, in metres (a pixel is a millimetre, as for grrl-perceive). */
struct Pictures {
    struct Place {
        bool seen = false;
        grrl_sim::Vec2 at_m;
    };
    std::vector<int32_t> id;                /* of each row */
    std::vector<std::vector<Place>> places; /* [frame][row] */
};
Pictures pictures_of(const Recording &recording, int pictures, size_t max_tracks);

} // namespace grrl_experiment::recordings

#endif
