/*
 * baseline.hpp: the perceptual skill of the paper, as a baseline (Katz and Brock, "Manipulating
 * articulated objects with interactive perception", ICRA 2008).
 *
 * Features whose mutual distance has not changed by more than a threshold are joined by an edge;
 * the connected components of that graph, divided where they are connected by few edges (features
 * near a joint keep their distances to both links), are the bodies; bodies at rest are background.
 * Two bodies are compared in two poses: a relative rotation is a revolute joint about its centre, a
 * translation without rotation is a prismatic joint. It has no noise model, and reports every joint
 * with certainty.
 *
 * Order of calls: observe one rest after another; estimate at any time.
 */
#ifndef GRRL_EXPERIMENT_PERCEPTION_BASELINE_HPP
#define GRRL_EXPERIMENT_PERCEPTION_BASELINE_HPP

#include <vector>

#include "truth.hpp"

namespace grrl_experiment::perception
{

struct BaselineParams {
    double distance_m = 0.003; /* change of a mutual distance that counts as constant */
    double turn_rad = grrl_sim::radians(5.0); /* more is a rotation */
    double slide_m = 0.004;                   /* more is a translation */
    double near_m = 0.05;                     /* how close joined bodies and their pivot are */
    int min_features = 4;                     /* fewer do not make a body */
};

class Baseline
{
public:
    explicit Baseline(int features) : features_(static_cast<size_t>(features)) {}

    /* The frames of one rest; their medians form one snapshot. */
    void rest(const std::vector<grrl_sim::Frame> &frames);

    Estimate estimate() const;

private:
    struct Place {
        bool seen = false;
        grrl_sim::Vec2 at_m;
    };
    using Picture = std::vector<Place>; /* by the id of a feature */

    bool rigid(size_t a, size_t b) const;
    std::vector<std::vector<size_t>> components(const std::vector<size_t> &features) const;
    std::vector<std::vector<size_t>> clusters() const;
    bool moved(const std::vector<size_t> &body) const;
    bool motion(const std::vector<size_t> &body, const Picture &from, const Picture &to,
                grrl_sim::Pose &pose) const;
    double distance_to(const std::vector<size_t> &body, grrl_sim::Vec2 point) const;
    bool relate(const std::vector<size_t> &a, const std::vector<size_t> &b,
                EstimatedJoint &joint) const;

    size_t features_;
    BaselineParams params_;
    std::vector<Picture> pictures_;
};

} // namespace grrl_experiment::perception

#endif
