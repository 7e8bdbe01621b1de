/*
 * statistics.hpp: means over experiments and their intervals.
 *
 * Each experiment contributes one number, its mean over the trials in question, because the trials
 * of one experiment are not independent. The interval is +- t(0.975, n - 1) s / sqrt(n).
 */
#ifndef GRRL_EXPERIMENT_STATISTICS_HPP
#define GRRL_EXPERIMENT_STATISTICS_HPP

#include <string>
#include <vector>

#include "sides.hpp"

namespace grrl_experiment
{

/* The trials of one experiment, in order; and of all experiments of a curve. */
using Trials = std::vector<TrialRow>;
using Experiments = std::vector<Trials>;

struct Mean {
    int n = 0;
    double mean = 0.0;
    double half = -1.0; /* half-width of the interval; negative: undefined for one experiment */
    double low() const { return half < 0.0 ? mean : mean - half; }
    double high() const { return half < 0.0 ? mean : mean + half; }
};

Mean mean_of(const std::vector<double> &values);

/* Pushes over the trials first .. last, counted from 1. */
Mean pushes(const Experiments &experiments, int first, int last);

/* The share of trials first .. last that ended at the cap. */
double capped(const Experiments &experiments, int first, int last);

/* The two-sided 95% quantile of Student's t. */
double t_quantile(int degrees);

/* The ranges of trials that tables show: first five, 6-10, 11-20, 21-40, last ten, all; and
 * 41-100, 101-200, .. of as many trials. */
struct Range {
    int first;
    int last;
    std::string label;
};
std::vector<Range> ranges(int trials);

} // namespace grrl_experiment

#endif
