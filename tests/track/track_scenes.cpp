/*
 * track_scenes OBJECT SEED SCENES PUSHES [LOOK]: how well the eye sees, and what perception makes
 * of it.
 *
 * In each scene random pushes; ideal points and those of the eye, of the same pictures, go to a
 * perception each. Prints after how many scenes both have the right structure at each push, how far
 * points are off at rest, and the time a picture takes.
 */
#include <time.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include <opencv2/core/utility.hpp>

#include "eye.hpp"
#include "scene.hpp"
#include "structure.hpp"
#include "supervisor.hpp"

extern "C" {
#include "grrl/learner/grounding.h"
#include "grrl/learner/relational_state.h"
#include "grrl/perception/perception.h"
}

using namespace grrl_sim;

namespace
{

constexpr int rest_frames = 10;

double cpu_s()
{
    timespec now{};
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Sum {
    std::vector<double> error_px;
    double seconds = 0.0;
    double slowest = 0.0;
    int frames = 0;
    double visible = 0.0;
    std::vector<int> right[2]; /* scenes, by push: ideal points, the eye */
};

/* Where a point was born: on which link, and where on it. */
struct Home {
    int link;
    Vec2 place;
};

class Bench
{
public:
    Bench(const ObjectSpec &object, const CameraLook &look, uint64_t seed, Sum &sum)
        : object_(object), look_(look), world_(object, params(look), seed),
          scene_(object, look, seed), sum_(sum), supervisor_(visible_structure(object))
    {
        grrl_perception_config config;
        grrl_perception_config_default(&config);
        for (auto &p : perception_)
            (void)!grrl_perception_init(p.get(), &config);
        if (std::getenv("MODEL_MM")) {
            config.model_error_m = 0.001f * static_cast<float>(std::atof(std::getenv("MODEL_MM")));
            if (std::getenv("NOISE_MM"))
                config.noise_m = 0.001f * static_cast<float>(std::atof(std::getenv("NOISE_MM")));
            (void)!grrl_perception_init(perception_[1].get(), &config);
        }
        grrl_grounding_config_default(&grounding_);
        grrl_random_init(&random_, seed, 99);
        rest();
    }

    static WorldParams params(const CameraLook &look)
    {
        WorldParams p;
        p.table_m = camera_view_m(look);
        return p;
    }

    void push()
    {
        const grrl_model *model = grrl_perception_model(perception_[0].get());
        grrl_push push;
        auto body = static_cast<uint8_t>(grrl_random_below(&random_, model->n_bodies));
        auto direction = static_cast<uint8_t>(grrl_random_below(&random_, GRRL_DIRECTIONS));
        if (grrl_grounding_push(model, &grounding_, body, direction, &push) == GRRL_OK) {
            PushCommand command;
            command.start_m = {push.start_m.x, push.start_m.y};
            command.end_m = {push.end_m.x, push.end_m.y};
            command.speed_m_s = push.speed_m_s;
            command.force_limit_n = push.force_n;
            command.travel_m = push.travel_m;
            command.timeout_s = push.timeout_s;
            if (world_.begin_push(command).empty())
                while (world_.step_frame())
                    observe(true);
        }
        rest();
    }

    bool right(int which)
    {
        grrl_graph graph;
        grrl_relational_state_of(grrl_perception_model(perception_[which].get()), 0.15f, &graph,
                                 nullptr, nullptr);
        return supervisor_.judge(graph).correct;
    }

    std::string term(int which)
    {
        std::string text;
        const grrl_model *m = grrl_perception_model(perception_[which].get());
        for (int i = 0; i < m->n_bodies; i++)
            text += " " + std::to_string(m->body[i].n_features);
        for (int i = 0; i < m->n_joints; i++)
            text += std::string(" ") + (m->joint[i].type == GRRL_REVOLUTE ? "R" : "P") +
                    std::to_string(m->joint[i].a) + std::to_string(m->joint[i].b);
        return text;
    }

private:
    void observe(bool pushing)
    {
        world_.observe(frame_);
        std::vector<int32_t> id;
        std::vector<float> x, y;
        for (const TrackedFeature &f : frame_.features) {
            id.push_back(static_cast<int32_t>(f.id));
            x.push_back(static_cast<float>(f.x_m));
            y.push_back(static_cast<float>(f.y_m));
        }
        give(0, id, x, y, pushing);
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
        sum_.seconds += took;
        sum_.slowest = std::max(sum_.slowest, took);
        sum_.frames++;
        id.clear(), x.clear(), y.clear();
        for (const grrl_track::Point &p : eye_.points()) {
            if (!p.visible)
                continue;
            Vec2 m = scene_.to_m({p.x, p.y});
            id.push_back(p.id);
            x.push_back(static_cast<float>(m.x));
            y.push_back(static_cast<float>(m.y));
            if (!pushing)
                measure(p);
        }
        sum_.visible += static_cast<double>(id.size());
        give(1, id, x, y, pushing);
    }

    void measure(const grrl_track::Point &p)
    {
        std::vector<Pose> poses = world_.true_poses();
        Vec2 m = scene_.to_m({p.x, p.y});
        auto known = home_.find(p.id);
        if (known == home_.end()) {
            Home home{-1, m};
            for (size_t i = 0; i < poses.size(); i++) {
                Vec2 local = transform(inverse(poses[i]), m);
                if (!object_.links[i].fixed &&
                    std::abs(local.x) <= object_.links[i].half_length_m + 0.003 &&
                    std::abs(local.y) <= object_.links[i].half_width_m + 0.003)
                    home = {static_cast<int>(i), local};
            }
            home_[p.id] = home;
            return;
        }
        Vec2 truth =
            known->second.link < 0
                ? known->second.place
                : transform(poses[static_cast<size_t>(known->second.link)], known->second.place);
        sums_[p.id].first = sums_[p.id].first + (m - truth);
        sums_[p.id].second++;
    }

    void give(int which, const std::vector<int32_t> &id, const std::vector<float> &x,
              const std::vector<float> &y, bool pushing)
    {
        grrl_frame frame{static_cast<uint32_t>(id.size()), id.data(), x.data(), y.data()};
        grrl_perception_observe(perception_[which].get(), &frame, pushing);
    }

    void rest()
    {
        sums_.clear();
        for (int i = 0; i < rest_frames; i++) {
            (void)world_.step_frame();
            observe(false);
        }
        for (const auto &[id, sum] : sums_) {
            double e = length((1.0 / sum.second) * sum.first) * 1000.0 / look_.mm_per_px;
            sum_.error_px.push_back(e);
            if (std::getenv("VERBOSE") && e > 0.3) {
                const Home &h = home_[id];
                std::printf("   id %d link %d at %.1f %.1f mm error %.2f px (%.2f %.2f) n %d\n", id,
                            h.link, 1e3 * h.place.x, 1e3 * h.place.y, e,
                            sum.first.x / sum.second * 1000 / look_.mm_per_px,
                            sum.first.y / sum.second * 1000 / look_.mm_per_px, sum.second);
            }
        }
        for (auto &p : perception_)
            (void)!grrl_perception_update(p.get());
    }

    ObjectSpec object_;
    CameraLook look_;
    World world_;
    Scene scene_;
    Sum &sum_;
    Supervisor supervisor_;
    grrl_track::Eye eye_{grrl_track::EyeConfig{}};
    std::unique_ptr<grrl_perception> perception_[2] = {
        std::unique_ptr<grrl_perception>(new grrl_perception),
        std::unique_ptr<grrl_perception>(new grrl_perception)};
    grrl_grounding_config grounding_;
    grrl_random random_;
    Frame frame_;
    std::map<int32_t, Home> home_;
    std::map<int32_t, std::pair<Vec2, int>> sums_;
};

double share(std::vector<double> &values, double q)
{
    if (values.empty())
        return 0.0;
    size_t i = static_cast<size_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values.end());
    return values[i];
}

} // namespace

