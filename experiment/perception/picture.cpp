/* picture.cpp: draws the figures as bars with gnuplot. */
#include "figures.hpp"

#include <algorithm>
#include <sstream>

#include "gnuplot.hpp"

namespace grrl_experiment::perception
{

namespace
{

std::string tick(const Group &group)
{
    std::ostringstream text;
    text << group.object.substr(0, 18) << " x" << group.noise;
    std::string label = text.str();
    for (char &c : label)
        c = c == '"' || c == '\\' ? '\'' : c;
    return label;
}

/* One row per group: position, label, then for each panel ours and the baseline's. */
std::string data_of(const std::vector<Group> &groups)
{
    std::ostringstream data;
    data << "$data << END\n";
    for (size_t i = 0; i < groups.size(); i++) {
        Figures f[METHODS];
        for (int m = OURS; m < METHODS; m++)
            f[m] = figures(sum(groups[i], static_cast<Method>(m)), groups[i].trials.size());
        Mean count = pushes(groups[i]).count;
        data << i << " \"" << tick(groups[i]) << "\"";
        for (double x :
             {f[OURS].wrong, f[BASELINE].wrong, f[OURS].misplaced, f[BASELINE].misplaced,
              f[OURS].exact_when_moved, f[BASELINE].exact_when_moved, count.mean, count.half})
            data << " " << std::max(x, 0.0);
        data << "\n";
    }
    data << "END\n";
    return data.str();
}

std::string script_of(const std::string &path, size_t n)
{
    std::ostringstream script;
    script << "set terminal svg size " << std::max<size_t>(900, 60 + 36 * n)
           << ",1150 background '#ffffff' font 'sans-serif,13'\n"
              "set output "
           << gnuplot_quoted(path)
           << "\n"
              "set multiplot layout 4,1 margins 0.08,0.98,0.13,0.96 spacing 0.0,0.045\n"
              "set style data boxes\nset style fill solid 0.9 noborder\n"
              "set boxwidth 0.38\nset grid ytics lc rgb '#dddddd'\nset border 3\n"
              "set xrange [-0.6:"
           << n
           << "-0.4]\nset yrange [0:*]\nunset xtics\n"
              "set ytics nomirror\nset key at graph 1,1.13 right horizontal\n";
    const char *const titles[] = {"states with a wrong joint or a false split, %",
                                  "features in a wrong body, %",
                                  "trials exact when every joint has moved enough, %"};
    for (int i = 0; i < 3; i++)
        script << "set title '" << titles[i] << "'\nplot $data using ($1-0.2):" << 3 + 2 * i
               << " lc rgb '#0072b2' title 'grrl', '' using ($1+0.2):" << 4 + 2 * i
               << " lc rgb '#bbbbbb' title 'baseline'\n";
    script << "set title 'random pushes until the structure is found, with the 95% interval of the "
              "mean'\n"
              "set xtics rotate by -45 nomirror\nset boxwidth 0.6\nunset key\n"
              "set pointintervalbox 0\n"
              "plot $data using 1:9:xtic(2) lc rgb '#0072b2', '' using 1:9:10 with "
              "yerrorbars lc rgb '#222222' pt -1\nunset multiplot\n";
    return script.str();
}

} // namespace

bool draw_svg(const std::string &path, const std::vector<Group> &groups)
{
    return run_gnuplot(".", data_of(groups) + script_of(path, groups.size()));
}

} // namespace grrl_experiment::perception
