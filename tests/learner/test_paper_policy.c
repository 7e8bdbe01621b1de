/* The policy paper: phi, Interval Estimation, bounds, on a store made by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/learner/relational_q/paper_policy.h"

#define SEED UINT64_C(20080629)

enum { LINKS = 2, ACTIONS = LINKS * GRRL_DIRECTIONS, DRAWS = 20000 };

/* A store whose experience i stands for action i of a state of two links. */
struct fixture {
    struct grrl_experience_store store;
    struct grrl_experience_state states[1];
    struct grrl_experience experiences[ACTIONS];
    struct grrl_recall recall;
    struct grrl_paper_config config;
    struct grrl_random random;
};

static struct fixture f;

static void know(unsigned action, float value, float deviations, uint32_t n)
{
    f.experiences[action].q = (struct grrl_q){value, value, deviations, n};
    f.recall.entry[action / GRRL_DIRECTIONS][action % GRRL_DIRECTIONS] = (struct grrl_recall_entry){
        .experience = (uint32_t)action, .level = GRRL_RECALL_SUBSTRUCTURE, .distance = 3};
}

static int set_up(void **state)
{
    (void)state;
    memset(&f, 0, sizeof f);
    grrl_experience_init(&f.store, f.states, 1, f.experiences, ACTIONS);
    grrl_paper_config_default(&f.config);
    grrl_random_init(&f.random, SEED, 1);
    f.recall.n_links = LINKS;
    for (int link = 0; link < GRRL_MAX_LINKS; link++)
        for (int direction = 0; direction < GRRL_DIRECTIONS; direction++)
            f.recall.entry[link][direction].experience = GRRL_NO_EXPERIENCE;
    return 0;
}

static unsigned choose(struct grrl_choice *choice)
{
    grrl_paper_choose(&f.config, &f.store, &f.recall, &f.random, choice);
    assert_true(choice->link < LINKS && choice->direction < GRRL_DIRECTIONS);
    return choice->link * (unsigned)GRRL_DIRECTIONS + choice->direction;
}

/* Each of the wanted actions is chosen about equally often, no other ever. */
static void check_uniform(const unsigned *count, uint32_t wanted)
{
    unsigned n = 0;
    unsigned sum = 0;
    for (unsigned i = 0; i < ACTIONS; i++) {
        n += wanted >> i & 1u;
        sum += count[i];
    }
    for (unsigned i = 0; i < ACTIONS; i++) {
        if ((wanted >> i & 1u) == 0) {
            assert_int_equal(count[i], 0);
            continue;
        }
        double mean = (double)sum / n;
        assert_true(fabs(count[i] - mean) < 6.0 * sqrt(mean));
    }
}

static void exploration_follows_phi(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    uint32_t known = 0;
    for (unsigned n = 0; n <= ACTIONS; n++) {
        unsigned count[ACTIONS] = {0};
        unsigned explored = 0;
        for (int i = 0; i < DRAWS; i++) {
            struct grrl_choice choice;
            unsigned action = choose(&choice);
            assert_true(fabsf(choice.phi - (float)n / ACTIONS) < 1e-6f);
            if (choice.reason == GRRL_CHOICE_EXPLORE) {
                explored++;
                count[action]++;
                assert_int_equal(choice.source.kind, GRRL_SOURCE_NONE);
            } else {
                assert_int_equal(choice.reason, GRRL_CHOICE_EXPLOIT);
                assert_int_equal(choice.source.index, action);
            }
        }
        double share = n < ACTIONS ? exp(-2.0 * n / ACTIONS) : 0.0;
        assert_true(fabs(explored - share * DRAWS) <= 5.0 * sqrt(DRAWS * share * (1.0 - share)));
        if (explored > 0)
            check_uniform(count, ((1u << ACTIONS) - 1u) & ~known);
        if (n < ACTIONS) {
            unsigned next = n * 5 % ACTIONS;
            know(next, (float)n, 0.0f, 1);
            known |= 1u << next;
        }
    }
}

