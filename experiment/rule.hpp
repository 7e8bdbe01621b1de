/*
 * rule.hpp: a fixed rule that learns nothing.
 *
 * It pushes the longest estimated body in one way after the other, then the next longest. The ways
 * are along its axis, perpendicular to it and slanted, at 45 degrees; their order matters, and no
 * order is the best for all objects. The rule repeats no push while the estimated structure stays
 * the same.
 */
#ifndef GRRL_EXPERIMENT_RULE_HPP
#define GRRL_EXPERIMENT_RULE_HPP

#include <memory>
#include <string>

#include "chooser.hpp"

namespace grrl_experiment
{

/* order: "aps" is along, perpendicular, slanted. */
std::unique_ptr<Chooser> make_rule(const std::string &order);

} // namespace grrl_experiment

#endif
