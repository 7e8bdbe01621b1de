/* transport_memq.cpp: agent and simulator in one process. */
#include <stdexcept>

#include "transport.hpp"

namespace grrl_experiment
{

namespace
{

struct Lcm {
    lcm_t *lcm = lcm_create("memq://");
    ~Lcm()
    {
        if (lcm != nullptr)
            lcm_destroy(lcm);
    }
};

} // namespace

Bytes run_over_memq(const Phase &phase, const Bytes &experience, const WorldSide::OnTrial &on_trial)
{
    /* Time advances only when there is nothing to do, so no message is resent, however slow the
     * machine. */
    int64_t now_us = 1000000;
    Clock clock = [&now_us] { return now_us; };
    Lcm wire;
    if (wire.lcm == nullptr)
        throw std::runtime_error("LCM has no memq:// provider");
    WorldSide world(wire.lcm, phase, clock, on_trial);
    AgentSide agent(wire.lcm, phase, clock, &world.node(), experience);
    while (!world.finished()) {
        int handled = lcm_handle_timeout(wire.lcm, 0);
        if (handled < 0)
            throw std::runtime_error("LCM failed to receive");
        if (handled == 0) {
            now_us += 5000;
            world.tick();
            agent.tick();
        }
    }
    return agent.experience();
}

} // namespace grrl_experiment
