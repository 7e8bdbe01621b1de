/* An agent without a supervisor: when it ends, its limits, an emergency stop, and what it tells of
 * a tracker and a robot that are wrong. */
#include <algorithm>
#include <cmath>

#include "harness.hpp"
#include "own_plant.hpp"

using namespace harness;

namespace
{

constexpr int64_t frame_us = 33333;

struct Seen {
    std::vector<std::string> notes;
    int models = 0;
    int perceived = 0;
    grrl_model model{};
    uint8_t pair[2] = {0, 0};
    float sure = 0.0f;
    int learned = 0;
    int ends = 0;
    int commands = 0;
    int last_model_push = -1;
    std::vector<grrl_decision_t> decisions;
};

/* An agent and its plant on one bus. */
class Scene
{
public:
    explicit Scene(const grrl_agent_config &changes, const char *object = "RPR",
                   const PlantMistakes &mistakes = PlantMistakes(), uint64_t seed = 5)
        : lcm_(lcm_create("memq://")), agent_(std::make_unique<grrl_agent>()),
          plant_(lcm_, object, seed, mistakes)
    {
        clock_us = 1000000;
        grrl_agent_config config = changes;
        config.learner.seed = 1;
        config.session_id = agent_session;
        config.now_us = agent_clock;
        config.pair = grrl_perception_pair;
        config.ground = grrl_grounding_push;
        config.on_event = on_event;
        config.context = this;
        assert_int_equal(grrl_policy_make(&grrl_policy_learn, policy_.bytes, sizeof policy_.bytes,
                                          capacity, nullptr, &config.policy),
                         GRRL_OK);
        assert_int_equal(grrl_agent_init(agent_.get(), &config, lcm_), GRRL_OK);
        (void)lcm_subscribe(lcm_, GRRL_CHANNEL_MODEL, on_model, this);
    }
    ~Scene() { grrl_agent_close(agent_.get()); }

    void frame()
    {
        plant_.frame(clock_us += frame_us_);
        handle_all();
    }

    void handle_all()
    {
        while (lcm_handle_timeout(lcm_, 0) > 0)
            continue;
        grrl_agent_tick(agent_.get());
    }

    /* Until it ends, at most so many frames. */
    void run(int frames = 5000)
    {
        for (int i = 0; i < frames && grrl_agent_end(agent_.get()) == GRRL_AGENT_GOES_ON; i++)
            frame();
    }

    void seconds(double s)
    {
        for (double t = 0; t < s; t += static_cast<double>(frame_us_) * 1e-6)
            frame();
    }

    void send(const char *channel, const void *data, unsigned size)
    {
        assert_int_equal(lcm_publish(lcm_, channel, data, size), 0);
        handle_all();
    }

    /* How many of the notes hold a text. */
    long told(const std::string &text) const
    {
        return std::count_if(
            seen.notes.begin(), seen.notes.end(),
            [&text](const std::string &n) { return n.find(text) != std::string::npos; });
    }

    grrl_agent &agent() { return *agent_; }
    OwnPlant &plant() { return plant_; }
    void period_us(int64_t period) { frame_us_ = period; }

    Seen seen;

private:
    static void on_event(void *context, const grrl_agent_event *event)
    {
        auto *self = static_cast<Scene *>(context);
        Seen &seen = self->seen;
        switch (event->kind) {
        case GRRL_AGENT_NOTE:
            seen.notes.push_back(event->text);
            break;
        case GRRL_AGENT_PERCEIVED:
            seen.perceived++;
            seen.model = *grrl_perception_model(&self->agent_->learner.perception);
            seen.sure = grrl_agent_sureness(self->agent_.get(), &seen.pair[0], &seen.pair[1]);
            break;
        case GRRL_AGENT_DECIDED:
            seen.decisions.push_back(*event->decision);
            break;
        case GRRL_AGENT_LEARNED:
            seen.learned++;
            break;
        case GRRL_AGENT_TRIAL_END:
            seen.ends++;
            break;
        }
    }

