/* gnuplot.hpp: draws pictures with gnuplot if it is installed. */
#ifndef GRRL_EXPERIMENT_GNUPLOT_HPP
#define GRRL_EXPERIMENT_GNUPLOT_HPP

#include <string>

namespace grrl_experiment
{

/* Quotes a text as a gnuplot string, on one line. */
std::string gnuplot_quoted(const std::string &text);

/* Runs a script in a folder, without output. False if gnuplot is missing or fails. */
bool run_gnuplot(const std::string &folder, const std::string &script);

} // namespace grrl_experiment

#endif
