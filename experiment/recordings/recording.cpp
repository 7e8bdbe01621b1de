/* recording.cpp: points on bodies, seen by a camera and an imperfect tracker. */
#include "recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "camera.hpp"
#include "random.hpp"

namespace grrl_experiment::recordings
{

using grrl_sim::Random;
using grrl_sim::Vec2;

namespace
{

constexpr int least_points = 4; /* of a body that can be told */
constexpr double duration_s = 4.0;
constexpr double missing = 0.03;       /* of all points in a frame */
constexpr double sliding_share = 0.25; /* of a link's points, along edges */
constexpr double frozen_share = 0.15;  /* of all points */

/* A feature of a body and its current track. */
struct Feature {
    size_t body = 0;
    bool below = false; /* on the ground, where bodies hide it */
    Vec2 place_m;       /* in the body */
    double height_m = 0.0;
    double slide_m = 0.0; /* along the body's x axis over the whole time */
    double begin = 0.0;   /* of its track, on a time scale from 0 to 1 */
    double end = 1.0;
    double freezes = 2.0;
    int32_t id = -1; /* no track yet */
    double renewed = 2.0;
    Seen last{-1, 0.0, 0.0};
};

/*
 * Points in a rectangle, none too close to another: corner detectors keep a distance. Of several
 * candidates the one farthest from all others is taken (Mitchell, 1991).
 */
std::vector<Vec2> spread_points(Random &random, int count, double half_length, double half_width)
{
    std::vector<Vec2> points;
    for (int i = 0; i < count; i++) {
        Vec2 best;
        double farthest = -1.0;
        for (int candidate = 0; candidate < 12; candidate++) {
            Vec2 at{random.uniform(-half_length, half_length),
                    random.uniform(-half_width, half_width)};
            double nearest = HUGE_VAL;
            for (Vec2 other : points)
                nearest = std::min(nearest, length(at - other));
            if (nearest > farthest) {
                farthest = nearest;
                best = at;
            }
        }
        points.push_back(best);
    }
    return points;
}

std::vector<Feature> place_features(const Scene &scene, int points, Random &random)
{
    std::vector<Feature> features;
    auto add = [&](size_t body, Vec2 place) {
        Feature feature;
        feature.body = body;
        feature.place_m = place;
        features.push_back(feature);
    };
    for (size_t b = 0; b < scene.bodies.size(); b++) {
        const Body &body = scene.bodies[b];
        if (body.half_length_m > 0.0)
            for (Vec2 at : spread_points(random, points, body.half_length_m, body.half_width_m)) {
                add(b, at);
                if (body.half_depth_m > 0.0)
                    features.back().height_m =
                        random.uniform(-body.half_depth_m, body.half_depth_m);
            }
    }
    Vec2 half{0.5 * table_links[0] * scene.link_m, 0.5 * table_links[1] * scene.link_m};
    for (Vec2 at : spread_points(random, std::max(2 * points, 10), half.x, half.y)) {
        add(0, transform(inverse(scene.bodies[0].start), at));
        features.back().below = true;
    }
    return features;
}

/* Applies the imperfections of the tracks. */
void spoil(Tracks tracks, const Scene &scene, std::vector<Feature> &features, Random &random)
{
    size_t one = 1 + static_cast<size_t>(random.below(static_cast<int>(scene.bodies.size()) - 1));
    double all_at = random.uniform(0.15, 0.33);
    for (Feature &feature : features) {
        bool some = random.uniform() < 0.3;
        double when = random.uniform(0.15, 0.6);
        double share = random.uniform();
        switch (tracks) {
        case Tracks::WHOLE:
            break;
        case Tracks::LATE: /* all of one link, some of the others */
            feature.begin = feature.body == one ? all_at : some ? when : 0.0;
            break;
        case Tracks::EARLY:
            feature.end = 1.0 - (feature.body == one ? all_at : some ? when : 0.0);
            break;
        case Tracks::RENEWED:
            feature.renewed = 0.0;
            break;
        case Tracks::EDGES:
            if (feature.body > 0 && share < sliding_share)
                feature.slide_m = (when - 0.375) / 0.225 * scene.link_m;
            break;
        case Tracks::FROZEN:
            feature.freezes = share < frozen_share ? when : 2.0;
            break;
        }
    }
}

/* Whether no motion could tell a joint. In a picture something that slides on the ground without a
 * turn may as well go straight on its own, as `crossing` does; only the way back tells. On a table
 * what lies side by side is joined. And a link with fewer points than a body needs is none. */
bool is_open(const Joint &joint, const Conditions &conditions)
{
    bool slides_once = joint.type == GRRL_PRISMATIC && joint.ramps.size() == 1;
    return conditions.points < least_points ||
           (conditions.size.unit == Unit::PX && joint.a == 0 && slides_once);
}

double standard_noise(const Conditions &conditions)
{
    const Size &size = conditions.size;
    double noise_m = std::min(0.0007, 0.004 * size.link_m);
    return size.unit == Unit::PX   ? std::max(0.3, 0.5 * std::sqrt(size.picture_px / 1280.0))
           : size.unit == Unit::MM ? 1000.0 * noise_m
                                   : noise_m;
}

class Tracker
{
public:
    Tracker(const Conditions &conditions, const Scene &scene, uint64_t seed)
        : conditions_(conditions), scene_(scene), view_(conditions, seed),
          random_(seed, grrl_sim::Stream::NOISE),
          features_(place_features(scene, conditions.points, random_))
    {
        spoil(conditions.tracks, scene, features_, random_);
        recording_.unit = conditions.size.unit;
        recording_.bodies = static_cast<int>(scene.bodies.size());
        recording_.joints = scene.joints;
        for (const Joint &joint : scene.joints)
            recording_.open.push_back(is_open(joint, conditions));
        recording_.noise = standard_noise(conditions);
    }

