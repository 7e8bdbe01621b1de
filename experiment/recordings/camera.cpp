/* camera.cpp: a pinhole camera above the table, and its motion. */
#include "camera.hpp"

#include <cmath>

#include "random.hpp"

namespace grrl_experiment::recordings
{

using grrl_sim::radians;
using grrl_sim::Random;
using grrl_sim::Vec2;

namespace
{

constexpr double links_in_picture = 3.6;   /* side by side */
constexpr double height_of_width = 0.5625; /* 16:9 */

Wave draw_wave(Random &random, double size, double slow, double fast)
{
    Wave wave;
    for (int i = 0; i < 2; i++) {
        wave.size[i] = size * random.uniform(0.4, 0.7);
        wave.phase[i] = random.uniform(0.0, 2.0 * grrl_sim::pi);
        wave.cycles[i] = random.uniform(slow, fast);
    }
    return wave;
}

} // namespace

View::View(const Conditions &conditions, uint64_t seed) : width_px_(conditions.size.picture_px)
{
    Random random(seed, grrl_sim::Stream::PUSH);
    double sign = random.below(2) == 0 ? -1.0 : 1.0;
    per_metre_ = width_px_ / (links_in_picture * conditions.size.link_m);
    switch (conditions.camera) {
    case Camera::FIXED:
        break;
    case Camera::PAN:
        pan_x_px_ = draw_wave(random, 0.15 * width_px_, 0.3, 0.7);
        pan_y_px_ = draw_wave(random, 0.08 * width_px_, 0.3, 0.7);
        break;
    case Camera::ROLL:
        roll_rad_ = {0.0, 1.0, sign * radians(random.uniform(8.0, 20.0))};
        break;
    case Camera::ZOOM:
        zoom_ = {0.0, 1.0, sign * random.uniform(0.15, 0.35)};
        break;
    case Camera::SHAKE:
        shake_x_px_ = draw_wave(random, 0.006 * width_px_, 4.0, 14.0);
        shake_y_px_ = draw_wave(random, 0.006 * width_px_, 4.0, 14.0);
        turn_rad_ = draw_wave(random, radians(0.5), 4.0, 14.0);
        break;
    case Camera::TILT15:
        tilt_rad_ = sign * radians(15.0);
        break;
    case Camera::TILT30:
        tilt_rad_ = sign * radians(30.0);
        break;
    case Camera::PERSPECTIVE:
        tilt_rad_ = sign * radians(30.0);
        focal_ = 0.9;
        break;
    }
    distance_m_ = focal_ * width_px_ / std::max(per_metre_, 1e-9);
}

Vec2 View::project(const Place &place, double t) const
{
    Vec2 table_m = place.table_m;
    double depth_m =
        distance_m_ + std::sin(tilt_rad_) * table_m.y - std::cos(tilt_rad_) * place.height_m;
    double scale = focal_ * width_px_ / depth_m * (1.0 + zoom_.at(t));
    double up_m = std::cos(tilt_rad_) * table_m.y + std::sin(tilt_rad_) * place.height_m;
    Vec2 p{scale * table_m.x, scale * up_m};
    p = rotate(p, roll_rad_.at(t) + turn_rad_.at(t));
    return p + Vec2{0.5 * width_px_ + pan_x_px_.at(t) + shake_x_px_.at(t),
                    0.5 * height_of_width * width_px_ + pan_y_px_.at(t) + shake_y_px_.at(t)};
}

bool View::in_picture(Vec2 p) const
{
    return p.x >= 0.0 && p.x <= width_px_ && p.y >= 0.0 && p.y <= height_of_width * width_px_;
}

} // namespace grrl_experiment::recordings
