/*
 * merging.hpp: plain rigid motion segmentation with joints, as a baseline.
 *
 * Small groups of neighbours at constant distances are merged while that lowers the BIC: squared
 * residuals over sigma^2, plus a pose of three parameters for each body and frame. The BIC of their
 * relative poses decides whether two bodies are independent or have a revolute or prismatic joint.
 * The method handles neither camera motion nor outliers.
 */
#ifndef GRRL_EXPERIMENT_RECORDINGS_MERGING_HPP
#define GRRL_EXPERIMENT_RECORDINGS_MERGING_HPP

#include "methods.hpp"

namespace grrl_experiment::recordings
{

/* sigma_m: noise of a point in a frame. The ids of the estimate are rows of the frames. Cost: cubic
 * in the tracks in the worst case. */
Estimate merge_by_bic(const Pictures &pictures, double sigma_m);

} // namespace grrl_experiment::recordings

#endif
