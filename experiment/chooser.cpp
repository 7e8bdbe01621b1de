/* chooser.cpp: adapts a chooser to the library's policy interface, and records its pushes. */
#include "chooser.hpp"

#include <algorithm>
#include <tuple>

namespace grrl_experiment
{

namespace
{

Chooser &chooser_of(void *self)
{
    return *static_cast<Chooser *>(self);
}

size_t no_bytes(uint32_t)
{
    return 0;
}

grrl_status no_init(void *, uint32_t, const void *)
{
    return GRRL_OK;
}

void begin_trial(void *self)
{
    chooser_of(self).begin_trial();
}

void choose(void *self, const grrl_view *view, grrl_random *, grrl_choice *choice)
{
    chooser_of(self).observe(*view->perception);
    Action action = chooser_of(self).choose(*view->model);
    *choice = grrl_choice{};
    while (choice->link + 1 < view->model->n_bodies &&
           view->model->body[choice->link].number != action.body_number)
        choice->link++;
    choice->direction = action.direction;
    choice->reason = GRRL_CHOICE_RULE;
    choice->source = grrl_no_source();
}

grrl_policy_type make_chooser_policy()
{
    grrl_policy_type type{};
    type.name = "chooser";
    type.text = "a rule of the experiment";
    type.bytes = no_bytes;
    type.init = no_init;
    type.begin_trial = begin_trial;
    type.choose = choose;
    return type;
}

} // namespace

const grrl_policy_type chooser_policy = make_chooser_policy();

grrl_policy policy_of(Chooser &chooser)
{
    return {&chooser_policy, &chooser};
}

bool Tried::Joint::operator<(const Joint &other) const
{
    return std::tie(a, b, type) < std::tie(other.a, other.b, other.type);
}

bool Tried::Joint::operator==(const Joint &other) const
{
    return std::tie(a, b, type) == std::tie(other.a, other.b, other.type);
}

void Tried::update(const grrl_model &model)
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
