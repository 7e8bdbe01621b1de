/* eye_bench.hpp: a world, its drawn pictures and the eye that looks at them, with the truth beside:
 * how far points are off at rest, from where on their link they were born. */
#ifndef GRRL_TESTS_EYE_BENCH_HPP
#define GRRL_TESTS_EYE_BENCH_HPP

#include <algorithm>
#include <functional>
#include <map>
#include <vector>

#include <time.h>

#include "eye.hpp"
#include "scene.hpp"

namespace eye_bench
{

using namespace grrl_sim;

constexpr int rest_frames = 10;
constexpr double border_m = 0.003; /* a corner of a link is seen that far beside it */

inline double cpu_s()
{
    timespec now{};
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline WorldParams world_of(const CameraLook &look)
{
    WorldParams params;
    params.table_m = camera_view_m(look);
    return params;
}

/* A push across a link, at its middle, from one side or the other. */
inline PushCommand push_across(const World &world, int link, bool other_side)
{
    const Pose pose = world.true_poses()[static_cast<size_t>(link)];
    Vec2 across = direction(pose.angle + (other_side ? -0.5 : 0.5) * pi);
    PushCommand command;
    command.start_m = pose.position - 0.06 * across;
    command.end_m = pose.position + 0.06 * across;
    return command;
}

/* A push at an end of a link, towards its other end. */
inline PushCommand push_along(const World &world, int link, bool other_end)
{
    const Pose pose = world.true_poses()[static_cast<size_t>(link)];
    double reach = world.object().links[static_cast<size_t>(link)].half_length_m + 0.03;
    Vec2 along = direction(pose.angle + (other_end ? pi : 0.0));
    PushCommand command;
    command.start_m = pose.position - reach * along;
    command.end_m = pose.position + reach * along;
    return command;
}

class EyeBench
{
public:
    EyeBench(const ObjectSpec &object, const CameraLook &look, uint64_t seed,
             std::function<void(bool pushing)> on_frame = {})
        : look_(look), world_(object, world_of(look), seed), scene_(object, look, seed),
          on_frame_(std::move(on_frame))
    {
    }

    void push(const PushCommand &command)
    {
        if (world_.begin_push(command).empty())
            while (world_.step_frame())
                observe(true);
    }

    /* errors_px then has the mean error of each point that was told. */
    void rest()
    {
        sums_.clear();
        for (int i = 0; i < rest_frames; i++) {
            (void)world_.step_frame();
            observe(false);
        }
        for (const auto &[id, sum] : sums_)
            errors_px.push_back(length((1.0 / sum.second) * sum.first) * 1000.0 / look_.mm_per_px);
    }

    /* Of a point that was told at rest at any time, where it should be. */
    Vec2 truth(int32_t id) const
    {
        const Home &home = home_.at(id);
        if (home.link < 0)
            return home.place_m;
        return transform(world_.true_poses()[static_cast<size_t>(home.link)], home.place_m);
    }

    /* Whether the finger covers a part of a point's patch. */
    bool under_finger(int32_t id) const
    {
        std::optional<Vec2> finger = world_.finger_position();
        return home_.count(id) != 0 && finger &&
               length(truth(id) - *finger) < finger_radius_m + 0.008;
    }

    /* Whether a link that is drawn later than this one covers a point. */
    bool covered(int link, Vec2 m) const
    {
        std::vector<Pose> poses = world_.true_poses();
        const std::vector<LinkSpec> &links = world_.object().links;
        for (size_t i = static_cast<size_t>(link + 1); i < links.size(); i++) {
            Rectangle shape{poses[i], links[i].half_length_m, links[i].half_width_m};
            if (!links[i].fixed && distance(shape, m) <= 0.0)
                return true;
        }
        return false;
    }

    bool knows(int32_t id) const { return home_.count(id) != 0; }
    bool on_link(int32_t id) const { return home_.count(id) != 0 && home_.at(id).link >= 0; }
    World &world() { return world_; }
    Scene &scene() { return scene_; }
    const std::vector<grrl_track::Point> &points() const { return points_; }

    std::vector<double> errors_px;
    double seconds = 0.0; /* of the eye, all frames */
    double slowest_s = 0.0;
    int frames = 0;
    double visible = 0.0; /* points, all frames */

private:
    struct Home {
        int link; /* -1: the table */
        Vec2 place_m;
    };

    void observe(bool pushing)
    {
        grrl_track::View view;
        view.picture = scene_.draw(world_.true_poses(), world_.finger_position());
        view.motion = pushing ? grrl_track::Motion::PUSHING : grrl_track::Motion::REST;
        if (world_.finger_position()) {
            Vec2 tool = scene_.to_px(*world_.finger_position());
            view.tool.push_back({static_cast<float>(tool.x), static_cast<float>(tool.y),
                                 static_cast<float>(1000.0 * finger_radius_m / look_.mm_per_px)});
        }
        double start = cpu_s();
        eye_.look(view);
        double took = cpu_s() - start;
        seconds += took;
        slowest_s = std::max(slowest_s, took);
        frames++;
        points_ = eye_.points();
        for (const grrl_track::Point &point : points_)
            if (point.visible) {
                visible++;
                if (!pushing)
                    measure(point);
            }
        if (on_frame_)
            on_frame_(pushing);
    }

    Home home_of(Vec2 m) const
    {
        std::vector<Pose> poses = world_.true_poses();
        const std::vector<LinkSpec> &links = world_.object().links;
        for (size_t i = 0; i < poses.size(); i++) {
            Rectangle shape{poses[i], links[i].half_length_m, links[i].half_width_m};
            if (!links[i].fixed && distance(shape, m) <= border_m)
                return {static_cast<int>(i), transform(inverse(poses[i]), m)};
        }
        return {-1, m};
    }

    void measure(const grrl_track::Point &point)
    {
        Vec2 m = scene_.to_m({static_cast<double>(point.x), static_cast<double>(point.y)});
        if (home_.count(point.id) == 0) {
            home_[point.id] = home_of(m);
            return;
        }
        auto &[sum, n] = sums_[point.id];
        sum = sum + (m - truth(point.id));
        n++;
    }

    CameraLook look_;
    World world_;
    Scene scene_;
    grrl_track::Eye eye_{grrl_track::EyeConfig{}};
    std::function<void(bool)> on_frame_;
    std::vector<grrl_track::Point> points_;
    std::map<int32_t, Home> home_;
    std::map<int32_t, std::pair<Vec2, int>> sums_;
};

inline double quantile(std::vector<double> values, double q)
{
    if (values.empty())
        return 0.0;
    auto at =
        values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

} // namespace eye_bench

#endif
