/*
 * rule.hpp: a fixed rule that learns nothing.
 *
 * It pushes the longest estimated body along its axis, then perpendicular to it, then at 45
 * degrees; then the next longest. It repeats no push while the estimated structure stays the same.
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