    static void on_model(const lcm_recv_buf_t *buffer, const char *, void *user)
    {
        static grrl_wire_model model;
        grrl_wire_why why;
        Seen &seen = static_cast<Scene *>(user)->seen;
        assert_true(grrl_wire_decode_model(buffer->data, buffer->data_size, &model, &why));
        seen.models++;
        seen.last_model_push = model.message.cmd_seq;
    }

    struct Destroy {
        lcm_t *lcm;
        ~Destroy() { lcm_destroy(lcm); }
    };

    lcm_t *lcm_;
    Destroy destroy_{lcm_}; /* after those that use it */
    std::unique_ptr<grrl_agent> agent_;
    OwnPlant plant_;
    POLICY_MEMORY(capacity) policy_;
    int64_t frame_us_ = frame_us;
};

grrl_agent_config defaults()
{
    grrl_agent_config config{};
    grrl_learner_config_default(&config.learner);
    return config;
}

void ends_after_the_pushes_that_were_wanted(void **)
{
    grrl_agent_config config = defaults();
    config.max_pushes = 3;
    Scene scene(config);
    scene.run();
    assert_int_equal(grrl_agent_end(&scene.agent()), GRRL_AGENT_PUSHES_DONE);
    assert_true(grrl_agent_finished(&scene.agent()));
    assert_int_equal(scene.plant().pushes(), 3);
    assert_int_equal(scene.seen.learned, 3);
    assert_int_equal(scene.seen.perceived, 4);
    assert_int_equal(scene.seen.models, 4); /* before the first push and after each */
    assert_int_equal(scene.seen.last_model_push, 3);
    assert_int_equal(scene.seen.ends, 1);
    scene.seconds(3.0);
    assert_int_equal(scene.plant().commands(), 3);
    assert_int_equal(scene.seen.notes.size(), 0); /* all was well */
}

/* Nearly all runs end by themselves, and nearly all that do are right. */
void ends_when_it_is_sure(void **)
{
    int sure = 0;
    int right = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        grrl_agent_config config = defaults();
        config.max_pushes = 40;
        config.until_sure = 0.95f;
        Scene scene(config, "RR", PlantMistakes(), seed);
        scene.run(20000);
        if (grrl_agent_end(&scene.agent()) != GRRL_AGENT_SURE)
            continue;
        const grrl_model &model = scene.seen.model;
        sure++;
        right += model.n_bodies == 3 && model.n_joints == 2 &&
                 model.joint[0].type == GRRL_REVOLUTE && model.joint[1].type == GRRL_REVOLUTE;
        assert_true(scene.plant().pushes() < 40);
        assert_int_equal(scene.seen.last_model_push, scene.plant().pushes());
        assert_int_equal(scene.seen.learned, scene.plant().pushes());
    }
    print_message("sure %d of 10, right %d\n", sure, right);
    assert_true(sure >= 8);
    assert_true(right >= sure - 2);
}

/* One link has no pair: nothing is decided, and the pushes end the run. */
void is_never_sure_of_one_link(void **)
{
    grrl_agent_config config = defaults();
    config.max_pushes = 3;
    config.until_sure = 0.5f;
    Scene scene(config, "l1");
    scene.run();
    assert_int_equal(grrl_agent_end(&scene.agent()), GRRL_AGENT_PUSHES_DONE);
    uint8_t a = 9, b = 9;
    assert_true(grrl_agent_sureness(&scene.agent(), &a, &b) <= 0.0f);
    assert_int_equal(a + b, 0);
}

