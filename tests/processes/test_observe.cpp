/* Observers, and an agent with a tracker and a robot that know nothing of trials. */
#include <algorithm>

#include "harness.hpp"
#include "own_plant.hpp"

using namespace harness;

namespace
{

class Listener
{
public:
    explicit Listener(bool observe) : lcm_(lcm_create("memq://"))
    {
        agent_ = std::make_unique<grrl_agent>();
        grrl_agent_config config{};
        grrl_learner_config_default(&config.learner);
        config.learner.seed = 1;
        config.session_id = agent_session;
        config.observe = observe;
        config.now_us = agent_clock;
        assert_int_equal(grrl_policy_make(&grrl_policy_learn, policy_.bytes, sizeof policy_.bytes,
                                          capacity, nullptr, &config.policy),
                         GRRL_OK);
        assert_int_equal(grrl_agent_init(agent_.get(), &config, lcm_), GRRL_OK);
    }
    ~Listener()
    {
        grrl_agent_close(agent_.get());
        lcm_destroy(lcm_);
    }

    void hear(const Message &message)
    {
        assert_int_equal(lcm_publish(lcm_, message.channel.c_str(), message.data.data(),
                                     static_cast<unsigned>(message.data.size())),
                         0);
        handle_all();
    }

    void handle_all()
    {
        while (lcm_handle_timeout(lcm_, 0) > 0)
            continue;
    }

    std::vector<uint8_t> experiences()
    {
        std::vector<uint8_t> bytes;
        grrl_io io = {&bytes, append, nullptr};
        assert_int_equal(grrl_learner_save(&agent_->learner, &io), GRRL_OK);
        return bytes;
    }

    lcm_t *lcm() { return lcm_; }
    const grrl_agent &agent() const { return *agent_; }

private:
    lcm_t *lcm_;
    std::unique_ptr<grrl_agent> agent_;
    POLICY_MEMORY(capacity) policy_;
};

struct Recording {
    std::vector<Message> messages;
    std::vector<uint8_t> experiences;
};

Recording record()
{
    Setup setup;
    setup.object = "RPR";
    setup.trials = 4;
    Run run(setup);
    Outcome outcome = run.finish();
    return {run.messages(), outcome.experiences};
}

void assert_learns_the_same(const Recording &live, const std::vector<Message> &messages)
{
    Listener observer(true);
    for (const Message &message : messages)
        observer.hear(message);
    assert_true(grrl_agent_finished(&observer.agent()));
    assert_true(observer.experiences() == live.experiences);
}

void an_observer_learns_the_same(void **)
{
    Recording live = record();
    assert_learns_the_same(live, live.messages);
}

void an_observer_without_push_commands_learns_the_same(void **)
{
    Recording live = record();
    std::vector<Message> thinned;
    for (const Message &message : live.messages)
        if (message.channel != GRRL_CHANNEL_PUSH_COMMAND && message.channel != GRRL_CHANNEL_MODEL &&
            message.channel != GRRL_CHANNEL_PUSH_STATUS)
            thinned.push_back(message);
    assert_learns_the_same(live, thinned);
}

/* The offer of a trial is no judgement; no frame comes before the agent has agreed to it. */
bool is_offer(const Message &message)
{
    grrl_trial_t trial;
    grrl_wire_why why;
    return message.channel == GRRL_CHANNEL_TRIAL &&
           grrl_wire_decode_trial(message.data.data(), static_cast<uint32_t>(message.data.size()),
                                  &trial, &why) &&
           trial.judged_cmd_seq < 0;
}

/* Moves each message of a channel n places on, past messages of other channels. */
std::vector<Message> delayed(std::vector<Message> messages, const char *channel, size_t n)
{
    for (size_t i = messages.size(); i-- > 0;) {
        if (messages[i].channel != channel || is_offer(messages[i]))
            continue;
        for (size_t k = i;
             k < i + n && k + 1 < messages.size() && messages[k + 1].channel != channel; k++)
            std::swap(messages[k], messages[k + 1]);
    }
    return messages;
}

void decisions_may_come_late(void **)
{
    Recording live = record();
    for (size_t n = 1; n <= 8; n++)
        assert_learns_the_same(live, delayed(live.messages, GRRL_CHANNEL_DECISION, n));
}

/* The judgement may come after the decision and the command that rest on it. */
void judgements_may_come_late(void **)
{
    Recording live = record();
    for (size_t n = 1; n <= 6; n++)
        assert_learns_the_same(live, delayed(live.messages, GRRL_CHANNEL_TRIAL, n));
}

void count(const lcm_recv_buf_t *, const char *, void *user)
{
    ++*static_cast<int *>(user);
}

void a_tracker_and_a_robot_are_enough(void **)
{
    int models = 0;
    Listener listener(false);
    (void)lcm_subscribe(listener.lcm(), GRRL_CHANNEL_MODEL, count, &models);
    OwnPlant plant(listener.lcm(), "RPR", 5);
    for (int i = 0; i < 5000 && plant.pushes() < 12; i++) {
        plant.frame(clock_us += 33333);
        listener.handle_all();
    }
    assert_int_equal(plant.pushes(), 12);
    assert_true(plant.orderly());
    assert_int_equal(models, 12); /* before each push */
    assert_true(grrl_learner_usage(&listener.agent().learner).n > 0);
    assert_int_equal(listener.agent().counts.lost, 0);
    /* it found joints, so the frames reached perception as frames of pushes */
    assert_true(grrl_perception_model(&listener.agent().learner.perception)->n_joints >= 1);
}

/* What the other one moves would be put down to this agent's push. */
void an_agent_gives_way_when_its_robot_moves_for_another(void **)
{
    Listener listener(false);
    OwnPlant plant(listener.lcm(), "RPR", 5);
    for (int i = 0; i < 5000 && plant.pushes() < 2; i++) {
        plant.frame(clock_us += 33333);
        listener.handle_all();
    }
    assert_int_equal(grrl_agent_end(&listener.agent()), GRRL_AGENT_GOES_ON);
    uint32_t cases = grrl_learner_usage(&listener.agent().learner).n;
    plant.obey_rival();
    for (int i = 0; i < 200; i++) {
        plant.frame(clock_us += 33333);
        listener.handle_all();
    }
    assert_int_equal(grrl_agent_end(&listener.agent()), GRRL_AGENT_GAVE_WAY);
    assert_int_equal(plant.pushes(), 2);
    assert_int_equal(grrl_learner_usage(&listener.agent().learner).n, cases);
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(an_observer_learns_the_same),
        cmocka_unit_test(an_observer_without_push_commands_learns_the_same),
        cmocka_unit_test(decisions_may_come_late),
        cmocka_unit_test(judgements_may_come_late),
        cmocka_unit_test(a_tracker_and_a_robot_are_enough),
        cmocka_unit_test(an_agent_gives_way_when_its_robot_moves_for_another),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
