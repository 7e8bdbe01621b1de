/* plan.cpp: determines the curves for a figure or a command line. */
#include "plan.hpp"

#include <climits>
#include <map>

#include "files.hpp"
#include "object_folder.hpp"
#include "object_stream.hpp"
#include "options.hpp"
#include "shipped_store.h"

namespace grrl_experiment
{

namespace
{

constexpr const char *own_figure = "curves";
constexpr int paper_pretrain_trials = 50;
constexpr int matrix_trials = 5;
constexpr const char *ablations_object = "RPRPRPR";

struct PaperFigure {
    const char *name;
    const char *object;
    const char *pretrain; /* nullptr: none */
    std::vector<const char *> policies;
};

const std::vector<PaperFigure> &paper_figures()
{
    static const std::vector<PaperFigure> table = {
        {"3b", "RPRPRPR", nullptr, {"random", "paper", "learn"}},
        {"4a", "PRPRPRP", "PRPRP", {"paper", "learn"}},
        {"4b", "RRRR", "RRRRR", {"paper", "learn"}},
        {"4c", "PRRP", "PRRRRP", {"paper", "learn"}},
    };
    return table;
}

Course course_of(const std::string &text, int trials)
{
    Course course;
    course.text = text;
    course.trials = trials;
    return course;
}

/* The options were checked when they were read. */
Conditions world_of(const Options &options, const std::string &text)
{
    Conditions conditions;
    conditions.world.tracker.noise_sigma_m = options.noise_mm * 0.001;
    (void)parse_conditions(text, conditions);
    return conditions;
}

/* Adds the curve without pretraining and, where it makes a difference, with it. */
void add_curves(Plan &plan, Figure &figure, const Curve &base)
{
    Curve without = base;
    without.before.clear();
    figure.curves.push_back(plan.curves.size());
    plan.curves.push_back(without);
    if (base.before.empty() || !base.policy->learns())
        return;
    figure.curves.push_back(plan.curves.size());
    plan.curves.push_back(base);
}

/* Fills in the objects of a course, and returns what is wrong with them. */
std::string read_course(Course &course, const Conditions &conditions)
{
    std::string path = grrl_sim::object_path(course.text);
    course.key = read_file(path.empty() ? course.text : path).value_or(course.text);
    course.key += "\n" + conditions.text;
    course.stream = is_stream(course.text);
    if (course.stream) {
        auto stream = grrl_sim::stream_from_file(course.text);
        if (!stream)
            return stream.error;
        course.objects = [all = *stream.value, scale = conditions.scale](uint64_t seed,
                                                                         int32_t trial) {
            return all.sample(grrl_sim::trial_seed(seed, trial), scale);
        };
        return {};
    }
    auto object = grrl_sim::object_from_text(course.text, conditions.scale);
    if (!object)
        return course.text + ": " + object.error;
    course.objects = [only = *object.value](uint64_t, int32_t) { return only; };
    return {};
}

/* Gives all learners what the store holds, and returns what is wrong with it. */
std::string read_start(Plan &plan, const std::string &store)
{
    char path[PATH_MAX];
    grrl_shipped_store_path(store.c_str(), sizeof path, path);
    std::optional<std::string> text = read_file(path);
    if (!text)
        return "--start: " + std::string(path) + " cannot be read";
    auto bytes = std::make_shared<const Bytes>(text->begin(), text->end());
    std::map<const Policy *, std::string> objections;
    for (Curve &curve : plan.curves) {
        if (!curve.policy->learns())
            continue;
        if (objections.count(curve.policy) == 0)
            objections[curve.policy] = objection(*curve.policy, *bytes);
        if (!objections[curve.policy].empty())
            return "--start: " + curve.policy->name + " cannot start with " + path + ": " +
                   objections[curve.policy];
        curve.start = store;
        curve.experience = bytes;
    }
    if (objections.empty())
        return "--start: none of the policies learns";
    return {};
}

std::string read_objects(Plan &plan)
{
    for (Curve &curve : plan.curves) {
        std::string error = read_course(curve.course, curve.conditions);
        for (Course &course : curve.before)
            error = error.empty() ? read_course(course, curve.conditions) : error;
        if (!error.empty())
            return error;
    }
    return {};
}

void add_figure(Plan &plan, const Options &options, const PaperFigure &paper)
{
    Figure figure;
    figure.name = std::string("figure-") + paper.name;
    figure.title = std::string("Figure ") + paper.name + ": " + paper.object;
    Curve curve;
    curve.course = course_of(paper.object, options.trials);
    curve.conditions = world_of(options, "default");
    if (paper.pretrain != nullptr) {
        curve.before.push_back(course_of(paper.pretrain, paper_pretrain_trials));
        figure.title += std::string(", without and with ") + std::to_string(paper_pretrain_trials) +
                        " trials of " + paper.pretrain;
    }
    std::vector<const Policy *> chosen = options.policies;
    if (chosen.empty())
        for (const char *name : paper.policies)
            chosen.push_back(find_policy(name));
    for (const Policy *policy : chosen) {
        curve.policy = policy;
        add_curves(plan, figure, curve);
    }
    plan.figures.push_back(figure);
}

/* Adds both complete learners, and their ablations. */
void add_ablations(Plan &plan, const Options &options)
{
    Figure figure;
    figure.kind = Figure::Kind::ROWS;
    figure.name = "ablations";
    figure.title = std::string("Ablations: ") + ablations_object;
    std::vector<const Policy *> chosen = options.policies;
    if (chosen.empty())
        for (const char *base : {"paper", "learn"}) {
            chosen.push_back(find_policy(base));
            for (const Policy &policy : ablations())
                if (policy.name.compare(0, std::string(base).size(), base) == 0)
                    chosen.push_back(&policy);
        }
    for (const Policy *policy : chosen) {
        Curve curve;
        curve.course = course_of(ablations_object, options.trials);
        curve.conditions = world_of(options, "default");
        curve.policy = policy;
        add_curves(plan, figure, curve);
    }
    plan.figures.push_back(figure);
}

/* Each object without experience and after each of the others and itself. */
void add_matrix(Plan &plan, const Options &options)
{
    std::vector<std::string> objects = options.objects;
    if (objects.empty())
        objects = {"PRPRP",
                   "PRPRPRP",
                   "RPRPRPR",
                   "RRRR",
                   "RRRRR",
                   "PRRP",
                   "PRRRRP",
                   "PPRRP",
                   "RRPPRR",
                   "R(l1, l2, l3, l4)",
                   "R(l1, P(l2, l3), P(l4, l5), R(l6, l7))",
                   "R(l1, R(l4, R(l3, P(l2, l1))))"};
    std::vector<const Policy *> chosen = options.policies;
    if (chosen.empty())
        chosen.push_back(find_policy("learn"));
    for (const Policy *policy : chosen) {
        Figure figure;
        figure.kind = Figure::Kind::MATRIX;
        figure.name = std::string(interference) + "-" + policy->name;
        figure.title = policy->name + ": pushes in the first " + std::to_string(matrix_trials) +
                       " trials, with " + std::to_string(options.trials) +
                       " trials of another object before minus without";
        for (const std::string &then : objects) {
            Curve curve;
            curve.course = course_of(then, matrix_trials);
            curve.conditions = world_of(options, "default");
            curve.policy = policy;
            add_curves(plan, figure, curve);
            for (const std::string &before : objects) {
                curve.before = {course_of(before, options.trials)};
                figure.curves.push_back(plan.curves.size());
                plan.curves.push_back(curve);
            }
        }
        plan.figures.push_back(figure);
    }
}

/* Where the clairvoyant ran, too, a second figure shows the distance from it. */
void add_distance_from_bound(Plan &plan, const Figure &figure)
{
    Figure distance = figure;
    distance.name += "-above-clairvoyant";
    distance.title += ": above the clairvoyant";
    distance.curves.clear();
    for (size_t c : figure.curves)
        if (plan.curves[c].policy->needs_truth)
            distance.bound = c;
        else
            distance.curves.push_back(c);
    if (distance.bound && !distance.curves.empty())
        plan.figures.push_back(distance);
}

/* An object in a world, as the next figure. */
void add_own(Plan &plan, const Options &options, const std::string &object,
             const Conditions &conditions)
{
    Figure figure;
    Curve curve;
    curve.course = course_of(object, options.trials);
    curve.conditions = conditions;
    figure.name = own_figure;
    if (plan.curves.size() > 0)
        figure.name += "-" + std::to_string(plan.figures.size() + 1);
    figure.title = curve.object();
    figure.drawn = options.worlds.size() < 2;
    for (const std::string &pretrain : options.pretrain) {
        Course course;
        (void)split_pretrain(pretrain, course.text, course.trials);
        figure.title += (curve.before.empty() ? ", without and with " : " and ") +
                        std::to_string(course.trials) + " trials of " + course.text;
        curve.before.push_back(course);
    }
    std::vector<const Policy *> chosen = options.policies;
    if (chosen.empty())
        chosen.push_back(find_policy("learn"));
    for (const Policy *policy : chosen) {
        curve.policy = policy;
        add_curves(plan, figure, curve);
    }
    plan.figures.push_back(figure);
    add_distance_from_bound(plan, figure);
}

} // namespace

bool is_stream(const std::string &text)
{
    const std::string end = ".stream";
    return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string Curve::object() const
{
    return conditions.text.empty() ? course.text : course.text + " in " + conditions.text;
}

std::string Curve::pretrain_text() const
{
    std::string text = start;
    for (const Course &earlier : before)
        text += (text.empty() ? "" : ", ") + earlier.text + ":" + std::to_string(earlier.trials);
    return text.empty() ? "none" : text;
}

int Curve::all_trials() const
{
    int all = course.trials;
    for (const Course &earlier : before)
        all += earlier.trials;
    return all;
}

std::vector<std::string> figure_names()
{
    std::vector<std::string> names;
    for (const PaperFigure &figure : paper_figures())
        names.push_back(figure.name);
    names.push_back("all");
    names.push_back("ablations");
    names.push_back(interference);
    return names;
}

grrl_sim::Result<Plan> make_plan(const Options &options)
{
    Plan plan;
    std::vector<std::string> worlds = options.worlds;
    if (worlds.empty())
        worlds.emplace_back("default");
    if (options.figure == interference)
        add_matrix(plan, options);
    for (const std::string &object : options.objects)
        for (const std::string &world : worlds)
            if (options.figure.empty())
                add_own(plan, options, object, world_of(options, world));
    if (options.figure == "ablations")
        add_ablations(plan, options);
    for (const PaperFigure &figure : paper_figures())
        if (options.figure == figure.name || options.figure == "all")
            add_figure(plan, options, figure);
    std::string error = read_objects(plan);
    if (error.empty() && !options.start.empty())
        error = read_start(plan, options.start);
    return error.empty() ? grrl_sim::Result<Plan>::good(std::move(plan))
                         : grrl_sim::Result<Plan>::bad(error);
}

} // namespace grrl_experiment
