#include "policies.hpp"

namespace grrl_experiment
{

namespace
{

using Change = std::function<void(grrl_learner_config &config)>;

/* A policy of the other table, but for a change. */
Policy changed(const char *base, const std::string &suffix, const std::string &text,
               const Change &change)
{
    Policy policy;
    for (const Policy &whole : policies())
        if (whole.name == base)
            policy = whole;
    Change configure = policy.configure;
    policy.name = std::string(base) + "-" + suffix;
    policy.text = text;
    policy.configure = [configure, change](grrl_learner_config &config) {
        configure(config);
        change(config);
    };
    return policy;
}

void add_capacities(std::vector<Policy> &table, const char *base, const char *what)
{
    for (int capacity : {32, 64, 128, 256, 1024, 4096}) {
        std::string number = std::to_string(capacity);
        table.push_back(changed(base, number, "memory for " + number + " " + what,
                                [](grrl_learner_config &) {}));
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
        {"exact", "nothing but the very same structure is recalled",
         [](grrl_learner_config &c) { c.policy.recall.deepest = GRRL_RECALL_EXACT; }},
        {"strict", "no property is ever dropped",
         [](grrl_learner_config &c) { c.policy.recall.strict = true; }},
        {"no-sub", "no sub-structures: same structure, properties may be dropped",
         [](grrl_learner_config &c) { c.policy.recall.deepest = GRRL_RECALL_RELAXED; }},
        {"no-phi", "no exploration by phi: the best of the known actions, if any is",
         [](grrl_learner_config &c) { c.policy.beta = GRRL_POLICY_MOST; }},
        {"no-ie", "no Interval Estimation: the best mean",
         [](grrl_learner_config &c) { c.policy.z = 0.0f; }},
        {"no-size", "no property: every link is small",
         [](grrl_learner_config &c) { c.large_m = 1000.0f; }},
        {"gamma-0", "nothing but the immediate reward",
         [](grrl_learner_config &c) { c.policy.gamma = 0.0f; }},
        {"gamma-0.9", "later rewards count nearly as much",
         [](grrl_learner_config &c) { c.policy.gamma = 0.9f; }},
    };
    for (const auto &row : rows)
        table.push_back(changed("paper", row.suffix, row.text, row.change));
    add_capacities(table, "paper", "experiences");
}

void add_learn(std::vector<Policy> &table)
{
    static const char *const parts[GRRL_CONTEXT_PARTS] = {
        "direction", "length",    "tried",        "neighbours", "neighbour-length",
        "revolute",  "prismatic", "others-tried", "longer"};
    table.push_back(changed(
        "learn", "exact", "nothing but cases of the very same context count",
        [](grrl_learner_config &c) { c.policy.cases.mismatch = 0.0f; }));
    table.push_back(changed(
        "learn", "no-bound", "the best estimate, not the best bound",
        [](grrl_learner_config &c) { c.policy.cases.bound = 0.0f; }));
    table.push_back(changed(
        "learn", "no-doubt", "older rewards count whatever the trial brings",
        [](grrl_learner_config &c) { c.policy.cases.confidence = GRRL_MAX_REWARD; }));
    table.push_back(changed("learn", "no-present", "newer rewards count no more than older ones",
                            [](grrl_learner_config &c) { c.policy.cases.present = 0.0f; }));
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        table.push_back(changed("learn", std::string("no-") + parts[i],
                                std::string("without a part of the context: ") + parts[i],
                                [i](grrl_learner_config &c) {
                                    c.policy.cases.parts &= static_cast<uint16_t>(~(1u << i));
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
