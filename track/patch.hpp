/*
 * patch.hpp: the appearance of a feature at its creation, and its pose in a later image.
 *
 * Tracking from frame to frame drifts; registering the first appearance does not. A patch is
 * aligned under shift, rotation, gain and offset by Gauss-Newton steps (inverse compositional, with
 * all five unknowns and robust weights), so that light and partial occlusion have little effect.
 * Pixels that turn out to belong to something else are excluded for good.
 */
#ifndef GRRL_TRACK_PATCH_HPP
#define GRRL_TRACK_PATCH_HPP

#include <array>
#include <cstdint>

#include <opencv2/core.hpp>

namespace grrl_track
{

/* The pose of a patch: its centre in pixels, and its rotation since its creation. */
struct PatchPose {
    float x = 0.0f;
    float y = 0.0f;
    float angle = 0.0f;
};

PatchPose operator*(const PatchPose &outer, const PatchPose &inner);
PatchPose inverse(const PatchPose &pose);
float distance(const PatchPose &a, const PatchPose &b); /* of the centres */

struct PatchFit {
    bool good = false;
    PatchPose pose;
    float correlation = 0.0f; /* of the weighted pixels, 0 .. 1 */
    float share = 0.0f;       /* of the weight that fits */
    float sd_px = 0.0f;       /* of the centre, estimated from the residuals */
};

class Patch
{
public:
    static constexpr int half = 7;
    static constexpr int side = 2 * half + 1;
    static constexpr int n = side * side;

    /* Takes the appearance around a point; smooth is CV_32F. false: too close to the edge of the
     * image. */
    bool take(const cv::Mat &smooth, float x, float y);

    /* Averages in one more image of the same appearance at its first pose. */
    void average(const cv::Mat &smooth);

    /* Refines a guess within about two pixels. Not good: it left the image, or did not converge. */
    PatchFit find(const cv::Mat &smooth, const PatchPose &guess);

    /* Adds the residuals of the last find to those that judge_pixels uses. */
    void remember_residuals();

    /* Excludes pixels that on average did not fit since the last call. */
    void judge_pixels();

    /* The remaining share of the initial weight. */
    float kept() const;

    float x() const { return birth_.x; }
    float y() const { return birth_.y; }

private:
    struct Normal;

    void make_gradients();
    bool sample(const cv::Mat &smooth, const PatchPose &pose);
    float residual_scale() const;
    void accumulate(Normal &normal, bool robust);

    PatchPose birth_;
    int taken_ = 0;
    std::array<float, (side + 2) * (side + 2)> look_{}; /* with a margin for the gradients */
    std::array<float, n> value_{};
    std::array<float, n> across_{}; /* gradients */
    std::array<float, n> down_{};
    std::array<float, n> weight_{};
    std::array<float, n> seen_{}; /* of the last find, like the next two */
    std::array<float, n> residual_{};
    float gain_ = 1.0f;
    float offset_ = 0.0f;
    std::array<float, n> residual_sum_{};
    int residuals_ = 0;
};

} // namespace grrl_track

#endif
