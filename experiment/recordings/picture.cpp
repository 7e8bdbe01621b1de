/* picture.cpp: draws the figures as bars, and the calibration, with gnuplot. */
#include <algorithm>
#include <sstream>

#include "figures.hpp"
#include "gnuplot.hpp"

namespace grrl_experiment::recordings
{

namespace
{

const char *const colours[METHODS] = {"#0072b2", "#bbbbbb", "#e69f00"};

/* One row per condition: position, label, then for each panel the percentages of the methods. */
std::string data_of(const std::vector<Result> &results)
{
    std::ostringstream data;
    data << "$data << END\n";
    std::vector<std::string> names = conditions_of(results);
    for (size_t i = 0; i < names.size(); i++) {
        Figures f[METHODS];
        data << i << " \"" << names[i] << "\"";
        for (int m = 0; m < METHODS; m++)
            f[m] = figures(results, static_cast<Method>(m), names[i], "");
        for (Share Figures::*share : {&Figures::right, &Figures::bodies,
                                      &Figures::independent_called, &Figures::independent_sure})
            for (const Figures &of : f)
                data << " " << std::max((of.*share).percent(), 0.0);
        data << "\n";
    }
    data << "END\n$calibration << END\n";
    for (int bin = 0; bin < BINS; bin++) {
        data << bin << " \"" << bins[bin].low << " to " << std::min(bins[bin].high, 1.0) << "\"";
        for (int m = 0; m < METHODS; m++)
            data << " "
                 << std::max(
                        figures(results, static_cast<Method>(m), "", "").calibration[bin].percent(),
                        0.0);
        data << "\n";
    }
    data << "END\n";
    return data.str();
}

void bars(std::ostringstream &script, const char *title, const char *data, int column, size_t n)
{
    script << "set title '" << title << "'\nset xrange [-0.6:" << n << "-0.4]\nplot ";
    for (int m = 0; m < METHODS; m++)
        script << (m > 0 ? ", " : "") << data << " using ($1+" << 0.26 * (m - 1)
               << "):" << column + m << (m == METHODS / 2 ? ":xtic(2)" : "") << " lc rgb '"
               << colours[m] << "' title '" << method_names[m] << "'";
    script << "\n";
}

} // namespace

bool draw_svg(const std::string &path, const std::vector<Result> &results)
{
    size_t n = conditions_of(results).size();
    std::ostringstream script;
    script << data_of(results) << "set terminal svg size " << std::max<size_t>(900, 60 + 44 * n)
           << ",1500 background '#ffffff' font 'sans-serif,13'\nset output " << gnuplot_quoted(path)
           << "\nset multiplot layout 5,1 margins 0.08,0.92,0.05,0.96 spacing 0.0,0.09\n"
              "set style data boxes\nset style fill solid 0.9 noborder\nset boxwidth 0.24\n"
              "set grid ytics lc rgb '#dddddd'\nset border 3\nset yrange [0:100]\n"
              "set xtics rotate by -30 nomirror\nset ytics nomirror\n"
              "set key at graph 1,1.25 right horizontal\n";
    bars(script, "one mechanism: right structure, % of recordings", "$data", 3, n);
    script << "unset key\n";
    bars(script, "all: bodies right, %", "$data", 3 + METHODS, n);
    bars(script, "independent bodies: some joint at .5 and above, %", "$data", 3 + 2 * METHODS, n);
    bars(script, "independent bodies: some joint at .95 and above, %", "$data", 3 + 3 * METHODS, n);
    script << "set xtics norotate\n";
    bars(script, "joints that are right by their probability, %", "$calibration", 3, BINS);
    script << "unset multiplot\n";
    return run_gnuplot(".", script.str());
}

} // namespace grrl_experiment::recordings
