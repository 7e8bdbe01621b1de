/*
 * claims.hpp: whether learn < every rule < random holds, for each object and world of a plan.
 *
 * Judged by the paired differences over the last ten trials: "yes" if all of them are below zero by
 * more than their 95% intervals, "NO" if one is above zero by more than its interval, else
 * "unclear".
 */
#ifndef GRRL_EXPERIMENT_CLAIMS_HPP
#define GRRL_EXPERIMENT_CLAIMS_HPP

#include <string>
#include <vector>

#include "plan.hpp"
#include "statistics.hpp"

namespace grrl_experiment
{

/* A line for each object and world that has learn, all rules and random; empty if none has. */
std::string claims_table(const Plan &plan, const std::vector<Experiments> &results);

/* "yes", "NO" or "unclear": whether each is below all of the others. */
std::string is_below(const std::vector<Experiments> &lower, const std::vector<Experiments> &upper,
                     int first, int last);

} // namespace grrl_experiment

#endif
