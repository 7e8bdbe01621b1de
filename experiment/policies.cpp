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

std::unique_ptr<Chooser> motion(const grrl_sim::Node *, uint64_t)
{
    return make_motion();
}

std::unique_ptr<Chooser> clairvoyant(const grrl_sim::Node *node, uint64_t seed)
{
    return make_clairvoyant([node]() -> const grrl_sim::World & { return node->world(); }, seed);
}

Policy chooser_row(const std::string &name, const std::string &text, const char *color,
                   decltype(Policy::make_chooser) make)
{
    Policy policy{name, text, &chooser_policy, color, memory};
    policy.make_chooser = std::move(make);
    return policy;
}

/* The rule in its six orders; the first one is called just rule. */
void add_rules(std::vector<Policy> &table)
{
    const struct {
        const char *order;
        const char *text;
        const char *color;
    } rows[] = {
        {"aps", "along, across, at 45 degrees", "#2f8f4e"},
        {"asp", "along, at 45 degrees, across", "#7fb87f"},
        {"pas", "across, along, at 45 degrees", "#4e9f9f"},
        {"psa", "across, at 45 degrees, along", "#7fc4c4"},
        {"sap", "at 45 degrees, along, across", "#9aa33a"},
        {"spa", "at 45 degrees, across, along", "#c3cb72"},
    };
    for (const auto &row : rows) {
        bool first = std::string(row.order) == "aps";
        table.push_back(chooser_row(
            first ? "rule" : std::string("rule-") + row.order,
            std::string("no learning: the longest body; ") + row.text + "; no repeats", row.color,
            [order = row.order](const grrl_sim::Node *, uint64_t) { return make_rule(order); }));
        table.back().is_rule = true;
    }
}

std::vector<Policy> make_table()
{
    /* For the library's policies, in their order; further policies start again from the front. */
    const char *const colors[] = {"#1666a8", "#d1661b", "#c2a21f", "#8c8c8c"};
    std::vector<Policy> table;
    for (const grrl_policy_type *const *type = grrl_policies; *type != nullptr; type++)
        table.push_back({(*type)->name, (*type)->text, *type,
                         colors[table.size() % (sizeof colors / sizeof colors[0])], memory});
    add_rules(table);
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
