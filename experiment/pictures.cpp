/* pictures.cpp: data and scripts for gnuplot. */
#include "pictures.hpp"

#include <algorithm>
#include <sstream>

#include "files.hpp"
#include "gnuplot.hpp"
#include "matrix.hpp"
#include "results.hpp"

namespace grrl_experiment
{

namespace
{

constexpr int max_points = 200; /* of a curve; with more there are lines only */

/* Lines and bands average this many trials on either side, fewer at the ends. */
int neighbours(int trials)
{
    return std::max(2, trials / 50);
}

/* A block for each curve: the trial, its mean, and mean, low and high over the trials around it. */
std::string data_of(const Plan &plan, const Figure &figure, const std::vector<Experiments> &results)
{
    std::ostringstream text;
    for (size_t c : figure.curves) {
        text << "# " << curve_label(plan.curves[c], true) << "\n";
        Experiments rows = shown(figure, results, c);
        int trials = plan.curves[c].trials();
        for (int trial = 1; trial <= trials; trial++) {
            int reach = std::min({neighbours(trials), trial - 1, trials - trial});
            Mean around = pushes(rows, trial - reach, trial + reach);
            text << trial << "\t" << pushes(rows, trial, trial).mean << "\t" << around.mean << "\t"
                 << around.low() << "\t" << around.high() << "\n";
        }
        text << "\n\n";
    }
    return text.str();
}

std::string plot_command(const Plan &plan, const Figure &figure, const std::string &data)
{
    std::vector<std::string> parts;
    auto index = [&data](size_t block) {
        return gnuplot_quoted(data) + " index " + std::to_string(block);
    };
    for (size_t i = 0; i < figure.curves.size(); i++) {
        std::string color = plan.curves[figure.curves[i]].policy->color;
        parts.push_back(index(i) + " using 1:4:5 with filledcurves lc rgb '" + color + "' notitle");
    }
    bool transfer = false;
    for (size_t c : figure.curves)
        transfer = transfer || !plan.curves[c].before.empty();
    for (size_t i = 0; i < figure.curves.size(); i++) {
        const Curve &curve = plan.curves[figure.curves[i]];
        std::string color = curve.policy->color;
        /* in a transfer, the curve without pretraining is dashed */
        bool dashed = transfer && curve.policy->learns() && curve.before.empty();
        if (curve.trials() <= max_points)
            parts.push_back(index(i) + " using 1:2 with points pt 7 ps 0.3 lc rgb '" + color +
                            "' notitle");
        parts.push_back(index(i) + " using 1:3 with lines lw 2.5 dt " + (dashed ? "2" : "1") +
                        " lc rgb '" + color + "' title " +
                        gnuplot_quoted(curve_label(curve, false)));
    }
    std::string command = "plot ";
    for (size_t i = 0; i < parts.size(); i++)
        command += (i > 0 ? ", \\\n     " : "") + parts[i];
    return command + "\n";
}

/* A line for each curve: its name, and mean, low and high over the first five and the last ten
 * trials. */
std::string rows_of(const Plan &plan, const Figure &figure, const std::vector<Experiments> &results)
{
    std::ostringstream text;
    for (size_t c : figure.curves) {
        int trials = plan.curves[c].trials();
        text << curve_label(plan.curves[c], false);
        for (Mean of : {pushes(results[c], 1, std::min(5, trials)),
                        pushes(results[c], std::max(1, trials - 9), trials)})
            text << "\t" << of.mean << "\t" << of.low() << "\t" << of.high();
        text << "\n";
    }
    return text.str();
}

std::string rows_script(const Figure &figure)
{
    std::string height = std::to_string(150 + 18 * figure.curves.size());
    std::string data = gnuplot_quoted(figure.name + ".tsv");
    auto series = [&data](const char *columns, const char *point, const char *color,
                          const char *title) {
        return data + " using " + columns + " with xerrorbars pt " + point + " ps 0.7 lc rgb '" +
               color + "' title '" + title + "'";
    };
    return "# Means over experiments with 95% intervals.\n"
           "set terminal svg size 900," +
           height +
           " font 'Helvetica,Arial,sans-serif,13' background '#ffffff'\n"
           "set output " +
           gnuplot_quoted(figure.name + ".svg") +
           "\nset datafile separator '\\t'\n"
           "set border 3 lc rgb '#555555'\n"
           "set tics nomirror out tc rgb '#333333'\n"
           "set ytics noenhanced\n"
           "set grid x y lc rgb '#e6e6e6' lt 1\n"
           "set title " +
           gnuplot_quoted(figure.title) +
           " noenhanced tc rgb '#222222'\n"
           "set xlabel 'pushes until the structure is known' tc rgb '#222222'\n"
           "set yrange [" +
           std::to_string(figure.curves.size()) +
           ":-1]\n"
           "set xrange [0:*]\n"
           "set key outside center top horizontal tc rgb '#222222'\n"
           "plot " +
           series("2:0:3:4:ytic(1)", "6", "#8c8c8c", "first five trials") + ", \\\n     " +
           series("5:0:6:7", "7", "#1666a8", "last ten") + "\n" +
           "set terminal pngcairo size 1200," + height + " font 'Helvetica,13'\nset output " +
           gnuplot_quoted(figure.name + ".png") + "\nreplot\n";
}

std::string curves_script(const Plan &plan, const Figure &figure)
{
    const char *what =
        figure.bound ? "pushes above the clairvoyant" : "pushes until the structure is known";
    return "# Lines: means over neighbouring trials with 95% intervals; points: of one trial.\n"
           "set terminal svg size 900,540 font 'Helvetica,Arial,sans-serif,15' "
           "background '#ffffff'\n"
           "set output " +
           gnuplot_quoted(figure.name + ".svg") +
           "\n"
           "set border 3 lc rgb '#555555'\n"
           "set tics nomirror out tc rgb '#333333'\n"
           "set grid y lc rgb '#e6e6e6' lt 1\n"
           "set title " +
           gnuplot_quoted(figure.title) +
           " noenhanced tc rgb '#222222'\n"
           "set xlabel 'trial' tc rgb '#222222'\n"
           "set ylabel '" +
           what +
           "' tc rgb '#222222'\n"
           "set key outside bottom center horizontal reverse Left samplen 2 tc rgb '#222222' "
           "noenhanced\n"
           "set yrange [0:*]\n"
           "set style fill transparent solid 0.18 noborder\n" +
           plot_command(plan, figure, figure.name + ".tsv") +
           "set terminal pngcairo size 1200,720 font 'Helvetica,15'\n"
           "set output " +
           gnuplot_quoted(figure.name + ".png") + "\nreplot\n";
}

} // namespace

bool draw(const Folder &folder, const Plan &plan, const Figure &figure,
          const std::vector<Experiments> &results)
{
    std::string data;
    std::string script;
    switch (figure.kind) {
    case Figure::Kind::CURVES:
        data = data_of(plan, figure, results);
        script = curves_script(plan, figure);
        break;
    case Figure::Kind::ROWS:
        data = rows_of(plan, figure, results);
        script = rows_script(figure);
        break;
    case Figure::Kind::MATRIX:
        data = matrix_data(plan, figure, results);
        script = matrix_script(plan, figure);
        break;
    }
    write_file(folder.path(figure.name + ".tsv"), data);
    write_file(folder.path(figure.name + ".gp"), script);
    return run_gnuplot(folder.path(""), script);
}

} // namespace grrl_experiment
