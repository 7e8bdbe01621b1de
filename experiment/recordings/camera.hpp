/* camera.hpp: from the table to the image, for stationary, moving and tilted cameras. */
#ifndef GRRL_EXPERIMENT_RECORDINGS_CAMERA_HPP
#define GRRL_EXPERIMENT_RECORDINGS_CAMERA_HPP

#include "recording.hpp"

namespace grrl_experiment::recordings
{

class View
{
public:
    View(const Conditions &conditions, uint64_t seed);

    /* The position of a point at a time, in the unit of the recording. */
    grrl_sim::Vec2 project(const Place &place, double t) const;
    bool in_picture(grrl_sim::Vec2 p) const;

private:
    double width_px_;
    double per_metre_;
    double tilt_rad_ = 0.0;
    double focal_ = 3.0; /* in image widths */
    double distance_m_;
    Wave pan_x_px_, pan_y_px_, turn_rad_, shake_x_px_, shake_y_px_;
    Ramp roll_rad_;
    Ramp zoom_;
};

} // namespace grrl_experiment::recordings

#endif
