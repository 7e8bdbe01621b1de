/* Rules: every context falls under one, and they tell apart what differs by a ratio. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "grrl/base/random.h"
#include "rules.h"

enum { MAX_CASES = 512 };

static struct grrl_case cases[MAX_CASES];
static struct grrl_case_base base;

static int set_up(void **state)
{
    (void)state;
    grrl_cases_init(&base, cases, MAX_CASES);
    return 0;
}

static void add(const struct grrl_context *context, uint8_t pushes, float mean)
{
    cases[base.n++] = (struct grrl_case){.key = grrl_context_key(context),
                                         .n_all = pushes,
                                         .n_found = (uint8_t)(mean > 1.0f ? pushes : pushes / 5),
                                         .value_all = mean};
}

/* Long links reveal 7 to 26, by their length and neighbours; tiny ones a half, or next to nothing
 * once pushed. */
static void fill(void)
{
    for (uint8_t length = 0; length <= 4; length++)
        for (uint8_t neighbour = 0; neighbour <= 5; neighbour++)
            for (uint8_t tried = 0; tried <= 3; tried++) {
                struct grrl_context context = {{0}};
                context.part[GRRL_CONTEXT_LENGTH] = length;
                context.part[GRRL_CONTEXT_NEIGHBOUR_LENGTH] = neighbour;
                context.part[GRRL_CONTEXT_TRIED] = tried;
                float reward = tried == 0 ? 0.5f : 0.01f;
                /* unlike tiny ones in more parts, so that they teach nothing on these */
                if (length > 0) {
                    context.part[GRRL_CONTEXT_REVOLUTE] = 2;
                    context.part[GRRL_CONTEXT_PRISMATIC] = 2;
                    context.part[GRRL_CONTEXT_ASPECT] = 2;
                    context.part[GRRL_CONTEXT_LONGER] = 2;
                    reward = 4.0f + (float)(2 * neighbour + 3 * length);
                }
                add(&context, 50, reward);
            }
}

static double mean(const struct grrl_rule *rule)
{
    return rule->reward / rule->pushes;
}

static void each_context_falls_under_one_rule(void **state)
{
    (void)state;
    struct grrl_rule rules[GRRL_MAX_RULES];
    fill();
    int n = grrl_rules_of(&base, rules);
    assert_in_range(n, 2, GRRL_MAX_RULES);
    double pushes = 0.0;
    double found = 0.0;
    for (int i = 0; i < n; i++) {
        pushes += rules[i].pushes;
        found += rules[i].found;
        if (i > 0)
            assert_true(mean(&rules[i - 1]) >= mean(&rules[i]));
    }
    assert_true(pushes == 50.0 * (double)base.n);
    /* of five lengths one is tiny, and there a fifth of the pushes find something */
    assert_true(found == 0.8 * pushes + 0.2 * 0.2 * pushes);
    struct grrl_random random;
    grrl_random_init(&random, 7, 0);
    for (int run = 0; run < 5000; run++) { /* also those never met */
        struct grrl_context context;
        unsigned under = 0;
        for (unsigned part = 0; part < GRRL_CONTEXT_PARTS; part++)
            context.part[part] = (uint8_t)grrl_random_below(&random, grrl_context_max[part] + 1u);
        for (int i = 0; i < n; i++)
            under += grrl_rule_holds(&rules[i], grrl_context_key(&context));
        assert_int_equal(under, 1);
    }
}

/* Tiny links differ by 0.5 only, but by a factor of 50: a choice among them depends on it. */
static void a_ratio_counts_more_than_a_difference(void **state)
{
    (void)state;
    struct grrl_rule rules[GRRL_MAX_RULES];
    fill();
    int n = grrl_rules_of(&base, rules);
    struct grrl_context fresh = {{0}};
    struct grrl_context tried = {{0}};
    tried.part[GRRL_CONTEXT_TRIED] = 1;
    for (int i = 0; i < n; i++)
        assert_false(grrl_rule_holds(&rules[i], grrl_context_key(&fresh)) &&
                     grrl_rule_holds(&rules[i], grrl_context_key(&tried)));
    assert_true(mean(&rules[n - 1]) < 0.02);
}

static void an_empty_store_has_no_rules(void **state)
{
    (void)state;
    struct grrl_rule rules[GRRL_MAX_RULES];
    assert_int_equal(grrl_rules_of(&base, rules), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(each_context_falls_under_one_rule, set_up),
        cmocka_unit_test_setup(a_ratio_counts_more_than_a_difference, set_up),
        cmocka_unit_test_setup(an_empty_store_has_no_rules, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
