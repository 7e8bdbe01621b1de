/*
 * score.hpp: how accurate an answer about a recording is.
 *
 * A body of the answer represents the true body to which most of its tracks belong. Things at rest
 * are one body with the ground: their tracks may be background, in no body, or in one body (in
 * metres in several, since anything on a table may be an object). Tracks that belong nowhere do not
 * count.
 */
#ifndef GRRL_EXPERIMENT_RECORDINGS_SCORE_HPP
#define GRRL_EXPERIMENT_RECORDINGS_SCORE_HPP

#include <vector>

#include "recording.hpp"
#include "truth.hpp"

namespace grrl_experiment::recordings
{

constexpr double called_probability = 0.5; /* a joint is called from here on ... */
constexpr double sure_probability = 0.95;  /* ... and sure from here on */

struct Called {
    double probability;
    bool right; /* a true joint of this type between the two bodies, not matched by a more probable
                   call */
};

struct Score {
    bool right = false; /* bodies right, every joint called, none false */
    bool bodies_right =
        false;          /* each is one body with little else in it, and there are no others */
    double error = 0.0; /* share of the tracks in some body that are in a wrong one */
    int bodies = 0;     /* in the answer */
    int joints = 0;     /* true ones, but for open ones */
    int missed = 0;     /* of these, not called */
    int false_called = 0;
    int false_sure = 0;
    std::vector<Called> called; /* all joints of the answer, most probable first */
};

Score score(const Recording &recording, const Estimate &estimate);

} // namespace grrl_experiment::recordings

#endif