static void the_highest_upper_bound_wins(void **state)
{
    (void)state;
    for (unsigned i = 0; i < ACTIONS; i++)
        know(i, 0.0f, 0.0f, 100);
    know(4, 1.0f, 0.0f, 100);
    know(7, 0.9f, 0.0f, 1); /* 0.9 + 0.25 beats 1 + 0.25 * 0.1 / 10 */
    struct grrl_choice choice;
    assert_int_equal(choose(&choice), 7);
    assert_int_equal(choice.reason, GRRL_CHOICE_EXPLOIT);
    assert_int_equal(choice.source.index, 7);
    assert_int_equal(choice.source.kind, GRRL_SOURCE_SUBSTRUCTURE);
    assert_int_equal(choice.source.distance, 3);
    assert_true(choice.value == 0.9f && fabsf(choice.upper - 1.15f) < 1e-6f &&
                fabsf(choice.lower - 0.65f) < 1e-6f && choice.phi == 1.0f);
    f.config.z = 0.0f;
    assert_int_equal(choose(&choice), 4);
    for (unsigned i = 0; i < ACTIONS; i++)
        know(i, -3.0f - (float)i, 0.0f, 1); /* the best of bad ones */
    assert_int_equal(choose(&choice), 0);
}

static void ties_are_broken_at_random(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    for (unsigned i = 0; i < ACTIONS; i++)
        know(i, i % 3 == 0 ? 2.0f : 1.0f, 0.0f, 4);
    unsigned count[ACTIONS] = {0};
    for (int i = 0; i < DRAWS; i++) {
        struct grrl_choice choice;
        count[choose(&choice)]++;
    }
    check_uniform(count, 0x249);
}

static void bounds_shrink_with_the_targets_met(void **state)
{
    (void)state;
    struct grrl_q q = {.value = 2.0f, .deviations = 0.0f, .n = 1};
    float lower, upper;
    f.config.z = 2.0f;
    f.config.prior_sd = 3.0f;
    grrl_paper_bounds(&f.config, &q, &lower, &upper);
    assert_true(fabsf(upper - 8.0f) < 1e-5f && fabsf(lower + 4.0f) < 1e-5f);
    q.n = 4;
    q.deviations = 27.0f; /* (27 + 9) / 4 = 9: sd 3, over 2 */
    grrl_paper_bounds(&f.config, &q, &lower, &upper);
    assert_true(fabsf(upper - 5.0f) < 1e-5f && fabsf(lower + 1.0f) < 1e-5f);
}

static void the_best_value_is_that_of_known_actions(void **state)
{
    (void)state;
    assert_true(grrl_paper_best_value(&f.store, &f.recall) == 0.0f);
    know(5, -2.0f, 0.0f, 1);
    assert_true(grrl_paper_best_value(&f.store, &f.recall) == -2.0f);
    know(8, 1.5f, 0.0f, 1);
    assert_true(grrl_paper_best_value(&f.store, &f.recall) == 1.5f);
}

static void check_refused(const char *name)
{
    const char *field = NULL;
    assert_int_equal(grrl_paper_config_check(&f.config, &field), GRRL_ERR_ARGUMENT);
    assert_string_equal(field, name);
    assert_int_equal(grrl_paper_config_check(&f.config, NULL), GRRL_ERR_ARGUMENT);
    grrl_paper_config_default(&f.config);
}

static void a_parameter_out_of_range_is_named(void **state)
{
    (void)state;
    const char *field = NULL;
    assert_int_equal(grrl_paper_config_check(&f.config, &field), GRRL_OK);
    assert_null(field);
    struct grrl_paper_config *c = &f.config;
    const struct {
        const char *name;
        float *value;
        float wrong[4];
    } floats[] = {{"alpha", &c->alpha, {0.0f, -0.1f, 1.01f, NAN}},
                  {"gamma", &c->gamma, {-0.1f, 1.0f, INFINITY, NAN}},
                  {"beta", &c->beta, {-0.1f, 1e9f, INFINITY, NAN}},
                  {"z", &c->z, {-0.1f, 1e9f, INFINITY, NAN}},
                  {"prior_sd", &c->prior_sd, {-0.1f, 1e9f, INFINITY, NAN}}};
    for (unsigned i = 0; i < sizeof floats / sizeof floats[0]; i++) {
        for (unsigned k = 0; k < 4; k++) {
            *floats[i].value = floats[i].wrong[k];
            check_refused(floats[i].name);
        }
    }
    c->recall.deepest = (enum grrl_recall_level)3;
    check_refused("recall.deepest");
    c->recall.budget = 0;
    check_refused("recall.budget");
    c->recall.states = 0;
    check_refused("recall.states");
    c->recall.states = GRRL_RECALL_STATES + 1;
    check_refused("recall.states");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(exploration_follows_phi, set_up),
        cmocka_unit_test_setup(the_highest_upper_bound_wins, set_up),
        cmocka_unit_test_setup(ties_are_broken_at_random, set_up),
        cmocka_unit_test_setup(bounds_shrink_with_the_targets_met, set_up),
        cmocka_unit_test_setup(the_best_value_is_that_of_known_actions, set_up),
        cmocka_unit_test_setup(a_parameter_out_of_range_is_named, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
