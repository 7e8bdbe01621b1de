/* jobs.cpp: runs experiments in separate processes, several at a time. */
#include "jobs.hpp"

#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace grrl_experiment
{

namespace
{

constexpr int poll_ms = 100;

volatile std::sig_atomic_t stop = 0;

/* Installs the signal handlers while jobs run. */
class Signals
{
public:
    Signals()
    {
        for (int signal : {SIGINT, SIGTERM, SIGHUP})
            (void)std::signal(
                signal, [](int) { stop = 1; });
    }
    ~Signals() { reset(); }
    Signals(const Signals &) = delete;
    Signals &operator=(const Signals &) = delete;

    static void reset()
    {
        for (int signal : {SIGINT, SIGTERM, SIGHUP})
            (void)std::signal(signal, SIG_DFL);
    }
};

class Workers
{
public:
    explicit Workers(const JobCallbacks &callbacks) : callbacks_(callbacks)
    {
        if (pipe2(ends_, O_CLOEXEC) != 0)
            throw std::runtime_error("cannot create a pipe for the workers");
        (void)fcntl(ends_[0], F_SETFL, O_NONBLOCK);
    }
    ~Workers()
    {
        for (pid_t pid : pids_)
            (void)kill(pid, SIGKILL);
        for (pid_t pid : pids_)
            (void)waitpid(pid, nullptr, 0);
        (void)close(ends_[0]);
        (void)close(ends_[1]);
    }
    Workers(const Workers &) = delete;
    Workers &operator=(const Workers &) = delete;

    size_t running() const { return pids_.size(); }

    void start(size_t task)
    {
        (void)std::fflush(nullptr);
        pid_t parent = getpid();
        pid_t pid = fork();
        if (pid < 0)
            throw std::runtime_error("cannot create a worker process");
        if (pid == 0)
            live(task, parent);
        pids_.push_back(pid);
    }

    /* Waits briefly and processes what has arrived. */
    void read_reports() const
    {
        pollfd ready{ends_[0], POLLIN, 0};
        (void)poll(&ready, 1, poll_ms);
        int pushes[64];
        ssize_t size;
        while ((size = read(ends_[0], pushes, sizeof pushes)) > 0)
            for (size_t i = 0; i < static_cast<size_t>(size) / sizeof pushes[0]; i++)
                callbacks_.on_trial(pushes[i]);
    }

    /* False if a worker that ended had failed. */
    bool reap()
    {
        bool good = true;
        std::vector<pid_t> left;
        for (pid_t pid : pids_) {
            int status = 0;
            if (waitpid(pid, &status, WNOHANG) != pid) {
                left.push_back(pid);
                continue;
            }
            bool fine = WIFEXITED(status) && WEXITSTATUS(status) == 0;
            if (fine)
                callbacks_.on_task();
            else if (WIFSIGNALED(status) && stop == 0)
                (void)std::fprintf(stderr, "grrl-experiment: signal %d ended a worker\n",
                                   WTERMSIG(status));
            good = good && fine;
        }
        pids_ = left;
        return good;
    }

private:
    [[noreturn]] void live(size_t task, pid_t parent) const
    {
        int status = 1;
        Signals::reset();
        (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
        try {
            if (getppid() == parent) {
                /* A report is shorter than an atomic pipe write, so reports of different workers do
                 * not mix. */
                callbacks_.work(task, [this](int pushes) {
                    if (write(ends_[1], &pushes, sizeof pushes) != sizeof pushes)
                        throw std::runtime_error("the parent process is gone");
                });
                status = 0;
            }
        } catch (const std::exception &error) {
            (void)std::fprintf(stderr, "grrl-experiment: %s\n", error.what());
        }
        _exit(status);
    }

    const JobCallbacks &callbacks_;
    int ends_[2];
    std::vector<pid_t> pids_;
};

} // namespace

JobsResult run_jobs(size_t count, int jobs, const JobCallbacks &callbacks)
{
    Signals signals;
    Workers workers(callbacks);
    size_t next = 0;
    bool good = true;
    while (stop == 0 && good && (next < count || workers.running() > 0)) {
        while (next < count && workers.running() < static_cast<size_t>(jobs))
            workers.start(next++);
        workers.read_reports();
        good = workers.reap();
        callbacks.on_tick();
    }
    workers.read_reports();
    if (stop != 0)
        return JobsResult::INTERRUPTED;
    return good ? JobsResult::DONE : JobsResult::FAILED;
}

double workers_cpu_s()
{
    rusage usage{};
    (void)getrusage(RUSAGE_CHILDREN, &usage);
    auto seconds = [](const timeval &t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

} // namespace grrl_experiment
