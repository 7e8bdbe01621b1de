/* grid.cpp: axes, levels and their products. */
#include "grid.hpp"

#include <functional>
#include <sstream>

namespace grrl_experiment::recordings
{

using grrl_sim::Result;

namespace
{

struct Level {
    std::string name;
    std::function<void(Conditions &)> set;
};

struct Axis {
    std::string name;
    std::vector<Level> levels; /* the first is the usual one, except for objects */
};

template <typename T> Level level(const std::string &name, T Conditions::*field, T value)
{
    return {name, [field, value](Conditions &what) { what.*field = value; }};
}

enum { OBJECTS }; /* the first axis */

const std::vector<Axis> &axes()
{
    static const std::vector<Axis> all = [] {
        std::vector<Axis> a(1);
        a[OBJECTS].name = "objects";
        for (const NamedObject &object : all_objects())
            a[OBJECTS].levels.push_back(level(object.name, &Conditions::object, object.object));
        auto camera = &Conditions::camera;
        a.push_back(
            {"camera",
             {level("fixed", camera, Camera::FIXED), level("pan", camera, Camera::PAN),
              level("roll", camera, Camera::ROLL), level("zoom", camera, Camera::ZOOM),
              level("shake", camera, Camera::SHAKE), level("tilt15", camera, Camera::TILT15),
              level("tilt30", camera, Camera::TILT30),
              level("perspective", camera, Camera::PERSPECTIVE)}});
        auto tracks = &Conditions::tracks;
        a.push_back(
            {"tracks",
             {level("whole", tracks, Tracks::WHOLE), level("late", tracks, Tracks::LATE),
              level("early", tracks, Tracks::EARLY), level("renewed", tracks, Tracks::RENEWED),
              level("edges", tracks, Tracks::EDGES), level("frozen", tracks, Tracks::FROZEN)}});
        a.push_back({"points", {}});
        for (int points : {20, 2, 4, 8, 60, 250})
            a.back().levels.push_back(level(std::to_string(points), &Conditions::points, points));
        a.push_back({"rate", {}});
        for (int rate : {30, 3, 10, 60})
            a.back().levels.push_back(level(std::to_string(rate), &Conditions::rate_hz, rate));
        a.push_back({"size", {}});
        for (Size size : {Size{"px", Unit::PX, 0.3, 1280.0}, Size{"320px", Unit::PX, 0.3, 320.0},
                          Size{"4k", Unit::PX, 0.3, 3840.0}, Size{"5cm", Unit::MM, 0.05, 0.0},
                          Size{"30cm", Unit::MM, 0.3, 0.0}, Size{"80cm", Unit::M, 0.8, 0.0},
                          Size{"2m", Unit::M, 2.0, 0.0}})
            a.back().levels.push_back(level(size.name, &Conditions::size, size));
        return a;
    }();
    return all;
}

/* The levels of each axis. */
using Choice = std::vector<std::vector<size_t>>;

std::string trimmed(const std::string &text)
{
    size_t begin = text.find_first_not_of(' ');
    size_t end = text.find_last_not_of(' ');
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

std::string names_of(const Axis &axis)
{
    std::string names;
    for (const Level &each : axis.levels)
        names += (names.empty() ? "" : ", ") + each.name;
    return names;
}

Choice usual()
{
    Choice choice(axes().size(), {0});
    choice[OBJECTS].clear();
    for (size_t i = 0; i < axes()[OBJECTS].levels.size(); i++)
        choice[OBJECTS].push_back(i);
    return choice;
}

/* An empty text or an error message. */
std::string choose(const std::string &part, Choice &choice)
{
    size_t equals = part.find('=');
    std::string name = trimmed(part.substr(0, equals));
    size_t at = 0;
    while (at < axes().size() && axes()[at].name != name)
        at++;
    if (at == axes().size())
        return "'" + name + "': must be objects, camera, tracks, points, rate or size";
    const Axis &axis = axes()[at];
    choice[at].clear();
    std::istringstream levels(equals == std::string::npos ? "" : part.substr(equals + 1));
    for (std::string text; std::getline(levels, text, ',');) {
        size_t i = 0;
        while (i < axis.levels.size() && axis.levels[i].name != trimmed(text))
            i++;
        if (i == axis.levels.size())
            return name + "=" + trimmed(text) + ": must be one of " + names_of(axis);
        choice[at].push_back(i);
    }
    for (size_t i = 0; i < axis.levels.size() && equals == std::string::npos; i++)
        choice[at].push_back(i);
    return choice[at].empty() ? name + "=: a level is missing: " + names_of(axis) : "";
}

/* All combinations; the objects vary fastest. */
void cross(const Choice &choice, std::vector<Cell> &cells)
{
    size_t n = 1;
    for (const auto &levels : choice)
        n *= levels.size();
    for (size_t i = 0; i < n; i++) {
        Cell cell;
        size_t rest = i;
        for (size_t a = 0; a < choice.size(); a++) {
            size_t which = choice[a][rest % choice[a].size()];
            rest /= choice[a].size();
            axes()[a].levels[which].set(cell.what);
            if (a == OBJECTS)
                cell.object = &all_objects()[which];
            else if (which > 0)
                cell.conditions += (cell.conditions.empty() ? "" : ",") + axes()[a].name + "=" +
                                   axes()[a].levels[which].name;
        }
        if (cell.what.size.unit != Unit::PX && cell.what.camera != Camera::FIXED)
            continue;
        if (cell.conditions.empty())
            cell.conditions = "usual";
        cells.push_back(cell);
    }
}

} // namespace

Result<std::vector<Cell>> make_grid(const std::string &text)
{
    std::vector<Cell> cells;
    Choice choice = usual();
    if (trimmed(text).empty()) {
        cross(choice, cells);
        for (size_t a = OBJECTS + 1; a < axes().size(); a++) {
            for (size_t i = 1; i < axes()[a].levels.size(); i++) {
                Choice one = choice;
                one[a] = {i};
                cross(one, cells);
            }
        }
        return {cells, {}};
    }
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ';');) {
        std::string wrong = trimmed(part).empty() ? "" : choose(part, choice);
        if (!wrong.empty())
            return {std::nullopt, wrong};
    }
    cross(choice, cells);
    if (cells.empty())
        return {std::nullopt, "a camera other than fixed needs a size in pixels"};
    return {cells, {}};
}

std::string grid_help()
{
    std::string text;
    for (const Axis &axis : axes())
        text += "  " + axis.name + std::string(10 - axis.name.size(), ' ') + names_of(axis) + "\n";
    return text;
}

} // namespace grrl_experiment::recordings
