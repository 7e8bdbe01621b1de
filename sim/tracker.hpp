/*
 * tracker.hpp: the camera. Feature points on the links and on the table, seen with noise.
 *
 * A frame is all a robot gets to see. It holds no body, link or joint: the ids are a random
 * permutation over all features, and a frame lists what is visible by ascending id.
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
    double dropout_probability = 0.0; /* of a feature to be missing in a frame, 0 .. 1 */
    double outlier_probability = 0.0; /* of a feature to be elsewhere in a frame, 0 .. 1 */
    double outlier_reach_m = 0.05;    /* how far it then jumps at most */
    int background_features = 25;     /* fewer if GRRL_MAX_FEATURES does not hold them */
    double feature_distance_m = 0.01; /* least distance on a link; gives way on a crowded one */
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
    /* Puts features on the links and, where no link is, on the table (centred on the origin). */
    Tracker(const ObjectSpec &object, const TrackerParams &params, Vec2 table_m,
            const std::vector<Pose> &poses, Random &random);

    /* What is visible with the links at these poses. */
    void observe(const std::vector<Pose> &poses, Random &noise, Frame &frame) const;

    /* For tests and pictures: how many there are, whose each is (-1: the table's), and where. */
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
