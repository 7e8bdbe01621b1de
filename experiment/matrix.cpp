/* matrix.cpp: the interference of experiences as a table and as a picture. */
#include "matrix.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "gnuplot.hpp"

namespace grrl_experiment
{

namespace
{

/* The objects in their order, which is that of the curves without pretraining. */
std::vector<std::string> objects_of(const Plan &plan, const Figure &figure)
{
    std::vector<std::string> objects;
    for (size_t c : figure.curves)
        if (plan.curves[c].before.empty())
            objects.push_back(plan.curves[c].course.text);
    return objects;
}

/* The curves of a figure are, for each object: without, then after each of the objects. */
Mean cell_of(const Figure &figure, const std::vector<Experiments> &results, size_t n, size_t before,
             size_t then)
{
    const Experiments &without = results[figure.curves[then * (n + 1)]];
    const Experiments &with = results[figure.curves[then * (n + 1) + 1 + before]];
    std::vector<double> differences;
    for (size_t e = 0; e < with.size(); e++) {
        int last = static_cast<int>(with[e].size());
        differences.push_back(pushes({with[e]}, 1, last).mean - pushes({without[e]}, 1, last).mean);
    }
    return mean_of(differences);
}

std::string cell_text(const Mean &mean)
{
    char text[40];
    bool sure = mean.low() > 0.0 || mean.high() < 0.0;
    (void)std::snprintf(text, sizeof text, "%.1f%s", mean.mean, sure ? "*" : "");
    return text;
}

} // namespace

std::string matrix_table(const Plan &plan, const Figure &figure,
                         const std::vector<Experiments> &results)
{
    std::vector<std::string> objects = objects_of(plan, figure);
    size_t n = objects.size();
    size_t width = 6;
    for (const std::string &object : objects)
        width = std::max(width, object.size() + 2);
    std::ostringstream text;
    auto padded = [&text](const std::string &word, size_t size) {
        text << word << std::string(size > word.size() ? size - word.size() : 1, ' ');
    };
    text << figure.title << "\n  ";
    padded("before", width);
    for (const std::string &object : objects)
        padded(object, std::max<size_t>(8, object.size() + 2));
    for (size_t i = 0; i < n; i++) {
        text << "\n  ";
        padded(objects[i], width);
        for (size_t j = 0; j < n; j++)
            padded(cell_text(cell_of(figure, results, n, i, j)),
                   std::max<size_t>(8, objects[j].size() + 2));
    }
    return text.str() + "\n";
}

std::string matrix_data(const Plan &plan, const Figure &figure,
                        const std::vector<Experiments> &results)
{
    size_t n = objects_of(plan, figure).size();
    std::ostringstream text;
    text << "# then, before (from 0), mean, low, high, text\n";
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            Mean mean = cell_of(figure, results, n, i, j);
            text << j << "\t" << i << "\t" << mean.mean << "\t" << mean.low() << "\t" << mean.high()
                 << "\t" << cell_text(mean) << "\n";
        }
    return text.str();
}

std::string matrix_script(const Plan &plan, const Figure &figure)
{
    std::vector<std::string> objects = objects_of(plan, figure);
    std::string tics;
    for (size_t i = 0; i < objects.size(); i++)
        tics += (i > 0 ? ", " : "") + gnuplot_quoted(objects[i]) + " " + std::to_string(i);
    std::string ends = std::to_string(objects.size()) + ".0 - 0.5";
    std::string data = gnuplot_quoted(figure.name + ".tsv");
    return "# Differences in pushes; * marks those beyond their 95% intervals.\n"
           "set terminal svg size 1000,860 font 'Helvetica,Arial,sans-serif,13' "
           "background '#ffffff'\n"
           "set output " +
           gnuplot_quoted(figure.name + ".svg") +
           "\nset datafile separator '\\t'\n"
           "set title " +
           gnuplot_quoted(figure.title) +
           " noenhanced tc rgb '#222222'\n"
           "set xlabel 'object then' tc rgb '#222222'\n"
           "set ylabel 'object before' tc rgb '#222222'\n"
           "set xtics rotate by 45 right noenhanced out nomirror (" +
           tics + ")\nset ytics noenhanced out nomirror (" + tics + ")\nset xrange [-0.5:" + ends +
           "]\nset yrange [" + ends +
           ":-0.5]\n"
           "set palette defined (-1 '#1666a8', 0 '#ffffff', 1 '#c8442a')\n"
           "set cbrange [-5:5]\n"
           "set cblabel 'pushes more in the first five trials' offset 1 tc rgb '#222222'\n"
           "set key off\n"
           "plot " +
           data + " using 1:2:3 with image pixels, " + data +
           " using 1:2:6 with labels noenhanced font ',11' tc rgb '#222222'\n"
           "set terminal pngcairo size 1200,1030 font 'Helvetica,13'\n"
           "set output " +
           gnuplot_quoted(figure.name + ".png") + "\nreplot\n";
}

} // namespace grrl_experiment
