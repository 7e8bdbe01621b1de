/* Lost, repeated, late messages, rivals, frozen and restarted peers: the run goes on with the same
 * result, or stops with a word; and never is a reward learned for another action (harness.hpp
 * asserts that at each update). */
#include "harness.hpp"

using namespace harness;

namespace
{

Setup lossy(uint64_t seed)
{
    Setup setup;
    setup.object = "RPR";
    setup.trials = 5;
    setup.faults.loss = 0.1;
    setup.faults.seed = seed;
    return setup;
}

Setup clean()
{
    Setup setup = lossy(1);
    setup.faults = {};
    return setup;
}

void with_loss_the_run_is_the_same_bit_for_bit(void **)
{
    Outcome expected = run(clean());
    for (uint64_t seed = 1; seed <= 5; seed++) {
        Outcome outcome = run(lossy(seed));
        assert_same(expected, outcome);
        double part = static_cast<double>(outcome.bus.lost) /
                      static_cast<double>(outcome.bus.lost + outcome.bus.passed);
        print_message("seed %d: %d of %d messages lost\n", static_cast<int>(seed),
                      static_cast<int>(outcome.bus.lost),
                      static_cast<int>(outcome.bus.lost + outcome.bus.passed));
        assert_true(part > 0.07 && part < 0.13);
    }
}

void with_repetition_and_disorder_it_is_the_same(void **)
{
    Outcome expected = run(clean());
    for (uint64_t seed = 1; seed <= 5; seed++) {
        Setup setup = lossy(seed);
        setup.faults.twice = 0.1;
        setup.faults.late = 0.1;
        Outcome outcome = run(setup);
        assert_same(expected, outcome);
        assert_true(outcome.bus.twice > 0 && outcome.bus.late > 0);
    }
}

void a_bus_that_loses_most_is_slow_and_the_same(void **)
{
    Setup setup = lossy(1);
    setup.object = "RR";
    setup.trials = 2;
    Setup good = clean();
    good.object = "RR";
    good.trials = 2;
    setup.faults.loss = 0.6;
    Outcome outcome = run(setup);
    assert_same(run(good), outcome);
    assert_true(outcome.bus.lost > outcome.bus.passed);
}

bool told(const Outcome &outcome, const char *what)
{
    return outcome.notes.find(what) != std::string::npos;
}

void a_second_agent_learns_nothing_and_changes_nothing(void **)
{
    Outcome expected = run(clean());
    for (double loss : {0.0, 0.1}) {
        Setup setup = clean();
        setup.second_agent_at = 1;
        setup.faults.loss = loss;
        Outcome outcome = run(setup);
        assert_same(expected, outcome);
        assert_int_equal(outcome.rival_lessons, 0);
        assert_true(told(outcome, "another agent is in control and this one waits"));
        assert_true(told(outcome, "another agent answers too"));
    }
}

void a_second_agent_takes_over_when_the_first_is_gone(void **)
{
    Setup setup = clean();
    setup.object = "RPRPR";
    setup.second_agent_at = 1;
    setup.stop_agent_at = 3;
    Outcome outcome = run(setup);
    assert_int_equal(outcome.aborted, 1);
    assert_int_equal(outcome.trials.size(), 5);
    assert_true(outcome.rival_lessons > 0);
}

void a_second_simulator_changes_nothing(void **)
{
    Outcome expected = run(clean());
    Setup setup = clean();
    setup.second_node_at = 1;
    setup.faults.loss = 0.1;
    Outcome outcome = run(setup);
    assert_same(expected, outcome);
    assert_true(outcome.bus.lost > 0);
    assert_true(told(outcome, "another simulator or tracker is sending"));
}

/* Longer than the other side takes for a restart, and in the middle of the run. */
void assert_same_though_frozen(const Outcome &expected, const Setup &setup)
{
    Outcome outcome = run(setup);
    assert_same(expected, outcome);
    assert_true(outcome.frozen_us > 2000000);
    assert_true(outcome.pushes.size() > 3);
}

void a_frozen_agent_goes_on_with_the_same_result(void **)
{
    Outcome expected = run(clean());
    Setup setup = clean();
    setup.freeze_agent_at = 3;
    assert_same_though_frozen(expected, setup);
    setup.faults.loss = 0.1;
    assert_same_though_frozen(expected, setup);
}

void a_frozen_simulator_goes_on_with_the_same_result(void **)
{
    Outcome expected = run(clean());
    Setup setup = clean();
    setup.freeze_node_at = 3;
    assert_same_though_frozen(expected, setup);
    setup.faults.loss = 0.1;
    assert_same_though_frozen(expected, setup);
}

void restarted_peers_cost_one_trial_on_a_bad_bus(void **)
{
    for (uint64_t seed = 1; seed <= 3; seed++) {
        Setup setup = lossy(seed);
        setup.object = "RPRPR";
        setup.faults.twice = 0.1;
        setup.faults.late = 0.1;
        setup.restart_agent_at = 2;
        Outcome outcome = run(setup);
        assert_int_equal(outcome.aborted, 1);
        assert_int_equal(outcome.trials.size(), 5);
        assert_true(told(outcome, "the agent was restarted"));
        setup.restart_agent_at = 0;
        setup.restart_node_at = 2;
        outcome = run(setup);
        assert_int_equal(outcome.trials.size(), 5);
        assert_true(told(outcome, "the simulator or tracker was restarted"));
    }
}

void real_time_survives_a_bad_bus(void **)
{
    Setup setup = lossy(1);
    setup.object = "RR";
    setup.trials = 2;
    setup.real_time = true;
    setup.faults.twice = 0.1;
    setup.faults.late = 0.1;
    Outcome outcome = run(setup);
    assert_int_equal(outcome.trials.size(), 2);
    assert_true(outcome.trials[0] < 100);
}

void a_scene_without_points_stops_the_run(void **)
{
    for (double loss : {0.0, 0.1}) {
        Setup setup = clean();
        setup.dropout = 1.0;
        setup.faults.loss = loss;
        Outcome outcome = run(setup);
        assert_true(outcome.blind);
        assert_true(outcome.trials.empty());
        assert_true(told(outcome, "no link is visible that could be pushed"));
    }
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(with_loss_the_run_is_the_same_bit_for_bit),
        cmocka_unit_test(with_repetition_and_disorder_it_is_the_same),
        cmocka_unit_test(a_bus_that_loses_most_is_slow_and_the_same),
        cmocka_unit_test(a_second_agent_learns_nothing_and_changes_nothing),
        cmocka_unit_test(a_second_agent_takes_over_when_the_first_is_gone),
        cmocka_unit_test(a_second_simulator_changes_nothing),
        cmocka_unit_test(a_frozen_agent_goes_on_with_the_same_result),
        cmocka_unit_test(a_frozen_simulator_goes_on_with_the_same_result),
        cmocka_unit_test(restarted_peers_cost_one_trial_on_a_bad_bus),
        cmocka_unit_test(real_time_survives_a_bad_bus),
        cmocka_unit_test(a_scene_without_points_stops_the_run),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
