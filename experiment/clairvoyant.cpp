#include "clairvoyant.hpp"

#include <algorithm>
#include <cmath>

#include "truth.hpp"

namespace grrl_experiment
{

namespace
{

using grrl_sim::World;

/* Motion after which perception is mostly sure of a joint; twice what it asks for at least. */
constexpr double sure_turn_rad = 0.14;
constexpr double sure_slide_m = 0.006;

/* Copies in which each push is tried: chance decides less. */
constexpr int copies = 2;

grrl_sim::PushCommand command_of(const grrl_push &push)
{
    grrl_sim::PushCommand command;
    command.start_m = {static_cast<double>(push.start_m.x), static_cast<double>(push.start_m.y)};
    command.end_m = {static_cast<double>(push.end_m.x), static_cast<double>(push.end_m.y)};
    command.travel_m = static_cast<double>(push.travel_m);
    command.speed_m_s = static_cast<double>(push.speed_m_s);
    command.force_limit_n = static_cast<double>(push.force_n);
    command.timeout_s = static_cast<double>(push.timeout_s);
    return command;
}

double sure_motion(const grrl_sim::JointSpec &joint)
{
    return joint.type == GRRL_REVOLUTE ? sure_turn_rad : sure_slide_m;
}

class Clairvoyant : public Chooser
{
public:
    Clairvoyant(std::function<const World &()> world, uint64_t seed)
        : world_(std::move(world)), seed_(seed)
    {
    }
    Action choose(const grrl_model &model) override;

private:
    double revealed(const World &world, const std::vector<bool> &known,
                    const grrl_sim::PushCommand &command);

    std::function<const World &()> world_;
    uint64_t seed_;
};

double Clairvoyant::revealed(const World &world, const std::vector<bool> &known,
                             const grrl_sim::PushCommand &command)
{
    double sum = 0.0;
    for (int c = 0; c < copies; c++) {
        World copy = world.copy(seed_++);
        if (!copy.begin_push(command).empty())
            return 0.0;
        while (copy.step_frame())
            ;
        for (size_t j = 0; j < known.size(); j++) {
            int joint = static_cast<int>(j);
            double need = sure_motion(world.object().joints[j]);
            double before = std::min(1.0, world.true_joint_range(joint) / need);
            double after = std::min(1.0, copy.true_joint_range(joint) / need);
            double moved = std::abs(copy.true_joint_value(joint) - world.true_joint_value(joint));
            /* Moved enough before and still not believed: it takes another motion. */
            if (!known[j])
                sum += std::max(after - before, std::min(1.0, moved / need));
        }
    }
    return sum / copies;
}

Action Clairvoyant::choose(const grrl_model &model)
{
    const World &world = world_();
    std::vector<bool> known = known_joints(world, belief_of(model));
    grrl_grounding_config config;
    grrl_grounding_config_default(&config);
    Action best{model.body[0].number, 0};
    double most = -1.0;
    for (uint8_t body = 0; body < model.n_bodies; body++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            grrl_push push;
            if (grrl_grounding_push(&model, &config, body, direction, &push) != GRRL_OK)
                continue;
            double gain = revealed(world, known, command_of(push));
            if (gain > most) {
                most = gain;
                best = {model.body[body].number, direction};
            }
        }
    }
    return best;
}

} // namespace

std::unique_ptr<Chooser> make_clairvoyant(std::function<const World &()> world, uint64_t seed)
{
    return std::make_unique<Clairvoyant>(std::move(world), seed);
}

} // namespace grrl_experiment
