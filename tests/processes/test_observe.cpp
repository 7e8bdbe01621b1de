/* Observers, and an agent with a tracker and a robot that know nothing of trials. */
#include <algorithm>

#include "grrl/base/settling.h"
#include "harness.hpp"

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

/* A tracker that knows no trials, no pushes and no phases, and a robot with its own session. */
class OwnPlant
{
public:
    explicit OwnPlant(lcm_t *lcm)
        : lcm_(lcm), world_(*object_from_text("RPR").value, WorldParams(), 5)
    {
        grrl_wire_bind_points(&points_);
        subscription_ = lcm_subscribe(lcm_, GRRL_CHANNEL_PUSH_COMMAND, on_command, this);
        (void)lcm_subscription_set_queue_capacity(subscription_, 0);
    }
    ~OwnPlant() { (void)lcm_unsubscribe(lcm_, subscription_); }

    void frame()
    {
        clock_us += 33333;
        bool was_moving = moving_;
        moving_ = moving_ && world_.step_frame();
        if (was_moving != moving_)
            report(GRRL_PUSH_STATUS_T_DONE, GRRL_PUSH_STATUS_T_REACHED);
        rest_frames_ = moving_ ? 0 : rest_frames_ + 1;
        Frame frame;
        world_.observe(frame);
        grrl_points_t &m = points_.message;
        m.utime = clock_us;
        m.session_id = 77;
        m.seq++;
        m.n_points = 0;
        for (const TrackedFeature &feature : frame.features) {
            m.id[m.n_points] = static_cast<int32_t>(feature.id);
            m.x[m.n_points] = static_cast<float>(feature.x_m);
            m.y[m.n_points] = static_cast<float>(feature.y_m);
            m.n_points++;
        }
        send(GRRL_CHANNEL_POINTS, grrl_wire_encode_points(&m, GRRL_WIRE_MAX_BYTES, bytes_, &why_));
    }

    int pushes() const { return pushes_; }

    void obey_rival()
    {
        rival_ = true;
        report(GRRL_PUSH_STATUS_T_MOVING, GRRL_PUSH_STATUS_T_NONE);
    }

private:
    static void on_command(const lcm_recv_buf_t *buffer, const char *, void *user)
    {
        auto *plant = static_cast<OwnPlant *>(user);
        grrl_push_command_t c;
        assert_true(
            grrl_wire_decode_push_command(buffer->data, buffer->data_size, &c, &plant->why_));
        assert_int_equal(c.plant_session_id, 77);
        if (c.kind != GRRL_PUSH_COMMAND_T_PUSH || c.cmd_seq <= plant->pushes_)
            return;
        assert_int_equal(c.cmd_seq, plant->pushes_ + 1);
        plant->obey(c);
    }

    void obey(const grrl_push_command_t &c)
    {
        PushCommand push;
        push.start_m = {static_cast<double>(c.start[0]), static_cast<double>(c.start[1])};
        push.end_m = {static_cast<double>(c.end[0]), static_cast<double>(c.end[1])};
        push.travel_m = static_cast<double>(c.travel);
        pushes_++;
        assert_true(rest_frames_ >= GRRL_SETTLING_FRAMES); /* enough to average */
        rest_frames_ = 0;
        moving_ = world_.begin_push(push).empty();
        report(moving_ ? GRRL_PUSH_STATUS_T_MOVING : GRRL_PUSH_STATUS_T_REFUSED,
               moving_ ? GRRL_PUSH_STATUS_T_NONE : GRRL_PUSH_STATUS_T_BAD_COMMAND);
    }

    void report(int8_t state, int8_t reason)
    {
        grrl_push_status_t status{};
        status.utime = clock_us;
        status.session_id = 78;
        status.agent_session_id = rival_ ? agent_session + 1 : agent_session;
        status.cmd_seq = pushes_;
        status.state = state;
        status.reason = reason;
        send(GRRL_CHANNEL_PUSH_STATUS,
             grrl_wire_encode_push_status(&status, GRRL_WIRE_MAX_BYTES, bytes_, &why_));
    }

    void send(const char *channel, int size)
    {
        assert_true(size > 0);
        assert_int_equal(lcm_publish(lcm_, channel, bytes_, static_cast<unsigned>(size)), 0);
    }

    lcm_t *lcm_;
    World world_;
    lcm_subscription_t *subscription_;
    grrl_wire_points points_{};
    grrl_wire_why why_;
    uint8_t bytes_[GRRL_WIRE_MAX_BYTES];
    int pushes_ = 0;
    int rest_frames_ = 0;
    bool moving_ = false;
    bool rival_ = false;
};

void a_tracker_and_a_robot_are_enough(void **)
{
    Listener listener(false);
    OwnPlant plant(listener.lcm());
    for (int i = 0; i < 5000 && plant.pushes() < 12; i++) {
        plant.frame();
        listener.handle_all();
    }
    assert_int_equal(plant.pushes(), 12);
    assert_true(grrl_learner_usage(&listener.agent().learner).n > 0);
    assert_int_equal(listener.agent().counts.lost, 0);
    /* it found joints, so the frames reached perception as frames of pushes */
    assert_true(grrl_perception_model(&listener.agent().learner.perception)->n_joints >= 1);
}

/* What the other one moves would be put down to this agent's push. */
void an_agent_gives_way_when_its_robot_moves_for_another(void **)
{
    Listener listener(false);
    OwnPlant plant(listener.lcm());
    for (int i = 0; i < 5000 && plant.pushes() < 2; i++) {
        plant.frame();
        listener.handle_all();
    }
    assert_false(grrl_agent_gave_way(&listener.agent()));
    uint32_t cases = grrl_learner_usage(&listener.agent().learner).n;
    plant.obey_rival();
    for (int i = 0; i < 200; i++) {
        plant.frame();
        listener.handle_all();
    }
    assert_true(grrl_agent_gave_way(&listener.agent()));
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