/* Without the functions that they need, neither a table nor an end is promised. */
void refuses_what_it_cannot_keep(void **)
{
    lcm_t *lcm = lcm_create("memq://");
    auto agent = std::make_unique<grrl_agent>();
    POLICY_MEMORY(capacity) memory;
    grrl_agent_config config = defaults();
    config.session_id = agent_session;
    config.now_us = agent_clock;
    assert_int_equal(grrl_policy_make(&grrl_policy_learn, memory.bytes, sizeof memory.bytes,
                                      capacity, nullptr, &config.policy),
                     GRRL_OK);
    config.until_sure = 0.9f;
    assert_int_equal(grrl_agent_init(agent.get(), &config, lcm), GRRL_ERR_ARGUMENT);
    config.until_sure = 0.0f;
    config.table = {0.0f, 0.0f, 1.0f, 1.0f};
    assert_int_equal(grrl_agent_init(agent.get(), &config, lcm), GRRL_ERR_ARGUMENT);
    lcm_destroy(lcm);
}

/* A pair is named, however sure it is. */
void names_the_pair_it_is_least_sure_of(void **)
{
    grrl_agent_config config = defaults();
    config.max_pushes = 12;
    Scene scene(config, "RR", PlantMistakes(), 2);
    for (int i = 0; i < 20000 && grrl_agent_end(&scene.agent()) == GRRL_AGENT_GOES_ON; i++) {
        int perceived = scene.seen.perceived;
        scene.frame();
        if (scene.seen.perceived == perceived || scene.seen.model.n_bodies < 2)
            continue;
        assert_true(scene.seen.pair[0] < scene.seen.pair[1]);
        assert_true(scene.seen.pair[1] < scene.seen.model.n_bodies);
        assert_true(scene.seen.sure >= 0.0f && scene.seen.sure <= 1.0f);
    }
    assert_true(scene.seen.model.n_bodies >= 2);
}

void keeps_the_limits_of_the_robot(void **)
{
    grrl_agent_config config = defaults();
    config.max_pushes = 4;
    config.learner.grounding.force_n = 3.0f;
    config.learner.grounding.speed_m_s = 0.04f;
    config.learner.grounding.travel_m = 0.02f;
    Scene scene(config);
    for (int i = 0; i < 5000 && grrl_agent_end(&scene.agent()) == GRRL_AGENT_GOES_ON; i++) {
        scene.frame();
        if (scene.plant().pushes() == 0)
            continue;
        assert_true(scene.plant().last().force <= 3.0f);
        assert_true(scene.plant().last().speed <= 0.04f);
        assert_true(scene.plant().last().travel <= 0.02f);
    }
    assert_int_equal(scene.plant().pushes(), 4);
}

bool inside(const grrl_agent_table &t, const float *point)
{
    return point[0] >= t.x0_m && point[0] <= t.x1_m && point[1] >= t.y0_m && point[1] <= t.y1_m;
}

/* Later, a feature that was seen may leave the table with its link. */
void assert_no_feature_off_table(const grrl_model &model, const grrl_agent_table &table)
{
    for (uint16_t i = 0; i < model.n_features; i++) {
        const float point[2] = {model.feature_m[i].x, model.feature_m[i].y};
        assert_true(inside(table, point));
    }
}

/* A table that ends close beside the object. */
void no_push_leaves_the_table(void **)
{
    grrl_agent_config config = defaults();
    config.max_pushes = 1;
    Scene first(config);
    first.run();
    const grrl_model *model = &first.seen.model;
    assert_true(model->n_bodies > 0);
    grrl_vec2 middle = model->body[0].centroid_m;

    config.max_pushes = 12;
    config.table = {middle.x - 0.35f, middle.y - 0.09f, middle.x + 0.35f, middle.y + 0.35f};
    Scene scene(config);
    for (int i = 0; i < 20000 && grrl_agent_end(&scene.agent()) == GRRL_AGENT_GOES_ON; i++) {
        int pushes = scene.plant().pushes();
        scene.frame();
        if (scene.plant().pushes() == pushes)
            continue;
        if (pushes == 0)
            assert_no_feature_off_table(scene.seen.model, config.table);
        assert_true(inside(config.table, scene.plant().last().start));
        assert_true(inside(config.table, scene.plant().last().end));
    }
    assert_int_equal(scene.plant().pushes(), 12);
    assert_int_equal(scene.seen.learned, 12);
    assert_true(grrl_agent_mistakes(&scene.agent(), GRRL_MISTAKE_PUSH_OFF_TABLE) > 0);
    assert_int_equal(scene.told("would leave --table"), 1);
    assert_true(grrl_agent_mistakes(&scene.agent(), GRRL_MISTAKE_OFF_TABLE) > 0);
    assert_int_equal(scene.told("lie outside --table"), 1);
    /* what replaced a choice is another's, so that an observer learns the same */
    assert_true(
        std::any_of(scene.seen.decisions.begin(), scene.seen.decisions.end(),
                    [](const grrl_decision_t &d) { return d.reason == GRRL_DECISION_T_ADOPTED; }));
}

