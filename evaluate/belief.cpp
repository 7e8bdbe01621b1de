#include "belief.hpp"

#include <algorithm>

#include "structure.hpp"
#include "supervisor.hpp"

namespace grrl_evaluate
{

using grrl_sim::JointSpec;
using grrl_sim::World;

namespace
{

constexpr double sure_probability = 0.95;

/* Features by body and true link, and what follows from them. */
struct Matching {
    std::vector<int> body_of_link; /* no_body: it has none */
    std::vector<bool> is_a_link;   /* by body: whether it stands for some link */
};

Matching match(const Belief &belief, const World &world)
{
    size_t links = world.object().links.size();
    std::vector<std::vector<int>> count(links,
                                        std::vector<int>(static_cast<size_t>(belief.n_bodies)));
    for (size_t id = 0; id < belief.body_of.size(); id++) {
        int link = world.tracker().true_link(static_cast<uint32_t>(id));
        int body = belief.body_of[id];
        if (link >= 0 && body >= 0)
            count[static_cast<size_t>(link)][static_cast<size_t>(body)]++;
    }
    Matching matching{std::vector<int>(links, no_body),
                      std::vector<bool>(static_cast<size_t>(belief.n_bodies))};
    for (size_t link = 0; link < links; link++) {
        auto most = std::max_element(count[link].begin(), count[link].end());
        if (most == count[link].end() || *most == 0)
            continue;
        matching.body_of_link[link] = static_cast<int>(most - count[link].begin());
        matching.is_a_link[static_cast<size_t>(matching.body_of_link[link])] = true;
    }
    return matching;
}

bool same_pair(int a, int b, int c, int d)
{
    return (a == c && b == d) || (a == d && b == c);
}

bool is_right(const BelievedJoint &joint, const Matching &matching, const World &world)
{
    const std::vector<JointSpec> &truth = world.object().joints;
    return std::any_of(truth.begin(), truth.end(), [&](const JointSpec &t) {
        return t.type == joint.type &&
               same_pair(joint.a, joint.b, matching.body_of_link[static_cast<size_t>(t.a)],
                         matching.body_of_link[static_cast<size_t>(t.b)]);
    });
}

bool is_believed(const JointSpec &truth, const Matching &matching, const Belief &belief)
{
    int a = matching.body_of_link[static_cast<size_t>(truth.a)];
    int b = matching.body_of_link[static_cast<size_t>(truth.b)];
    return std::any_of(belief.joints.begin(), belief.joints.end(), [&](const BelievedJoint &j) {
        return j.type == truth.type && same_pair(j.a, j.b, a, b);
    });
}

/* As the supervisor sees it: the structures are isomorphic. */
bool is_exact(const Belief &belief, const World &world)
{
    grrl_graph graph;
    grrl_graph_clear(&graph);
    for (int i = 0; i < belief.n_bodies; i++)
        if (grrl_graph_add_link(&graph, 0, nullptr) != GRRL_OK)
            return false;
    for (const BelievedJoint &joint : belief.joints)
        if (grrl_graph_add_joint(&graph, static_cast<uint8_t>(joint.a),
                                 static_cast<uint8_t>(joint.b), joint.type) != GRRL_OK)
            return false;
    grrl_sim::Supervisor supervisor(grrl_sim::visible_structure(world.object()));
    return supervisor.judge(graph).correct;
}

void count_features(const Belief &belief, const Matching &matching, const World &world,
                    Verdict &verdict)
{
    for (size_t id = 0; id < belief.body_of.size(); id++) {
        int link = world.tracker().true_link(static_cast<uint32_t>(id));
        int right = link >= 0 ? matching.body_of_link[static_cast<size_t>(link)] : no_body;
        if (belief.body_of[id] == unseen || (link >= 0 && right == no_body))
            continue;
        verdict.features++;
        verdict.misplaced += belief.body_of[id] != right;
    }
}

} // namespace

Verdict judge(const Belief &belief, const World &world)
{
    Matching matching = match(belief, world);
    Verdict verdict;
    for (const BelievedJoint &joint : belief.joints) {
        bool right = is_right(joint, matching, world);
        bool sure = joint.probability >= sure_probability;
        verdict.wrong_joint = verdict.wrong_joint || !right;
        verdict.sure += sure;
        verdict.sure_and_right += sure && right;
    }
    for (bool is_a_link : matching.is_a_link)
        verdict.false_split = verdict.false_split || !is_a_link;
    for (const JointSpec &truth : world.object().joints)
        verdict.missed_joint = verdict.missed_joint || !is_believed(truth, matching, belief);
    verdict.exact = !verdict.wrong_joint && !verdict.false_split && is_exact(belief, world);
    count_features(belief, matching, world, verdict);
    return verdict;
}

} // namespace grrl_evaluate
