/* trial.cpp: the course of a trial, and its counts. */
#include "trial.hpp"

#include <time.h>

#include "adapter.hpp"
#include "baseline.hpp"
#include "grrl/base/settling.h"
#include "grrl/learner/grounding.h"
#include "grrl/perception/perception.h"
#include "verdict.hpp"

namespace grrl_experiment::perception
{

using grrl_sim::Frame;
using grrl_sim::ObjectSpec;
using grrl_sim::World;

namespace
{

enum { SIX = 6 };
constexpr uint64_t push_stream = 99; /* random stream for the choice of body and direction */

/* CPU time of this thread: other work on the machine must not count. */
double cpu_s()
{
    timespec now{};
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/* The world, the two methods that observe it, and the pusher. */
class Bench
{
public:
    Bench(const ObjectSpec &object, const TrialParams &params, uint64_t seed);

    bool push(); /* false: nothing to push */
    Estimate ours() const { return estimate_of(*grrl_perception_model(perception_.get())); }
    Estimate baseline() const { return baseline_.estimate(); }
    bool every_joint_moved_enough() const;
    const World &world() const { return world_; }
    double perception_s() const { return perception_s_; }

private:
    void observe(bool pushing);
    void rest();

    World world_;
    Baseline baseline_;
    std::unique_ptr<grrl_perception> perception_{new grrl_perception};
    grrl_grounding_config grounding_;
    grrl_random random_;
    Frame frame_;
    grrl_sim::FrameArrays arrays_;
    double perception_s_ = 0.0;
};

Bench::Bench(const ObjectSpec &object, const TrialParams &params, uint64_t seed)
    : world_(object, params.world, seed), baseline_(world_.tracker().feature_count())
{
    grrl_perception_config config;
    grrl_perception_config_default(&config);
    config.noise_m = static_cast<float>(params.world.tracker.noise_sigma_m);
    (void)!grrl_perception_init(perception_.get(), &config);
    grrl_grounding_config_default(&grounding_);
    grrl_random_init(&random_, seed, push_stream);
    rest();
}

void Bench::observe(bool pushing)
{
    world_.observe(frame_);
    grrl_frame frame = arrays_.frame_of(frame_);
    const double start = cpu_s();
    grrl_perception_observe(perception_.get(), &frame, pushing);
    perception_s_ += cpu_s() - start;
}

/* The rest after a push, and the resulting model. */
void Bench::rest()
{
    std::vector<Frame> frames;
    for (int i = 0; i < GRRL_SETTLING_FRAMES; i++) {
        (void)world_.step_frame();
        observe(false);
        frames.push_back(frame_);
    }
    const double start = cpu_s();
    (void)!grrl_perception_update(perception_.get());
    perception_s_ += cpu_s() - start;
    baseline_.rest(frames);
}

bool Bench::push()
{
    const grrl_model *model = grrl_perception_model(perception_.get());
    if (model->n_bodies == 0)
        return false;
    grrl_push push;
    auto body = static_cast<uint8_t>(grrl_random_below(&random_, model->n_bodies));
    auto direction = static_cast<uint8_t>(grrl_random_below(&random_, GRRL_DIRECTIONS));
    if (grrl_grounding_push(model, &grounding_, body, direction, &push) != GRRL_OK)
        return false;
    if (world_.begin_push(grrl_sim::command_of(push)).empty())
        while (world_.step_frame())
            observe(true);
    rest();
    return true;
}

bool Bench::every_joint_moved_enough() const
{
    const std::vector<grrl_sim::JointSpec> &joints = world_.object().joints;
    for (size_t i = 0; i < joints.size(); i++)
        if (world_.true_joint_range(static_cast<int>(i)) <
            (joints[i].type == GRRL_REVOLUTE ? enough_rad : enough_m))
            return false;
    return true;
}

void count_state(const Verdict &verdict, bool moved, Tally &tally)
{
    tally.states++;
    tally.wrong_joint += verdict.wrong_joint;
    tally.false_split += verdict.false_split;
    tally.wrong += verdict.wrong_joint || verdict.false_split;
    tally.moved_states += moved;
    tally.missed += moved && verdict.missed_joint;
    tally.features += verdict.features;
    tally.misplaced += verdict.misplaced;
    tally.sure += verdict.sure;
    tally.sure_and_right += verdict.sure_and_right;
}

} // namespace

Tally &Tally::operator+=(const Tally &other)
{
    states += other.states;
    wrong_joint += other.wrong_joint;
    false_split += other.false_split;
    wrong += other.wrong;
    moved_states += other.moved_states;
    missed += other.missed;
    features += other.features;
    misplaced += other.misplaced;
    sure += other.sure;
    sure_and_right += other.sure_and_right;
    six += other.six;
    six_exact += other.six_exact;
    told += other.told;
    told_exact += other.told_exact;
    ended_exact += other.ended_exact;
    return *this;
}

/* The trial ends when the library is right; it continues up to six pushes only for the figure about
 * the state after six. */
TrialResult run_trial(const ObjectSpec &object, const TrialParams &params, uint64_t seed)
{
    Bench bench(object, params, seed);
    TrialResult result;
    bool ended = false;
    bool moved_so_far = false; /* every joint has moved enough */
    bool moved_in_six = false;
    bool exact_when_moved[METHODS] = {false, false};
    bool exact_in_six[METHODS] = {false, false};
    int pushes = 0;
    while ((!ended || pushes < SIX) && pushes < params.cap && bench.push()) {
        pushes++;
        bool moved = bench.every_joint_moved_enough();
        Verdict verdict[METHODS] = {judge(bench.ours(), bench.world()),
                                    judge(bench.baseline(), bench.world())};
        moved_in_six = moved_in_six || (pushes <= SIX && moved);
        for (int m = OURS; m < METHODS; m++) {
            exact_in_six[m] = exact_in_six[m] || (pushes <= SIX && verdict[m].exact);
            if (!moved_so_far)
                exact_when_moved[m] = exact_when_moved[m] || verdict[m].exact;
            if (!ended)
                count_state(verdict[m], moved, result.tally[m]);
            if (!ended && verdict[OURS].exact)
                result.tally[m].ended_exact += verdict[m].exact;
        }
        moved_so_far = moved_so_far || moved;
        result.pushes += !ended;
        ended = ended || verdict[OURS].exact;
    }
    result.at_cap = !ended;
    result.update_ms = pushes > 0 ? 1e3 * bench.perception_s() / pushes : 0.0;
    for (int m = OURS; m < METHODS; m++) {
        result.tally[m].six = moved_in_six;
        result.tally[m].told = moved_so_far || exact_when_moved[OURS];
        result.tally[m].told_exact = exact_when_moved[m];
        result.tally[m].six_exact = moved_in_six && exact_in_six[m];
    }
    return result;
}

} // namespace grrl_experiment::perception
