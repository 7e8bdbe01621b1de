/* claims.cpp: compares policies by paired differences. */
#include "claims.hpp"

#include <algorithm>
#include <cstdio>

#include "results.hpp"

namespace grrl_experiment
{

namespace
{

constexpr int judged_trials = 10;

/* The curves of one object and world that start with an empty memory, by what they are. */
struct Row {
    std::string object;
    int trials;
    std::vector<Experiments> random;
    std::vector<Experiments> rules;
    std::vector<Experiments> paper;
    std::vector<Experiments> learn;
    std::vector<Experiments> clairvoyant;
};

std::vector<Row> rows_of(const Plan &plan, const std::vector<Experiments> &results)
{
    std::vector<Row> rows;
    for (size_t c = 0; c < plan.curves.size(); c++) {
        const Curve &curve = plan.curves[c];
        if (!curve.starts_empty())
            continue;
        if (rows.empty() || rows.back().object != curve.object())
            rows.push_back({curve.object(), curve.trials(), {}, {}, {}, {}, {}});
        const std::string &name = curve.policy->name;
        std::vector<Experiments> *list = curve.policy->is_rule   ? &rows.back().rules
                                         : name == "random"      ? &rows.back().random
                                         : name == "paper"       ? &rows.back().paper
                                         : name == "learn"       ? &rows.back().learn
                                         : name == "clairvoyant" ? &rows.back().clairvoyant
                                                                 : nullptr;
        if (list != nullptr)
            list->push_back(results[c]);
    }
    return rows;
}

std::string padded(const std::string &text, size_t width)
{
    return text + std::string(width > text.size() ? width - text.size() : 1, ' ');
}

} // namespace

std::string is_below(const std::vector<Experiments> &lower, const std::vector<Experiments> &upper,
                     int first, int last)
{
    bool all = true;
    for (const Experiments &a : lower)
        for (const Experiments &b : upper) {
            std::vector<double> differences;
            for (size_t e = 0; e < a.size(); e++)
                differences.push_back(pushes({a[e]}, first, last).mean -
                                      pushes({b[e]}, first, last).mean);
            Mean difference = mean_of(differences);
            if (difference.low() > 0.0)
                return "NO";
            all = all && difference.high() < 0.0;
        }
    return all ? "yes" : "unclear";
}

std::string claims_table(const Plan &plan, const std::vector<Experiments> &results)
{
    const char *const heads[] = {"random",
                                 "rules",
                                 "paper",
                                 "learn",
                                 "clairvoyant",
                                 "learn capped",
                                 "learn < every rule",
                                 "every rule < random"};
    constexpr size_t width = 15;
    std::vector<Row> rows;
    size_t name_width = 6;
    size_t orders = 0;
    for (const Policy &policy : policies())
        orders += policy.is_rule ? 1 : 0;
    for (const Row &row : rows_of(plan, results))
        if (!row.random.empty() && row.rules.size() == orders && !row.learn.empty()) {
            rows.push_back(row);
            name_width = std::max(name_width, row.object.size());
        }
    if (rows.empty())
        return {};
    std::string text = "Is learn < every rule < random? (pushes in the last ten trials)\n  " +
                       padded("object", name_width + 2);
    for (const char *head : heads)
        text += padded(head, head == heads[6] ? 20 : width);
    for (const Row &row : rows) {
        int first = std::max(1, row.trials - judged_trials + 1);
        char share[20];
        (void)std::snprintf(share, sizeof share, "%.1f%%",
                            100.0 * capped(row.learn[0], 1, row.trials));
        text += "\n  " + padded(row.object, name_width + 2);
        for (const auto *curves :
             {&row.random, &row.rules, &row.paper, &row.learn, &row.clairvoyant})
            text += padded(means_text(*curves, first, row.trials), width);
        text += padded(share, width) +
                padded(is_below(row.learn, row.rules, first, row.trials), 20) +
                is_below(row.rules, row.random, first, row.trials);
    }
    return text + "\n";
}

} // namespace grrl_experiment
