/* plan.hpp: which curves a command asks for, and which pictures show them. */
#ifndef GRRL_EXPERIMENT_PLAN_HPP
#define GRRL_EXPERIMENT_PLAN_HPP

#include <string>
#include <vector>

#include "object.hpp"
#include "policies.hpp"
#include "result.hpp"

namespace grrl_experiment
{

struct Options;

/* A policy on an object, with or without pretraining on another object. */
struct Curve {
    std::string object; /* as given by the user */
    const Policy *policy = nullptr;
    std::string pretrain; /* object; empty: none */
    int pretrain_trials = 0;
    int trials = 0;
    grrl_sim::ObjectSpec object_spec;
    grrl_sim::ObjectSpec pretrain_spec;

    std::string pretrain_text() const; /* RRRRR:50, or none */
};

struct Figure {
    enum class Kind { CURVES, ROWS }; /* pushes by trial, or a row of means per curve */
    Kind kind = Kind::CURVES;
    std::string name; /* figure-3b, or curves */
    std::string title;
    std::vector<size_t> curves; /* of the plan */
};

struct Plan {
    std::vector<Curve> curves;
    std::vector<Figure> figures;
};

/* 3b, 4a, .., all (of the paper), and ablations. */
std::vector<std::string> figure_names();

/* An error says which object is wrong and why. */
grrl_sim::Result<Plan> make_plan(const Options &options);

} // namespace grrl_experiment

#endif
