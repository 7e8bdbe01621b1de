/* results.cpp: writes trials and means as CSV and as text. */
#include "results.hpp"

#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>

#include "files.hpp"
#include "matrix.hpp"
#include "object_stream.hpp"

namespace grrl_experiment
{

namespace
{

std::string curve_fields(const Curve &curve)
{
    return csv_field(curve.object()) + "," + curve.policy->name + "," +
           csv_field(curve.pretrain_text());
}

std::string number(double value)
{
    char text[40];
    (void)std::snprintf(text, sizeof text, "%.3f", value);
    return text;
}

std::string summary_row(const Curve &curve, const Experiments &experiments, const Range &range)
{
    Mean mean = pushes(experiments, range.first, range.last);
    bool interval = mean.half >= 0.0;
    return curve_fields(curve) + "," + range.label + "," + std::to_string(range.first) + "," +
           std::to_string(range.last) + "," + std::to_string(mean.n) + "," + number(mean.mean) +
           "," + (interval ? number(mean.low()) : "") + "," +
           (interval ? number(mean.high()) : "") + "," +
           number(capped(experiments, range.first, range.last)) + "\n";
}

} // namespace

uint64_t pretrain_seed(uint64_t experiment_seed)
{
    return experiment_seed + UINT64_C(1000000000000000);
}

std::string trials_csv(const Plan &plan, const std::vector<Experiments> &results,
                       const std::vector<uint64_t> &seeds)
{
    std::ostringstream text;
    text << "object,policy,pretrain,experiment,seed,trial,pushes,outcome,wrong_joints\n";
    for (size_t c = 0; c < plan.curves.size(); c++) {
        for (size_t e = 0; e < results[c].size(); e++) {
            std::string fields = curve_fields(plan.curves[c]) + "," + std::to_string(e + 1) + "," +
                                 std::to_string(seeds[e]) + ",";
            for (const TrialRow &row : results[c][e])
                text << fields << row.trial << "," << row.pushes << ","
                     << (row.discovered ? "discovered" : "capped") << "," << row.wrong_joints
                     << "\n";
        }
    }
    return text.str();
}

std::string objects_csv(const Plan &plan, const std::vector<uint64_t> &seeds)
{
    std::ostringstream text;
    std::set<std::string> done;
    for (const Curve &curve : plan.curves) {
        if (!curve.course.stream || !done.insert(curve.object()).second)
            continue;
        for (uint64_t seed : seeds)
            for (int trial = 1; trial <= curve.trials(); trial++) {
                grrl_sim::ObjectSpec object = curve.course.objects(seed, trial);
                text << csv_field(curve.object()) << "," << seed << "," << trial << ","
                     << object.links.size() << "," << object.joints.size() << ","
                     << csv_field(grrl_sim::term_of(object)) << "\n";
            }
    }
    return done.empty() ? "" : "stream,seed,trial,links,joints,object\n" + text.str();
}

Experiments shown(const Figure &figure, const std::vector<Experiments> &results, size_t curve)
{
    Experiments experiments = results[curve];
    if (!figure.bound)
        return experiments;
    const Experiments &bound = results[*figure.bound];
    for (size_t e = 0; e < experiments.size(); e++)
        for (size_t t = 0; t < experiments[e].size(); t++)
            experiments[e][t].pushes -= bound[e][t].pushes;
    return experiments;
}

std::string summary_csv(const Plan &plan, const std::vector<Experiments> &results)
{
    std::string text =
        "object,policy,pretrain,trials,first,last,experiments,mean,low,high,capped\n";
    for (size_t c = 0; c < plan.curves.size(); c++) {
        const Curve &curve = plan.curves[c];
        for (const Range &range : ranges(curve.trials()))
            text += summary_row(curve, results[c], range);
        for (int trial = 1; trial <= curve.trials(); trial++)
            text += summary_row(curve, results[c], {trial, trial, std::to_string(trial)});
    }
    return text;
}

std::string curve_label(const Curve &curve, bool with_object)
{
    std::string label = with_object ? curve.object() + " " : "";
    label += curve.policy->name;
    if (!curve.starts_empty())
        label += " after " + curve.pretrain_text();
    return label;
}

std::string mean_text(const Mean &mean, const char *plus_minus)
{
    char text[60];
    if (mean.half < 0.0)
        (void)std::snprintf(text, sizeof text, "%.1f", mean.mean);
    else
        (void)std::snprintf(text, sizeof text, "%.1f %s %.1f", mean.mean, plus_minus, mean.half);
    return text;
}

std::string means_text(const std::vector<Experiments> &curves, int first, int last)
{
    if (curves.empty())
        return "-";
    std::vector<double> means;
    for (const Experiments &curve : curves)
        means.push_back(pushes(curve, first, last).mean);
    auto ends = std::minmax_element(means.begin(), means.end());
    char text[60];
    if (curves.size() == 1)
        return mean_text(pushes(curves[0], first, last), "+-");
    (void)std::snprintf(text, sizeof text, "%.1f to %.1f", *ends.first, *ends.second);
    return text;
}

std::vector<Experiments> every_rule(const Plan &plan, const Figure &figure,
                                    const std::vector<Experiments> &results)
{
    std::vector<Experiments> rules;
    size_t orders = 0;
    for (const Policy &policy : policies())
        orders += policy.is_rule ? 1 : 0;
    for (size_t c : figure.curves)
        if (plan.curves[c].policy->is_rule)
            rules.push_back(shown(figure, results, c));
    return rules.size() == orders ? rules : std::vector<Experiments>{};
}

std::string text_table(const Plan &plan, const Figure &figure,
                       const std::vector<Experiments> &results)
{
    if (figure.kind == Figure::Kind::MATRIX)
        return matrix_table(plan, figure, results);
    std::ostringstream text;
    text << figure.title << "\n";
    size_t width = 10;
    for (size_t c : figure.curves)
        width = std::max(width, curve_label(plan.curves[c], false).size());
    std::vector<Range> columns = ranges(plan.curves[figure.curves[0]].trials());
    auto cell = [&text](const std::string &s, size_t size) {
        text << s << std::string(size > s.size() ? size - s.size() : 0, ' ');
    };
    text << "  ";
    cell("trials", width + 2);
    for (const Range &column : columns)
        cell(column.label, 14);
    text << "capped  wrong joints\n";
    for (size_t c : figure.curves) {
        Experiments rows = shown(figure, results, c);
        text << "  ";
        cell(curve_label(plan.curves[c], false), width + 2);
        for (const Range &column : columns)
            cell(mean_text(pushes(rows, column.first, column.last), "+-"), 14);
        double wrong = 0.0;
        double trials = 0.0;
        for (const Trials &experiment : rows)
            for (const TrialRow &row : experiment) {
                wrong += row.wrong_joints;
                trials += 1.0;
            }
        char rest[40];
        (void)std::snprintf(rest, sizeof rest, "%5.1f%%  %.2f",
                            100.0 * capped(rows, 1, plan.curves[c].trials()),
                            wrong / std::max(trials, 1.0));
        text << rest << "\n";
    }
    std::vector<Experiments> rules = every_rule(plan, figure, results);
    if (!rules.empty()) {
        text << "  ";
        cell("every rule", width + 2);
        for (const Range &column : columns)
            cell(means_text(rules, column.first, column.last), 14);
        text << "\n";
    }
    return text.str();
}

} // namespace grrl_experiment
