/* gnuplot.hpp: pictures, drawn by the program gnuplot where it is there. */
#ifndef GRRL_EXPERIMENT_GNUPLOT_HPP
#define GRRL_EXPERIMENT_GNUPLOT_HPP

#include <string>

namespace grrl_experiment
{

/* As a string of gnuplot's, on one line. */
std::string gnuplot_quoted(const std::string &text);

/* Runs a script in a folder, in silence. False: gnuplot is not there, or fails. */
bool run_gnuplot(const std::string &folder, const std::string &script);

} // namespace grrl_experiment

#endif
