/* policies.cpp: the table of policies: one row for each of the library's, and one for each of the
 * experiment's own. */
#include "policies.hpp"

#include "clairvoyant.hpp"
#include "grrl/policies.h"
#include "motion.hpp"
#include "rule.hpp"

namespace grrl_experiment
{

namespace
{

constexpr uint16_t memory = 1000; /* grrl-agent's default */

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

Policy chooser_row(const char *name, const char *text, const char *color,
                   std::unique_ptr<Chooser> (*make)(const grrl_sim::Node *, uint64_t))
{
    Policy policy{name, text, &chooser_policy, color, memory};
    policy.make_chooser = make;
    return policy;
}

std::vector<Policy> make_table()
{
    /* For the library's policies, in their order; further policies start again from the front. */
    const char *const colors[] = {"#1666a8", "#d1661b", "#c2a21f", "#8c8c8c"};
    std::vector<Policy> table;
    for (const grrl_policy_type *const *type = grrl_policies; *type != nullptr; type++)
        table.push_back({(*type)->name, (*type)->text, *type,
                         colors[table.size() % (sizeof colors / sizeof colors[0])], memory});
    table.push_back(chooser_row(
        "rule", "no learning: the longest body; along, across, at 45 degrees; no repeats",
        "#2f8f4e", rule));
    table.push_back(chooser_row("motion",
                                "no learning: the most predicted motion in joints still uncertain",
                                "#8a4fb0", motion));
    table.push_back(chooser_row(
        "clairvoyant", "knows the truth and tries every push in a copy of the world: a bound",
        "#b3243a", clairvoyant));
    table.back().needs_truth = true;
    return table;
}

} // namespace

const std::vector<Policy> &policies()
{
    static const std::vector<Policy> table = make_table();
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
