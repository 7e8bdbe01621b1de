#include "chooser.hpp"

#include <algorithm>
#include <tuple>

namespace grrl_experiment
{

bool Tried::Joint::operator<(const Joint &other) const
{
    return std::tie(a, b, type) < std::tie(other.a, other.b, other.type);
}

bool Tried::Joint::operator==(const Joint &other) const
{
    return std::tie(a, b, type) == std::tie(other.a, other.b, other.type);
}

void Tried::look(const grrl_model &model)
{
    std::set<uint16_t> bodies;
    std::set<Joint> joints;
    for (int i = 0; i < model.n_bodies; i++)
        bodies.insert(model.body[i].number);
    for (int i = 0; i < model.n_joints; i++) {
        const grrl_joint &joint = model.joint[i];
        auto ends = std::minmax(model.body[joint.a].number, model.body[joint.b].number);
        joints.insert({ends.first, ends.second, joint.type});
    }
    bool same = bodies == bodies_ && joints == joints_;
    if (!same || actions_.size() >= bodies.size() * GRRL_DIRECTIONS)
        actions_.clear();
    bodies_ = std::move(bodies);
    joints_ = std::move(joints);
}

bool Tried::has(Action action) const
{
    return actions_.count({action.body_number, action.direction}) > 0;
}

void Tried::add(Action action)
{
    actions_.insert({action.body_number, action.direction});
}

} // namespace grrl_experiment
