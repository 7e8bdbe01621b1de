/*
 * jobs.hpp: runs tasks in worker processes, several at a time.
 *
 * A worker is a fork, which isolates LCM's threads, crashes and signals. It ends with its parent,
 * however the parent ends. Results are files; only progress comes back here.
 */
#ifndef GRRL_EXPERIMENT_JOBS_HPP
#define GRRL_EXPERIMENT_JOBS_HPP

#include <cstddef>
#include <functional>

namespace grrl_experiment
{

/* A worker calls it after each trial. */
using Report = std::function<void(int pushes)>;

struct JobCallbacks {
    /* Runs in a worker; may throw std::exception. */
    std::function<void(size_t task, const Report &report)> work;
    std::function<void(int pushes)> on_trial;
    std::function<void()> on_task;
    std::function<void()> on_tick; /* at least five times a second */
};

enum class JobsResult { DONE, FAILED, INTERRUPTED };

/* Runs tasks 0 .. count - 1. Stops at the first failure and on SIGINT, SIGTERM or SIGHUP. */
JobsResult run_jobs(size_t count, int jobs, const JobCallbacks &callbacks);

/* CPU time of all workers that have ended, seconds. */
double workers_cpu_s();

} // namespace grrl_experiment

#endif