int main(int argc, char **argv)
{
    if (argc < 5)
        return 2;
    cv::setNumThreads(1);
    Result<ObjectSpec> object = object_from_text(argv[1]);
    CameraLook look;
    std::string problem = argc > 5 ? parse_camera_look(argv[5], look) : "";
    if (!object || !problem.empty()) {
        (void)std::fprintf(stderr, "track_scenes: %s%s\n", object.error.c_str(), problem.c_str());
        return 2;
    }
    uint64_t seed = std::strtoull(argv[2], nullptr, 10);
    int scenes = std::atoi(argv[3]);
    int pushes = std::atoi(argv[4]);
    Sum sum;
    for (auto &r : sum.right)
        r.assign(static_cast<size_t>(pushes), 0);
    for (int s = 0; s < scenes; s++) {
        Bench bench(*object.value, look, seed + static_cast<uint64_t>(s), sum);
        for (int p = 0; p < pushes; p++) {
            bench.push();
            for (int w = 0; w < 2; w++)
                sum.right[w][static_cast<size_t>(p)] += bench.right(w);
        }
        if (std::getenv("VERBOSE"))
            std::printf("scene %d: ideal %d%s | eye %d%s\n", s, bench.right(0),
                        bench.term(0).c_str(), bench.right(1), bench.term(1).c_str());
    }
    std::printf("%s: %d scenes, %.1f points, %.2f ms a picture (slowest %.1f)\n", argv[1], scenes,
                sum.visible / sum.frames, 1e3 * sum.seconds / sum.frames, 1e3 * sum.slowest);
    std::printf("error at rest, px: median %.3f, p90 %.3f, p99 %.3f (n %zu)\n",
                share(sum.error_px, 0.5), share(sum.error_px, 0.9), share(sum.error_px, 0.99),
                sum.error_px.size());
    for (int w = 0; w < 2; w++) {
        std::printf("right, %s:", w == 0 ? "ideal" : "eye  ");
        for (int r : sum.right[w])
            std::printf(" %d", r);
        std::printf("\n");
    }
    return 0;
}
