/* policies.hpp: everything that may choose pushes, in two tables. */
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
    bool needs_truth = false;     /* only where the simulator is in the same process */
    /* Changes the defaults; config: of the policy's type. Empty: nothing. */
    std::function<void(grrl_learner_config &learner, void *config)> configure = {};
    /* Whom chooser_policy asks; nullptr for a policy of the library. node: nullptr, or the
     * simulator in this process. */
    std::unique_ptr<Chooser> (*make_chooser)(const grrl_sim::Node *node, uint64_t seed) = nullptr;

    /* Otherwise it keeps nothing, and pretraining changes nothing. */
    bool learns() const { return type->entries != nullptr; }
};

/* Those of the library, and those that live here. */
const std::vector<Policy> &policies();

/* The learners with one thing taken away or made smaller, those of paper first. */
const std::vector<Policy> &ablations();

/* Of both tables; nullptr: there is none of this name. */
const Policy *find_policy(const std::string &name);

} // namespace grrl_experiment

#endif
