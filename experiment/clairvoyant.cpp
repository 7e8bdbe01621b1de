/* clairvoyant.cpp: tries every push in a copy of the world, and takes the best. */
#include "clairvoyant.hpp"

#include <algorithm>
#include <cmath>

#include "adapter.hpp"
#include "grrl/base/settling.h"
#include "truth.hpp"

namespace grrl_experiment
{

namespace
{

using grrl_sim::World;

/* Motion after which perception is usually certain of a joint: twice its minimum. */
constexpr double sure_turn_rad = 0.14;
constexpr double sure_slide_m = 0.006;

/* Value of a moved joint relative to an estimated one; decides among pushes that reveal the
 * same. */
constexpr double moved_weight = 0.1;

double sure_motion(const grrl_sim::JointSpec &joint)
{
    return joint.type == GRRL_REVOLUTE ? sure_turn_rad : sure_slide_m;
}

/* Number of correctly estimated joints minus wrongly estimated ones. */
double score(const World &world, const grrl_model &model)
{
    Estimate estimate = estimate_of(model);
    std::vector<bool> known = known_joints(world, estimate);
    std::vector<bool> wrong = wrong_joints(world, estimate);
    return static_cast<double>(std::count(known.begin(), known.end(), true) -
                               std::count(wrong.begin(), wrong.end(), true));
}

void see(World &world, grrl_perception &perception, bool pushing)
{
    grrl_sim::Frame frame;
    grrl_sim::FrameArrays arrays;
    world.observe(frame);
    grrl_frame seen = arrays.frame_of(frame);
    grrl_perception_observe(&perception, &seen, pushing);
}

class Clairvoyant : public Chooser
{
public:
    Clairvoyant(std::function<const World &()> world, uint64_t seed)
        : world_(std::move(world)), seed_(seed)
    {
    }
    void begin_trial() override { tried_.clear(); }
    void observe(const grrl_perception &perception) override { perception_ = &perception; }
    Action choose(const grrl_model &model) override;

private:
    double value_of(const std::vector<bool> &known, const grrl_sim::PushCommand &command);

    std::function<const World &()> world_;
    uint64_t seed_;
    const grrl_perception *perception_ = nullptr;
    Tried tried_;
};

/* How many unknown joints the push moved, as shares of the motion that makes perception
 * certain. */
double moved_joints(const World &before, const World &after, const std::vector<bool> &known)
{
    double sum = 0.0;
    for (size_t j = 0; j < known.size(); j++) {
        int joint = static_cast<int>(j);
        double by = std::abs(after.true_joint_value(joint) - before.true_joint_value(joint));
        if (!known[j])
            sum += std::min(1.0, by / sure_motion(before.object().joints[j]));
    }
    return sum;
}

/* The value of a push: the estimate after it, in copies of world and perception. */
double Clairvoyant::value_of(const std::vector<bool> &known, const grrl_sim::PushCommand &command)
{
    auto perception = std::make_unique<grrl_perception>(*perception_);
    World copy = world_().copy(seed_++);
    if (!copy.begin_push(command).empty())
        return 0.0;
    bool moving = true;
    while (moving) {
        moving = copy.step_frame();
        see(copy, *perception, true);
    }
    for (int i = 0; i < GRRL_SETTLING_FRAMES; i++)
        see(copy, *perception, false);
    double share = moved_weight * moved_joints(world_(), copy, known);
    if (grrl_perception_update(perception.get()) != GRRL_OK)
        return share;
    return score(copy, *grrl_perception_model(perception.get())) + share;
}

Action Clairvoyant::choose(const grrl_model &model)
{
    std::vector<bool> known = known_joints(world_(), estimate_of(model));
    grrl_grounding_config config;
    grrl_grounding_config_default(&config);
    Action best{model.body[0].number, 0};
    bool any = false;
    double most = 0.0;
    tried_.update(model);
    for (uint8_t body = 0; body < model.n_bodies; body++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            grrl_push push;
            Action action{model.body[body].number, direction};
            if (tried_.has(action) ||
                grrl_grounding_push(&model, &config, body, direction, &push) != GRRL_OK)
                continue;
            double gain = value_of(known, grrl_sim::command_of(push));
            if (!any || gain > most) {
                any = true;
                most = gain;
                best = action;
            }
        }
    }
    tried_.add(best);
    return best;
}

} // namespace

std::unique_ptr<Chooser> make_clairvoyant(std::function<const World &()> world, uint64_t seed)
{
    return std::make_unique<Clairvoyant>(std::move(world), seed);
}

} // namespace grrl_experiment
