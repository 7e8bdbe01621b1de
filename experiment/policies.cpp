#include "policies.hpp"

#include "clairvoyant.hpp"
#include "motion.hpp"
#include "rule.hpp"

namespace grrl_experiment
{

namespace
{

constexpr uint16_t memory = 1000; /* grrl-agent's default */

void learn(grrl_learner_config &config)
{
    config.policy.kind = GRRL_POLICY_LEARN;
}

void paper(grrl_learner_config &config)
{
    config.policy.kind = GRRL_POLICY_PAPER;
}

/* Also for policies that are not the library's: they keep no experience. */
void not_learning(grrl_learner_config &config)
{
    config.policy.kind = GRRL_POLICY_RANDOM;
}

std::unique_ptr<Chooser> rule(const grrl_sim::Node *, uint64_t)
{
    return make_rule();
}

std::unique_ptr<Chooser> motion(const grrl_sim::Node *, uint64_t)
{
    return make_motion();
}

std::unique_ptr<Chooser> clairvoyant(const grrl_sim::Node *node, uint64_t seed)
{
    return make_clairvoyant([node]() -> const grrl_sim::World & { return node->world(); }, seed);
}

} // namespace

const std::vector<Policy> &policies()
{
    static const std::vector<Policy> table = {
        {"random", "any push, as likely as any other", false, false, "#8c8c8c", memory,
         not_learning, nullptr},
        {"paper", "the paper's learner: closest experience, phi, Interval Estimation", true, false,
         "#d1661b", memory, paper, nullptr},
        {"learn", "the library's learner: the mean over all cases alike", true, false, "#1666a8",
         memory, learn, nullptr},
        {"rule", "no learning: the longest body, along, across, at 45 degrees, no repeats", false,
         false, "#2f8f4e", memory, not_learning, rule},
        {"motion", "no learning: the most motion expected in joints not sure yet", false, false,
         "#8a4fb0", memory, not_learning, motion},
        {"clairvoyant", "knows the truth, tries every push in a copy of the world: a bound", false,
         true, "#b3243a", memory, not_learning, clairvoyant},
    };
    return table;
}

const Policy *find_policy(const std::string &name)
{
    for (const auto *table : {&policies(), &ablations()})
        for (const Policy &policy : *table)
            if (policy.name == name)
                return &policy;
    return nullptr;
}

} // namespace grrl_experiment
