/* The world: deterministic, within its limits, and seen only through the tracker. */
#include "support.hpp"

#include <limits>
#include <set>
#include <type_traits>

#include "world.hpp"

using namespace grrl_sim;

namespace
{

WorldParams exact_params()
{
    WorldParams params;
    params.contact_offset_sigma_m = 0.0;
    params.push_direction_sigma_rad = 0.0;
    params.friction_spread = 0.0;
    return params;
}

PushReason push(World &world, const PushCommand &command)
{
    std::string problem = world.begin_push(command);
    if (!problem.empty())
        fail_msg("%s", problem.c_str());
    while (world.step_frame()) {
    }
    return world.push_result().reason;
}

/* Across a link at a place along it, from 2 cm beside it. */
PushCommand push_across(const World &world, int link, double along_m)
{
    Pose pose = world.true_poses()[static_cast<size_t>(link)];
    double side = world.object().links[static_cast<size_t>(link)].half_width_m + 0.02;
    PushCommand command;
    command.start_m = transform(pose, {along_m, -side});
    command.end_m = transform(pose, {along_m, 0.05});
    return command;
}

/* A push at a random link that keeps to the table. */
void push_at_random(World &world, Random &random)
{
    std::vector<Pose> poses = world.true_poses();
    int link = random.below(static_cast<int>(poses.size()));
    const Pose &pose = poses[static_cast<size_t>(link)];
    Vec2 along = direction(random.uniform(-pi, pi));
    PushCommand command;
    command.start_m = pose.position - 0.1 * along;
    command.end_m = pose.position + 0.1 * along;
    if (check_push(command, {2.0, 1.6}).empty())
        (void)push(world, command);
}

void same_seed_is_the_same_run(void **)
{
    uint64_t hashes[3];
    double sums[3] = {0.0, 0.0, 0.0};
    const uint64_t seeds[3] = {7, 7, 8};
    for (int run = 0; run < 3; run++) {
        World world(must_build("RPRPRPR"), WorldParams{}, seeds[run]);
        Random random(3, Stream::PUSH);
        Frame frame;
        for (int i = 0; i < 40; i++) {
            push_at_random(world, random);
            world.observe(frame);
            for (const TrackedFeature &feature : frame.features)
                sums[run] += (feature.id + 1.0) * (feature.x_m + 2.0 * feature.y_m);
        }
        hashes[run] = world.state_hash();
    }
    assert_true(hashes[0] == hashes[1]);
    assert_true(hashes[0] != hashes[2]);
    assert_memory_equal(&sums[0], &sums[1], sizeof sums[0]);
}

void limits_hold_and_loops_stay_closed(void **)
{
    for (const char *text : {"RPRPRPR", "PRRRRP", "R(l1, R(l5, R(l4, R(l3, R(l2, l1)))))",
                             "P(l1, R(l4, R(l3, R(l2, l1))))", "R(l1, l2, l3, P(l4, l5))"}) {
        World world(must_build(text), WorldParams{}, 11);
        Random random(5, Stream::PUSH);
        for (int i = 0; i < 100; i++) {
            push_at_random(world, random);
            for (size_t j = 0; j < world.object().joints.size(); j++) {
                const JointSpec &joint = world.object().joints[j];
                double slack = joint.type == GRRL_REVOLUTE ? radians(3.0) : 0.002;
                double value = world.true_joint_value(static_cast<int>(j));
                assert_true(value > joint.lower - slack && value < joint.upper + slack);
                assert_true(world.true_loop_gap_m(static_cast<int>(j)) < 0.002);
            }
        }
    }
}

void a_push_at_the_end_turns_a_link(void **)
{
    World world(must_build("RRR"), exact_params(), 1);
    double before = world.true_poses()[0].angle;
    assert_int_equal(push(world, push_across(world, 0, -0.05)), PushReason::REACHED);
    assert_true(std::abs(world.true_poses()[0].angle - before) > radians(5.0));
    assert_true(world.push_result().touched);
    double travelled = world.push_result().travelled_m;
    assert_true(travelled > 0.0299 && travelled < 0.033);
    assert_true(world.true_joint_range(0) > radians(1.0));
}

void a_push_beside_everything_misses(void **)
{
    World world(must_build("R"), exact_params(), 2);
    uint64_t before = world.state_hash();
    double corner = world.true_poses()[0].position.x > 0.0 ? -1.2 : 1.2;
    PushCommand command;
    command.start_m = {corner, 1.1};
    command.end_m = {corner, 1.0};
    assert_int_equal(push(world, command), PushReason::MISSED);
    assert_false(world.push_result().touched);
    assert_true(world.state_hash() == before);
}

void a_weak_push_is_blocked(void **)
{
    World world(must_build("RPRPRPR"), exact_params(), 3);
    PushCommand command = push_across(world, 3, 0.0);
    command.force_limit_n = 0.05;
    std::vector<Pose> before = world.true_poses();
    assert_int_equal(push(world, command), PushReason::BLOCKED);
    for (size_t i = 0; i < before.size(); i++)
        assert_true(length(world.true_poses()[i].position - before[i].position) < 0.001);
    command = push_across(world, 3, 0.0);
    command.timeout_s = 0.2;
    assert_int_equal(push(world, command), PushReason::TIMEOUT);
}

void the_finger_does_not_land_on_a_link(void **)
{
    World world(must_build("RRR"), exact_params(), 4);
    PushCommand command = push_across(world, 1, 0.0);
    command.start_m = world.true_poses()[1].position;
    assert_int_equal(push(world, command), PushReason::REACHED);
    assert_true(length(world.push_result().from_m - command.start_m) > 0.0275);
}

void friction_holds_what_is_not_pushed(void **)
{
    World world(must_build("D(R(l1, l2), P(l3, l4))"), exact_params(), 5);
    std::vector<Pose> before = world.true_poses();
    assert_int_equal(push(world, push_across(world, 0, -0.05)), PushReason::REACHED);
    for (size_t i = 2; i < 4; i++)
        assert_true(length(world.true_poses()[i].position - before[i].position) < 1e-6);
    uint64_t rest = world.state_hash();
    for (int i = 0; i < 30; i++)
        assert_false(world.step_frame());
    assert_true(world.state_hash() == rest);
}

void bad_commands_are_refused(void **)
{
    World world(must_build("R"), WorldParams{}, 1);
    PushCommand good;
    good.end_m = {0.1, 0.0};
    PushCommand bad = good;
    bad.start_m.x = std::numeric_limits<double>::quiet_NaN();
    assert_contains(world.begin_push(bad), "start (nan, 0) m is off the table; it must be finite");
    bad = good;
    bad.end_m.y = 1.4;
    assert_contains(world.begin_push(bad), "end (0.1, 1.4) m is off the table");
    bad = good;
    bad.end_m = bad.start_m;
    assert_contains(world.begin_push(bad), "at least 0.001 m apart");
    bad = good;
    bad.speed_m_s = 0.6;
    assert_contains(world.begin_push(bad), "speed 0.6 m/s must be above 0 and at most 0.5");
    bad = good;
    bad.force_limit_n = -1.0;
    assert_contains(world.begin_push(bad), "force limit -1 N must be above 0 and at most 10");
    bad = good;
    bad.travel_m = 0.0;
    assert_contains(world.begin_push(bad), "travel");
    bad = good;
    bad.timeout_s = std::numeric_limits<double>::infinity();
    assert_contains(world.begin_push(bad), "timeout inf s must be above 0 and at most 10");
    assert_string_equal(world.begin_push(good).c_str(), "");
    assert_contains(world.begin_push(good), "a push is in progress");
}

void bad_parameters_are_refused(void **)
{
    WorldParams params;
    assert_string_equal(check_world(params).c_str(), "");
    params.tracker.noise_sigma_m = -1.0;
    assert_contains(check_world(params), "noise sigma (m) is -1 but must be from 0 to 0.1");
    params = WorldParams{};
    params.table_friction = std::numeric_limits<double>::quiet_NaN();
    assert_contains(check_world(params), "table friction is nan but must be");
}

void a_joint_to_the_background_stays_in_place(void **)
{
    World world(must_build("R(lb, R(l1, l2))"), exact_params(), 6);
    size_t background = 0;
    while (!world.object().links[background].fixed)
        background++;
    assert_string_equal(world.object().links[background].name.c_str(), "lb");
    Random random(2, Stream::PUSH);
    Pose before = world.true_poses()[background];
    for (int i = 0; i < 30; i++)
        push_at_random(world, random);
    assert_true(length(world.true_poses()[background].position - before.position) <= 0.0);
    for (size_t j = 0; j < 2; j++)
        assert_true(world.true_joint_range(static_cast<int>(j)) > radians(5.0));
    for (int id = 0; id < world.tracker().feature_count(); id++)
        assert_int_not_equal(world.tracker().true_link(static_cast<uint32_t>(id)), background);
}

void features_vary_and_ids_hide_the_bodies(void **)
{
    int neighbours = 0;
    int same_body = 0;
    for (uint64_t seed = 0; seed < 20; seed++) {
        World world(must_build("RPRPRPR"), WorldParams{}, seed);
        const Tracker &tracker = world.tracker();
        std::vector<int> counts(9, 0);
        for (int id = 0; id < tracker.feature_count(); id++) {
            int link = tracker.true_link(static_cast<uint32_t>(id));
            counts[static_cast<size_t>(link + 1)]++;
            neighbours += id > 0 ? 1 : 0;
            if (id > 0 && link == tracker.true_link(static_cast<uint32_t>(id - 1)))
                same_body++;
        }
        assert_int_equal(counts[0], 25);
        std::set<int> different(counts.begin() + 1, counts.end());
        assert_true(*different.begin() >= 8 && *different.rbegin() <= 14);
        assert_true(different.size() > 1);
    }
    /* By chance: sum of squared shares, 8 (11/113)^2 + (25/113)^2 = 0.125. */
    double share = static_cast<double>(same_body) / neighbours;
    assert_true(share > 0.10 && share < 0.15);
}

void frames_are_noisy_by_the_right_sigma(void **)
{
    WorldParams params;
    World world(must_build("RPR"), params, 9);
    std::vector<Pose> poses = world.true_poses();
    double sum = 0.0;
    double squares = 0.0;
    int n = 0;
    Frame frame;
    for (int i = 0; i < 100; i++) {
        world.step_frame();
        world.observe(frame);
        assert_int_equal(frame.index, i + 1);
        for (size_t k = 0; k < frame.features.size(); k++) {
            const TrackedFeature &seen = frame.features[k];
            assert_true(k == 0 || frame.features[k - 1].id < seen.id);
            Vec2 truth = world.tracker().true_position(seen.id, poses);
            for (double error : {seen.x_m - truth.x, seen.y_m - truth.y}) {
                sum += error;
                squares += error * error;
                n++;
            }
        }
    }
    assert_true(n > 10000);
    assert_true(std::abs(sum / n) < 4.0 * 0.0007 / std::sqrt(n));
    assert_true(std::abs(std::sqrt(squares / n) / 0.0007 - 1.0) < 0.03);
}

void dropouts_and_outliers_come_as_often_as_told(void **)
{
    WorldParams params;
    params.tracker.dropout_probability = 0.2;
    params.tracker.outlier_probability = 0.1;
    World world(must_build("RPR"), params, 9);
    std::vector<Pose> poses = world.true_poses();
    int seen = 0;
    int jumped = 0;
    Frame frame;
    for (int i = 0; i < 200; i++) {
        world.observe(frame);
        for (const TrackedFeature &feature : frame.features) {
            Vec2 truth = world.tracker().true_position(feature.id, poses);
            double error = length(Vec2{feature.x_m, feature.y_m} - truth);
            assert_true(error < 0.06);
            seen++;
            jumped += error > 0.005 ? 1 : 0; /* nine in ten jumps go further */
        }
    }
    double expected = 200.0 * world.tracker().feature_count();
    assert_true(std::abs(seen / expected - 0.8) < 0.02);
    assert_true(std::abs(static_cast<double>(jumped) / seen - 0.09) < 0.015);
}

void the_background_is_static_and_hidden_when_covered(void **)
{
    WorldParams params;
    params.tracker.background_features = 90;
    World world(must_build("RPRPRPR"), params, 21);
    const Tracker &tracker = world.tracker();
    std::vector<Pose> start = world.true_poses();
    Random random(1, Stream::PUSH);
    Frame frame;
    int hidden = 0;
    for (int i = 0; i < 60; i++) {
        push_at_random(world, random);
        world.observe(frame);
        std::vector<Pose> poses = world.true_poses();
        std::set<uint32_t> visible;
        for (const TrackedFeature &feature : frame.features)
            visible.insert(feature.id);
        for (uint32_t id = 0; id < static_cast<uint32_t>(tracker.feature_count()); id++) {
            bool background = tracker.true_link(id) < 0;
            Vec2 place = tracker.true_position(id, poses);
            bool covered = false;
            for (size_t l = 0; l < poses.size(); l++)
                covered = covered || distance({poses[l], 0.065, 0.0175}, place) <= 0.0;
            assert_int_equal(visible.count(id), background && covered ? 0 : 1);
            hidden += background && covered ? 1 : 0;
            if (background)
                assert_true(length(place - tracker.true_position(id, start)) <= 0.0);
        }
    }
    assert_true(hidden > 0);
}

void a_full_structure_keeps_to_what_a_tracker_follows(void **)
{
    World world(must_build("RRRRRRRRRRRRRRR"), WorldParams{}, 4);
    assert_true(world.tracker().feature_count() <= GRRL_MAX_FEATURES);
    std::vector<int> counts(17, 0);
    for (int id = 0; id < world.tracker().feature_count(); id++)
        counts[static_cast<size_t>(world.tracker().true_link(static_cast<uint32_t>(id)) + 1)]++;
    for (size_t i = 1; i < counts.size(); i++)
        assert_true(counts[i] >= 6);
}

/* A frame is ids and coordinates: this stops compiling if anything is added to it. */
void a_frame_holds_nothing_but_what_is_seen(void **)
{
    auto [id, x, y] = TrackedFeature{1, 2.0, 3.0};
    static_assert(std::is_same_v<decltype(id), uint32_t>);
    static_assert(std::is_same_v<decltype(x), double> && std::is_same_v<decltype(y), double>);
    Frame frame;
    auto &[index, time_s, features] = frame;
    static_assert(std::is_same_v<decltype(features), std::vector<TrackedFeature>>);
    assert_int_equal(index, 0);
    assert_true(time_s <= 0.0 && id == 1 && x < y);
}

void a_copy_is_the_same_scene_and_leaves_it_alone(void **)
{
    World world(must_build("RPRPRPR"), WorldParams{}, 5);
    PushCommand push;
    push.end_m = world.true_poses()[3].position;
    push.start_m = push.end_m + Vec2{0.0, 0.1};
    assert_string_equal(world.begin_push(push).c_str(), "");
    while (world.step_frame())
        ;
    assert_true(world.push_result().touched);
    push.start_m = world.true_poses()[3].position + Vec2{0.0, 0.1};
    push.end_m = world.true_poses()[3].position;
    uint64_t before = world.state_hash();
    World a = world.copy(7);
    World b = world.copy(7);
    World c = world.copy(8);
    assert_true(a.state_hash() == before);
    for (int j = 0; j < 7; j++)
        assert_true(std::abs(a.true_joint_value(j) - world.true_joint_value(j)) < 1e-6);
    for (World *copy : {&a, &b, &c}) {
        assert_string_equal(copy->begin_push(push).c_str(), "");
        while (copy->step_frame())
            ;
    }
    assert_true(a.state_hash() == b.state_hash());
    assert_true(a.state_hash() != c.state_hash());
    assert_true(a.state_hash() != before);
    assert_true(world.state_hash() == before);
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(same_seed_is_the_same_run),
        cmocka_unit_test(limits_hold_and_loops_stay_closed),
        cmocka_unit_test(a_push_at_the_end_turns_a_link),
        cmocka_unit_test(a_push_beside_everything_misses),
        cmocka_unit_test(a_weak_push_is_blocked),
        cmocka_unit_test(the_finger_does_not_land_on_a_link),
        cmocka_unit_test(friction_holds_what_is_not_pushed),
        cmocka_unit_test(bad_commands_are_refused),
        cmocka_unit_test(bad_parameters_are_refused),
        cmocka_unit_test(a_joint_to_the_background_stays_in_place),
        cmocka_unit_test(features_vary_and_ids_hide_the_bodies),
        cmocka_unit_test(frames_are_noisy_by_the_right_sigma),
        cmocka_unit_test(dropouts_and_outliers_come_as_often_as_told),
        cmocka_unit_test(the_background_is_static_and_hidden_when_covered),
        cmocka_unit_test(a_full_structure_keeps_to_what_a_tracker_follows),
        cmocka_unit_test(a_copy_is_the_same_scene_and_leaves_it_alone),
        cmocka_unit_test(a_frame_holds_nothing_but_what_is_seen),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
