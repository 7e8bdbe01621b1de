/*
 * merging.hpp: plain rigid motion segmentation with joints, as a yardstick.
 *
 * Small groups of neighbours that keep their distances are merged while that lowers the BIC:
 * squared residuals over sigma^2, and for each body and picture a pose of three parameters. The
 * number of bodies is what remains. Two bodies are independent, or have a revolute or a prismatic
 * joint, by the BIC of their relative poses. It knows neither cameras nor outliers.
 */
#ifndef GRRL_EXPERIMENT_RECORDINGS_MERGING_HPP
#define GRRL_EXPERIMENT_RECORDINGS_MERGING_HPP

#include "methods.hpp"

namespace grrl_experiment::recordings
{

/* sigma_m: of a point in a picture. The ids of the estimate are rows of the pictures. Cost: cubic
 * in the tracks at worst. */
Estimate merge_by_bic(const Pictures &pictures, double sigma_m);

} // namespace grrl_experiment::recordings

#endif
