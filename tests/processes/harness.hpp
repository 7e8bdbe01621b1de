/* harness.hpp: agents and simulators in one process, each side on a memq:// of its own with a bus
 * between that may be a bad one, on a clock of the test. */
#ifndef GRRL_TESTS_HARNESS_HPP
#define GRRL_TESTS_HARNESS_HPP

#include <algorithm>
#include <csetjmp>
#include <cstdarg>
#include <cstdint>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

extern "C" {
#include <cmocka.h>
}

#include "agent.h"
#include "bad_bus.hpp"
#include "grrl/learner/relational_q/experience.h"
#include "node.hpp"
#include "policy_memory.h"

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
    bad_bus::Counts bus;
    std::string notes;     /* of all agents and simulators */
    int rival_lessons = 0; /* of the second agent */
    bool blind = false;    /* the simulator gave up */
    int64_t frozen_us = 0; /* how long a peer stood still while the others had nothing to do */
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
    size_t freeze_agent_at = 0; /* for freeze_us */
    size_t freeze_node_at = 0;
    int64_t freeze_us = 3000000;
    size_t second_agent_at = 0; /* joins; 1: with the first push */
    size_t second_node_at = 0;
    size_t stop_agent_at = 0; /* the first one, for good */
    double dropout = 0.0;     /* of tracked points */
    bad_bus::Faults faults;
    const grrl_policy_type *policy = &grrl_policy_learn;
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

/* An agent with its memory. */
struct AgentHost {
    class Run *run = nullptr;
    grrl_agent agent;
    POLICY_MEMORY(capacity) policy;
};

class Run
{
public:
    explicit Run(const Setup &setup)
        : setup_(setup), lcm_(lcm_create("memq://")), agent_lcm_(lcm_create("memq://"))
    {
        assert_non_null(lcm_);
        assert_non_null(agent_lcm_);
        clock_us = 1000000;
        grrl_random_init(&random_, 99, 0);
        bus_ = std::make_unique<bad_bus::BadBus>(lcm_, agent_lcm_, setup.faults);
        agent_ = start_agent();
        node_ = start_node();
    }
    ~Run()
    {
        stop(agent_);
        stop(rival_);
        node_.reset();
        rival_node_.reset();
        bus_.reset();
        lcm_destroy(lcm_);
        lcm_destroy(agent_lcm_);
    }

    Outcome finish()
    {
        int idle = 0;
        for (int64_t step = 0; !node_->finished() && !node_->agent_has_nothing_to_push(); step++) {
            assert_true(step < 5000000);
            idle = handle() ? 0 : idle + 1;
            /* Time passes only when there is nothing to do: the machine is infinitely fast. */
            if (idle > 0) {
                bool stands = frozen(setup_.freeze_agent_at) || frozen(setup_.freeze_node_at);
                outcome_.frozen_us += stands ? 5000 : 0;
                clock_us += 5000;
            }
            tick();
            if (step % 7 == 0)
                disturb();
            restart();
        }
        AgentHost *last = agent_ != nullptr ? agent_.get() : rival_.get();
        grrl_io io = {&outcome_.experiences, append, nullptr};
        if (setup_.policy->save != nullptr)
            assert_int_equal(grrl_learner_save(&last->agent.learner, &io), GRRL_OK);
        outcome_.agent_repeated = last->agent.counts.repeated;
        outcome_.agent_foreign = last->agent.counts.foreign;
        outcome_.agent_rejected = last->agent.counts.rejected;
        outcome_.sim_rejected = node_->rejected();
        outcome_.bus = bus_->counts();
        outcome_.blind = node_->agent_has_nothing_to_push();
        return outcome_;
    }

    const std::vector<Message> &messages() const { return seen_; }

private:
    /* What a push is known by everywhere. */
    struct Push {
        int64_t agent_session;
        int32_t trial_id;
        int32_t cmd_seq;
        bool operator<(const Push &o) const
        {
            return std::tie(agent_session, trial_id, cmd_seq) <
                   std::tie(o.agent_session, o.trial_id, o.cmd_seq);
        }
    };

    std::unique_ptr<AgentHost> start_agent()
    {
        auto host = std::make_unique<AgentHost>();
        host->run = this;
        grrl_agent_config config{};
        grrl_learner_config_default(&config.learner);
        config.learner.seed = setup_.seed;
        config.session_id = agent_session_++;
        config.now_us = agent_clock;
        config.on_event = on_event;
        config.context = host.get();
        assert_int_equal(grrl_policy_make(setup_.policy, host->policy.bytes,
                                          sizeof host->policy.bytes, capacity, nullptr,
                                          &config.policy),
                         GRRL_OK);
        assert_int_equal(grrl_agent_init(&host->agent, &config, agent_lcm_), GRRL_OK);
        return host;
    }

    static void stop(std::unique_ptr<AgentHost> &host)
    {
        if (host != nullptr)
            grrl_agent_close(&host->agent);
        host.reset();
    }

    static void on_event(void *context, const grrl_agent_event *event)
    {
        auto *host = static_cast<AgentHost *>(context);
        Run *run = host->run;
        if (event->kind == GRRL_AGENT_NOTE)
            run->outcome_.notes += std::string(event->text) + "\n";
        if (event->kind != GRRL_AGENT_LEARNED)
            return;
        /* No reward without the own action, carried out: whatever the bus does. */
        Push push = {host->agent.config.session_id, event->trial_id, event->pushes};
        assert_int_equal(run->carried_out_.count(push), 1);
        run->outcome_.rival_lessons += host == run->rival_.get();
    }

