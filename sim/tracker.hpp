/*
 * tracker.hpp: the camera: noisy feature points on the links and the table.
 *
 * A frame is all that a robot sees. It contains no body, link or joint: the ids are a random
 * permutation over all features, and a frame lists the visible ones by ascending id.
 */
#ifndef GRRL_SIM_TRACKER_HPP
#define GRRL_SIM_TRACKER_HPP

#include <cstdint>
#include <vector>

#include "object.hpp"
#include "random.hpp"

namespace grrl_sim
{

struct TrackerParams {
    double noise_sigma_m = 0.0007;    /* of each coordinate in each frame, >= 0 */
    double dropout_probability = 0.0; /* that a feature is missing in a frame, 0 .. 1 */
    double outlier_probability = 0.0; /* that a feature is displaced in a frame, 0 .. 1 */
    double outlier_reach_m = 0.05;    /* largest displacement of an outlier */
    int background_features = 25;     /* fewer if GRRL_MAX_FEATURES does not suffice */
    double feature_distance_m = 0.01; /* minimum distance on a link; reduced on a crowded one */
};

struct TrackedFeature {
    uint32_t id;
    double x_m;
    double y_m;
};

struct Frame {
    uint64_t index = 0; /* frames since the start, 30 a second */
    double time_s = 0.0;
    std::vector<TrackedFeature> features;
};

class Tracker
{
public:
    /* Places features on the links, and on the table (centred on the origin) where there is no
     * link. */
    Tracker(const ObjectSpec &object, const TrackerParams &params, Vec2 table_m,
            const std::vector<Pose> &poses, Random &random);

    /* Fills in what is visible with the links at these poses. */
    void observe(const std::vector<Pose> &poses, Random &noise, Frame &frame) const;

    /* For tests and pictures: the number of features, the link of each (-1: the table), and
     * positions. */
    int feature_count() const { return static_cast<int>(features_.size()); }
    int true_link(uint32_t id) const { return features_[id].link; }
    Vec2 true_position(uint32_t id, const std::vector<Pose> &poses) const;

private:
    struct Feature {
        int link;
        Vec2 place_m; /* in the link's frame, or on the table */
    };

    void place_on_link(int link, int count, Random &random);
    void place_on_table(Vec2 table_m, const std::vector<Pose> &poses, Random &random);
    bool covered(Vec2 point, const std::vector<Pose> &poses, double margin_m) const;

    std::vector<LinkSpec> links_;
    TrackerParams params_;
    std::vector<Feature> features_; /* by id */
};

} // namespace grrl_sim

#endif
