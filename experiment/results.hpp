/* results.hpp: trials.csv, summary.csv and the table on the terminal. */
#ifndef GRRL_EXPERIMENT_RESULTS_HPP
#define GRRL_EXPERIMENT_RESULTS_HPP

#include <string>
#include <vector>

#include "plan.hpp"
#include "statistics.hpp"

namespace grrl_experiment
{

/* The seed of experiment 1, 2, .., for the world and the policy; pretraining uses another one. */
uint64_t experiment_seed(uint64_t seed, int experiment);
uint64_t pretrain_seed(uint64_t experiment_seed);

/* results[i] belongs to curve i of the plan. */
std::string trials_csv(const Plan &plan, const std::vector<Experiments> &results, uint64_t seed);
std::string summary_csv(const Plan &plan, const std::vector<Experiments> &results);

/* "paper", "paper after RRRRR:50"; optionally preceded by the object. */
std::string curve_label(const Curve &curve, bool with_object);

/* "7.2 +- 0.4" */
std::string mean_text(const Mean &mean, const char *plus_minus);

/* A row for each curve of a figure. */
std::string text_table(const Plan &plan, const Figure &figure,
                       const std::vector<Experiments> &results);

} // namespace grrl_experiment

#endif
