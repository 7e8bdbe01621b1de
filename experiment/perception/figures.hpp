/* figures.hpp: the results of many trials, as a table, as CSV and as a chart. */
#ifndef GRRL_EXPERIMENT_PERCEPTION_FIGURES_HPP
#define GRRL_EXPERIMENT_PERCEPTION_FIGURES_HPP

#include <cstdio>
#include <string>
#include <vector>

#include "statistics.hpp"
#include "trial.hpp"

namespace grrl_experiment::perception
{

/* The trials of one object at one noise level, or of all objects together. */
struct Group {
    std::string object;
    double noise = 1.0;
    std::vector<TrialResult> trials;
};

/* In percent; below 0: no data. */
struct Figures {
    double wrong_joint;
    double false_split;
    double wrong;
    double missed;
    double misplaced;
    double calibration;
    double exact_in_six;
    double exact_when_moved;
    double ended_exact;
};

struct Pushes {
    Mean count;    /* over the trials */
    double at_cap; /* percent */
    double update_ms;
};

Tally sum(const Group &group, Method method);
Figures figures(const Tally &tally, size_t trials);
Pushes pushes(const Group &group);

void print_table(std::FILE *file, const std::vector<Group> &groups);
void print_csv(std::FILE *file, const std::vector<Group> &groups);

/* false: gnuplot is missing or fails. */
bool draw_svg(const std::string &path, const std::vector<Group> &groups);

} // namespace grrl_experiment::perception

#endif
