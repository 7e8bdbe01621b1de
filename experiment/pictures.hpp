/* pictures.hpp: draws learning curves with interval bands, using gnuplot. */
#ifndef GRRL_EXPERIMENT_PICTURES_HPP
#define GRRL_EXPERIMENT_PICTURES_HPP

#include "folder.hpp"

namespace grrl_experiment
{

/*
 * Writes NAME.tsv, NAME.gp, NAME.svg and NAME.png for a figure. False if gnuplot is missing or
 * fails; data and script are written anyway.
 */
bool draw(const Folder &folder, const Plan &plan, const Figure &figure,
          const std::vector<Experiments> &results);

} // namespace grrl_experiment

#endif
