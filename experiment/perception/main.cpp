/*
 * grrl-evaluate: measures the accuracy of perception.
 *
 * Exit status: 0 fine, 1 failed, 2 wrong command line.
 */
#include <cstring>

#include "figures.hpp"
#include "files.hpp"
#include "objects.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "recordings/study.hpp"

using namespace grrl_experiment::perception;

namespace
{

enum { EXIT_FINE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

/* Runs all trials of all groups; a trial depends only on its seed. */
void run_all(const std::vector<NamedObject> &objects, const Options &options,
             std::vector<Group> &groups)
{
    size_t trials = static_cast<size_t>(options.trials);
    auto one = [&](size_t i) {
        Group &group = groups[i / trials];
        TrialParams params = options.trial;
        params.world.tracker.noise_sigma_m *= group.noise;
        TrialResult &result = group.trials[i % trials];
        result =
            run_trial(objects[i / trials % objects.size()].spec, params, options.seed + i % trials);
        return result.pushes;
    };
    grrl_experiment::run_parallel(groups.size() * trials, options.jobs, options.quiet, "trials",
                                  one);
}

/* One group per noise level over all objects, to follow the groups of single objects. */
std::vector<Group> totals(const std::vector<Group> &groups, const std::vector<double> &noise)
{
    std::vector<Group> result;
    for (double level : noise) {
        Group all{"all", level, {}};
        for (const Group &group : groups)
            if (group.noise == level)
                all.trials.insert(all.trials.end(), group.trials.begin(), group.trials.end());
        result.push_back(std::move(all));
    }
    return result;
}

int report(const Options &options, std::vector<Group> groups)
{
    if (groups.size() > options.noise.size())
        for (Group &all : totals(groups, options.noise))
            groups.push_back(std::move(all));
    print_table(stdout, groups);
    bool good = grrl_experiment::write_outputs(
        "grrl-evaluate", options.csv, [&](std::FILE *file) { print_csv(file, groups); },
        options.svg, [&] { return draw_svg(options.svg, groups); });
    return good ? EXIT_FINE : EXIT_FAILED;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc > 1 && std::strcmp(argv[1], "recordings") == 0)
        return grrl_experiment::recordings::study(argc, argv);
    Options options;
    grrl_options_result parsed = parse_options(argc, argv, options);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    grrl_sim::Result<std::vector<NamedObject>> objects = select_objects(options.objects);
    if (!objects) {
        (void)std::fprintf(stderr, "grrl-evaluate: --objects: %s\n", objects.error.c_str());
        return EXIT_USAGE;
    }
    std::vector<Group> groups;
    for (double noise : options.noise)
        for (const NamedObject &object : *objects.value)
            groups.push_back({object.name, noise,
                              std::vector<TrialResult>(static_cast<size_t>(options.trials))});
    run_all(*objects.value, options, groups);
    return report(options, std::move(groups));
}
