/* verdict.hpp: how accurate an estimate is, the same for every method of perception. */
#ifndef GRRL_EXPERIMENT_PERCEPTION_VERDICT_HPP
#define GRRL_EXPERIMENT_PERCEPTION_VERDICT_HPP

#include "truth.hpp"

namespace grrl_experiment::perception
{

struct Verdict {
    bool wrong_joint = false;  /* a joint where there is none, or of the wrong type */
    bool false_split = false;  /* a body that is part of a link, or of the table */
    bool missed_joint = false; /* the estimate lacks some joint */
    bool exact = false;        /* links and joints match the truth */
    int features = 0;          /* visible, on links that have a body, or on the table */
    int misplaced = 0;         /* of these, in the wrong body */
    int sure = 0;              /* joints with a probability of at least 0.95 ... */
    int sure_and_right = 0;    /* ... and those that are right */
};

Verdict judge(const Estimate &estimate, const grrl_sim::World &world);

} // namespace grrl_experiment::perception

#endif
