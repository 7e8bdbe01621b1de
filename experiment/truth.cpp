/* truth.cpp: assigns estimated links to true ones by the features they hold. */
#include "truth.hpp"

#include <algorithm>

namespace grrl_experiment
{

namespace
{

bool agree(const grrl_sim::JointSpec &truth, const EstimatedJoint &joint,
           const std::vector<int> &links)
{
    int a = links[static_cast<size_t>(truth.a)];
    int b = links[static_cast<size_t>(truth.b)];
    bool ends = (a == joint.a && b == joint.b) || (a == joint.b && b == joint.a);
    return ends && a != b && static_cast<int>(truth.type) == joint.type;
}

} // namespace

Estimate estimate_of(const grrl_model_t &model)
{
    Estimate estimate;
    estimate.links = model.n_links;
    for (int i = 0; i < model.n_joints; i++)
        estimate.joints.push_back({model.joint_a[i], model.joint_b[i], model.joint_type[i],
                                   static_cast<double>(model.joint_probability[i])});
    for (int i = 0; i < model.n_features; i++)
        estimate.features.push_back({model.feature_id[i], model.feature_link[i]});
    return estimate;
}

Estimate estimate_of(const grrl_model &model)
{
    Estimate estimate;
    estimate.links = model.n_bodies;
    for (int i = 0; i < model.n_joints; i++)
        estimate.joints.push_back({model.joint[i].a, model.joint[i].b, model.joint[i].type,
                                   static_cast<double>(model.joint[i].probability)});
    for (int i = 0; i < model.n_features; i++)
        estimate.features.push_back(
            {model.feature_id[i], model.feature_body[i] < model.n_bodies
                                      ? static_cast<int>(model.feature_body[i])
                                      : static_cast<int>(no_link)});
    return estimate;
}

std::vector<int> estimated_links(const grrl_sim::World &world, const Estimate &estimate)
{
    size_t links = world.object().links.size();
    size_t held_n = static_cast<size_t>(estimate.links);
    std::vector<std::vector<int>> held(links, std::vector<int>(held_n, 0));
    for (auto [id, link] : estimate.features) {
        bool held_by =
            id >= 0 && id < world.tracker().feature_count() && link >= 0 && link < estimate.links;
        int of = held_by ? world.tracker().true_link(static_cast<uint32_t>(id)) : -1;
        if (of >= 0)
            held[static_cast<size_t>(of)][static_cast<size_t>(link)]++;
    }
    std::vector<int> most;
    for (const std::vector<int> &counts : held) {
        auto best = std::max_element(counts.begin(), counts.end());
        bool any = best != counts.end() && *best > 0;
        most.push_back(any ? static_cast<int>(best - counts.begin()) : static_cast<int>(no_link));
    }
    return most;
}

std::vector<bool> known_joints(const grrl_sim::World &world, const Estimate &estimate)
{
    std::vector<int> links = estimated_links(world, estimate);
    std::vector<bool> known;
    for (const grrl_sim::JointSpec &truth : world.object().joints)
        known.push_back(
            std::any_of(estimate.joints.begin(), estimate.joints.end(),
                        [&](const EstimatedJoint &joint) { return agree(truth, joint, links); }));
    return known;
}

std::vector<bool> wrong_joints(const grrl_sim::World &world, const Estimate &estimate)
{
    std::vector<int> links = estimated_links(world, estimate);
    const std::vector<grrl_sim::JointSpec> &joints = world.object().joints;
    std::vector<bool> wrong;
    for (const EstimatedJoint &joint : estimate.joints)
        wrong.push_back(
            std::none_of(joints.begin(), joints.end(), [&](const grrl_sim::JointSpec &truth) {
                return agree(truth, joint, links);
            }));
    return wrong;
}

} // namespace grrl_experiment
