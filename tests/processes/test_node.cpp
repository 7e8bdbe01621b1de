/* The simulator's side alone, answered by hand: what it refuses and what it ignores. */
#include "grrl/base/settling.h"
#include "harness.hpp"

using namespace harness;

namespace
{

/* An agent that does as the test says. */
class Puppet
{
public:
    Puppet() : lcm_(lcm_create("memq://"))
    {
        clock_us = 1000000;
        grrl_wire_bind_model(&model_);
        listen(GRRL_CHANNEL_POINTS, [](const lcm_recv_buf_t *b, const char *, void *user) {
            auto *self = static_cast<Puppet *>(user);
            assert_true(grrl_wire_decode_points(b->data, b->data_size, &self->points, &self->why_));
            self->frames++;
            self->burst.push_back(self->points.message);
        });
        listen(GRRL_CHANNEL_TRIAL, [](const lcm_recv_buf_t *b, const char *, void *user) {
            auto *self = static_cast<Puppet *>(user);
            assert_true(grrl_wire_decode_trial(b->data, b->data_size, &self->trial, &self->why_));
        });
        listen(GRRL_CHANNEL_PUSH_STATUS, [](const lcm_recv_buf_t *b, const char *, void *user) {
            auto *self = static_cast<Puppet *>(user);
            assert_true(
                grrl_wire_decode_push_status(b->data, b->data_size, &self->status, &self->why_));
            self->states.push_back(self->status.state);
        });
        NodeConfig config;
        config.object = *object_from_text("RR").value;
        config.session_id = sim_session;
        config.cap = 3;
        config.now_us = [] { return clock_us; };
        config.on_note = [this](const std::string &text) { notes += text; };
        node_ = std::make_unique<Node>(lcm_, std::move(config));
        handle();
    }
    ~Puppet()
    {
        node_.reset();
        for (lcm_subscription_t *subscription : subscriptions_)
            (void)lcm_unsubscribe(lcm_, subscription);
        lcm_destroy(lcm_);
    }

    void handle()
    {
        while (lcm_handle_timeout(lcm_, 0) > 0)
            continue;
    }

    grrl_push_command_t answer() const
    {
        grrl_push_command_t command{};
        command.session_id = agent_session;
        command.plant_session_id = sim_session;
        command.points_seq = points.message.seq;
        command.trial_id = trial.trial_id;
        command.trial_revision = trial.revision;
        command.cmd_seq = points.message.ack_cmd_seq;
        return command;
    }

    void send(const grrl_push_command_t &command)
    {
        burst.clear();
        states.clear();
        publish(GRRL_CHANNEL_PUSH_COMMAND,
                grrl_wire_encode_push_command(&command, GRRL_WIRE_MAX_BYTES, bytes_, &why_));
    }

    /* Answers frames until the scene has settled, then sends an empty model. */
    void settle()
    {
        for (int i = 0; i < 1000 && points.message.phase != GRRL_POINTS_T_SETTLED; i++)
            send(answer());
        assert_int_equal(points.message.phase, GRRL_POINTS_T_SETTLED);
        grrl_model_t &model = model_.message;
        model.session_id = agent_session;
        model.trial_id = trial.trial_id;
        model.cmd_seq = points.message.ack_cmd_seq;
        publish(GRRL_CHANNEL_MODEL,
                grrl_wire_encode_model(&model, GRRL_WIRE_MAX_BYTES, bytes_, &why_));
        assert_int_equal(trial.judged_cmd_seq, points.message.ack_cmd_seq);
    }

    /* The next push from somewhere to somewhere, with its decision. */
    grrl_push_command_t push(float x0, float x1)
    {
        grrl_push_command_t command = answer();
        command.kind = GRRL_PUSH_COMMAND_T_PUSH;
        command.cmd_seq++;
        command.start[0] = x0;
        command.start[1] = 0.7f;
        command.end[0] = x1;
        command.end[1] = 0.7f;
        command.travel = 0.03f;
        command.speed = 0.5f;
        command.force = 5.0f;
        command.timeout = 1.0f;
        return command;
    }