/* Nothing but the object fits: the agent waits and says why. */
void a_table_without_room_gets_no_push(void **)
{
    grrl_agent_config config = defaults();
    config.table = {-0.3f, -0.02f, 0.3f, 0.02f};
    Scene scene(config, "R");
    scene.seconds(5.0);
    assert_int_equal(scene.plant().commands(), 0);
}

void a_stop_ends_the_run(void **)
{
    grrl_agent_config config = defaults();
    Scene scene(config);
    while (scene.plant().pushes() < 2)
        scene.frame();
    int commands = scene.plant().commands();
    scene.plant().stop(GRRL_STOP_T_LIMIT);
    scene.handle_all();
    assert_int_equal(grrl_agent_end(&scene.agent()), GRRL_AGENT_STOPPED);
    assert_false(grrl_agent_finished(&scene.agent()));
    assert_string_equal(grrl_agent_stop_text(&scene.agent()),
                        "stopped by GRRL_STOP from session 78, reason LIMIT");
    scene.seconds(5.0);
    assert_int_equal(scene.plant().commands(), commands);
    assert_int_equal(scene.seen.learned, 1); /* the push under way teaches nothing */
}

/* A robot with other message types must not go unheard, and another agent's stop is not this one's.
 */
void any_stop_counts_but_anothers(void **)
{
    Scene scene(defaults());
    scene.seconds(0.2);
    grrl_stop_t stop{};
    grrl_wire_why why;
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
    stop.session_id = 9;
    stop.agent_session_id = agent_session + 1;
    int size = grrl_wire_encode_stop(&stop, GRRL_WIRE_MAX_BYTES, bytes, &why);
    scene.send(GRRL_CHANNEL_STOP, bytes, static_cast<unsigned>(size));
    assert_int_equal(grrl_agent_end(&scene.agent()), GRRL_AGENT_GOES_ON);
    scene.send(GRRL_CHANNEL_STOP, "stop", 4);
    assert_int_equal(grrl_agent_end(&scene.agent()), GRRL_AGENT_STOPPED);
    assert_non_null(std::strstr(grrl_agent_stop_text(&scene.agent()), "not a stop_t"));
}

void a_stop_outlasts_a_new_trial(void **)
{
    Scene scene(defaults());
    scene.plant().stop(GRRL_STOP_T_OPERATOR);
    scene.handle_all();
    grrl_trial_t trial{};
    grrl_wire_why why;
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
    trial.session_id = OwnPlant::tracker_session;
    trial.trial_id = 1;
    trial.revision = 1;
    trial.judged_cmd_seq = -1;
    int size = grrl_wire_encode_trial(&trial, GRRL_WIRE_MAX_BYTES, bytes, &why);
    scene.send(GRRL_CHANNEL_TRIAL, bytes, static_cast<unsigned>(size));
    scene.seconds(5.0);
    assert_int_equal(grrl_agent_end(&scene.agent()), GRRL_AGENT_STOPPED);
    assert_int_equal(scene.plant().commands(), 0);
}

