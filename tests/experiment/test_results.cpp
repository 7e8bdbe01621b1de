/* Statistics and tables against figures worked out by hand. */
#include <cmath>
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "claims.hpp"
#include "results.hpp"

extern "C" {
#include <cmocka.h>
}

using namespace grrl_experiment;

namespace
{

Experiments two_experiments()
{
    Experiments experiments(2);
    const int pushes[2][3] = {{1, 2, 3}, {3, 4, 100}};
    for (size_t e = 0; e < 2; e++)
        for (int t = 0; t < 3; t++) {
            TrialRow row;
            row.trial = t + 1;
            row.pushes = pushes[e][t];
            row.discovered = pushes[e][t] < 100;
            experiments[e].push_back(row);
        }
    return experiments;
}

void assert_near(double a, double b)
{
    if (!(std::abs(a - b) < 1e-3))
        fail_msg("%f is not %f", a, b);
}

void the_interval_is_students(void **)
{
    Mean e = mean_of({1.0, 2.0, 3.0, 4.0}); /* s = 1.29099, t(3) = 3.182 */
    assert_near(e.mean, 2.5);
    assert_near(e.half, 3.182 * 1.29099 / 2.0);
    assert_true(mean_of({7.0}).half < 0.0);
    assert_near(mean_of({7.0}).low(), 7.0);
    assert_near(t_quantile(30), 2.042);
    assert_near(t_quantile(40), 2.0211);
    assert_near(t_quantile(100), 1.9840);
}

void an_experiment_counts_as_one_number(void **)
{
    Mean e = pushes(two_experiments(), 1, 2); /* 1.5 and 3.5 */
    assert_int_equal(e.n, 2);
    assert_near(e.mean, 2.5);
    assert_near(e.half, 12.706 * std::sqrt(2.0) / std::sqrt(2.0));
    assert_near(capped(two_experiments(), 1, 3), 1.0 / 6.0);
}

void ranges_end_with_the_trials(void **)
{
    std::vector<Range> all = ranges(50);
    assert_int_equal(all.size(), 6);
    assert_int_equal(all[4].first, 41);
    assert_string_equal(all[4].label.c_str(), "last 10");
    std::vector<Range> few = ranges(7);
    assert_int_equal(few.size(), 3);
    assert_int_equal(few[1].last, 7);
    std::vector<Range> many = ranges(1000);
    assert_int_equal(many.size(), 10);
    assert_string_equal(many[7].label.c_str(), "501-1000");
}

void csv_quotes_what_it_must(void **)
{
    Plan plan;
    Curve curve;
    curve.course.text = "R(l1, l2)";
    curve.course.trials = 3;
    curve.policy = find_policy("paper");
    for (const char *object : {"RR", "P"}) {
        curve.before.emplace_back();
        curve.before.back().text = object;
        curve.before.back().trials = 5;
    }
    plan.curves.push_back(curve);
    std::string csv = trials_csv(plan, {two_experiments()}, {2001, 2002});
    assert_non_null(
        std::strstr(csv.c_str(), "\n\"R(l1, l2)\",paper,\"RR:5, P:5\",2,2002,3,100,capped,0\n"));
    std::string summary = summary_csv(plan, {two_experiments()});
    assert_non_null(std::strstr(
        summary.c_str(), "\n\"R(l1, l2)\",paper,\"RR:5, P:5\",2,2,2,2,3.000,-9.706,15.706,"));
}

void the_distance_from_the_bound_is_taken_trial_by_trial(void **)
{
    std::vector<Experiments> results = {two_experiments(), two_experiments()};
    for (Trials &trials : results[1])
        for (TrialRow &row : trials)
            row.pushes = row.trial;
    Figure figure;
    assert_int_equal(shown(figure, results, 0)[1][2].pushes, 100);
    figure.bound = 1;
    assert_int_equal(shown(figure, results, 0)[1][2].pushes, 97);
    assert_near(pushes(shown(figure, results, 0), 1, 2).mean, 1.0); /* 0, 0, 2, 2 */
}

void a_claim_needs_every_difference(void **)
{
    Experiments low(3);
    Experiments high(3);
    for (size_t e = 0; e < 3; e++) {
        TrialRow row;
        row.trial = 1;
        row.pushes = static_cast<int>(e);
        low[e].push_back(row);
        row.pushes += 5 + static_cast<int>(e % 2);
        high[e].push_back(row);
    }
    assert_string_equal(is_below({low}, {high}, 1, 1).c_str(), "yes");
    assert_string_equal(is_below({high}, {low}, 1, 1).c_str(), "NO");
    assert_string_equal(is_below({low}, {high, low}, 1, 1).c_str(), "unclear");
    assert_string_equal(is_below({low, high}, {low, high}, 1, 1).c_str(), "NO");
}

void every_policy_has_a_name_of_its_own(void **)
{
    for (const Policy &policy : policies())
        assert_ptr_equal(find_policy(policy.name), &policy);
    for (const Policy &policy : ablations())
        assert_ptr_equal(find_policy(policy.name), &policy);
    assert_null(find_policy("nobody"));
}

/* A policy's configuration, bytes that nobody set being zero. */
struct Configuration {
    explicit Configuration(const Policy &policy)
    {
        std::memset(&learner, 0, sizeof learner);
        grrl_learner_config_default(&learner);
        policy.type->config_default(config);
        if (policy.configure)
            policy.configure(learner, config);
    }
    grrl_learner_config learner;
    alignas(std::max_align_t) unsigned char config[GRRL_POLICY_CONFIG_BYTES] = {};
};

void an_ablation_changes_what_it_says(void **)
{
    for (const Policy &policy : ablations()) {
        const Policy &base = *find_policy(policy.name.substr(0, 5)); /* paper or learn */
        Configuration whole(base);
        Configuration changed(policy);
        assert_ptr_equal(policy.type, base.type);
        assert_int_equal(policy.type->config_check(changed.config, nullptr), GRRL_OK);
        assert_true(policy.capacity != base.capacity ||
                    std::memcmp(&changed.learner, &whole.learner, sizeof whole.learner) != 0 ||
                    std::memcmp(changed.config, whole.config, sizeof whole.config) != 0);
    }
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_interval_is_students),
        cmocka_unit_test(an_experiment_counts_as_one_number),
        cmocka_unit_test(ranges_end_with_the_trials),
        cmocka_unit_test(csv_quotes_what_it_must),
        cmocka_unit_test(the_distance_from_the_bound_is_taken_trial_by_trial),
        cmocka_unit_test(a_claim_needs_every_difference),
        cmocka_unit_test(every_policy_has_a_name_of_its_own),
        cmocka_unit_test(an_ablation_changes_what_it_says),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
