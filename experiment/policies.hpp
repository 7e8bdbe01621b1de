/* policies.hpp: everything that may choose pushes, in one table. */
#ifndef GRRL_EXPERIMENT_POLICIES_HPP
#define GRRL_EXPERIMENT_POLICIES_HPP

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "agent_c.hpp"
#include "chooser.hpp"
#include "node.hpp"

namespace grrl_experiment
{

struct Policy {
    const char *name;
    const char *text;  /* for --help and the report */
    bool learns;       /* otherwise its experience is nothing, and pretraining changes nothing */
    bool needs_truth;  /* only where the simulator is in the same process */
    const char *color; /* in pictures, #rrggbb */
    uint16_t capacity; /* experiences and states */
    void (*configure)(grrl_learner_config &config);
    /* nullptr: the library chooses. node: nullptr, or the simulator in this process. */
    std::unique_ptr<Chooser> (*make_chooser)(const grrl_sim::Node *node, uint64_t seed);
};

const std::vector<Policy> &policies();

/* nullptr: there is none of this name. */
const Policy *find_policy(const std::string &name);

} // namespace grrl_experiment

#endif