    void decide(int32_t cmd_seq)
    {
        grrl_decision_t decision{};
        decision.session_id = agent_session;
        decision.trial_id = trial.trial_id;
        decision.cmd_seq = cmd_seq;
        publish(GRRL_CHANNEL_DECISION,
                grrl_wire_encode_decision(&decision, GRRL_WIRE_MAX_BYTES, bytes_, &why_));
    }

    void wait_us(int64_t us)
    {
        clock_us += us;
        node_->tick();
        handle();
    }

    const Node &node() const { return *node_; }

    std::vector<grrl_points_t> burst; /* frames since the last command; their arrays are gone */
    std::vector<int8_t> states;
    grrl_wire_points points{};
    grrl_trial_t trial{};
    grrl_push_status_t status{};
    std::string notes;
    int frames = 0;

private:
    void listen(const char *channel, lcm_msg_handler_t handler)
    {
        subscriptions_.push_back(lcm_subscribe(lcm_, channel, handler, this));
        (void)lcm_subscription_set_queue_capacity(subscriptions_.back(), 0);
    }

    void publish(const char *channel, int size)
    {
        assert_true(size > 0);
        assert_int_equal(lcm_publish(lcm_, channel, bytes_, static_cast<unsigned>(size)), 0);
        handle();
    }

