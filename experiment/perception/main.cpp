/*
 * grrl-evaluate: how good perception is, measured.
 *
 * Exit status: 0 fine, 1 failed, 2 wrong command line.
 */
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <thread>

#include "figures.hpp"
#include "objects.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "recordings/study.hpp"

using namespace grrl_experiment::perception;
using grrl_experiment::Progress;

namespace
{

enum { EXIT_FINE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

/* All trials of all groups, by as many threads as there are jobs; a trial depends on its seed
 * alone. */
void run_all(const std::vector<NamedObject> &objects, const Options &options,
             std::vector<Group> &groups)
{
    size_t trials = static_cast<size_t>(options.trials);
    auto all = static_cast<int64_t>(groups.size() * trials);
    Progress progress(all, all, "trials");
    std::mutex mutex; /* of progress */
    std::atomic<size_t> next{0};
    auto work = [&] {
        for (size_t i = next++; i < groups.size() * trials; i = next++) {
            Group &group = groups[i / trials];
            TrialParams params = options.trial;
            params.world.tracker.noise_sigma_m *= group.noise;
            TrialResult &result = group.trials[i % trials];
            result = run_trial(objects[i / trials % objects.size()].spec, params,
                               options.seed + i % trials);
            std::lock_guard<std::mutex> lock(mutex);
            progress.trial(result.pushes);
            progress.part();
            if (!options.quiet)
                progress.show();
        }
    };
    std::vector<std::thread> threads;
    for (int i = 1; i < options.jobs; i++)
        threads.emplace_back(work);
    work();
    for (std::thread &thread : threads)
        thread.join();
    if (!options.quiet)
        progress.finish();
}

/* Each noise level over all objects, after the groups of single objects. */
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

bool write_csv(const std::string &path, const std::vector<Group> &groups)
{
    std::FILE *file = std::fopen(path.c_str(), "w");
    if (file != nullptr) {
        print_csv(file, groups);
        bool good = std::ferror(file) == 0;
        if (std::fclose(file) == 0 && good)
            return true;
    }
    (void)std::fprintf(stderr, "grrl-evaluate: %s: %s\n", path.c_str(), std::strerror(errno));
    return false;
}

int report(const Options &options, std::vector<Group> groups)
{
    if (groups.size() > options.noise.size())
        for (Group &all : totals(groups, options.noise))
            groups.push_back(std::move(all));
    print_table(stdout, groups);
    bool good = options.csv.empty() || write_csv(options.csv, groups);
    bool drawn = options.svg.empty() || draw_svg(options.svg, groups);
    if (!drawn)
        (void)std::fprintf(
            stderr,
            "grrl-evaluate: %s: gnuplot failed; is it installed, and can the file be "
            "written?\n",
            options.svg.c_str());
    return good && drawn ? EXIT_FINE : EXIT_FAILED;
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
