/* plan.hpp: which curves a command asks for, and which pictures show them. */
#ifndef GRRL_EXPERIMENT_PLAN_HPP
#define GRRL_EXPERIMENT_PLAN_HPP

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "conditions.hpp"
#include "policies.hpp"
#include "result.hpp"
#include "sides.hpp"

namespace grrl_experiment
{

struct Options;

/* Whether a text names a file that describes a stream, FILE.stream, and not an object. */
bool is_stream(const std::string &text);

/* A number of trials with one object, or with a stream that gives each trial one of its own. */
struct Course {
    std::string text; /* as given by the user */
    int trials = 0;
    std::string key; /* what the objects depend on: a file by its content */
    Objects objects;
    bool stream = false;
};

/* A policy on an object, with or without pretraining on others. */
struct Curve {
    Course course;
    const Policy *policy = nullptr;
    std::string start; /* a store, as given by the user; empty: an empty memory */
    std::shared_ptr<const Bytes> experience; /* of that store */
    std::vector<Course> before;              /* one after the other; empty: none */
    Conditions conditions;                   /* of all its courses */

    bool starts_empty() const { return start.empty() && before.empty(); }
    std::string object() const; /* RPRPRPR, or RPRPRPR in links=0.7 */
    int trials() const { return course.trials; }
    int all_trials() const;            /* with those before */
    std::string pretrain_text() const; /* mixed, RRRRR:50, PRPRP:20, or none */
};

struct Figure {
    /* Pushes by trial; a row of means per curve; or for each object the curve without pretraining
     * and those after each of the objects. */
    enum class Kind { CURVES, ROWS, MATRIX };
    Kind kind = Kind::CURVES;
    std::string name; /* figure-3b, or curves */
    std::string title;
    std::vector<size_t> curves;  /* of the plan */
    bool drawn = true;           /* as a picture */
    std::optional<size_t> bound; /* shows by how much the curves lie above this one */
};

struct Plan {
    std::vector<Curve> curves;
    std::vector<Figure> figures;
};

constexpr const char *interference = "interference"; /* a figure; --object may name its objects */

/* 3b, 4a, .., all (of the paper), ablations and interference. */
std::vector<std::string> figure_names();

/* An error says which object is wrong and why. */
grrl_sim::Result<Plan> make_plan(const Options &options);

} // namespace grrl_experiment

#endif
