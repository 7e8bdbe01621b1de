/* report.hpp: writes all results to one self-contained HTML file. */
#ifndef GRRL_EXPERIMENT_REPORT_HPP
#define GRRL_EXPERIMENT_REPORT_HPP

#include "folder.hpp"

namespace grrl_experiment
{

/* Includes the pictures in the folder, if there are any. */
std::string report_html(const Options &options, const Folder &folder, const Plan &plan,
                        const std::vector<Experiments> &results);

} // namespace grrl_experiment

#endif
