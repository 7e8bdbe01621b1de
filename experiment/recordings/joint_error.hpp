/* joint_error.hpp: how far relative poses deviate from those that a joint allows. */
#ifndef GRRL_EXPERIMENT_RECORDINGS_JOINT_ERROR_HPP
#define GRRL_EXPERIMENT_RECORDINGS_JOINT_ERROR_HPP

#include <vector>

#include "geometry.hpp"

namespace grrl_experiment::recordings
{

/* Root mean squares over the poses. */
struct JointErrors {
    double pivot_m;  /* from the best pivot */
    double reach_m;  /* distance of that pivot from the origin of the second body */
    double line_m;   /* across the best axis */
    double turn_rad; /* about the mean angle: an axis has none */
};

/* poses: of one body in another. */
JointErrors joint_errors(const std::vector<grrl_sim::Pose> &poses);

} // namespace grrl_experiment::recordings

#endif
