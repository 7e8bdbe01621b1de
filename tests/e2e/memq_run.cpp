/* memq_run OBJECT TRIALS SEED STORE: agent and simulator in one process over memq://, with the
 * defaults of grrl-agent and grrl-sim. What these two write over a network must be the same. */
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "agent.h"
#include "node.hpp"
#include "policy_memory.h"
#include "store_file.h"

using namespace grrl_sim;

static int64_t now_us()
{
    using namespace std::chrono;
    return duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count();
}

static int64_t agent_clock(void *)
{
    return now_us();
}

int main(int argc, char **argv)
{
    if (argc != 5)
        return 2;
    Result<ObjectSpec> object = object_from_text(argv[1]);
    lcm_t *lcm = lcm_create("memq://");
    if (!object || lcm == nullptr)
        return 1;
    static POLICY_MEMORY(1000) memory;
    auto agent = std::make_unique<grrl_agent>();
    grrl_agent_config agent_config{};
    grrl_learner_config_default(&agent_config.learner);
    agent_config.learner.seed = std::strtoull(argv[3], nullptr, 10);
    agent_config.session_id = 1;
    agent_config.now_us = agent_clock;
    if (grrl_policy_make(&grrl_policy_learn, memory.bytes, sizeof memory.bytes, 1000, nullptr,
                         &agent_config.policy) != GRRL_OK ||
        grrl_agent_init(agent.get(), &agent_config, lcm) != GRRL_OK)
        return 1;
    NodeConfig config;
    config.object = *object.value;
    config.trials = std::atoi(argv[2]);
    config.seed = std::strtoull(argv[3], nullptr, 10);
    config.now_us = now_us;
    int64_t start = now_us();
    {
        Node node(lcm, std::move(config));
        while (!node.finished() && lcm_handle_timeout(lcm, 5) >= 0) {
            node.tick();
            grrl_agent_tick(agent.get());
        }
        (void)std::printf("%lld frames in %.2f s\n", static_cast<long long>(node.frames()),
                          static_cast<double>(now_us() - start) * 1e-6);
    }
    grrl_agent_close(agent.get());
    grrl_store_report report;
    bool saved = grrl_store_file_save(&grrl_file_calls_posix, argv[4], &agent->learner, &report);
    lcm_destroy(lcm);
    return saved ? 0 : 1;
}
