/*
 * grrl-evaluate: how good perception is, measured.
 *
 * Exit status: 0 fine, 1 trouble, 2 wrong command line.
 */
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>
#include <unistd.h>

#include "figures.hpp"
#include "objects.hpp"
#include "options.hpp"

using namespace grrl_evaluate;

namespace
{

enum { EXIT_FINE = 0, EXIT_TROUBLE = 1, EXIT_USAGE = 2 };

/* How far a run is, on standard error. */
class Progress
{
public:
    Progress(size_t trials, bool quiet) : trials_(trials), quiet_(quiet) {}

    void trial_done()
    {
        std::lock_guard<std::mutex> lock(mutex_);
        done_++;
        double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
        if (quiet_ || (seconds - shown_ < (terminal_ ? 1.0 : 20.0) && done_ != trials_))
            return;
        shown_ = seconds;
        double left = seconds / static_cast<double>(done_) * static_cast<double>(trials_ - done_);
        (void)std::fprintf(stderr, "%s%zu of %zu trials, %.0f s, about %.0f s left   %s",
                           terminal_ ? "\r" : "", done_, trials_, seconds, left,
                           terminal_ && done_ != trials_ ? "" : "\n");
        (void)std::fflush(stderr);
    }

private:
    using Clock = std::chrono::steady_clock;
    size_t trials_;
    bool quiet_;
    bool terminal_ = isatty(STDERR_FILENO) != 0; /* one line that changes, not many */
    std::mutex mutex_;
    size_t done_ = 0;
    double shown_ = 0.0;
    Clock::time_point start_ = Clock::now();
};

/* All trials of all groups, by as many threads as there are jobs; a trial depends on its seed
 * alone. */
void run_all(const std::vector<NamedObject> &objects, const Options &options,
             std::vector<Group> &groups)
{
    size_t trials = static_cast<size_t>(options.trials);
    Progress progress(groups.size() * trials, options.quiet);
    std::atomic<size_t> next{0};
    auto work = [&] {
        for (size_t i = next++; i < groups.size() * trials; i = next++) {
            Group &group = groups[i / trials];
            TrialParams params = options.trial;
            params.world.tracker.noise_sigma_m *= group.noise;
            group.trials[i % trials] = run_trial(objects[i / trials % objects.size()].spec, params,
                                                 options.seed + i % trials);
            progress.trial_done();
        }
    };
    std::vector<std::thread> threads;
    for (int i = 1; i < options.jobs; i++)
        threads.emplace_back(work);
    work();
    for (std::thread &thread : threads)
        thread.join();
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
    std::string problem = options.svg.empty() ? "" : draw_svg(options.svg, groups);
    if (!problem.empty())
        (void)std::fprintf(stderr, "grrl-evaluate: %s\n", problem.c_str());
    return good && problem.empty() ? EXIT_FINE : EXIT_TROUBLE;
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    OptionsResult parsed = parse_options(argc, argv, options);
    if (parsed != OptionsResult::RUN)
        return parsed == OptionsResult::DONE ? EXIT_FINE : EXIT_USAGE;
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
