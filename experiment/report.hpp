/* report.hpp: everything in one HTML file that needs no other. */
#ifndef GRRL_EXPERIMENT_REPORT_HPP
#define GRRL_EXPERIMENT_REPORT_HPP

#include "folder.hpp"

namespace grrl_experiment
{

/* Pictures are taken from the folder, if they are there. */
std::string report_html(const Options &options, const Folder &folder, const Plan &plan,
                        const std::vector<Experiments> &results);

} // namespace grrl_experiment

#endif
