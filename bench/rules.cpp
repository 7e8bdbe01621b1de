/*
 * rules.cpp: grrl-bench-rules, which grrl-bench rules runs: how many choices of a learner the rules
 * of its store explain.
 *
 * Robots start with the store that comes with grrl. A choice is explained if its push falls under
 * the rule with the highest mean reward of all rules that a push of any link falls under in that
 * state. Chance is the share of pushes under that rule.
 */
#include <algorithm>
#include <cassert>
#include <climits>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "files.hpp"
#include "grrl/learner/cases/learn_policy.h"
#include "grrl/policies.h"
#include "object.hpp"
#include "object_stream.hpp"
#include "rules.h"
#include "shipped_store.h"
#include "transport.hpp"

using grrl_experiment::Bytes;

namespace
{

constexpr uint64_t first_seed = 8000;
constexpr int random_objects = 300;
constexpr int robots = 10; /* for each named object */
constexpr int trials = 5;

const char *const named[] = {"PPRRP",
                             "PRPRRP",
                             "RRPPRR",
                             "R(l1, P(l2, l3), P(l4, l5), R(l6, l7))",
                             "R(l1, l2, l3, l4)",
                             "R(l1, R(l4, R(l3, P(l2, l1))))",
                             "RPRPRPR",
                             "PRRRRP",
                             "RRRRR",
                             "PRPRP",
                             "D(R(l1, l2), P(l3, l4))"};

std::vector<grrl_rule> rules; /* the best first */

struct Count {
    int choices = 0;
    int explained = 0;
    double chance = 0.0; /* summed over choices */
};
Count count;

/* Each context falls under one rule. */
size_t rule_of(uint32_t key)
{
    auto rule = std::find_if(rules.begin(), rules.end(),
                             [key](const grrl_rule &r) { return grrl_rule_holds(&r, key); });
    assert(rule != rules.end());
    return static_cast<size_t>(rule - rules.begin());
}

void count_choice(const grrl_contexts &contexts, const grrl_choice &choice)
{
    size_t best = rules.size();
    int pushes = 0;
    int under = 0; /* the best rule */
    for (int link = 0; link < contexts.n_links; link++)
        for (uint32_t key : contexts.action[link]) {
            size_t rule = rule_of(key);
            under = rule < best ? 0 : under;
            best = std::min(best, rule);
            under += rule == best ? 1 : 0;
            pushes++;
        }
    count.choices++;
    count.explained += rule_of(contexts.action[choice.link][choice.direction]) == best ? 1 : 0;
    count.chance += static_cast<double>(under) / pushes;
}

/* The first robot's cases, at its first choice, are those of the store. */
void choose(void *self, const grrl_view *view, grrl_random *random, grrl_choice *choice)
{
    grrl_learn_policy *policy = static_cast<grrl_learn_policy *>(self);
    if (rules.empty()) {
        rules.resize(GRRL_MAX_RULES);
        rules.resize(static_cast<size_t>(std::max(0, grrl_rules_of(&policy->cases, rules.data()))));
    }
    grrl_policy_learn.choose(self, view, random, choice);
    if (!rules.empty())
        count_choice(policy->contexts, *choice);
}

/* A robot's life; its choices are counted. */
void live(const grrl_experiment::Objects &objects, uint64_t seed, int n_trials, const Bytes &store)
{
    grrl_policy_type type = grrl_policy_learn;
    type.choose = choose;
    grrl_experiment::Policy policy = *grrl_experiment::find_policy("learn");
    policy.type = &type;
    grrl_experiment::Phase phase;
    phase.objects = objects;
    phase.policy = &policy;
    phase.trials = n_trials;
    phase.seed = seed;
    (void)grrl_experiment::run_over_memq(phase, store, [](const grrl_experiment::TrialRow &) {});
}

Count over_stream(const Bytes &store)
{
    auto stream = grrl_sim::stream_from_file(GRRL_BENCH_STREAM);
    if (!stream)
        throw std::runtime_error(stream.error);
    count = Count{};
    for (uint64_t seed = first_seed; seed < first_seed + random_objects; seed++)
        live([&](uint64_t s, int32_t) { return stream.value->sample(s); }, seed, 1, store);
    return count;
}

Count over_named(const Bytes &store)
{
    count = Count{};
    for (const char *text : named) {
        const grrl_sim::ObjectSpec object = *grrl_sim::object_from_text(text).value;
        for (uint64_t seed = first_seed; seed < first_seed + robots; seed++)
            live([&](uint64_t, int32_t) { return object; }, seed, trials, store);
    }
    return count;
}

void print(const char *objects, const Count &counted, bool json)
{
    double n = counted.choices;
    (void)std::printf(json ? "{\"objects\": \"%s\", \"choices\": %d, \"explained\": %.3f, "
                             "\"chance\": %.3f}"
                           : "| %s | %d | %.2f | %.2f |\n",
                      objects, counted.choices, counted.explained / n, counted.chance / n);
}

} // namespace

int main(int argc, char **)
{
    bool json = argc > 1;
    try {
        char path[PATH_MAX];
        grrl_shipped_store_path("mixed", sizeof path, path);
        const std::optional<std::string> text = grrl_experiment::read_file(path);
        if (!text)
            throw std::runtime_error(std::string(path) + " cannot be read");
        const Bytes store(text->begin(), text->end());
        const Count on_stream = over_stream(store);
        if (rules.empty())
            throw std::runtime_error(std::string(path) + " has no cases to make rules of");
        if (json)
            (void)std::printf("[{\"rules\": %zu}, ", rules.size());
        else
            (void)std::printf("%zu rules\n\n| objects | choices | explained | chance |\n"
                              "|---|---|---|---|\n",
                              rules.size());
        print("300 of mixed.stream", on_stream, json);
        if (json)
            (void)std::printf(", ");
        print("11 named ones", over_named(store), json);
        if (json)
            (void)std::puts("]");
    } catch (const std::exception &error) {
        (void)std::fprintf(stderr, "grrl-bench: %s\n", error.what());
        return 1;
    }
    return 0;
}
