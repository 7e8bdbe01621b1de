/* figures.cpp: the results of many recordings. */
#include "figures.hpp"

#include <algorithm>
#include <cmath>

#include "files.hpp"

namespace grrl_experiment::recordings
{

namespace
{

void add(const Outcome &outcome, Kind kind, bool fixed, Figures &f)
{
    const Score &score = outcome.score;
    bool false_called = score.false_called > 0;
    bool false_sure = score.false_sure > 0;
    f.recordings++;
    f.failed += {outcome.failed, 1};
    f.bodies += {score.bodies_right, 1};
    f.error += score.error;
    f.ms += outcome.ms;
    f.missed += {score.missed, score.joints};
    if (kind == Kind::MECHANISM) {
        if (score.joints > 0) /* else there was nothing to be told */
            f.right += {score.right, 1};
        if (score.joints > 0 && fixed)
            f.fixed += {score.right, 1};
        f.mechanism_false += {false_called, 1};
    } else if (kind == Kind::INDEPENDENT) {
        f.independent_called += {false_called, 1};
        f.independent_sure += {false_sure, 1};
        f.independent_right += {score.right, 1};
    } else {
        f.hand += {score.right, 1};
    }
    for (const Called &called : score.called)
        for (size_t i = 0; i < std::size(bins); i++)
            if (called.probability >= bins[i].low && called.probability < bins[i].high)
                f.calibration[i] += {called.right, 1};
}

std::string cell(const Share &share)
{
    char text[16] = "-";
    if (share.of > 0)
        (void)std::snprintf(text, sizeof text, "%.1f", share.percent());
    return text;
}

void print_row(std::FILE *file, const char *label, const Figures &f, Method method)
{
    (void)std::fprintf(
        file, "%-20s %-6s %5d | %6s %6s %6s | %6s %6s | %6s | %6s %6.1f | %6s | %7.1f\n", label,
        method_names[method], f.recordings, cell(f.right).c_str(), cell(f.missed).c_str(),
        cell(f.mechanism_false).c_str(), cell(f.independent_called).c_str(),
        cell(f.independent_sure).c_str(), cell(f.hand).c_str(), cell(f.bodies).c_str(),
        100.0 * f.error / std::max(f.recordings, 1), cell(f.calibration[SURE]).c_str(),
        f.ms / std::max(f.recordings, 1));
}

std::string with_interval(const Share &share)
{
    char text[64] = "-";
    Interval interval = share.interval();
    if (share.of > 0)
        (void)std::snprintf(text, sizeof text, "%.1f%% (%.1f to %.1f) of %d", share.percent(),
                            interval.low, interval.high, share.of);
    return text;
}

/* The figures that a release must meet, with intervals, and the calibration. */
void print_summary(std::FILE *file, const Figures *f)
{
    const struct {
        const char *what;
        Share Figures::*share;
    } lines[] = {
        {"one mechanism: right structure", &Figures::right},
        {"the same, camera at rest", &Figures::fixed},
        {"one mechanism: some false joint", &Figures::mechanism_false},
        {"independent: some joint >= .5", &Figures::independent_called},
        {"independent: some joint >= .95", &Figures::independent_sure},
        {"a hand that lets go: right structure", &Figures::hand},
        {"bodies right", &Figures::bodies},
        {"true joints missed", &Figures::missed},
        {"no answer", &Figures::failed},
    };
    (void)std::fprintf(file, "\n%-38s", "with 95% intervals (Wilson)");
    for (const char *name : method_names)
        (void)std::fprintf(file, "%-34s", name);
    for (const auto &line : lines) {
        (void)std::fprintf(file, "\n%-38s", line.what);
        for (int m = 0; m < METHODS; m++)
            (void)std::fprintf(file, "%-34s", with_interval(f[m].*line.share).c_str());
    }
    for (size_t i = 0; i < std::size(bins); i++) {
        (void)std::fprintf(file, "\n%-38s", bins[i].name);
        for (int m = 0; m < METHODS; m++)
            (void)std::fprintf(file, "%-34s", with_interval(f[m].calibration[i]).c_str());
    }
    (void)std::fputc('\n', file);
}

} // namespace

const Bin bins[BINS] = {{"joints from .5 to .8 that are right", 0.5, 0.8},
                        {"joints from .8 to .95 that are right", 0.8, 0.95},
                        {"joints from .95 on that are right", 0.95, 2.0}};

Share &Share::operator+=(const Share &other)
{
    part += other.part;
    of += other.of;
    return *this;
}

double Share::percent() const
{
    return of > 0 ? 100.0 * part / of : -1.0;
}

Interval Share::interval() const
{
    const double z = 1.959964;
    double n = of;
    double p = of > 0 ? part / n : 0.0;
    double centre = p + z * z / (2.0 * n);
    double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
    double scale = 100.0 / (1.0 + z * z / n);
    return {std::max(0.0, scale * (centre - half)),
            std::min(100.0, scale * (centre + half))}; /* rounding */
}

std::vector<std::string> conditions_of(const std::vector<Result> &results)
{
    std::vector<std::string> names;
    for (const Result &result : results)
        if (std::find(names.begin(), names.end(), result.cell->conditions) == names.end())
            names.push_back(result.cell->conditions);
    return names;
}

Figures figures(const std::vector<Result> &results, Method method, const std::string &conditions,
                const std::string &object)
{
    Figures f;
    for (const Result &result : results) {
        bool wanted = (conditions.empty() || conditions == result.cell->conditions) &&
                      (object.empty() || object == result.cell->object->name);
        if (wanted)
            add(result.of[method], result.cell->object->kind,
                result.cell->what.camera == Camera::FIXED, f);
    }
    return f;
}

void print_table(std::FILE *file, const std::vector<Result> &results)
{
    (void)std::fprintf(file, "%-20s %-6s %5s | %6s %6s %6s | %6s %6s | %6s | %6s %6s | %6s | %7s\n",
                       "conditions", "method", "n", "right", "missed", "false", ">=.5", ">=.95",
                       "hand", "bodies", "error", "calib.", "ms");
    auto rows = [&](const std::string &label, const std::string &conditions,
                    const std::string &object) {
        for (int m = 0; m < METHODS; m++) {
            auto method = static_cast<Method>(m);
            Figures f = figures(results, method, conditions, object);
            if (f.recordings > 0)
                print_row(file, m == 0 ? label.c_str() : "", f, method);
        }
    };
    for (const std::string &conditions : conditions_of(results))
        rows(conditions, conditions, "");
    for (const NamedObject &object : all_objects())
        rows(std::string("objects=") + object.name, "", object.name);
    Figures all[METHODS];
    for (int m = 0; m < METHODS; m++)
        all[m] = figures(results, static_cast<Method>(m), "", "");
    rows("all", "", "");
    print_summary(file, all);
}

void print_csv(std::FILE *file, const std::vector<Result> &results)
{
    (void)std::fputs("conditions,object,seed,method,failed,right,bodies_right,error_percent,bodies,"
                     "joints,missed,false_called,false_sure,milliseconds\n",
                     file);
    for (const Result &result : results) {
        for (int m = 0; m < METHODS; m++) {
            const Score &s = result.of[m].score;
            (void)std::fprintf(
                file, "%s,%s,%llu,%s,%d,%d,%d,%.3f,%d,%d,%d,%d,%d,%.3f\n",
                csv_field(result.cell->conditions).c_str(), result.cell->object->name,
                static_cast<unsigned long long>(result.seed), method_names[m], result.of[m].failed,
                s.right, s.bodies_right, 100.0 * s.error, s.bodies, s.joints, s.missed,
                s.false_called, s.false_sure, result.of[m].ms);
        }
    }
}

} // namespace grrl_experiment::recordings
