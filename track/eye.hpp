/*
 * eye.hpp: tracks features through the images of a stationary camera.
 *
 * Order of calls: look for each image, then points; reset when a new scene begins.
 *
 * Features are created at rest, where there is texture. They are tracked from image to image by
 * pyramidal Lucas-Kanade, forward and back; then the first appearance is registered to prevent
 * drift. A lost feature keeps its id and is searched for where its neighbours predict it. One that
 * contradicts its neighbours (on a border, on a shadow) is not reported, and soon dropped.
 * Everything is in pixels: the eye knows no table. The same images give the same points.
 */
#ifndef GRRL_TRACK_EYE_HPP
#define GRRL_TRACK_EYE_HPP

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "patch.hpp"

namespace grrl_track
{

struct EyeConfig {
    int max_points = 128; /* tracked at a time */
    int max_ids = 184;    /* in a scene: perception remembers 192 */
    int max_sparse = 24;  /* of these, where texture is weak, as on a table */
    float spacing_px = 9.0f;
    float sparse_spacing_px = 48.0f;
    float strong = 0.05f; /* texture below this share of the best is weak */
};

enum class Motion { UNKNOWN, REST, PUSHING };

struct Disc {
    float x;
    float y;
    float radius;
};

/* An image, and what is known about it. */
struct View {
    cv::Mat picture; /* CV_8UC1 or CV_8UC3 */
    Motion motion = Motion::UNKNOWN;
    std::vector<Disc> tool; /* what hides the scene */
    cv::Mat tool_mask;      /* nonzero where the tool hides the scene; may be empty */
    cv::Mat object_mask;    /* texture is weak where it is 0, as on the table; may be empty */
};

struct Point {
    int32_t id;
    float x;
    float y;
    bool visible;
};

class Eye
{
public:
    explicit Eye(const EyeConfig &config) : config_(config) {}

    void reset();
    void look(const View &view);

    /* All features that were not dropped, by ascending id. */
    std::vector<Point> points() const;

    /* Whether things were at rest in the last image, as reported or as observed. */
    bool at_rest() const { return rest_frames_ > 0; }

    int ids() const { return next_id_ - first_id_; }

private:
    struct Neighbour {
        size_t feature;
        PatchPose offset; /* of the feature in the neighbour's frame, at birth */
    };

    struct Feature {
        int32_t id;
        Patch patch;
        PatchPose pose;
        PatchPose before;   /* in the last image */
        bool found = false; /* in this image */
        bool agrees = true; /* with its neighbours */
        bool given_up = false;
        bool sparse = false;
        bool has_moved = false;
        int rest_period = 0; /* in which it was created */
        int doubts = 0;      /* rest periods in which its neighbours disagreed */
        std::vector<Neighbour> neighbours;
    };

    void prepare(const View &view);
    void follow(const View &view);
    void register_all();
    void regain();
    bool accept(Feature &feature, const PatchFit &fit);
    void compare_neighbours();
    bool agrees(const Feature &feature) const;
    void watch_rest(Motion motion);
    void use_rest();
    void give_birth(const View &view);
    bool place_free(cv::Point2f point, float spacing) const;
    void introduce(size_t first);
    bool hidden(const View &view, float x, float y) const;

    EyeConfig config_;
    std::vector<Feature> features_;
    int32_t first_id_ = 1;
    int32_t next_id_ = 1;
    int rest_frames_ = 0; /* in a row */
    int rest_period_ = 0;
    int still_frames_ = 0; /* in a row, as observed */
    cv::Mat grey_;
    cv::Mat smooth_; /* CV_32F */
    std::vector<cv::Mat> pyramid_;
    std::vector<cv::Mat> last_pyramid_;
};

} // namespace grrl_track

#endif
