/*
 * score.hpp: how right an answer about a recording is.
 *
 * A body of the answer stands for the true one that most of its tracks are of. What rests is one
 * body with the ground: its tracks may be background, of no body, or of one body (in metres, of
 * several: anything on a table may be an object). Tracks of which
 * nobody can say where they belong do not count.
 */
#ifndef GRRL_EXPERIMENT_RECORDINGS_SCORE_HPP
#define GRRL_EXPERIMENT_RECORDINGS_SCORE_HPP

#include <vector>

#include "recording.hpp"
#include "truth.hpp"

namespace grrl_experiment::recordings
{

constexpr double called_probability = 0.5; /* a joint is called from here on .. */
constexpr double sure_probability = 0.95;  /* .. and sure from here on */

struct Called {
    double probability;
    bool right; /* two bodies with such a joint, which no better call has */
};

struct Score {
    bool right = false;        /* bodies right, every joint called, none false */
    bool bodies_right = false; /* each in one body, of little else, and none too many */
    double error = 0.0;        /* share of the tracks in some body that are in a wrong one */
    int bodies = 0;            /* in the answer */
    int joints = 0;            /* in truth, but for open ones */
    int missed = 0;            /* of them, not called */
    int false_called = 0;
    int false_sure = 0;
    std::vector<Called> called; /* all joints of the answer, the surest first */
};

Score score(const Recording &recording, const Estimate &estimate);

} // namespace grrl_experiment::recordings

#endif
