/* grrl-experiment: plans the experiments, runs them in workers, and presents the results. */
#include <cstdio>
#include <exception>
#include <sstream>
#include <stdexcept>

#include <unistd.h>

#include "claims.hpp"
#include "files.hpp"
#include "folder.hpp"
#include "jobs.hpp"
#include "options.hpp"
#include "pictures.hpp"
#include "plan.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "results.hpp"

using namespace grrl_experiment;

namespace
{

struct Task {
    size_t curve;
    uint64_t seed; /* of the experiment */
};

/* In a worker: runs one experiment, from its first memory to its file. */
void experiment(const Options &options, const Curve &curve, const Task &task, const Folder &folder,
                const Report &report)
{
    Phase phase;
    phase.policy = curve.policy;
    phase.cap = options.cap;
    phase.world = curve.conditions.world;
    Bytes experience = curve.experience ? *curve.experience : Bytes{};
    uint64_t seed = task.seed;
    for (const Course &course : curve.before) {
        phase.objects = course.objects;
        phase.trials = course.trials;
        phase.seed = seed = pretrain_seed(seed);
        experience = run_phase(options.transport, phase, experience,
                               [&](const TrialRow &row) { report(row.pushes); });
    }
    phase.objects = curve.course.objects;
    phase.trials = curve.trials();
    phase.seed = task.seed;
    Trials trials;
    experience = run_phase(options.transport, phase, experience, [&](const TrialRow &row) {
        trials.push_back(row);
        report(row.pushes);
    });
    if (static_cast<int>(trials.size()) != curve.trials())
        throw std::runtime_error("trials are missing");
    if (!experience.empty())
        folder.save_store(curve, task.seed, experience);
    folder.save(curve, task.seed, trials);
}

/* The experiments of this shard; each shard has some of every curve. Curves take turns, so that the
 * remaining time can be estimated from what is done. */
std::vector<Task> tasks_of(const Options &options, const Plan &plan)
{
    std::vector<uint64_t> seeds = experiment_seeds(options);
    std::vector<Task> tasks;
    for (size_t e = 0; e < seeds.size(); e++)
        for (size_t c = 0; c < plan.curves.size(); c++)
            if ((c * seeds.size() + e) % static_cast<size_t>(options.shards) + 1 ==
                static_cast<size_t>(options.shard))
                tasks.push_back({c, seeds[e]});
    return tasks;
}

int jobs_of(const Options &options)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return options.jobs > 0 ? options.jobs : static_cast<int>(cores > 0 ? cores : 1);
}

JobsResult run_tasks(const Options &options, const Plan &plan, const Folder &folder)
{
    std::vector<Task> tasks;
    size_t all = 0;
    for (const Task &task : tasks_of(options, plan)) {
        all++;
        if (!folder.load(plan.curves[task.curve], task.seed))
            tasks.push_back(task);
    }
    int64_t trials = 0;
    for (const Task &task : tasks)
        trials += plan.curves[task.curve].all_trials();
    if (tasks.size() < all)
        (void)std::fprintf(stderr, "grrl-experiment: %zu of %zu experiments are already done\n",
                           all - tasks.size(), all);
    if (tasks.empty())
        return JobsResult::DONE;
    Progress progress(trials, static_cast<int64_t>(tasks.size()), "experiments");
    JobCallbacks callbacks;
    callbacks.work = [&](size_t i, const Report &report) {
        experiment(options, plan.curves[tasks[i].curve], tasks[i], folder, report);
    };
    callbacks.on_trial = [&progress](int pushes) { progress.trial(pushes); };
    callbacks.on_task = [&progress] { progress.part(); };
    callbacks.on_tick = [&progress] { progress.show(); };
    JobsResult result = run_jobs(tasks.size(), jobs_of(options), callbacks);
    progress.finish();
    if (result == JobsResult::DONE)
        (void)std::fprintf(stderr,
                           "grrl-experiment: %lld pushes in %.1f s, %.0f a second of CPU time\n",
                           static_cast<long long>(progress.pushes()), progress.elapsed_s(),
                           static_cast<double>(progress.pushes()) / workers_cpu_s());
    return result;
}

