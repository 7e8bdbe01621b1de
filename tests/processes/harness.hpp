/* harness.hpp: agent and simulator in one process over memq://, on a clock of the test. */
#ifndef GRRL_TESTS_HARNESS_HPP
#define GRRL_TESTS_HARNESS_HPP

#include <csetjmp>
#include <cstdarg>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "node.hpp"

/* A struct and a function of the library share the name grrl_canonical: fine in C. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
extern "C" {
#include <cmocka.h>

#include "agent.h"
#include "grrl/experience.h"
}
#pragma GCC diagnostic pop

namespace harness
{

using namespace grrl_sim;

constexpr int64_t agent_session = 4711;
constexpr int64_t sim_session = 815;
constexpr uint16_t capacity = 500;

struct Message {
    std::string channel;
    std::vector<uint8_t> data;
};

/* All that must not depend on how messages travel. */
struct Outcome {
    std::vector<std::vector<float>> pushes; /* as carried out */
    std::vector<int> trials;                /* pushes of each */
    std::vector<uint8_t> experiences;
    int aborted = 0; /* trials, not in the list above */
    int64_t agent_repeated = 0;
    int64_t agent_foreign = 0;
    int64_t agent_rejected = 0;
    int64_t sim_rejected = 0;
};

struct Setup {
    const char *object = "RR";
    uint64_t seed = 1;
    int trials = 3;
    int cap = 100;
    bool real_time = false;
    bool old_messages = false;    /* earlier messages come again */
    bool forged_messages = false; /* foreign and malformed ones come between */
    size_t restart_agent_at = 0;  /* once so many pushes were commanded; 0: never */
    size_t restart_node_at = 0;
    enum grrl_status (*choose)(void *, grrl_learner *, grrl_decision *) = nullptr;
};

inline int64_t clock_us;

inline int64_t agent_clock(void *)
{
    return clock_us;
}

inline int append(void *context, const void *bytes, size_t size)
{
    auto *to = static_cast<std::vector<uint8_t> *>(context);
    const auto *from = static_cast<const uint8_t *>(bytes);
    to->insert(to->end(), from, from + size);
    return 0;
}

class Run
{
public:
    explicit Run(const Setup &setup) : setup_(setup), lcm_(lcm_create("memq://"))
    {
        assert_non_null(lcm_);
        clock_us = 1000000;
        grrl_random_init(&random_, 99, 0);
        start_agent();
        start_node();
    }
    ~Run()
    {
        grrl_agent_close(agent_.get());
        node_.reset();
        lcm_destroy(lcm_);
    }

    Outcome finish()
    {
        int idle = 0;
        for (int64_t step = 0; !node_->finished(); step++) {
            assert_true(step < 5000000);
            idle = lcm_handle_timeout(lcm_, 0) > 0 ? 0 : idle + 1;
            /* Time passes only when there is nothing to do: the machine is infinitely fast. */
            if (idle > 0)
                clock_us += 5000;
            node_->tick();
            grrl_agent_tick(agent_.get());
            if (step % 7 == 0)
                disturb();
            restart();
        }
        grrl_experience_io io = {&outcome_.experiences, append, nullptr};
        assert_int_equal(grrl_learner_save(&agent_->learner, &io), GRRL_OK);
        outcome_.agent_repeated = agent_->counts.repeated;
        outcome_.agent_foreign = agent_->counts.foreign;
        outcome_.agent_rejected = agent_->counts.rejected;
        outcome_.sim_rejected = node_->rejected();
        return outcome_;
    }

    const std::vector<Message> &messages() const { return seen_; }

private:
    void start_agent()
    {
        agent_ = std::make_unique<grrl_agent>();
        cases_.resize(capacity);
        states_.resize(capacity);
        experiences_.resize(capacity);
        grrl_agent_config config{};
        grrl_learner_config_default(&config.learner);
        config.learner.seed = setup_.seed;
        config.session_id = agent_session_;
        config.now_us = agent_clock;
        config.choose = setup_.choose;
        config.memory = {cases_.data(),       capacity, states_.data(), capacity,
                         experiences_.data(), capacity};
        assert_int_equal(grrl_agent_init(agent_.get(), &config, lcm_), GRRL_OK);
    }

