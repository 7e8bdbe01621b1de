/* Places features on links and table, and draws their noise. */
#include "tracker.hpp"

namespace grrl_sim
{

namespace
{

constexpr int placing_attempts = 60;
constexpr double edge_m = 0.002;             /* distance of features from the edge of a link */
constexpr double background_margin_m = 0.01; /* distance of background features from the object */
constexpr double background_distance_m = 0.05;

struct Circle {
    Vec2 middle;
    double radius2 = 0.0;

    bool contains(Vec2 point) const { return dot(point - middle, point - middle) <= radius2; }
};

/* Most of the table lies outside it, so that no link needs to be looked at. */
Circle circle_around(const std::vector<LinkSpec> &links, const std::vector<Pose> &poses)
{
    Circle circle;
    for (const Pose &pose : poses)
        circle.middle = circle.middle + (1.0 / static_cast<double>(poses.size())) * pose.position;
    for (size_t i = 0; i < links.size(); i++) {
        double radius = length(poses[i].position - circle.middle) + links[i].half_length_m +
                        links[i].half_width_m;
        circle.radius2 = std::max(circle.radius2, radius * radius);
    }
    return circle;
}

/* Draws a point at least `apart` from the others; if it finds none, the most distant one tried. */
template <typename Draw, typename Apart> Vec2 spread_point(Draw draw, Apart distance, double apart)
{
    Vec2 best;
    double best_distance = -1.0;
    for (int attempt = 0; attempt < placing_attempts && best_distance < apart; attempt++) {
        Vec2 point = draw();
        double d = distance(point);
        if (d > best_distance) {
            best = point;
            best_distance = d;
        }
    }
    return best;
}

} // namespace

Tracker::Tracker(const ObjectSpec &object, const TrackerParams &params, Vec2 table_m,
                 const std::vector<Pose> &poses, Random &random)
    : links_(object.links), params_(params)
{
    std::vector<int> counts;
    int total = 0;
    for (const LinkSpec &link : links_) {
        int range = link.features_max - link.features_min + 1;
        counts.push_back(link.fixed ? 0 : link.features_min + random.below(range));
        total += counts.back();
    }
    for (size_t i = 0; i < links_.size(); i++) {
        if (total > GRRL_MAX_FEATURES) /* the most that one tracker follows at a time */
            counts[i] = counts[i] * GRRL_MAX_FEATURES / total;
        place_on_link(static_cast<int>(i), counts[i], random);
    }
    place_on_table(table_m, poses, random);
    random.shuffle(features_);
}

void Tracker::place_on_link(int link, int count, Random &random)
{
    const LinkSpec &spec = links_[static_cast<size_t>(link)];
    double x = spec.half_length_m - edge_m;
    double y = spec.half_width_m - edge_m;
    size_t first = features_.size();
    for (int i = 0; i < count; i++) {
        auto draw = [&]() {
            double px = random.uniform(-x, x);
            return Vec2{px, random.uniform(-y, y)};
        };
        auto nearest = [&](Vec2 point) {
            double least = 1.0;
            for (size_t k = first; k < features_.size(); k++)
                least = std::min(least, length(features_[k].place_m - point));
            return least;
        };
        features_.push_back({link, spread_point(draw, nearest, params_.feature_distance_m)});
    }
}

void Tracker::place_on_table(Vec2 table_m, const std::vector<Pose> &poses, Random &random)
{
    size_t first = features_.size();
    int room = GRRL_MAX_FEATURES - static_cast<int>(first);
    for (int i = 0; i < std::min(params_.background_features, room); i++) {
        auto draw = [&]() {
            double px = random.uniform(-0.5, 0.5) * table_m.x;
            return Vec2{px, random.uniform(-0.5, 0.5) * table_m.y};
        };
        auto nearest = [&](Vec2 point) {
            double least = covered(point, poses, background_margin_m) ? -1.0 : 1.0;
            for (size_t k = first; k < features_.size(); k++)
                least = std::min(least, length(features_[k].place_m - point));
            return least;
        };
        Vec2 point = spread_point(draw, nearest, background_distance_m);
        if (!covered(point, poses, background_margin_m))
            features_.push_back({-1, point});
    }
}

bool Tracker::covered(Vec2 point, const std::vector<Pose> &poses, double margin_m) const
{
    for (size_t i = 0; i < links_.size(); i++) {
        if (links_[i].fixed)
            continue;
        double reach = links_[i].half_length_m + links_[i].half_width_m + margin_m;
        Vec2 offset = point - poses[i].position;
        if (dot(offset, offset) > reach * reach)
            continue;
        Rectangle shape{poses[i], links_[i].half_length_m, links_[i].half_width_m};
        if (distance(shape, point) <= margin_m)
            return true;
    }
    return false;
}

Vec2 Tracker::true_position(uint32_t id, const std::vector<Pose> &poses) const
{
    const Feature &feature = features_[id];
    if (feature.link < 0)
        return feature.place_m;
    return transform(poses[static_cast<size_t>(feature.link)], feature.place_m);
}

void Tracker::observe(const std::vector<Pose> &poses, Random &noise, Frame &frame) const
{
    const Circle object = circle_around(links_, poses);
    std::vector<Vec2> axis; /* of each link: one sine and cosine for all its features */
    axis.reserve(poses.size());
    for (const Pose &pose : poses)
        axis.push_back(direction(pose.angle));
    const uint32_t count = static_cast<uint32_t>(features_.size());
    const Feature *const features = features_.data();
    frame.features.resize(count);
    TrackedFeature *seen = frame.features.data();
    for (uint32_t id = 0; id < count; id++) {
        const Feature &feature = features[id];
        Vec2 point = feature.place_m;
        if (feature.link >= 0) {
            size_t link = static_cast<size_t>(feature.link);
            point = poses[link].position + rotate(point, axis[link]);
        } else if (object.contains(point) && covered(point, poses, 0.0)) {
            continue;
        }
        if (params_.dropout_probability > 0.0 && noise.uniform() < params_.dropout_probability)
            continue;
        if (params_.outlier_probability > 0.0 && noise.uniform() < params_.outlier_probability) {
            double reach = noise.uniform(0.0, params_.outlier_reach_m);
            point = point + reach * direction(noise.uniform(-pi, pi));
        }
        double x = point.x + params_.noise_sigma_m * noise.normal();
        double y = point.y + params_.noise_sigma_m * noise.normal();
        *seen++ = {id, x, y};
    }
    frame.features.resize(static_cast<size_t>(seen - frame.features.data()));
}

} // namespace grrl_sim
