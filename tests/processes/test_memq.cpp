/* Agent and simulator in one process over memq://: what a seed gives, and what repeated, old,
 * foreign and malformed messages and restarts must not change. */
#include "harness.hpp"

using namespace harness;

namespace
{

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

void a_restarted_agent_costs_one_trial(void **)
{
    Setup setup;
    setup.object = "RPRPR";
    setup.restart_agent_at = 2;
    Outcome outcome = run(setup);
    assert_int_equal(outcome.aborted, 1);
    assert_int_equal(outcome.trials.size(), 3);
}

void a_restarted_simulator_starts_over(void **)
{
    Setup setup;
    setup.object = "RPRPR";
    setup.restart_node_at = 2;
    Outcome outcome = run(setup);
    assert_int_equal(outcome.trials.size(), 3);
    assert_true(outcome.agent_foreign > 0); /* until the old one was silent for long enough */
}

void first_link_forward(void *, const grrl_view *, grrl_random *, grrl_choice *choice)
{
    *choice = grrl_choice{};
    choice->reason = GRRL_CHOICE_RULE;
    choice->source = grrl_no_source();
}

void a_policy_of_ones_own_chooses(void **)
{
    Setup setup;
    setup.cap = 5;
    grrl_policy_type forward = grrl_policy_random;
    forward.choose = first_link_forward;
    setup.policy = &forward;
    Run run(setup);
    Outcome outcome = run.finish();
    assert_int_equal(outcome.trials.size(), 3);
    int decisions = 0;
    for (const Message &message : run.messages()) {
        grrl_decision_t decision;
        grrl_wire_why why;
        if (message.channel != GRRL_CHANNEL_DECISION)
            continue;
        assert_true(grrl_wire_decode_decision(
            message.data.data(), static_cast<uint32_t>(message.data.size()), &decision, &why));
        assert_int_equal(decision.reason, GRRL_DECISION_T_RULE);
        assert_int_equal(decision.direction_deg, 0);
        decisions++;
    }
    assert_true(decisions >= static_cast<int>(outcome.pushes.size()));
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
        cmocka_unit_test(a_policy_of_ones_own_chooses),
        cmocka_unit_test(a_restarted_agent_costs_one_trial),
        cmocka_unit_test(a_restarted_simulator_starts_over),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