    lcm_t *lcm_;
    std::vector<lcm_subscription_t *> subscriptions_;
    std::unique_ptr<Node> node_;
    grrl_wire_model model_{};
    grrl_wire_why why_;
    uint8_t bytes_[GRRL_WIRE_MAX_BYTES];
};

void a_push_needs_its_decision(void **)
{
    Puppet puppet;
    puppet.settle();
    int frames = puppet.frames;
    puppet.send(puppet.push(-0.1f, 0.1f));
    assert_int_equal(puppet.frames, frames);
    puppet.decide(1);
    assert_true(puppet.frames > frames);
    assert_int_equal(puppet.burst[0].ack_cmd_seq, 1);
    assert_int_equal(puppet.burst[0].phase, GRRL_POINTS_T_PUSHING);
    assert_int_equal(puppet.states[0], GRRL_PUSH_STATUS_T_MOVING);
    assert_int_equal(puppet.status.agent_session_id, agent_session);
}

void a_bad_push_is_refused_with_a_reason_and_counts(void **)
{
    Puppet puppet;
    puppet.settle();
    puppet.decide(1);
    puppet.send(puppet.push(0.1f, 0.1f)); /* goes nowhere */
    assert_int_equal(puppet.status.state, GRRL_PUSH_STATUS_T_REFUSED);
    assert_int_equal(puppet.status.reason, GRRL_PUSH_STATUS_T_BAD_COMMAND);
    assert_true(puppet.notes.find("refused") != std::string::npos);
    assert_int_equal(puppet.points.message.ack_cmd_seq, 1);
    assert_int_equal(puppet.burst[0].phase, GRRL_POINTS_T_REST);
    puppet.settle(); /* and the trial goes on */
}

void a_push_acts_once(void **)
{
    Puppet puppet;
    puppet.settle();
    grrl_push_command_t push = puppet.push(-0.1f, 0.1f);
    puppet.decide(1);
    puppet.send(push);
    int frames = puppet.frames;
    puppet.send(push);
    puppet.send(push);
    assert_int_equal(puppet.frames, frames);
    puppet.settle();
    frames = puppet.frames;
    puppet.send(push); /* old, in a settled scene */
    assert_int_equal(puppet.frames, frames);
    assert_int_equal(puppet.points.message.ack_cmd_seq, 1);
}

void commands_that_are_out_of_turn_are_ignored(void **)
{
    Puppet puppet;
    puppet.settle();
    puppet.decide(1);
    int frames = puppet.frames;
    grrl_push_command_t good = puppet.push(-0.1f, 0.1f);
    grrl_push_command_t bad = good;
    bad.cmd_seq = 2;
    puppet.send(bad);
    bad = good;
    bad.trial_id++;
    puppet.send(bad);
    bad = good;
    bad.trial_revision--;
    puppet.send(bad);
    bad = good;
    bad.points_seq--;
    puppet.send(bad);
    bad = good;
    bad.plant_session_id++;
    puppet.send(bad);
    bad = good;
    bad.session_id++;
    puppet.send(bad);
    assert_int_equal(puppet.frames, frames);
    puppet.send(good);
    assert_true(puppet.frames > frames);
}

/* The first frame of a trial alone, then as many as there are until the scene has settled; the last
 * one asks for an answer, and without one all come again. */
void frames_come_in_bursts(void **)
{
    Puppet puppet;
    puppet.send(puppet.answer()); /* to the offer */
    assert_int_equal(puppet.burst.size(), 1);
    assert_int_equal(puppet.burst[0].mode, GRRL_POINTS_T_LOCK_STEP);
    puppet.send(puppet.answer());
    assert_int_equal(puppet.burst.size(), GRRL_SETTLING_FRAMES - 1);
    puppet.wait_us(60000);
    assert_int_equal(puppet.burst.size(), 2 * (GRRL_SETTLING_FRAMES - 1));
    for (size_t i = 0; i < puppet.burst.size(); i++) {
        size_t place = i % (GRRL_SETTLING_FRAMES - 1);
        bool last = place == GRRL_SETTLING_FRAMES - 2;
        assert_int_equal(puppet.burst[i].seq, 2 + place);
        assert_int_equal(puppet.burst[i].mode, last ? GRRL_POINTS_T_LOCK_STEP : GRRL_POINTS_T_MORE);
    }
}

/* WAIT, with the newest frame and the supervisor's word: the agent sees nothing it could push. */
void an_agent_with_nothing_to_push_is_shown_more_but_not_for_ever(void **)
{
    Puppet puppet;
    for (int look = 0; look < 10; look++) {
        puppet.settle();
        assert_false(puppet.node().agent_has_nothing_to_push());
        int frames = puppet.frames;
        puppet.send(puppet.answer());
        assert_true(puppet.frames > frames);
        assert_int_equal(puppet.burst[0].phase, GRRL_POINTS_T_REST);
    }
    puppet.settle();
    puppet.send(puppet.answer());
    assert_true(puppet.node().agent_has_nothing_to_push());
    puppet.decide(1);
    puppet.send(puppet.push(-0.1f, 0.1f)); /* at last */
    assert_false(puppet.node().agent_has_nothing_to_push());
}

void frames_tell_whose_pushes_they_show(void **)
{
    Puppet puppet;
    puppet.settle();
    assert_int_equal(puppet.points.message.agent_session_id, agent_session);
}

void no_model_no_push(void **)
{
    Puppet puppet;
    for (int i = 0; i < 100; i++)
        puppet.send(puppet.answer());
    assert_int_equal(puppet.frames, GRRL_SETTLING_FRAMES);
    puppet.decide(1);
    puppet.send(puppet.push(-0.1f, 0.1f));
    assert_int_equal(puppet.frames, GRRL_SETTLING_FRAMES);
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_push_needs_its_decision),
        cmocka_unit_test(a_bad_push_is_refused_with_a_reason_and_counts),
        cmocka_unit_test(a_push_acts_once),
        cmocka_unit_test(frames_come_in_bursts),
        cmocka_unit_test(commands_that_are_out_of_turn_are_ignored),
        cmocka_unit_test(an_agent_with_nothing_to_push_is_shown_more_but_not_for_ever),
        cmocka_unit_test(frames_tell_whose_pushes_they_show),
        cmocka_unit_test(no_model_no_push),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
