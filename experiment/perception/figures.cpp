/* figures.cpp: sums, percentages and their tables. */
#include "figures.hpp"

#include <algorithm>
#include <cstring>

#include "files.hpp"

namespace grrl_experiment::perception
{

namespace
{

const char *const method_names[] = {"ours", "baseline"};

double percent(int64_t part, int64_t whole)
{
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : -1.0;
}

std::string cell(double value, int digits)
{
    char text[32];
    (void)std::snprintf(text, sizeof text, "%.*f", digits, value);
    return value < 0.0 ? "-" : text;
}

void csv_counts(std::FILE *file, const Tally &t)
{
    for (int64_t count : {t.states, t.wrong_joint, t.false_split, t.wrong, t.moved_states, t.missed,
                          t.features, t.misplaced, t.sure, t.sure_and_right, t.six, t.six_exact,
                          t.told, t.told_exact, t.ended_exact})
        (void)std::fprintf(file, ",%lld", static_cast<long long>(count));
}

} // namespace

Tally sum(const Group &group, Method method)
{
    Tally total;
    for (const TrialResult &trial : group.trials)
        total += trial.tally[method];
    return total;
}

Figures figures(const Tally &tally, size_t trials)
{
    return {percent(tally.wrong_joint, tally.states),
            percent(tally.false_split, tally.states),
            percent(tally.wrong, tally.states),
            percent(tally.missed, tally.moved_states),
            percent(tally.misplaced, tally.features),
            percent(tally.sure_and_right, tally.sure),
            percent(tally.six_exact, tally.six),
            percent(tally.told_exact, tally.told),
            percent(tally.ended_exact, static_cast<int64_t>(trials))};
}

Pushes pushes(const Group &group)
{
    std::vector<double> counts;
    std::vector<double> ms;
    int64_t at_cap = 0;
    for (const TrialResult &trial : group.trials) {
        counts.push_back(trial.pushes);
        ms.push_back(trial.update_ms);
        at_cap += trial.at_cap;
    }
    return {mean_of(counts), percent(at_cap, static_cast<int64_t>(group.trials.size())),
            mean_of(ms).mean};
}

static void print_group(std::FILE *file, const Group &group, int width)
{
    for (int m = OURS; m < METHODS; m++) {
        Figures f = figures(sum(group, static_cast<Method>(m)), group.trials.size());
        (void)std::fprintf(file, "%-*s %5.3g %-8s | %6s %6s %6s %6s %6s | %6s %6s %6s |", width,
                           m == OURS ? group.object.c_str() : "", group.noise, method_names[m],
                           cell(f.wrong, 2).c_str(), cell(f.wrong_joint, 2).c_str(),
                           cell(f.false_split, 2).c_str(), cell(f.missed, 1).c_str(),
                           cell(f.misplaced, 2).c_str(), cell(f.calibration, 1).c_str(),
                           cell(f.exact_in_six, 0).c_str(), cell(f.exact_when_moved, 0).c_str());
        if (m == OURS) {
            Pushes p = pushes(group);
            (void)std::fprintf(file, " %6.1f +- %4s %5.1f %6.2f", p.count.mean,
                               cell(p.count.half, 1).c_str(), p.at_cap, p.update_ms);
        }
        (void)std::fputc('\n', file);
    }
}

void print_table(std::FILE *file, const std::vector<Group> &groups)
{
    size_t width = std::strlen("object");
    for (const Group &group : groups)
        width = std::max(width, group.object.size());
    (void)std::fprintf(file, "%-*s %5s %-8s | %6s %6s %6s %6s %6s | %6s %6s %6s | %14s %5s %6s\n",
                       static_cast<int>(width), "object", "noise", "method", "wrong", "joint",
                       "split", "missed", "feat.", "calib.", "six", "moved", "pushes", "cap", "ms");
    for (const Group &group : groups)
        print_group(file, group, static_cast<int>(width));
}

void print_csv(std::FILE *file, const std::vector<Group> &groups)
{
    (void)std::fprintf(
        file, "object,noise,method,trials,pushes_mean,pushes_half_width_95,at_cap_percent,"
              "milliseconds_a_push,wrong_percent,wrong_joint_percent,false_split_percent,"
              "missed_percent,misplaced_features_percent,calibration_percent,exact_in_six_percent,"
              "exact_when_moved_percent,ended_exact_percent,states,wrong_joint,false_split,wrong,"
              "moved_states,missed,"
              "features,misplaced,sure,sure_and_right,six,six_exact,told,told_exact,ended_exact\n");
    for (const Group &group : groups) {
        Pushes p = pushes(group);
        for (int m = OURS; m < METHODS; m++) {
            Tally tally = sum(group, static_cast<Method>(m));
            Figures f = figures(tally, group.trials.size());
            (void)std::fprintf(
                file, "%s,%g,%s,%zu,%.3f,%s,%.3f,%.3f", csv_field(group.object).c_str(),
                group.noise, method_names[m], group.trials.size(), p.count.mean,
                p.count.half < 0.0 ? "" : cell(p.count.half, 3).c_str(), p.at_cap, p.update_ms);
            for (double figure : {f.wrong, f.wrong_joint, f.false_split, f.missed, f.misplaced,
                                  f.calibration, f.exact_in_six, f.exact_when_moved, f.ended_exact})
                (void)std::fprintf(file, figure < 0.0 ? "," : ",%.3f", figure);
            csv_counts(file, tally);
            (void)std::fputc('\n', file);
        }
    }
}

} // namespace grrl_experiment::perception