    void start_node()
    {
        NodeConfig config;
        config.object = *object_from_text(setup_.object).value;
        config.seed = setup_.seed;
        config.trials = setup_.trials;
        config.cap = setup_.cap;
        config.real_time = setup_.real_time;
        config.session_id = sim_session_;
        config.now_us = [] { return clock_us; };
        config.on_trial = [this](const TrialResult &r) {
            if (r.outcome == GRRL_TRIAL_T_ABORTED)
                outcome_.aborted++;
            else
                outcome_.trials.push_back(r.pushes);
        };
        config.on_message = [this](const char *channel, const void *data, uint32_t size) {
            take(channel, data, size);
        };
        node_ = std::make_unique<Node>(lcm_, std::move(config));
    }

    void take(const char *channel, const void *data, uint32_t size)
    {
        const auto *bytes = static_cast<const uint8_t *>(data);
        seen_.push_back({channel, {bytes, bytes + size}});
        grrl_push_command_t c;
        grrl_wire_why why;
        if (seen_.back().channel != GRRL_CHANNEL_PUSH_COMMAND ||
            !grrl_wire_decode_push_command(data, size, &c, &why) ||
            c.kind != GRRL_PUSH_COMMAND_T_PUSH || c.session_id != agent_session_)
            return;
        std::vector<float> push = {static_cast<float>(c.trial_id),
                                   static_cast<float>(c.cmd_seq),
                                   c.start[0],
                                   c.start[1],
                                   c.end[0],
                                   c.end[1]};
        bool again = false;
        for (const auto &known : outcome_.pushes)
            again = again || known == push;
        if (!again)
            outcome_.pushes.push_back(push);
    }

    void send(const Message &message)
    {
        assert_int_equal(lcm_publish(lcm_, message.channel.c_str(), message.data.data(),
                                     static_cast<unsigned>(message.data.size())),
                         0);
    }

    /* As kill -9 and a fresh start: the experiences of the agent are gone, too. */
    void restart()
    {
        if (setup_.restart_agent_at > 0 && outcome_.pushes.size() >= setup_.restart_agent_at) {
            setup_.restart_agent_at = 0;
            grrl_agent_close(agent_.get());
            agent_session_++;
            start_agent();
        }
        if (setup_.restart_node_at > 0 && outcome_.pushes.size() >= setup_.restart_node_at) {
            setup_.restart_node_at = 0;
            node_.reset();
            sim_session_++;
            start_node();
        }
    }

    void disturb()
    {
        if (seen_.empty())
            return;
        if (setup_.old_messages)
            send(seen_[grrl_random_below(&random_, static_cast<uint32_t>(seen_.size()))]);
        if (setup_.forged_messages) {
            Message forged =
                seen_[grrl_random_below(&random_, static_cast<uint32_t>(seen_.size()))];
            if (grrl_random_below(&random_, 2) == 0)
                forged.data[16 + 3] ^= 0x5a; /* another session */
            else
                forged.data.resize(
                    grrl_random_below(&random_, static_cast<uint32_t>(forged.data.size())));
            send(forged);
        }
    }

    Setup setup_;
    lcm_t *lcm_;
    int64_t agent_session_ = agent_session;
    int64_t sim_session_ = sim_session;
    std::unique_ptr<grrl_agent> agent_;
    std::vector<grrl_case> cases_;
    std::vector<grrl_experience_state> states_;
    std::vector<grrl_experience> experiences_;
    std::unique_ptr<Node> node_;
    std::vector<Message> seen_;
    grrl_random random_{};
    Outcome outcome_;
};

inline Outcome run(const Setup &setup)
{
    return Run(setup).finish();
}

inline void assert_same(const Outcome &a, const Outcome &b)
{
    assert_true(a.trials == b.trials);
    assert_true(a.pushes == b.pushes);
    assert_true(a.experiences == b.experiences);
}

} // namespace harness

#endif
