/* bad_bus_relay URL_SIM URL_AGENT SEED LOSS TWICE LATE: passes the messages of a simulator on one
 * provider to an agent on another and back, and on the way loses, repeats and delays them with
 * these probabilities. Until SIGTERM; then it prints what it did. */
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <poll.h>

#include "bad_bus.hpp"

static volatile std::sig_atomic_t stop = 0;

static int64_t now_us()
{
    using namespace std::chrono;
    return duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count();
}

static void relay(lcm_t *sim, lcm_t *agent, const bad_bus::Faults &faults)
{
    bad_bus::BadBus bus(sim, agent, faults);
    pollfd ready[] = {{lcm_get_fileno(sim), POLLIN, 0}, {lcm_get_fileno(agent), POLLIN, 0}};
    (void)std::puts("ready");
    (void)std::fflush(stdout);
    while (stop == 0) {
        bus.tick(now_us());
        if (poll(ready, 2, 5) <= 0)
            continue;
        if (ready[0].revents != 0)
            (void)lcm_handle(sim);
        if (ready[1].revents != 0)
            (void)lcm_handle(agent);
    }
    const bad_bus::Counts &counts = bus.counts();
    (void)std::printf("%lld passed, %lld lost, %lld twice, %lld late\n",
                      static_cast<long long>(counts.passed), static_cast<long long>(counts.lost),
                      static_cast<long long>(counts.twice), static_cast<long long>(counts.late));
}

int main(int argc, char **argv)
{
    if (argc != 7)
        return 2;
    bad_bus::Faults faults;
    faults.seed = std::strtoull(argv[3], nullptr, 10);
    faults.loss = std::atof(argv[4]);
    faults.twice = std::atof(argv[5]);
    faults.late = std::atof(argv[6]);
    (void)std::signal(SIGTERM, [](int) { stop = 1; });
    lcm_t *sim = lcm_create(argv[1]);
    lcm_t *agent = lcm_create(argv[2]);
    if (sim == nullptr || agent == nullptr)
        return 1;
    relay(sim, agent, faults);
    lcm_destroy(sim);
    lcm_destroy(agent);
    return 0;
}
