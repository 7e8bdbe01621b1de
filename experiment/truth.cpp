#include "truth.hpp"

#include <algorithm>

namespace grrl_experiment
{

namespace
{

bool agree(const grrl_sim::JointSpec &truth, const BelievedJoint &joint,
           const std::vector<int> &links)
{
    int a = links[static_cast<size_t>(truth.a)];
    int b = links[static_cast<size_t>(truth.b)];
    bool ends = (a == joint.a && b == joint.b) || (a == joint.b && b == joint.a);
    return ends && a != b && static_cast<int>(truth.type) == joint.type;
}

} // namespace

Belief belief_of(const grrl_model_t &model)
{
    Belief belief;
    belief.links = model.n_links;
    for (int i = 0; i < model.n_joints; i++)
        belief.joints.push_back({model.joint_a[i], model.joint_b[i], model.joint_type[i]});
    for (int i = 0; i < model.n_features; i++)
        if (model.feature_link[i] >= 0)
            belief.features.push_back({model.feature_id[i], model.feature_link[i]});
    return belief;
}

Belief belief_of(const grrl_model &model)
{
    Belief belief;
    belief.links = model.n_bodies;
    for (int i = 0; i < model.n_joints; i++)
        belief.joints.push_back({model.joint[i].a, model.joint[i].b, model.joint[i].type});
    for (int i = 0; i < model.n_features; i++)
        if (model.feature_body[i] < model.n_bodies)
            belief.features.push_back({model.feature_id[i], model.feature_body[i]});
    return belief;
}

std::vector<int> believed_links(const grrl_sim::World &world, const Belief &belief)
{
    size_t links = world.object().links.size();
    size_t held_n = static_cast<size_t>(belief.links);
    std::vector<std::vector<int>> held(links, std::vector<int>(held_n, 0));
    for (auto [id, link] : belief.features) {
        bool seen = id >= 0 && id < world.tracker().feature_count() && link < belief.links;
        int of = seen ? world.tracker().true_link(static_cast<uint32_t>(id)) : -1;
        if (of >= 0)
            held[static_cast<size_t>(of)][static_cast<size_t>(link)]++;
    }
    std::vector<int> most;
    for (const std::vector<int> &counts : held) {
        auto best = std::max_element(counts.begin(), counts.end());
        bool any = best != counts.end() && *best > 0;
        most.push_back(any ? static_cast<int>(best - counts.begin()) : -1);
    }
    return most;
}

std::vector<bool> known_joints(const grrl_sim::World &world, const Belief &belief)
{
    std::vector<int> links = believed_links(world, belief);
    std::vector<bool> known;
    for (const grrl_sim::JointSpec &truth : world.object().joints)
        known.push_back(
            std::any_of(belief.joints.begin(), belief.joints.end(),
                        [&](const BelievedJoint &joint) { return agree(truth, joint, links); }));
    return known;
}

std::vector<bool> wrong_joints(const grrl_sim::World &world, const Belief &belief)
{
    std::vector<int> links = believed_links(world, belief);
    const std::vector<grrl_sim::JointSpec> &joints = world.object().joints;
    std::vector<bool> wrong;
    for (const BelievedJoint &joint : belief.joints)
        wrong.push_back(
            std::none_of(joints.begin(), joints.end(), [&](const grrl_sim::JointSpec &truth) {
                return agree(truth, joint, links);
            }));
    return wrong;
}

} // namespace grrl_experiment