void publish(const Options &options, const Plan &plan, const Folder &folder)
{
    std::vector<Experiments> results(plan.curves.size());
    for (size_t c = 0; c < plan.curves.size(); c++)
        for (uint64_t seed : experiment_seeds(options)) {
            std::optional<Trials> trials = folder.load(plan.curves[c], seed);
            if (!trials)
                throw std::runtime_error("the results of an experiment have disappeared");
            results[c].push_back(*trials);
        }
    write_file(folder.path("trials.csv"), trials_csv(plan, results, experiment_seeds(options)));
    write_file(folder.path("summary.csv"), summary_csv(plan, results));
    std::string objects = objects_csv(plan, experiment_seeds(options));
    if (!objects.empty())
        write_file(folder.path("objects.csv"), objects);
    std::string claims = claims_table(plan, results);
    if (!claims.empty())
        write_file(folder.path("claims.txt"), claims);
    bool drawn = true;
    for (const Figure &figure : plan.figures) {
        drawn = (!figure.drawn || draw(folder, plan, figure, results)) && drawn;
        (void)std::printf("%s\n", text_table(plan, figure, results).c_str());
    }
    if (!drawn)
        (void)std::fprintf(stderr, "grrl-experiment: no pictures: gnuplot (with pngcairo) is "
                                   "missing or failed; run it on the .gp files\n");
    if (!claims.empty())
        (void)std::printf("%s\n", claims.c_str());
    write_file(folder.path("report.html"), report_html(options, folder, plan, results));
    (void)std::printf("%s\n", folder.path("report.html").c_str());
}

int run(const Options &options, const Plan &plan)
{
    Folder folder(options);
    switch (run_tasks(options, plan, folder)) {
    case JobsResult::FAILED:
        return 1;
    case JobsResult::INTERRUPTED:
        (void)std::fprintf(stderr,
                           "grrl-experiment: interrupted; run the same command to resume\n");
        return 130;
    case JobsResult::DONE:
        break;
    }
    if (options.shards == 1)
        publish(options, plan, folder);
    return 0;
}

/* The options of the first part, which all others share. */
grrl_options_result options_of_parts(Options &options)
{
    const std::string first = options.merge[0] + "/" + arguments_file;
    std::optional<std::string> text = read_file(first);
    if (!text)
        throw std::runtime_error(first + ": cannot be read; name the folders of all parts");
    std::istringstream lines(*text);
    std::vector<std::string> words{"grrl-experiment", "--out", options.out};
    for (std::string line; std::getline(lines, line);)
        words.push_back(line);
    std::vector<char *> argv;
    for (std::string &word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    return parse_options(static_cast<int>(words.size()), argv.data(), options);
}

int merge(const Options &options, const Plan &plan)
{
    Folder folder(options);
    for (const std::string &part : options.merge)
        folder.take(part);
    int missing = 0;
    std::string first;
    for (const Task &task : tasks_of(options, plan)) {
        const Curve &curve = plan.curves[task.curve];
        if (!folder.load(curve, task.seed) && missing++ == 0)
            first = curve_label(curve, true) + " with seed " + std::to_string(task.seed);
    }
    if (missing > 0)
        throw std::runtime_error(std::to_string(missing) +
                                 " experiments are missing in these parts, such as " + first);
    publish(options, plan, folder);
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    grrl_options_result parsed = parse_options(argc, argv, options);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    try {
        if (!options.merge.empty())
            parsed = options_of_parts(options);
        if (parsed != GRRL_OPTIONS_RUN)
            return parsed;
        grrl_sim::Result<Plan> plan = make_plan(options);
        if (!plan) {
            (void)std::fprintf(stderr, "grrl-experiment: %s\n", plan.error.c_str());
            return 2;
        }
        return options.merge.empty() ? run(options, *plan.value) : merge(options, *plan.value);
    } catch (const std::exception &error) {
        (void)std::fprintf(stderr, "grrl-experiment: %s\n", error.what());
        return 1;
    }
}