    std::unique_ptr<Node> start_node()
    {
        NodeConfig config;
        config.object = *object_from_text(setup_.object).value;
        config.world.tracker.dropout_probability = setup_.dropout;
        config.seed = setup_.seed;
        config.trials = setup_.trials;
        config.cap = setup_.cap;
        config.real_time = setup_.real_time;
        config.session_id = sim_session_++;
        config.now_us = [] { return clock_us; };
        config.on_note = [this](const std::string &text) { outcome_.notes += text + "\n"; };
        config.on_trial = [this](const TrialResult &r) {
            if (r.outcome == GRRL_TRIAL_T_ABORTED)
                outcome_.aborted++;
            else
                outcome_.trials.push_back(r.pushes);
        };
        config.on_message = [this](const char *channel, const void *data, uint32_t size) {
            take(channel, data, size);
        };
        return std::make_unique<Node>(lcm_, std::move(config));
    }

    bool frozen(size_t at) const
    {
        return at > 0 && outcome_.pushes.size() >= at && clock_us < frozen_until_us_;
    }

    /* Whether there was anything to do. */
    bool handle()
    {
        bool any = false;
        if (!frozen(setup_.freeze_node_at))
            any = lcm_handle_timeout(lcm_, 0) > 0;
        if (!frozen(setup_.freeze_agent_at))
            any = lcm_handle_timeout(agent_lcm_, 0) > 0 || any;
        return any;
    }

    void tick()
    {
        bus_->tick(clock_us);
        if (!frozen(setup_.freeze_node_at))
            node_->tick();
        if (rival_node_ != nullptr)
            rival_node_->tick();
        if (agent_ != nullptr && !frozen(setup_.freeze_agent_at))
            grrl_agent_tick(&agent_->agent);
        if (rival_ != nullptr)
            grrl_agent_tick(&rival_->agent);
    }

    void take(const char *channel, const void *data, uint32_t size)
    {
        const auto *bytes = static_cast<const uint8_t *>(data);
        seen_.push_back({channel, {bytes, bytes + size}});
        grrl_wire_why why;
        grrl_push_status_t s;
        if (seen_.back().channel == GRRL_CHANNEL_PUSH_STATUS &&
            grrl_wire_decode_push_status(data, size, &s, &why))
            carried_out_.insert({s.agent_session_id, s.trial_id, s.cmd_seq});
        grrl_push_command_t c;
        if (seen_.back().channel != GRRL_CHANNEL_PUSH_COMMAND ||
            !grrl_wire_decode_push_command(data, size, &c, &why) ||
            c.kind != GRRL_PUSH_COMMAND_T_PUSH || agent_ == nullptr ||
            c.session_id != agent_->agent.config.session_id)
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

    /* To whom the message was. */
    void send(const Message &message)
    {
        bool to_agent = message.channel == GRRL_CHANNEL_POINTS ||
                        message.channel == GRRL_CHANNEL_TRIAL ||
                        message.channel == GRRL_CHANNEL_PUSH_STATUS;
        assert_int_equal(lcm_publish(to_agent ? agent_lcm_ : lcm_, message.channel.c_str(),
                                     message.data.data(),
                                     static_cast<unsigned>(message.data.size())),
                         0);
    }

    /* Whether it is time, once. */
    bool reached(size_t &at)
    {
        if (at == 0 || outcome_.pushes.size() < at)
            return false;
        at = 0;
        return true;
    }

    /* As kill -9 and a fresh start: the experiences of the agent are gone, too. */
    void restart()
    {
        if (frozen_until_us_ == 0 &&
            outcome_.pushes.size() >= std::max<size_t>(1, setup_.freeze_agent_at) &&
            outcome_.pushes.size() >= setup_.freeze_node_at)
            frozen_until_us_ = clock_us + setup_.freeze_us;
        if (reached(setup_.restart_agent_at)) {
            stop(agent_);
            agent_ = start_agent();
        }
        if (reached(setup_.restart_node_at)) {
            node_.reset();
            node_ = start_node();
        }
        if (reached(setup_.second_agent_at))
            rival_ = start_agent();
        if (reached(setup_.second_node_at))
            rival_node_ = start_node();
        if (reached(setup_.stop_agent_at))
            stop(agent_);
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
            size_t session_at = 16 + 3; /* one cut before is among those seen, too */
            if (grrl_random_below(&random_, 2) == 0 && forged.data.size() > session_at)
                forged.data[session_at] ^= 0x5a;
            else if (!forged.data.empty())
                forged.data.resize(
                    grrl_random_below(&random_, static_cast<uint32_t>(forged.data.size())));
            send(forged);
        }
    }

    Setup setup_;
    lcm_t *lcm_;
    lcm_t *agent_lcm_;
    int64_t agent_session_ = agent_session;
    int64_t sim_session_ = sim_session;
    std::unique_ptr<bad_bus::BadBus> bus_;
    std::unique_ptr<AgentHost> agent_;
    std::unique_ptr<AgentHost> rival_;
    std::unique_ptr<Node> node_;
    std::unique_ptr<Node> rival_node_;
    int64_t frozen_until_us_ = 0;
    std::set<Push> carried_out_;
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
