/* Agent and simulator in one process over memq://, on a clock of the test: what a seed gives, and
 * what repeated, old, foreign and malformed messages must not change. */
#include <csetjmp>
#include <cstdarg>
#include <cstdint>
#include <cstring>
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

using namespace grrl_sim;

namespace
{

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
};

int64_t clock_us;

int64_t agent_clock(void *)
{
    return clock_us;
}

int append(void *context, const void *bytes, size_t size)
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
        }
        grrl_experience_io io = {&outcome_.experiences, append, nullptr};
        assert_int_equal(grrl_experience_save(&agent_->learner.store, &io), GRRL_OK);
        outcome_.agent_repeated = agent_->counts.repeated;
        outcome_.agent_foreign = agent_->counts.foreign;
        outcome_.agent_rejected = agent_->counts.rejected;
        outcome_.sim_rejected = node_->rejected();
        return outcome_;
    }

private:
    void start_agent()
    {
        agent_ = std::make_unique<grrl_agent>();
        states_.resize(capacity);
        experiences_.resize(capacity);
        grrl_agent_config config{};
        grrl_learner_config_default(&config.learner);
        config.learner.seed = setup_.seed;
        config.session_id = agent_session;
        config.now_us = agent_clock;
        config.states = states_.data();
        config.states_capacity = capacity;
        config.experiences = experiences_.data();
        config.experiences_capacity = capacity;
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
        config.session_id = sim_session;
        config.now_us = [] { return clock_us; };
        config.on_trial = [this](const TrialResult &r) { outcome_.trials.push_back(r.pushes); };
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
            c.kind != GRRL_PUSH_COMMAND_T_PUSH || c.session_id != agent_session)
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
    std::unique_ptr<grrl_agent> agent_;
    std::vector<grrl_experience_state> states_;
    std::vector<grrl_experience> experiences_;
    std::unique_ptr<Node> node_;
    std::vector<Message> seen_;
    grrl_random random_{};
    Outcome outcome_;
};

Outcome run(const Setup &setup)
{
    return Run(setup).finish();
}

void assert_same(const Outcome &a, const Outcome &b)
{
    assert_true(a.trials == b.trials);
    assert_true(a.pushes == b.pushes);
    assert_true(a.experiences == b.experiences);
}

void trials_end_with_the_structure_discovered(void **)
{
    Outcome outcome = run({});
    assert_int_equal(outcome.trials.size(), 3);
    for (int pushes : outcome.trials) {
        assert_true(pushes >= 1);
        assert_true(pushes < 100);
    }
    assert_int_equal(outcome.agent_rejected, 0);
    assert_int_equal(outcome.sim_rejected, 0);
}

void a_seed_gives_the_same_run(void **)
{
    Setup setup;
    setup.object = "PRP";
    assert_same(run(setup), run(setup));
}

void another_seed_gives_another_run(void **)
{
    Setup other;
    other.seed = 2;
    Outcome a = run({});
    Outcome b = run(other);
    assert_false(a.pushes == b.pushes);
    assert_false(a.experiences == b.experiences);
}

void the_cap_ends_a_trial(void **)
{
    Setup setup;
    setup.object = "RRRRR";
    setup.cap = 2;
    Outcome outcome = run(setup);
    assert_true(outcome.trials == std::vector<int>({2, 2, 2}));
    assert_true(outcome.pushes.size() == 6);
}

void old_messages_change_nothing(void **)
{
    Setup disturbed;
    disturbed.old_messages = true;
    Outcome outcome = run(disturbed);
    assert_true(outcome.agent_repeated > 0);
    assert_same(run({}), outcome);
}

void foreign_and_malformed_messages_change_nothing(void **)
{
    Setup disturbed;
    disturbed.forged_messages = true;
    Outcome outcome = run(disturbed);
    assert_true(outcome.agent_foreign > 0);
    assert_true(outcome.agent_rejected > 0);
    assert_true(outcome.sim_rejected > 0);
    assert_same(run({}), outcome);
}

void real_time_works_too(void **)
{
    Setup setup;
    setup.real_time = true;
    setup.trials = 2;
    Outcome outcome = run(setup);
    assert_int_equal(outcome.trials.size(), 2);
    assert_true(outcome.trials[0] < 100);
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(trials_end_with_the_structure_discovered),
        cmocka_unit_test(a_seed_gives_the_same_run),
        cmocka_unit_test(another_seed_gives_another_run),
        cmocka_unit_test(the_cap_ends_a_trial),
        cmocka_unit_test(old_messages_change_nothing),
        cmocka_unit_test(foreign_and_malformed_messages_change_nothing),
        cmocka_unit_test(real_time_works_too),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
