/* pictures.hpp: learning curves with interval bands, by gnuplot. */
#ifndef GRRL_EXPERIMENT_PICTURES_HPP
#define GRRL_EXPERIMENT_PICTURES_HPP

#include "folder.hpp"

namespace grrl_experiment
{

/*
 * Writes NAME.tsv, NAME.gp, NAME.svg and NAME.png for a figure. False: gnuplot is not there or
 * fails; data and script then still are.
 */
bool draw(const Folder &folder, const Plan &plan, const Figure &figure,
          const std::vector<Experiments> &results);

} // namespace grrl_experiment

#endif
