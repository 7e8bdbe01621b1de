/* baseline.cpp: clusters of features, their motion, and the joints between them. */
#include "baseline.hpp"

#include <algorithm>
#include <cmath>

#include "sparse_cut.hpp"

namespace grrl_experiment::perception
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

/* Whether two features kept their distance in all snapshots that show both. */
bool Baseline::rigid(size_t a, size_t b) const
{
    double least = HUGE_VAL;
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

std::vector<std::vector<size_t>> Baseline::components(const std::vector<size_t> &features) const
{
    std::vector<std::vector<size_t>> components;
    std::vector<bool> done(features.size());
    for (size_t seed = 0; seed < features.size(); seed++) {
        if (done[seed])
            continue;
        std::vector<size_t> component{features[seed]};
        done[seed] = true;
        for (size_t i = 0; i < component.size(); i++) {
            for (size_t other = 0; other < features.size(); other++) {
                if (!done[other] && rigid(component[i], features[other])) {
                    done[other] = true;
                    component.push_back(features[other]);
                }
            }
        }
        components.push_back(std::move(component));
    }
    return components;
}

/* Components, divided where two parts are held together by less than half of the possible edges. */
std::vector<std::vector<size_t>> Baseline::clusters() const
{
    std::vector<size_t> all(features_);
    for (size_t id = 0; id < features_; id++)
        all[id] = id;
    std::vector<std::vector<size_t>> clusters;
    std::vector<std::vector<size_t>> open = components(all);
    while (!open.empty()) {
        std::vector<size_t> part = std::move(open.back());
        open.pop_back();
        size_t n = part.size();
        if (static_cast<int>(n) < params_.min_features)
            continue;
        std::vector<std::vector<int>> edges(n, std::vector<int>(n, 0));
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < i; j++)
                edges[i][j] = edges[j][i] = rigid(part[i], part[j]);
        SparseCut cut = sparse_cut(edges, static_cast<size_t>(params_.min_features));
        if (cut.density > 0.5) {
            clusters.push_back(std::move(part));
            continue;
        }
        std::vector<bool> apart(n, false);
        for (size_t i : cut.apart)
            apart[i] = true;
        std::vector<size_t> sides[2];
        for (size_t i = 0; i < n; i++)
            sides[apart[i] ? 1 : 0].push_back(part[i]);
        open.push_back(std::move(sides[0]));
        open.push_back(std::move(sides[1]));
    }
    return clusters;
}

/* Whether most of its features have left their first position. */
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

/* The motion of a body between two snapshots; false if too few features are in both. */
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
    double least = HUGE_VAL;
    for (size_t id : body)
        if (pictures_.front()[id].seen)
            least = std::min(least, length(pictures_.front()[id].at_m - point));
    return least;
}

/* The joint between two bodies by the two poses that differ most in rotation, or, if they never
 * turned, in place. */
bool Baseline::relate(const std::vector<size_t> &a, const std::vector<size_t> &b,
                      EstimatedJoint &joint) const
{
    Pose greatest;
    double slide = 0.0;
    Vec2 place = pictures_.front()[b.front()].at_m;
    double gap = HUGE_VAL;
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
        /* the centre is fixed: c = R c + p */
        double half = 0.5 / std::tan(0.5 * greatest.angle);
        Vec2 p = greatest.position;
        Vec2 centre{0.5 * p.x - half * p.y, 0.5 * p.y + half * p.x};
        joint.type = GRRL_REVOLUTE;
        return distance_to(a, centre) < params_.near_m && distance_to(b, centre) < params_.near_m;
    }
    joint.type = GRRL_PRISMATIC;
    return slide > params_.slide_m && gap < params_.near_m;
}

Estimate Baseline::estimate() const
{
    Estimate estimate;
    std::vector<int> body_of(features_, no_link);
    std::vector<std::vector<size_t>> bodies;
    for (std::vector<size_t> &component : clusters()) {
        if (!moved(component))
            continue;
        for (size_t id : component)
            body_of[id] = estimate.links;
        estimate.links++;
        bodies.push_back(std::move(component));
    }
    for (size_t id = 0; id < features_; id++)
        if (std::any_of(pictures_.begin(), pictures_.end(),
                        [id](const Picture &picture) { return picture[id].seen; }))
            estimate.features.push_back({static_cast<int32_t>(id), body_of[id]});
    for (int a = 0; a < estimate.links; a++) {
        for (int b = a + 1; b < estimate.links; b++) {
            EstimatedJoint joint{a, b, GRRL_REVOLUTE, 0.0};
            if (relate(bodies[static_cast<size_t>(a)], bodies[static_cast<size_t>(b)], joint))
                estimate.joints.push_back(joint);
        }
    }
    return estimate;
}

} // namespace grrl_experiment::perception
