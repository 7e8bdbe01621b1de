/*
 * matrix.hpp: what experience with one object does to the first trials on another, for all pairs.
 *
 * A cell is the paired difference in pushes over the first five trials, with the experience minus
 * without it; below zero it helps.
 */
#ifndef GRRL_EXPERIMENT_MATRIX_HPP
#define GRRL_EXPERIMENT_MATRIX_HPP

#include <string>
#include <vector>

#include "plan.hpp"
#include "statistics.hpp"

namespace grrl_experiment
{

/* A row for each object before, a column for each object then; * marks a difference beyond its 95%
 * interval. */
std::string matrix_table(const Plan &plan, const Figure &figure,
                         const std::vector<Experiments> &results);

/* The same as data for gnuplot and the script that draws them. */
std::string matrix_data(const Plan &plan, const Figure &figure,
                        const std::vector<Experiments> &results);
std::string matrix_script(const Plan &plan, const Figure &figure);

} // namespace grrl_experiment

#endif
