/* plan.cpp: determines the curves for a figure or a command line. */
#include "plan.hpp"

#include "options.hpp"

namespace grrl_experiment
{

namespace
{

constexpr int paper_pretrain_trials = 50;
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

/* Adds the curve without pretraining and, where it makes a difference, with it. */
void add_curves(Plan &plan, Figure &figure, const Curve &base)
{
    Curve without = base;
    without.pretrain.clear();
    without.pretrain_trials = 0;
    figure.curves.push_back(plan.curves.size());
    plan.curves.push_back(without);
    if (base.pretrain.empty() || !base.policy->learns())
        return;
    figure.curves.push_back(plan.curves.size());
    plan.curves.push_back(base);
}

std::string read_objects(Plan &plan)
{
    for (Curve &curve : plan.curves) {
        auto object = grrl_sim::object_from_text(curve.object);
        if (!object)
            return curve.object + ": " + object.error;
        curve.object_spec = *object.value;
        if (curve.pretrain.empty())
            continue;
        auto pretrain = grrl_sim::object_from_text(curve.pretrain);
        if (!pretrain)
            return curve.pretrain + ": " + pretrain.error;
        curve.pretrain_spec = *pretrain.value;
    }
    return {};
}

void add_figure(Plan &plan, const Options &options, const PaperFigure &paper)
{
    Figure figure;
    figure.name = std::string("figure-") + paper.name;
    figure.title = std::string("Figure ") + paper.name + ": " + paper.object;
    Curve curve;
    curve.object = paper.object;
    curve.trials = options.trials;
    if (paper.pretrain != nullptr) {
        curve.pretrain = paper.pretrain;
        curve.pretrain_trials = paper_pretrain_trials;
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
        curve.object = ablations_object;
        curve.trials = options.trials;
        curve.policy = policy;
        add_curves(plan, figure, curve);
    }
    plan.figures.push_back(figure);
}

void add_own(Plan &plan, const Options &options)
{
    Figure figure;
    figure.name = "curves";
    figure.title = options.object;
    Curve curve;
    curve.object = options.object;
    curve.trials = options.trials;
    curve.pretrain = options.pretrain;
    curve.pretrain_trials = options.pretrain_trials;
    if (!options.pretrain.empty())
        figure.title += ", without and with " + std::to_string(options.pretrain_trials) +
                        " trials of " + options.pretrain;
    std::vector<const Policy *> chosen = options.policies;
    if (chosen.empty())
        chosen.push_back(find_policy("learn"));
    for (const Policy *policy : chosen) {
        curve.policy = policy;
        add_curves(plan, figure, curve);
    }
    plan.figures.push_back(figure);
}

} // namespace

std::string Curve::pretrain_text() const
{
    return pretrain.empty() ? "none" : pretrain + ":" + std::to_string(pretrain_trials);
}

std::vector<std::string> figure_names()
{
    std::vector<std::string> names;
    for (const PaperFigure &figure : paper_figures())
        names.push_back(figure.name);
    names.push_back("all");
    names.push_back("ablations");
    return names;
}

grrl_sim::Result<Plan> make_plan(const Options &options)
{
    Plan plan;
    if (options.figure.empty())
        add_own(plan, options);
    if (options.figure == "ablations")
        add_ablations(plan, options);
    for (const PaperFigure &figure : paper_figures())
        if (options.figure == figure.name || options.figure == "all")
            add_figure(plan, options, figure);
    std::string error = read_objects(plan);
    return error.empty() ? grrl_sim::Result<Plan>::good(std::move(plan))
                         : grrl_sim::Result<Plan>::bad(error);
}

} // namespace grrl_experiment
