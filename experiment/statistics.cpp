/* statistics.cpp: means, Student's t, and ranges of trials. */
#include "statistics.hpp"

#include <algorithm>
#include <cmath>

namespace grrl_experiment
{

double t_quantile(int degrees)
{
    static const double table[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                   2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
                                   2.110,  2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064,
                                   2.060,  2.056, 2.052, 2.048, 2.045, 2.042};
    if (degrees >= 1 && degrees <= 30)
        return table[degrees - 1];
    /* The expansion of the quantile in 1 / degrees, accurate to three digits here. */
    return 1.95996 + 2.37226 / degrees + 2.8225 / (static_cast<double>(degrees) * degrees);
}

Mean mean_of(const std::vector<double> &values)
{
    Mean result;
    result.n = static_cast<int>(values.size());
    if (values.empty())
        return result;
    double sum = 0.0;
    for (double value : values)
        sum += value;
    result.mean = sum / result.n;
    if (result.n < 2)
        return result;
    double squares = 0.0;
    for (double value : values)
        squares += (value - result.mean) * (value - result.mean);
    result.half = t_quantile(result.n - 1) * std::sqrt(squares / (result.n - 1) / result.n);
    return result;
}

Mean pushes(const Experiments &experiments, int first, int last)
{
    std::vector<double> values;
    for (const Trials &trials : experiments) {
        double sum = 0.0;
        for (int t = first; t <= last; t++)
            sum += trials[static_cast<size_t>(t - 1)].pushes;
        values.push_back(sum / (last - first + 1));
    }
    return mean_of(values);
}

double capped(const Experiments &experiments, int first, int last)
{
    int n = 0;
    for (const Trials &trials : experiments)
        for (int t = first; t <= last; t++)
            n += trials[static_cast<size_t>(t - 1)].discovered ? 0 : 1;
    return experiments.empty() ? 0.0
                               : static_cast<double>(n) /
                                     (static_cast<double>(experiments.size()) * (last - first + 1));
}

std::vector<Range> ranges(int trials)
{
    std::vector<Range> chosen;
    const int ends[][2] = {{1, 5},       {6, 10},      {11, 20},     {21, 40},
                           {41, 100},    {101, 200},   {201, 500},   {501, 1000},
                           {1001, 2000}, {2001, 5000}, {5001, 10000}};
    for (const auto &end : ends)
        if (end[0] <= trials && (end[0] <= 21 || end[1] <= trials)) {
            int last = std::min(end[1], trials);
            chosen.push_back({end[0], last, std::to_string(end[0]) + "-" + std::to_string(last)});
        }
    if (trials > 10)
        chosen.push_back({trials - 9, trials, "last 10"});
    chosen.push_back({1, trials, "all"});
    return chosen;
}

} // namespace grrl_experiment