    void look(double t)
    {
        std::vector<Placed> placed = scene_.at(t);
        recording_.frames.emplace_back();
        for (Feature &feature : features_)
            look_at(feature, placed, t);
    }

    Recording result() { return std::move(recording_); }

private:
    void look_at(Feature &feature, const std::vector<Placed> &placed, double t)
    {
        Vec2 noise{random_.normal(), random_.normal()};
        bool missed = random_.uniform() < missing;
        if (t < feature.begin || t > feature.end)
            return;
        if (t > feature.freezes && feature.last.id >= 0) {
            recording_.frames.back().push_back(feature.last);
            return;
        }
        Place place = place_of(feature, placed[feature.body], t);
        Vec2 at = picture_of(place, t) + recording_.noise * noise;
        bool seen = (recording_.unit != Unit::PX || view_.in_picture(at)) &&
                    !(feature.below && is_covered(placed, place.table_m));
        if (!seen)
            feature.id = -1; /* the tracker has lost it */
        if (!seen || missed)
            return;
        if (feature.id < 0 || t > feature.renewed)
            begin_track(feature, t);
        feature.last = {feature.id, at.x, at.y};
        recording_.frames.back().push_back(feature.last);
    }

    /* What is measured on a table, in mm or m, stays flat on it. */
    Place place_of(const Feature &feature, const Placed &placed, double t) const
    {
        Vec2 place_m = feature.place_m;
        place_m.x += feature.slide_m * (t - 0.5);
        return recording_.unit == Unit::PX
                   ? transform(placed, {place_m, feature.height_m})
                   : Place{transform(placed.pose, placed.scale * place_m), 0.0};
    }

    Vec2 picture_of(const Place &place, double t) const
    {
        if (recording_.unit == Unit::PX)
            return view_.project(place, t);
        return (recording_.unit == Unit::MM ? 1000.0 : 1.0) * place.table_m;
    }

    /* Whether a body, or the frame of a door on the ground, hides it. */
    bool is_covered(const std::vector<Placed> &placed, Vec2 table_m) const
    {
        for (size_t b = 0; b < placed.size(); b++) {
            const Body &body = scene_.bodies[b];
            Vec2 at = transform(inverse(placed[b].pose), table_m);
            if (body.half_length_m > 0.0 &&
                std::abs(at.x) <= placed[b].scale * body.half_length_m &&
                std::abs(at.y) <= placed[b].scale * body.half_width_m)
                return true;
        }
        return false;
    }

    /* Ids of a tracker that renews them live for 8 to 60 frames at 30 Hz. */
    void begin_track(Feature &feature, double t)
    {
        feature.id = static_cast<int32_t>(recording_.tracks.size());
        bool judged = feature.slide_m == 0.0 && feature.freezes > 1.0;
        recording_.tracks.push_back({static_cast<int>(feature.body), judged});
        if (conditions_.tracks == Tracks::RENEWED)
            feature.renewed = t + random_.uniform(8.0, 60.0) / (30.0 * duration_s);
    }

    const Conditions &conditions_;
    const Scene &scene_;
    View view_;
    Random random_;
    std::vector<Feature> features_;
    Recording recording_;
};

} // namespace

Recording record(const Conditions &conditions, uint64_t seed)
{
    Scene scene = make_scene(conditions.object, conditions.size.link_m, seed);
    Tracker tracker(conditions, scene, seed);
    int frames = static_cast<int>(duration_s * conditions.rate_hz);
    for (int i = 0; i <= frames; i++)
        tracker.look(static_cast<double>(i) / frames);
    return tracker.result();
}

std::string csv_of(const Recording &recording)
{
    std::string text =
        recording.unit == Unit::PX ? "frame,point,x_px,y_px,truth\n" : "frame,point,x,y,truth\n";
    for (size_t i = 0; i < recording.frames.size(); i++) {
        for (const Seen &seen : recording.frames[i]) {
            char row[128];
            const TrackTruth &truth = recording.tracks[static_cast<size_t>(seen.id)];
            (void)std::snprintf(row, sizeof row, "%zu,%d,%.7g,%.7g,%d\n", i,
                                static_cast<int>(seen.id), seen.x, seen.y,
                                truth.judged ? truth.body : -1);
            text += row;
        }
    }
    return text;
}

} // namespace grrl_experiment::recordings