/* What is told within 3 s of the mistake, once, and then counted. */
void told_once(const PlantMistakes &mistakes, grrl_agent_mistake kind, const char *text,
               int64_t period_us = frame_us)
{
    Scene scene(defaults(), "RPR", mistakes);
    scene.period_us(period_us);
    /* the first push is due after ten frames */
    scene.seconds(3.0 + (kind == GRRL_MISTAKE_UNACKNOWLEDGED ? 0.4 : 0.0));
    if (scene.told(text) != 1)
        for (const std::string &note : scene.seen.notes)
            print_error("%s\n", note.c_str());
    assert_int_equal(scene.told(text), 1);
    int64_t counted = grrl_agent_mistakes(&scene.agent(), kind);
    assert_true(counted > 0);
    scene.seconds(5.0);
    assert_int_equal(scene.told(text), 1);
    assert_true(grrl_agent_mistakes(&scene.agent(), kind) > counted);
    for (int i = 0; i < GRRL_AGENT_MISTAKES; i++)
        if (i != kind)
            assert_int_equal(
                grrl_agent_mistakes(&scene.agent(), static_cast<grrl_agent_mistake>(i)), 0);
}

void tells_of_a_robot_that_does_not_answer(void **)
{
    PlantMistakes mistakes;
    mistakes.no_status = true;
    told_once(mistakes, GRRL_MISTAKE_UNACKNOWLEDGED, "answer MOVING on GRRL_PUSH_STATUS");
}

void tells_of_an_answer_to_something_else(void **)
{
    PlantMistakes mistakes;
    mistakes.status_trial = 4;
    told_once(mistakes, GRRL_MISTAKE_UNACKNOWLEDGED, "trial_id 4, cmd_seq 1; copy all three");
}

void tells_of_frames_that_do_not_acknowledge(void **)
{
    PlantMistakes mistakes;
    mistakes.phase = GRRL_POINTS_T_SETTLED;
    told_once(mistakes, GRRL_MISTAKE_UNACKNOWLEDGED, "ack_cmd_seq must become");
}

void tells_of_frames_without_a_trial(void **)
{
    PlantMistakes mistakes;
    mistakes.trial_id = 1;
    told_once(mistakes, GRRL_MISTAKE_NO_TRIAL, "without a supervisor send trial_id 0");
}

void tells_of_ids_that_change(void **)
{
    PlantMistakes mistakes;
    mistakes.new_ids = true;
    told_once(mistakes, GRRL_MISTAKE_IDS, "a feature must keep its id");
    mistakes = PlantMistakes();
    mistakes.renumbered = true;
    told_once(mistakes, GRRL_MISTAKE_IDS, "a feature must keep its id");
}

void tells_of_millimetres_and_pushes_nothing(void **)
{
    PlantMistakes mistakes;
    mistakes.scale = 1000.0;
    Scene scene(defaults(), "RPR", mistakes);
    scene.seconds(0.1);
    assert_int_equal(scene.told("are they millimetres?"), 1);
    scene.seconds(10.0);
    assert_int_equal(scene.told("are they millimetres?"), 1);
    assert_int_equal(scene.plant().commands(), 0);
    assert_true(grrl_agent_mistakes(&scene.agent(), GRRL_MISTAKE_SPAN) > 290);
}

/* A large table is fine once it is told of. */
void a_large_table_must_be_named(void **)
{
    PlantMistakes mistakes;
    mistakes.scale = 12.0;
    grrl_agent_config config = defaults();
    Scene refused(config, "RPR", mistakes);
    refused.seconds(2.0);
    assert_int_equal(refused.plant().commands(), 0);
    config.table = {-14.0f, -12.0f, 14.0f, 12.0f};
    Scene scene(config, "RPR", mistakes);
    scene.seconds(2.0);
    assert_true(scene.plant().commands() > 0);
}

/* Objects that drift apart on a table of 2 m span a little more than that. */
void a_little_more_than_the_table_is_fine(void **)
{
    PlantMistakes mistakes;
    mistakes.scale = 3.0;
    Scene scene(defaults(), "RPR", mistakes);
    scene.seconds(2.0);
    assert_true(scene.plant().commands() > 0);
}

