/* conditions.cpp: reads what is different in a world. */
#include "conditions.hpp"

#include <algorithm>
#include <sstream>

#include "cli/options.h"

namespace grrl_experiment
{

namespace
{

struct Row {
    const char *name;
    double least;
    double most;
    const char *text;
    void (*apply)(Conditions &conditions, double x);
};

const Row rows[] = {
    {"links", 0.3, 2.0, "length of links", [](Conditions &c, double x) { c.scale.length *= x; }},
    {"size", 0.3, 2.0, "length of links, and joint friction to match",
     [](Conditions &c, double x) {
         c.scale.length *= x;
         c.scale.similar = true;
     }},
    {"features", 0.2, 3.0, "number of features on a link",
     [](Conditions &c, double x) { c.scale.features = x; }},
    {"friction", 0.1, 10.0, "friction of joints",
     [](Conditions &c, double x) { c.scale.friction = x; }},
    {"scatter", 0.0, 5.0, "scatter of pushes",
     [](Conditions &c, double x) {
         c.world.contact_offset_sigma_m *= x;
         c.world.push_direction_sigma_rad *= x;
     }},
    {"noise", 0.0, 100.0, "standard deviation of a tracked point, mm",
     [](Conditions &c, double x) { c.world.tracker.noise_sigma_m = 0.001 * x; }},
    {"dropout", 0.0, 0.9, "probability that a point is missing in a frame",
     [](Conditions &c, double x) { c.world.tracker.dropout_probability = x; }},
};

const Row *find(const std::string &name)
{
    for (const Row &row : rows)
        if (name == row.name)
            return &row;
    return nullptr;
}

} // namespace

std::string parse_conditions(const std::string &text, Conditions &conditions)
{
    conditions.text = text == "default" ? "" : text;
    for (size_t at = 0; at <= text.size() && text != "default";) {
        size_t end = std::min(text.find(',', at), text.size());
        std::string word = text.substr(at, end - at);
        size_t sign = std::min(word.find('='), word.size());
        const Row *row = find(word.substr(0, sign));
        double x = 0.0;
        if (row == nullptr)
            return "default, grid or NAME=X[,..], see below";
        std::ostringstream right;
        right << "a number from " << row->least << " to " << row->most << " for " << row->name;
        if (sign == word.size() || !grrl_option_number_of(word.c_str() + sign + 1, &x) ||
            !(x >= row->least && x <= row->most))
            return right.str();
        row->apply(conditions, x);
        at = end + 1;
    }
    return {};
}

std::string conditions_help()
{
    std::ostringstream text;
    for (const Row &row : rows) {
        std::string name = row.name;
        text << "  " << name << std::string(13 - name.size(), ' ') << row.text << ", " << row.least
             << " to " << row.most << "\n";
    }
    return text.str();
}

const std::vector<std::string> &grid_of_worlds()
{
    static const std::vector<std::string> grid = {
        "default",      "links=0.5",    "links=0.7",  "links=0.85",   "links=1.2",
        "links=1.5",    "size=0.5",     "size=0.7",   "size=1.5",     "features=0.5",
        "features=0.7", "features=1.5", "features=2", "friction=0.5", "friction=2",
        "noise=0.35",   "noise=1.4",    "noise=2.8",  "scatter=0",    "scatter=2",
        "dropout=0.05", "dropout=0.2"};
    return grid;
}

} // namespace grrl_experiment
