/*
 * scene.hpp: renders the table from above: patterned links, their shadows, the finger, and the
 * effects of light, lens and sensor. Only in builds with OpenCV.
 *
 * A point (x, y) m of the table lies at pixel (width / 2 + x / s, height / 2 - y / s), half a pixel
 * less each, since pixel (0, 0) has its centre there. A lens with distortion k moves it along the
 * ray from the centre: a point seen at r, in units of half the width, is really at r / (1 + k r^2).
 */
#ifndef GRRL_SIM_SCENE_HPP
#define GRRL_SIM_SCENE_HPP

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "camera.hpp"

namespace grrl_sim
{

class Scene
{
public:
    Scene(const ObjectSpec &object, const CameraLook &look, uint64_t seed);

    /* The image is valid until the next call. */
    const cv::Mat &draw(const std::vector<Pose> &poses, std::optional<Vec2> finger);

    /* The exact pixel of a point on the table, and the inverse. */
    Vec2 to_px(Vec2 point_m) const;
    Vec2 to_m(Vec2 point_px) const;

private:
    struct Pattern {
        cv::Mat texture; /* CV_32F, around 0, two texels a pixel */
        cv::Vec3f colour;
    };

    struct Shape {
        Rectangle rectangle; /* pixels, y down */
        const Pattern *pattern;
    };

    void make_table(cv::RNG &random);
    void make_light();
    void make_lens();
    Shape shape_of(size_t link, const Pose &pose) const;
    void shade(const std::vector<Shape> &shapes, std::optional<Vec2> finger_px);
    void draw_link(const Shape &shape);
    void draw_finger(Vec2 centre_px);
    void expose();

    std::vector<LinkSpec> links_;
    CameraLook look_;
    uint64_t seed_;
    uint64_t frame_ = 0;
    double finger_px_;
    std::vector<Pattern> patterns_;
    cv::Mat table_;  /* CV_32FC3, like all others except the image */
    cv::Mat light_;  /* CV_32F, 0 .. 1 */
    cv::Mat lens_x_; /* for each pixel of the image, its source */
    cv::Mat lens_y_;
    cv::Mat shadow_; /* CV_32F */
    cv::Mat canvas_;
    cv::Mat bent_;
    cv::Mat noise_;
    cv::Mat picture_;
};

} // namespace grrl_sim

#endif
