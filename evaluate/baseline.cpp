#include "baseline.hpp"

#include <algorithm>
#include <cmath>

namespace grrl_evaluate
{

using grrl_sim::Frame;
using grrl_sim::Pose;
using grrl_sim::TrackedFeature;
using grrl_sim::Vec2;

namespace
{

double median(std::vector<double> &values)
{
    auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

void Baseline::rest(const std::vector<Frame> &frames)
{
    std::vector<std::vector<double>> x(features_);
    std::vector<std::vector<double>> y(features_);
    for (const Frame &frame : frames) {
        for (const TrackedFeature &feature : frame.features) {
            x[feature.id].push_back(feature.x_m);
            y[feature.id].push_back(feature.y_m);
        }
    }
    Picture picture(features_);
    for (size_t id = 0; id < features_; id++)
        if (!x[id].empty())
            picture[id] = {true, {median(x[id]), median(y[id])}};
    pictures_.push_back(std::move(picture));
}

/* Whether two features kept their distance, in all pictures that show both. */
bool Baseline::rigid(size_t a, size_t b) const
{
    double least = INFINITY;
    double most = 0.0;
    for (const Picture &picture : pictures_) {
        if (!picture[a].seen || !picture[b].seen)
            continue;
        double distance = length(picture[a].at_m - picture[b].at_m);
        least = std::min(least, distance);
        most = std::max(most, distance);
    }
    return most - least <= params_.distance_m && most > 0.0;
}

std::vector<std::vector<size_t>> Baseline::components() const
{
    std::vector<std::vector<size_t>> components;
    std::vector<bool> done(features_);
    for (size_t seed = 0; seed < features_; seed++) {
        if (done[seed])
            continue;
        std::vector<size_t> component{seed};
        done[seed] = true;
        for (size_t i = 0; i < component.size(); i++) {
            for (size_t other = 0; other < features_; other++) {
                if (!done[other] && rigid(component[i], other)) {
                    done[other] = true;
                    component.push_back(other);
                }
            }
        }
        components.push_back(std::move(component));
    }
    return components;
}

/* Most of its features have been elsewhere than where they were first. */
bool Baseline::moved(const std::vector<size_t> &body) const
{
    size_t votes = 0;
    for (size_t id : body) {
        const Place *first = nullptr;
        bool away = false;
        for (const Picture &picture : pictures_) {
            if (!picture[id].seen)
                continue;
            first = first == nullptr ? &picture[id] : first;
            away = away || length(picture[id].at_m - first->at_m) > params_.distance_m;
        }
        votes += away;
    }
    return 2 * votes > body.size();
}

/* The motion of a body between two pictures; false if too few features are in both. */
bool Baseline::motion(const std::vector<size_t> &body, const Picture &from, const Picture &to,
                      Pose &pose) const
{
    Vec2 mean_from;
    Vec2 mean_to;
    double n = 0.0;
    for (size_t id : body) {
        if (from[id].seen && to[id].seen) {
            mean_from = mean_from + from[id].at_m;
            mean_to = mean_to + to[id].at_m;
            n += 1.0;
        }
    }
    if (n < 2.0)
        return false;
    mean_from = (1.0 / n) * mean_from;
    mean_to = (1.0 / n) * mean_to;
    double c = 0.0;
    double s = 0.0;
    for (size_t id : body) {
        if (from[id].seen && to[id].seen) {
            c += dot(from[id].at_m - mean_from, to[id].at_m - mean_to);
            s += cross(from[id].at_m - mean_from, to[id].at_m - mean_to);
        }
    }
    double angle = std::atan2(s, c);
    pose = {mean_to - rotate(mean_from, angle), angle};
    return true;
}

double Baseline::distance_to(const std::vector<size_t> &body, Vec2 point) const
{
    double least = INFINITY;
    for (size_t id : body)
        if (pictures_.front()[id].seen)
            least = std::min(least, length(pictures_.front()[id].at_m - point));
    return least;
}

/* The joint between two bodies by the two poses that differ most in rotation, or, if they never
 * turned, in place. */
bool Baseline::relate(const std::vector<size_t> &a, const std::vector<size_t> &b,
                      BelievedJoint &joint) const
{
    Pose greatest;
    double slide = 0.0;
    Vec2 place = pictures_.front()[b.front()].at_m;
    double gap = INFINITY;
    for (size_t id : b)
        if (pictures_.front()[id].seen)
            gap = std::min(gap, distance_to(a, pictures_.front()[id].at_m));
    for (const Picture &picture : pictures_) {
        Pose pose_a;
        Pose pose_b;
        if (!motion(a, pictures_.front(), picture, pose_a) ||
            !motion(b, pictures_.front(), picture, pose_b))
            continue;
        Pose relative = compose(inverse(pose_a), pose_b);
        relative.angle = grrl_sim::wrap_angle(relative.angle);
        if (std::abs(relative.angle) > std::abs(greatest.angle))
            greatest = relative;
        slide = std::max(slide, length(transform(relative, place) - place));
    }
    joint.probability = 1.0;
    if (std::abs(greatest.angle) > params_.turn_rad) {
        /* the centre stays where it is: c = R c + p */
        double half = 0.5 / std::tan(0.5 * greatest.angle);
        Vec2 p = greatest.position;
        Vec2 centre{0.5 * p.x - half * p.y, 0.5 * p.y + half * p.x};
        joint.type = GRRL_REVOLUTE;
        return distance_to(a, centre) < params_.near_m && distance_to(b, centre) < params_.near_m;
    }
    joint.type = GRRL_PRISMATIC;
    return slide > params_.slide_m && gap < params_.near_m;
}

Belief Baseline::believe() const
{
    Belief belief;
    belief.body_of.assign(features_, no_body);
    std::vector<std::vector<size_t>> bodies;
    for (std::vector<size_t> &component : components()) {
        if (static_cast<int>(component.size()) < params_.min_features || !moved(component))
            continue;
        for (size_t id : component)
            belief.body_of[id] = belief.n_bodies;
        belief.n_bodies++;
        bodies.push_back(std::move(component));
    }
    for (size_t id = 0; id < features_; id++)
        if (std::none_of(pictures_.begin(), pictures_.end(),
                         [id](const Picture &picture) { return picture[id].seen; }))
            belief.body_of[id] = unseen;
    for (int a = 0; a < belief.n_bodies; a++) {
        for (int b = a + 1; b < belief.n_bodies; b++) {
            BelievedJoint joint{a, b, GRRL_REVOLUTE, 0.0};
            if (relate(bodies[static_cast<size_t>(a)], bodies[static_cast<size_t>(b)], joint))
                belief.joints.push_back(joint);
        }
    }
    return belief;
}

} // namespace grrl_evaluate
