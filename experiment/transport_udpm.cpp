/* transport_udpm.cpp: agent and simulator in two processes over multicast. */
#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "transport.hpp"

namespace grrl_experiment
{

namespace
{

constexpr int poll_ms = 5;
constexpr int64_t silence_timeout_us = 20000000; /* without a message from the other process */
constexpr int64_t exit_timeout_us = 5000000; /* for the simulator to end after its last message */

int64_t now_us()
{
    using namespace std::chrono;
    return duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count();
}

lcm_t *open_lcm(const std::string &url)
{
    lcm_t *lcm = lcm_create(url.c_str());
    if (lcm == nullptr || lcm_get_fileno(lcm) < 0)
        throw std::runtime_error(
            "cannot start LCM; if this machine has no network: ip link set lo up; "
            "ip route add 224.0.0.0/4 dev lo; or use --transport memq");
    return lcm;
}

void simulate(const std::string &url, const Phase &phase, int rows_fd)
{
    lcm_t *lcm = open_lcm(url);
    WorldSide world(lcm, phase, now_us, [rows_fd](const TrialRow &row) {
        if (write(rows_fd, &row, sizeof row) != sizeof row)
            throw std::runtime_error("the result of a trial was lost");
    });
    while (!world.finished()) {
        if (lcm_handle_timeout(lcm, poll_ms) < 0)
            throw std::runtime_error("LCM failed to receive");
        world.tick();
        if (world.agent_silent_us() > silence_timeout_us)
            throw std::runtime_error("the simulator does not hear the agent");
    }
}

/* The simulator as a child process, which ends with this process, however this one ends. */
class Child
{
public:
    Child(const std::string &url, const Phase &phase)
    {
        int ends[2];
        if (pipe(ends) != 0)
            throw std::runtime_error("cannot create a pipe for the simulator");
        (void)std::fflush(nullptr);
        pid_t parent = getpid();
        pid_ = fork();
        if (pid_ == 0)
            live(url, phase, parent, ends[1]);
        (void)close(ends[1]);
        rows_fd_ = ends[0];
        (void)fcntl(rows_fd_, F_SETFL, O_NONBLOCK);
        if (pid_ < 0)
            throw std::runtime_error("cannot create the simulator process");
    }
    ~Child()
    {
        if (pid_ > 0) {
            (void)kill(pid_, SIGKILL);
            (void)waitpid(pid_, nullptr, 0);
        }
        (void)close(rows_fd_);
    }
    Child(const Child &) = delete;
    Child &operator=(const Child &) = delete;

    /* Whether the child has ended; throws if it failed. */
    bool ended()
    {
        int status = 0;
        if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
            pid_ = 0;
            if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
                throw std::runtime_error("the simulator failed");
        }
        return pid_ == 0;
    }

    /* Reads the rows that have arrived. */
    void read_rows(const WorldSide::OnTrial &on_trial) const
    {
        TrialRow row;
        while (read(rows_fd_, &row, sizeof row) == sizeof row)
            on_trial(row);
    }

private:
    [[noreturn]] static void live(const std::string &url, const Phase &phase, pid_t parent,
                                  int rows_fd)
    {
        int status = 1;
        (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
        try {
            if (getppid() == parent) {
                simulate(url, phase, rows_fd);
                status = 0;
            }
        } catch (const std::exception &error) {
            (void)std::fprintf(stderr, "grrl-experiment: %s\n", error.what());
        }
        _exit(status);
    }

    pid_t pid_ = -1;
    int rows_fd_ = -1;
};

/* Concurrent processes have different ids and therefore different ports. */
std::string own_url()
{
    return "udpm://239.255.76.67:" + std::to_string(10000 + getpid() % 22000) + "?ttl=0";
}

} // namespace

Bytes run_over_udpm(const Phase &phase, const Bytes &experience, const WorldSide::OnTrial &on_trial)
{
    std::string url = own_url();
    Child simulator(url, phase);
    lcm_t *lcm = open_lcm(url);
    Bytes bytes;
    {
        AgentSide agent(lcm, phase, now_us, nullptr, experience);
        int64_t finished_us = 0;
        while (!simulator.ended()) {
            if (lcm_handle_timeout(lcm, poll_ms) < 0)
                throw std::runtime_error("LCM failed to receive");
            agent.tick();
            simulator.read_rows(on_trial);
            if (agent.finished() && finished_us == 0)
                finished_us = now_us();
            if (finished_us > 0 && now_us() - finished_us > exit_timeout_us)
                throw std::runtime_error("the simulator does not end");
        }
        bytes = agent.experience();
    }
    lcm_destroy(lcm);
    simulator.read_rows(on_trial);
    return bytes;
}

} // namespace grrl_experiment
