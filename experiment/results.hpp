/* results.hpp: trials.csv, summary.csv and the table on the terminal. */
#ifndef GRRL_EXPERIMENT_RESULTS_HPP
#define GRRL_EXPERIMENT_RESULTS_HPP

#include <string>
#include <vector>

#include "plan.hpp"
#include "statistics.hpp"

namespace grrl_experiment
{

/* The seed of what comes before an experiment, or before what comes before it, and so on. */
uint64_t pretrain_seed(uint64_t experiment_seed);

/* results[i][e] belongs to curve i of the plan and to seeds[e]. */
std::string trials_csv(const Plan &plan, const std::vector<Experiments> &results,
                       const std::vector<uint64_t> &seeds);
std::string summary_csv(const Plan &plan, const std::vector<Experiments> &results);

/* The object of each trial of a stream; empty without a stream. */
std::string objects_csv(const Plan &plan, const std::vector<uint64_t> &seeds);

/* What a figure shows of a curve: its results, or by how much they are above the bound. */
Experiments shown(const Figure &figure, const std::vector<Experiments> &results, size_t curve);

/* "paper", "paper after RRRRR:50"; optionally preceded by the object. */
std::string curve_label(const Curve &curve, bool with_object);

/* "7.2 +- 0.4" */
std::string mean_text(const Mean &mean, const char *plus_minus);

/* "4.2 to 17.1": the lowest and the highest mean of these curves, or the mean of the only one. */
std::string means_text(const std::vector<Experiments> &curves, int first, int last);

/* The rules of a figure, if it has all of their orders; else none. */
std::vector<Experiments> every_rule(const Plan &plan, const Figure &figure,
                                    const std::vector<Experiments> &results);

/* A row for each curve of a figure. */
std::string text_table(const Plan &plan, const Figure &figure,
                       const std::vector<Experiments> &results);

} // namespace grrl_experiment

#endif
