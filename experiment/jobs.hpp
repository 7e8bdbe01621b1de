/*
 * jobs.hpp: tasks in worker processes, several at a time.
 *
 * A worker is a fork: LCM's threads, a crash, a signal stay its own, and it ends with its parent
 * whatever happens to that. Results are files; what comes back here is progress.
 */
#ifndef GRRL_EXPERIMENT_JOBS_HPP
#define GRRL_EXPERIMENT_JOBS_HPP

#include <cstddef>
#include <functional>

namespace grrl_experiment
{

/* Called in a worker after each trial. */
using Report = std::function<void(int pushes)>;

struct JobCallbacks {
    /* In a worker; throws std::exception. */
    std::function<void(size_t task, const Report &report)> work;
    std::function<void(int pushes)> on_trial;
    std::function<void()> on_task;
    std::function<void()> on_tick; /* at least five times a second */
};

enum class JobsResult { DONE, FAILED, INTERRUPTED };

/* Runs tasks 0 .. count - 1. Stops at the first failure and by SIGINT, SIGTERM or SIGHUP. */
JobsResult run_jobs(size_t count, int jobs, const JobCallbacks &callbacks);

/* CPU time of all workers that have ended, seconds. */
double workers_cpu_s();

} // namespace grrl_experiment

#endif
