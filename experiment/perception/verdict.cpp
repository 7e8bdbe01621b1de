/* verdict.cpp: compares joints, links and features with the truth. */
#include "verdict.hpp"

#include <algorithm>

#include "structure.hpp"
#include "supervisor.hpp"

namespace grrl_experiment::perception
{

using grrl_sim::World;

namespace
{

constexpr double sure_probability = 0.95;

/* The supervisor's criterion: the structures are isomorphic. */
bool is_exact(const Estimate &estimate, const World &world)
{
    grrl_graph graph;
    grrl_graph_clear(&graph);
    for (int i = 0; i < estimate.links; i++)
        if (grrl_graph_add_link(&graph, 0, nullptr) != GRRL_OK)
            return false;
    for (const EstimatedJoint &joint : estimate.joints)
        if (grrl_graph_add_joint(&graph, static_cast<uint8_t>(joint.a),
                                 static_cast<uint8_t>(joint.b),
                                 static_cast<grrl_joint_type>(joint.type)) != GRRL_OK)
            return false;
    grrl_sim::Supervisor supervisor(grrl_sim::visible_structure(world.object()));
    return supervisor.judge(graph).correct;
}

void count_features(const Estimate &estimate, const std::vector<int> &links, const World &world,
                    Verdict &verdict)
{
    for (auto [id, body] : estimate.features) {
        int link = world.tracker().true_link(static_cast<uint32_t>(id));
        int right = link >= 0 ? links[static_cast<size_t>(link)] : no_link;
        if (link >= 0 && right == no_link)
            continue;
        verdict.features++;
        verdict.misplaced += body != right;
    }
}

} // namespace

Verdict judge(const Estimate &estimate, const World &world)
{
    Verdict verdict;
    std::vector<int> links = estimated_links(world, estimate);
    std::vector<bool> wrong = wrong_joints(world, estimate);
    std::vector<bool> known = known_joints(world, estimate);
    for (size_t i = 0; i < wrong.size(); i++) {
        bool sure = estimate.joints[i].probability >= sure_probability;
        verdict.wrong_joint = verdict.wrong_joint || wrong[i];
        verdict.sure += sure;
        verdict.sure_and_right += sure && !wrong[i];
    }
    for (int body = 0; body < estimate.links; body++)
        verdict.false_split =
            verdict.false_split || std::find(links.begin(), links.end(), body) == links.end();
    verdict.missed_joint = std::find(known.begin(), known.end(), false) != known.end();
    verdict.exact = !verdict.wrong_joint && !verdict.false_split && is_exact(estimate, world);
    count_features(estimate, links, world, verdict);
    return verdict;
}

} // namespace grrl_experiment::perception
