/* policies.hpp: all policies that an experiment can run, in two tables. */
#ifndef GRRL_EXPERIMENT_POLICIES_HPP
#define GRRL_EXPERIMENT_POLICIES_HPP

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "chooser.hpp"
#include "grrl/learner/learner.h"
#include "node.hpp"

namespace grrl_experiment
{

struct Policy {
    std::string name;
    std::string text;             /* for --help and the report */
    const grrl_policy_type *type; /* the operations */
    const char *color;            /* in pictures, #rrggbb */
    uint16_t capacity;            /* cases or experiences */
    bool needs_truth = false;     /* requires the simulator in the same process */
    bool is_rule = false;         /* rule in one of its orders */
    /* Changes the defaults; config belongs to the policy's type. Empty: no change. */
    std::function<void(grrl_learner_config &learner, void *config)> configure = {};
    /* Makes the chooser for chooser_policy; nullptr for a policy of the library. node: the
     * simulator in this process, or nullptr. */
    std::function<std::unique_ptr<Chooser>(const grrl_sim::Node *node, uint64_t seed)>
        make_chooser = {};

    /* A policy that does not learn keeps nothing, and pretraining has no effect. */
    bool learns() const { return type->entries != nullptr; }
};

/* The library's policies and the experiment's own. */
const std::vector<Policy> &policies();

/* The learners with one part removed or made smaller, those of paper first. */
const std::vector<Policy> &ablations();

/* Searches both tables; nullptr if there is no such policy. */
const Policy *find_policy(const std::string &name);

} // namespace grrl_experiment

#endif
