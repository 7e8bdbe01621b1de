/* ablations.cpp: the learners with one part removed or made smaller. */
#include "policies.hpp"

#include "grrl/learner/cases/learn_policy.h"
#include "grrl/learner/relational_q/paper_policy.h"

namespace grrl_experiment
{

namespace
{

using Change = std::function<void(grrl_learner_config &learner, void *config)>;

grrl_paper_config &paper(void *config)
{
    return *static_cast<grrl_paper_config *>(config);
}

grrl_case_config &cases(void *config)
{
    return *static_cast<grrl_case_config *>(config);
}

/* A copy of a policy from the main table, with one change. */
Policy variant(const char *base, const std::string &suffix, const std::string &text,
               const Change &change)
{
    Policy policy;
    for (const Policy &whole : policies())
        if (whole.name == base)
            policy = whole;
    policy.name = std::string(base) + "-" + suffix;
    policy.text = text;
    policy.configure = change;
    return policy;
}

void add_capacities(std::vector<Policy> &table, const char *base, const char *what)
{
    for (int capacity : {32, 64, 128, 256, 1024, 4096}) {
        std::string number = std::to_string(capacity);
        table.push_back(variant(base, number, "memory for " + number + " " + what, nullptr));
        table.back().capacity = static_cast<uint16_t>(capacity);
    }
}

void add_paper(std::vector<Policy> &table)
{
    const struct {
        const char *suffix;
        const char *text;
        Change change;
    } rows[] = {
        {"exact", "recalls only the same structure",
         [](grrl_learner_config &, void *c) { paper(c).recall.deepest = GRRL_RECALL_EXACT; }},
        {"strict", "never drops a property",
         [](grrl_learner_config &, void *c) { paper(c).recall.strict = true; }},
        {"no-sub", "no sub-structures; the same structure, perhaps without properties",
         [](grrl_learner_config &, void *c) { paper(c).recall.deepest = GRRL_RECALL_RELAXED; }},
        {"no-phi", "no exploration by phi: the best known action, if any",
         [](grrl_learner_config &, void *c) { paper(c).beta = GRRL_PAPER_MAX; }},
        {"no-ie", "no Interval Estimation: the highest mean",
         [](grrl_learner_config &, void *c) { paper(c).z = 0.0f; }},
        {"no-size", "no properties: every link is small",
         [](grrl_learner_config &learner, void *) { learner.large_m = 1000.0f; }},
        {"gamma-0", "immediate rewards only",
         [](grrl_learner_config &, void *c) { paper(c).gamma = 0.0f; }},
        {"gamma-0.9", "later rewards count nearly as much as immediate ones",
         [](grrl_learner_config &, void *c) { paper(c).gamma = 0.9f; }},
    };
    for (const auto &row : rows)
        table.push_back(variant("paper", row.suffix, row.text, row.change));
    add_capacities(table, "paper", "experiences");
}

void add_learn(std::vector<Policy> &table)
{
    static const char *const parts[GRRL_CONTEXT_PARTS] = {
        "direction",        "length",   "tried",     "neighbours",
        "neighbour-length", "revolute", "prismatic", "others-tried",
        "longer",           "aspect",   "skew",      "elsewhere"};
    table.push_back(variant(
        "learn", "exact", "only cases with exactly the same context count",
        [](grrl_learner_config &, void *c) { cases(c).mismatch = 0.0f; }));
    table.push_back(variant(
        "learn", "no-bound", "the highest estimate instead of the highest bound",
        [](grrl_learner_config &, void *c) { cases(c).bound = 0.0f; }));
    table.push_back(variant(
        "learn", "no-doubt", "older rewards keep their weight, whatever the trial reveals",
        [](grrl_learner_config &, void *c) { cases(c).confidence = GRRL_MAX_REWARD; }));
    table.push_back(variant(
        "learn", "no-present", "rewards of the current trial get no extra weight",
        [](grrl_learner_config &, void *c) { cases(c).present = 0.0f; }));
    table.push_back(variant("learn", "no-general", "no memory of what all objects have in common",
                            [](grrl_learner_config &, void *c) { cases(c).general = 0.0f; }));
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        table.push_back(variant("learn", std::string("no-") + parts[i],
                                std::string("ignores a part of the context: ") + parts[i],
                                [i](grrl_learner_config &, void *c) {
                                    cases(c).parts &= static_cast<uint16_t>(~(1u << i));
                                }));
    add_capacities(table, "learn", "cases");
}

} // namespace

const std::vector<Policy> &ablations()
{
    static const std::vector<Policy> table = [] {
        std::vector<Policy> made;
        add_paper(made);
        add_learn(made);
        return made;
    }();
    return table;
}

} // namespace grrl_experiment
