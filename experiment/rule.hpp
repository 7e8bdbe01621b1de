/*
 * rule.hpp: a fixed rule that learns nothing.
 *
 * Push the longest believed body: along its axis, then across, then at 45 degrees; never the same
 * push twice while the believed structure stays the same; then the next longest.
 */
#ifndef GRRL_EXPERIMENT_RULE_HPP
#define GRRL_EXPERIMENT_RULE_HPP

#include <memory>

#include "chooser.hpp"

namespace grrl_experiment
{

std::unique_ptr<Chooser> make_rule();

} // namespace grrl_experiment

#endif
