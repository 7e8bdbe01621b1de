/*
 * track_scenes OBJECT SEED SCENES PUSHES [LOOK]: how well the eye sees, and what perception makes
 * of it. docs/camera.md has its figures.
 *
 * In each scene random pushes, chosen by what is believed from ideal points. Four perceptions
 * watch: ideal points, the simulator's own; those that no other link covers; what the eye makes of
 * the pictures; and the eye's points without its error. Prints in how many scenes each has the
 * right structure after each push, how far points are off at rest, and the processor time of a
 * picture.
 */
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <opencv2/core/utility.hpp>

#include "eye_bench.hpp"
#include "grrl/learner/grounding.h"
#include "grrl/learner/relational_state.h"
#include "grrl/perception/perception.h"
#include "structure.hpp"
#include "supervisor.hpp"

using namespace grrl_sim;
using eye_bench::EyeBench;

namespace
{

/* Ideal points; those of them that no other link covers; the eye's; the eye's, where they truly
 * are. */
enum Eyes { IDEAL, UNCOVERED, PIXELS, EXACT, EYES };
const char *const names[EYES] = {"ideal points", "ideal, uncovered", "the eye",
                                 "the eye, no error"};
constexpr uint64_t push_stream = 99;
constexpr float large_m = 0.15f;
constexpr float eye_noise_px = 0.25f; /* what perception is told: nine tenths of the errors at rest
                                         are below 0.16 */

struct Sum {
    std::vector<double> errors_px;
    double seconds = 0.0;
    double slowest_s = 0.0;
    int frames = 0;
    double visible = 0.0;
    std::vector<int> right[EYES]; /* scenes, by push */
    std::vector<int> both;        /* ideal points and the eye */
};

class Trial
{
public:
    Trial(const ObjectSpec &object, const CameraLook &look, uint64_t seed)
        : bench_(object, look, seed, [this](bool pushing) { observe(pushing); }),
          supervisor_(visible_structure(object))
    {
        grrl_perception_config config;
        grrl_perception_config_default(&config);
        const float ideal_noise_m = config.noise_m;
        const float eye_noise_m = 0.001f * eye_noise_px * static_cast<float>(look.mm_per_px);
        for (Eyes eyes : {IDEAL, UNCOVERED, PIXELS, EXACT}) {
            config.noise_m = eyes == PIXELS || eyes == EXACT ? eye_noise_m : ideal_noise_m;
            perception_[eyes] = std::make_unique<grrl_perception>();
            (void)!grrl_perception_init(perception_[eyes].get(), &config);
        }
        grrl_grounding_config_default(&grounding_);
        grrl_random_init(&random_, seed, push_stream);
        rest();
    }

    void push()
    {
        const grrl_model *model = grrl_perception_model(perception_[IDEAL].get());
        auto body = static_cast<uint8_t>(grrl_random_below(&random_, model->n_bodies));
        auto turn = static_cast<uint8_t>(grrl_random_below(&random_, GRRL_DIRECTIONS));
        grrl_push push;
        if (grrl_grounding_push(model, &grounding_, body, turn, &push) == GRRL_OK) {
            PushCommand command;
            command.start_m = {static_cast<double>(push.start_m.x),
                               static_cast<double>(push.start_m.y)};
            command.end_m = {static_cast<double>(push.end_m.x), static_cast<double>(push.end_m.y)};
            command.speed_m_s = static_cast<double>(push.speed_m_s);
            command.force_limit_n = static_cast<double>(push.force_n);
            command.travel_m = static_cast<double>(push.travel_m);
            command.timeout_s = static_cast<double>(push.timeout_s);
            bench_.push(command);
        }
        rest();
    }

    bool right(Eyes eyes) const
    {
        grrl_graph graph;
        grrl_relational_state_of(grrl_perception_model(perception_[eyes].get()), large_m, &graph,
                                 nullptr, nullptr);
        return supervisor_.judge(graph).correct;
    }

    void print(Eyes eyes) const
    {
        const grrl_model *model = grrl_perception_model(perception_[eyes].get());
        (void)std::printf("  %s %d:",
                          eyes == IDEAL    ? "ideal"
                          : eyes == PIXELS ? "eye"
                                           : "exact",
                          right(eyes));
        for (int i = 0; i < model->n_bodies; i++)
            (void)std::printf(" %d", model->body[i].n_features);
        for (int i = 0; i < model->n_joints; i++)
            (void)std::printf(" %c%d-%d", model->joint[i].type == GRRL_REVOLUTE ? 'R' : 'P',
                              model->joint[i].a, model->joint[i].b);
        (void)std::printf("\n");
    }

