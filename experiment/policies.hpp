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
    std::string text;  /* for --help and the report */
    bool learns;       /* otherwise its experience is nothing, and pretraining changes nothing */
    bool needs_truth;  /* only where the simulator is in the same process */
    const char *color; /* in pictures, #rrggbb */
    uint16_t capacity; /* cases, experiences and states */
    std::function<void(grrl_learner_config &config)> configure;
    /* nullptr: the library chooses. node: nullptr, or the simulator in this process. */
    std::unique_ptr<Chooser> (*make_chooser)(const grrl_sim::Node *node, uint64_t seed);
};

const std::vector<Policy> &policies();

/* The learners with one thing taken away or made smaller, those of paper first. */
const std::vector<Policy> &ablations();

/* Of both tables; nullptr: there is none of this name. */
const Policy *find_policy(const std::string &name);

} // namespace grrl_experiment

#endif
