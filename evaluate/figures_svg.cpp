#include "figures.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace grrl_evaluate
{

namespace
{

std::string tick(const std::string &object, double noise)
{
    char text[64];
    (void)std::snprintf(text, sizeof text, "%.18s x%g", object.c_str(), noise);
    for (char &c : text)
        c = c == '"' || c == '\\' ? '\'' : c;
    return text;
}

/* A row a group: place, label, then for each panel ours and the baseline's. */
void write_data(std::FILE *gnuplot, const std::vector<Group> &groups)
{
    (void)std::fprintf(gnuplot, "$data << END\n");
    for (size_t i = 0; i < groups.size(); i++) {
        Figures f[METHODS];
        for (int m = OURS; m < METHODS; m++)
            f[m] = figures(sum(groups[i], static_cast<Method>(m)), groups[i].trials.size());
        Pushes p = pushes(groups[i]);
        auto shown = [](double x) { return std::max(x, 0.0); };
        (void)std::fprintf(gnuplot, "%zu \"%s\" %g %g %g %g %g %g %g %g\n", i,
                           tick(groups[i].object, groups[i].noise).c_str(), shown(f[OURS].wrong),
                           shown(f[BASELINE].wrong), shown(f[OURS].misplaced),
                           shown(f[BASELINE].misplaced), shown(f[OURS].exact_when_moved),
                           shown(f[BASELINE].exact_when_moved), p.mean, p.half_width);
    }
    (void)std::fprintf(gnuplot, "END\n");
}

void write_script(std::FILE *gnuplot, const std::string &path, size_t n)
{
    std::string quoted;
    for (char c : path)
        quoted += c == '\'' ? std::string("''") : std::string(1, c);
    (void)std::fprintf(gnuplot,
                       "set terminal svg size %zu,1150 background '#ffffff' font 'sans-serif,13'\n"
                       "set output '%s'\n"
                       "set multiplot layout 4,1 margins 0.08,0.98,0.13,0.96 spacing 0.0,0.045\n"
                       "set style data boxes\nset style fill solid 0.9 noborder\n"
                       "set boxwidth 0.38\nset grid ytics lc rgb '#dddddd'\nset border 3\n"
                       "set xrange [-0.6:%zu-0.4]\nset yrange [0:*]\nunset xtics\n"
                       "set ytics nomirror\nset key at graph 1,1.13 right horizontal\n",
                       std::max<size_t>(900, 60 + 36 * n), quoted.c_str(), n);
    const char *const titles[] = {"states with a wrong joint or a false split, %",
                                  "features in a wrong body, %",
                                  "trials exact when every joint has moved enough, %"};
    for (int i = 0; i < 3; i++) {
        (void)std::fprintf(gnuplot,
                           "set title '%s'\nplot $data using ($1-0.2):%d lc rgb '#0072b2' title "
                           "'grrl', '' using ($1+0.2):%d lc rgb '#bbbbbb' title 'baseline'\n",
                           titles[i], 3 + 2 * i, 4 + 2 * i);
    }
    (void)std::fprintf(
        gnuplot,
        "set title 'random pushes until the structure is found, with the 95%% "
        "interval of the mean'\n"
        "set xtics rotate by -45 nomirror\nset boxwidth 0.6\nunset key\nset pointintervalbox 0\n"
        "plot $data using 1:9:xtic(2) lc rgb '#0072b2', '' using 1:9:10 with "
        "yerrorbars lc rgb '#222222' pt -1\nunset multiplot\n");
}

} // namespace

std::string draw_svg(const std::string &path, const std::vector<Group> &groups)
{
    std::FILE *gnuplot = popen("gnuplot", "w");
    if (gnuplot == nullptr)
        return std::string("gnuplot: ") + std::strerror(errno);
    write_data(gnuplot, groups);
    write_script(gnuplot, path, groups.size());
    int status = pclose(gnuplot);
    if (status != 0)
        return path + ": gnuplot failed; is it installed, and can the file be written?";
    return {};
}

} // namespace grrl_evaluate
