/*
 * A bus on which anybody may send anything: agent and simulator run on memq:// while messages seen
 * before come again, changed in some bytes, and raw bytes come on any channel. An input is a row
 * of operations.
 */
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "agent.h"
#include "fuzz.h"
#include "node.hpp"
#include "policy_memory.h"

using namespace grrl_sim;

namespace
{

constexpr uint32_t capacity = 16;
constexpr int max_operations = 64;
constexpr int max_handled = 12;

const char *const channels[] = {GRRL_CHANNEL_POINTS,       GRRL_CHANNEL_TRIAL,
                                GRRL_CHANNEL_PUSH_STATUS,  GRRL_CHANNEL_PUSH_COMMAND,
                                GRRL_CHANNEL_MODEL,        GRRL_CHANNEL_DECISION,
                                GRRL_CHANNEL_AGENT_STATUS, "SOMETHING_ELSE"};

struct Message {
    std::string channel;
    std::vector<uint8_t> data;
};

int64_t clock_us;
std::vector<Message> seen;
POLICY_MEMORY(capacity) memory;

int64_t agent_clock(void *)
{
    return clock_us;
}

void start_agent(grrl_agent &agent, lcm_t *lcm)
{
    grrl_agent_config config{};
    grrl_learner_config_default(&config.learner);
    config.session_id = 1;
    config.now_us = agent_clock;
    REQUIRE(grrl_policy_make(&grrl_policy_learn, memory.bytes, sizeof memory.bytes, capacity,
                             nullptr, &config.policy) == GRRL_OK);
    REQUIRE(grrl_agent_init(&agent, &config, lcm) == GRRL_OK);
}

NodeConfig node_config()
{
    NodeConfig config;
    config.object = *object_from_text("RP").value;
    config.cap = 4;
    config.session_id = 2;
    config.now_us = [] { return clock_us; };
    config.on_message = [](const char *channel, const void *data, uint32_t size) {
        const auto *bytes = static_cast<const uint8_t *>(data);
        seen.push_back({channel, {bytes, bytes + size}});
    };
    return config;
}

void publish(lcm_t *lcm, const std::string &channel, const std::vector<uint8_t> &data)
{
    (void)lcm_publish(lcm, channel.c_str(), data.data(), static_cast<unsigned>(data.size()));
}

/* One that was seen, with up to three bytes changed. */
void send_again(lcm_t *lcm, fuzz_input &input)
{
    if (seen.empty())
        return;
    Message message = seen[seen.size() - 1 - fuzz_byte(&input) % seen.size()];
    for (int n = fuzz_byte(&input) % 4; n > 0; n--) {
        size_t at = static_cast<size_t>(fuzz_byte(&input)) * 256 + fuzz_byte(&input);
        message.data[at % message.data.size()] = fuzz_byte(&input);
    }
    publish(lcm, message.channel, message.data);
}

void send_raw(lcm_t *lcm, fuzz_input &input)
{
    std::string channel = channels[fuzz_byte(&input) % 8];
    std::vector<uint8_t> data(fuzz_byte(&input));
    for (uint8_t &byte : data)
        byte = fuzz_byte(&input);
    publish(lcm, channel, data);
}

} // namespace

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static lcm_t *lcm = lcm_create("memq://");
    static auto agent = std::make_unique<grrl_agent>();
    REQUIRE(lcm != nullptr);
    fuzz_input input = {data, size};
    clock_us = 1000000;
    seen.clear();
    start_agent(*agent, lcm);
    auto node = std::make_unique<Node>(lcm, node_config());
    for (int i = 0; i < max_operations && input.left > 0; i++) {
        switch (fuzz_byte(&input) % 4) {
        case 0:
            clock_us += 5000 * fuzz_byte(&input);
            break;
        case 1:
            send_again(lcm, input);
            break;
        case 2:
            send_raw(lcm, input);
            break;
        default:
            break;
        }
        for (int n = 0; n < max_handled && lcm_handle_timeout(lcm, 0) > 0; n++)
            continue;
        node->tick();
        grrl_agent_tick(agent.get());
    }
    REQUIRE(agent->counts.rejected <= agent->counts.received);
    grrl_agent_close(agent.get());
    node.reset();
    while (lcm_handle_timeout(lcm, 0) > 0)
        continue;
    return 0;
}