void tells_of_a_slow_tracker(void **)
{
    PlantMistakes mistakes;
    mistakes.no_status = true;
    Scene scene(defaults(), "RPR");
    scene.period_us(150000);
    scene.seconds(3.0);
    assert_int_equal(scene.told("6.7 frames per second; it needs 10 to 100"), 1);
    scene.seconds(10.0);
    assert_int_equal(scene.told("frames per second"), 1);
    assert_true(grrl_agent_mistakes(&scene.agent(), GRRL_MISTAKE_SLOW) > 3);
    Scene good(defaults(), "RPR");
    good.period_us(99000);
    good.seconds(10.0);
    assert_int_equal(good.told("frames per second"), 0);
}

void tells_of_a_phase_that_stays_at_rest(void **)
{
    PlantMistakes mistakes;
    mistakes.phase = GRRL_POINTS_T_REST;
    told_once(mistakes, GRRL_MISTAKE_REST, "send SETTLED");
}

void tells_of_a_push_that_does_not_end(void **)
{
    PlantMistakes mistakes;
    mistakes.never_done = true;
    Scene scene(defaults(), "RPR", mistakes);
    scene.seconds(7.0);
    assert_int_equal(scene.told("the robot must report DONE"), 0);
    scene.seconds(2.0);
    assert_int_equal(scene.told("the robot must report DONE"), 1);
    scene.seconds(5.0);
    assert_int_equal(scene.told("the robot must report DONE"), 1);
    assert_true(grrl_agent_mistakes(&scene.agent(), GRRL_MISTAKE_MOVING) > 100);
}

/* A robot that leaves out whose command it obeys is no other agent's. */
void an_answer_without_an_agent_is_no_rival(void **)
{
    PlantMistakes mistakes;
    mistakes.no_status = true;
    Scene scene(defaults(), "RPR", mistakes);
    while (scene.plant().pushes() < 1)
        scene.frame();
    grrl_push_status_t status{};
    grrl_wire_why why;
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
    status.session_id = OwnPlant::robot_session;
    status.cmd_seq = 1;
    status.state = GRRL_PUSH_STATUS_T_MOVING;
    int size = grrl_wire_encode_push_status(&status, GRRL_WIRE_MAX_BYTES, bytes, &why);
    scene.send(GRRL_CHANNEL_PUSH_STATUS, bytes, static_cast<unsigned>(size));
    assert_int_equal(grrl_agent_end(&scene.agent()), GRRL_AGENT_GOES_ON);
    scene.seconds(3.0);
    assert_int_equal(scene.told("came for agent_session_id 0"), 1);
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(ends_after_the_pushes_that_were_wanted),
        cmocka_unit_test(ends_when_it_is_sure),
        cmocka_unit_test(is_never_sure_of_one_link),
        cmocka_unit_test(refuses_what_it_cannot_keep),
        cmocka_unit_test(names_the_pair_it_is_least_sure_of),
        cmocka_unit_test(keeps_the_limits_of_the_robot),
        cmocka_unit_test(no_push_leaves_the_table),
        cmocka_unit_test(a_table_without_room_gets_no_push),
        cmocka_unit_test(a_stop_ends_the_run),
        cmocka_unit_test(any_stop_counts_but_anothers),
        cmocka_unit_test(a_stop_outlasts_a_new_trial),
        cmocka_unit_test(tells_of_a_robot_that_does_not_answer),
        cmocka_unit_test(tells_of_an_answer_to_something_else),
        cmocka_unit_test(tells_of_frames_that_do_not_acknowledge),
        cmocka_unit_test(tells_of_frames_without_a_trial),
        cmocka_unit_test(tells_of_ids_that_change),
        cmocka_unit_test(tells_of_millimetres_and_pushes_nothing),
        cmocka_unit_test(a_large_table_must_be_named),
        cmocka_unit_test(a_little_more_than_the_table_is_fine),
        cmocka_unit_test(tells_of_a_slow_tracker),
        cmocka_unit_test(tells_of_a_phase_that_stays_at_rest),
        cmocka_unit_test(tells_of_a_push_that_does_not_end),
        cmocka_unit_test(an_answer_without_an_agent_is_no_rival),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