    const EyeBench &bench() const { return bench_; }

private:
    void rest()
    {
        bench_.rest();
        for (auto &perception : perception_)
            (void)!grrl_perception_update(perception.get());
    }

    void observe(bool pushing)
    {
        std::vector<int32_t> id[EYES];
        std::vector<float> x[EYES];
        std::vector<float> y[EYES];
        auto add = [&](Eyes eyes, int32_t i, Vec2 m) {
            id[eyes].push_back(i);
            x[eyes].push_back(static_cast<float>(m.x));
            y[eyes].push_back(static_cast<float>(m.y));
        };
        bench_.world().observe(frame_);
        for (const TrackedFeature &f : frame_.features) {
            add(IDEAL, static_cast<int32_t>(f.id), {f.x_m, f.y_m});
            if (!bench_.covered(bench_.world().tracker().true_link(f.id), {f.x_m, f.y_m}))
                add(UNCOVERED, static_cast<int32_t>(f.id), {f.x_m, f.y_m});
        }
        for (const grrl_track::Point &p : bench_.points())
            if (p.visible) {
                Vec2 seen =
                    bench_.scene().to_m({static_cast<double>(p.x), static_cast<double>(p.y)});
                add(PIXELS, p.id, seen);
                add(EXACT, p.id, bench_.knows(p.id) ? bench_.truth(p.id) : seen);
            }
        for (int e = 0; e < EYES; e++) {
            grrl_frame frame{static_cast<uint32_t>(id[e].size()), id[e].data(), x[e].data(),
                             y[e].data()};
            grrl_perception_observe(perception_[e].get(), &frame, pushing);
        }
    }

    EyeBench bench_;
    Supervisor supervisor_;
    std::unique_ptr<grrl_perception> perception_[EYES];
    grrl_grounding_config grounding_;
    grrl_random random_;
    Frame frame_;
};

void add(const EyeBench &bench, Sum &sum)
{
    sum.errors_px.insert(sum.errors_px.end(), bench.errors_px.begin(), bench.errors_px.end());
    sum.seconds += bench.seconds;
    sum.slowest_s = std::max(sum.slowest_s, bench.slowest_s);
    sum.frames += bench.frames;
    sum.visible += bench.visible;
}

void print(const char *object, int scenes, const Sum &sum)
{
    (void)std::printf("%s: %d scenes, %.1f points, %.2f ms a picture, the slowest %.1f\n", object,
                      scenes, sum.visible / sum.frames, 1e3 * sum.seconds / sum.frames,
                      1e3 * sum.slowest_s);
    (void)std::printf("error at rest, px: median %.3f, p90 %.3f, p99 %.3f of %zu\n",
                      eye_bench::quantile(sum.errors_px, 0.5),
                      eye_bench::quantile(sum.errors_px, 0.9),
                      eye_bench::quantile(sum.errors_px, 0.99), sum.errors_px.size());
    for (int e = 0; e < EYES; e++) {
        (void)std::printf("right, %-18s", names[e]);
        for (int right : sum.right[e])
            (void)std::printf(" %d", right);
        (void)std::printf("\n");
    }
    (void)std::printf("right, %-18s", "ideal and the eye");
    for (int right : sum.both)
        (void)std::printf(" %d", right);
    (void)std::printf("\n");
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
        (void)std::fprintf(stderr, "track_scenes: %s%s%s\n", object.error.c_str(),
                           problem.empty() ? "" : "LOOK must be ", problem.c_str());
        return 2;
    }
    uint64_t seed = std::strtoull(argv[2], nullptr, 10);
    int scenes = std::atoi(argv[3]);
    int pushes = std::atoi(argv[4]);
    Sum sum;
    for (std::vector<int> &right : sum.right)
        right.assign(static_cast<size_t>(pushes), 0);
    sum.both.assign(static_cast<size_t>(pushes), 0);
    for (int s = 0; s < scenes; s++) {
        Trial trial(*object.value, look, seed + static_cast<uint64_t>(s));
        for (int p = 0; p < pushes; p++) {
            trial.push();
            for (Eyes eyes : {IDEAL, UNCOVERED, PIXELS, EXACT})
                sum.right[eyes][static_cast<size_t>(p)] += trial.right(eyes);
            sum.both[static_cast<size_t>(p)] += trial.right(IDEAL) && trial.right(PIXELS);
        }
        if (std::getenv("TRACK_SCENES_VERBOSE") != nullptr)
            for (Eyes eyes : {IDEAL, UNCOVERED, PIXELS, EXACT})
                trial.print(eyes);
        add(trial.bench(), sum);
    }
    print(argv[1], scenes, sum);
    return 0;
}
