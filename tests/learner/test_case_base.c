/* Estimates, doubt, eviction and the file of the cases. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/base/random.h"
#include "grrl/learner/cases/case_base.h"
#include "memory_file.h"

#define SEED UINT64_C(20080631)

enum { CAPACITY = 40 };

static struct {
    struct grrl_case_base base;
    struct grrl_case_config config;
    struct grrl_case cases[CAPACITY];
    struct grrl_random random;
} f;

static int set_up(void **state)
{
    (void)state;
    grrl_cases_init(&f.base, f.cases, CAPACITY);
    grrl_case_config_default(&f.config);
    grrl_random_init(&f.random, SEED, 1);
    return 0;
}

static struct grrl_context context(uint8_t a, uint8_t b)
{
    struct grrl_context context = {{0}};
    context.part[GRRL_CONTEXT_DIRECTION] = a;
    context.part[GRRL_CONTEXT_LENGTH] = b;
    return context;
}

static struct grrl_context random_context(void)
{
    struct grrl_context context;
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++) {
        uint32_t values = grrl_context_max[i] + 1u;
        context.part[i] = (uint8_t)grrl_random_below(&f.random, values < 2 ? values : 2);
    }
    return context;
}

/* Rewards of this object alone, at full weight. */
static void trust_always(void)
{
    f.config.general = 0.0f;
    f.config.confidence = GRRL_MAX_REWARD;
    f.base.log_odds = f.config.confidence;
}

static float estimate(const struct grrl_context *of)
{
    struct grrl_estimate estimate;
    grrl_cases_estimate(&f.base, &f.config, grrl_context_key(of), &estimate);
    return estimate.value;
}

static void nothing_known_is_worth_the_prior(void **state)
{
    (void)state;
    struct grrl_context a = context(0, 0);
    struct grrl_estimate estimate;
    grrl_cases_estimate(&f.base, &f.config, grrl_context_key(&a), &estimate);
    assert_true(estimate.value == f.config.prior && estimate.weight == f.config.prior_weight);
    assert_true(estimate.lower == f.config.prior - f.config.bound);
    assert_true(estimate.upper == f.config.prior + f.config.bound);
    assert_int_equal(estimate.closest, GRRL_NO_CASE);
}

/* Against a list of all rewards: a mean over them and the prior, by the parts that differ. */
static void an_estimate_is_the_weighted_mean_of_all_rewards(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_context met[CAPACITY];
    float reward[CAPACITY];
    trust_always();
    f.config.memory = CAPACITY;
    for (unsigned n = 0; n < CAPACITY; n++) {
        struct grrl_context asked = random_context();
        double weight = (double)f.config.prior_weight;
        double sum = weight * (double)f.config.prior;
        unsigned fewest = GRRL_CONTEXT_PARTS + 1;
        for (unsigned i = 0; i < n; i++) {
            unsigned differ = 0;
            for (unsigned part = 0; part < GRRL_CONTEXT_PARTS; part++)
                differ += met[i].part[part] != asked.part[part];
            double alike = pow((double)f.config.mismatch, differ);
            weight += alike;
            sum += alike * (double)reward[i];
            fewest = differ < fewest ? differ : fewest;
        }
        struct grrl_estimate estimate;
        grrl_cases_estimate(&f.base, &f.config, grrl_context_key(&asked), &estimate);
        assert_true(fabs((double)estimate.value - sum / weight) < 1e-4);
        assert_true(fabs((double)estimate.weight - weight) < 1e-3);
        if (n > 0)
            assert_int_equal(estimate.mismatches, fewest);
        met[n] = random_context();
        reward[n] = (float)grrl_random_below(&f.random, 4);
        assert_true(grrl_cases_learn(&f.base, &f.config, grrl_context_key(&met[n]), reward[n]) <
                    f.base.n);
        grrl_cases_begin_trial(&f.base, &f.config); /* newer rewards would count more */
    }
    assert_true(f.base.n > 1 && f.base.evictions == 0);
}

static void parts_left_out_do_not_count(void **state)
{
    (void)state;
    struct grrl_context a = context(0, 0);
    struct grrl_context b = context(2, 0);
    (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 3.0f);
    assert_true(estimate(&b) < estimate(&a));
    f.config.parts &= (uint16_t) ~(1u << GRRL_CONTEXT_DIRECTION);
    assert_true(estimate(&b) == estimate(&a));
}

static void the_latest_rewards_count(void **state)
{
    (void)state;
    struct grrl_context a = context(0, 0);
    trust_always();
    for (int i = 0; i < 50; i++)
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 0.0f);
    grrl_cases_begin_trial(&f.base, &f.config);
    float before = estimate(&a);
    for (int i = 0; i < 10; i++)
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 2.0f);
    grrl_cases_begin_trial(&f.base, &f.config);
    assert_true(before < 0.1f && estimate(&a) > 1.4f);
    assert_int_equal(f.base.cases[0].n, f.config.memory);
}

/* Of two contexts one finds something in each trial, the other nothing. */
static void learn_an_object(const struct grrl_context *good, const struct grrl_context *bad)
{
    for (int trial = 0; trial < 10; trial++) {
        grrl_cases_begin_trial(&f.base, &f.config);
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(good), 3.0f);
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(bad), 0.0f);
    }
    grrl_cases_begin_trial(&f.base, &f.config);
}

/* An object of another kind: what was expected does not come, and older rewards count less, in the
 * next trial, too; but one of each case stays. */
static void refuted_expectations_weaken_older_rewards(void **state)
{
    (void)state;
    struct grrl_context good = context(0, 0);
    struct grrl_context bad = context(2, 1);
    f.config.general = 0.0f;
    learn_an_object(&good, &bad);
    struct grrl_context other = context(0, 4);
    (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&other), 2.0f);
    (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&other), 2.0f);
    grrl_cases_begin_trial(&f.base, &f.config);
    float trusted = estimate(&good);
    float hoped = estimate(&other);
    assert_true(trusted > 2.0f && hoped > 1.0f && f.base.log_odds == f.config.confidence);
    for (int push = 0; push < 2; push++)
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&good), 0.0f);
    assert_true(f.base.log_odds == -1.0f);
    assert_true(estimate(&good) < 0.9f && estimate(&other) < hoped - 0.2f);
    grrl_cases_begin_trial(&f.base, &f.config);
    assert_true(f.base.log_odds == f.config.confidence);
    assert_true(estimate(&good) < 0.9f);
    assert_true(f.base.cases[0].n == f.config.memory && f.base.cases[2].n < 3);
    assert_true(f.base.cases[2].value == 2.0f);
}

/* The same failure in a trial that went as expected is one reward among others. */
static void a_failure_without_doubt_weakens_nothing(void **state)
{
    (void)state;
    struct grrl_context good = context(0, 0);
    struct grrl_context bad = context(2, 1);
    learn_an_object(&good, &bad);
    (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&good), 0.0f);
    for (int push = 0; push < 4; push++) {
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&good), 3.0f);
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&bad), 0.0f);
    }
    assert_true(f.base.log_odds > 0.0f);
    grrl_cases_begin_trial(&f.base, &f.config);
    assert_true(estimate(&good) > 1.7f);
    assert_int_equal(f.base.cases[0].n, f.config.memory);
}

static void what_was_to_be_expected_raises_no_doubt(void **state)
{
    (void)state;
    struct grrl_context good = context(0, 0);
    struct grrl_context bad = context(2, 1);
    f.config.general = 0.0f;
    learn_an_object(&good, &bad);
    f.base.log_odds = 0.0f;
    (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&bad),
                           0.0f); /* a failure, as ever */
    assert_true(f.base.log_odds > 0.0f);
    f.base.log_odds = 0.0f;
    (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&good),
                           1.0f); /* less than usual, but something */
    assert_true(f.base.log_odds > 0.0f);
    f.base.log_odds = 0.0f;
    (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&bad), 1.0f);
    assert_true(f.base.log_odds < 0.0f);
}

static void nothing_known_can_not_be_doubted(void **state)
{
    (void)state;
    grrl_cases_begin_trial(&f.base, &f.config);
    for (int push = 0; push < 50; push++) {
        struct grrl_context any = random_context();
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&any), 0.0f);
    }
    assert_true(f.base.log_odds == 0.0f);
}

static void doubt_has_bounds(void **state)
{
    (void)state;
    struct grrl_context good = context(0, 0);
    struct grrl_context bad = context(2, 1);
    f.config.memory = 50;
    learn_an_object(&good, &bad);
    float least = 0.0f;
    for (int push = 0; push < 200; push++) {
        struct grrl_context any = random_context();
        bool expected = grrl_random_below(&f.random, 2) == 0;
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(push % 3 == 0 ? &any : &good),
                               expected ? 3.0f : 0.0f);
        least = f.base.log_odds < least ? f.base.log_odds : least;
        assert_true(f.base.log_odds >= -1.0f);
        assert_true(f.base.log_odds <= f.config.confidence);
    }
    assert_true(least == -1.0f);
    trust_always();
    for (int push = 0; push < 100; push++)
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&good), 0.0f);
    grrl_cases_begin_trial(&f.base, &f.config);
    assert_true(f.base.log_odds == f.config.confidence && f.base.cases[0].n_new == 0);
}

static void newer_rewards_push_out_older_ones(void **state)
{
    (void)state;
    struct grrl_context a = context(0, 0);
    trust_always();
    for (int i = 0; i < 4; i++)
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 1.0f);
    assert_int_equal(f.base.cases[0].n, 0);
    assert_int_equal(f.base.cases[0].n_new, 4);
    grrl_cases_begin_trial(&f.base, &f.config);
    grrl_cases_begin_trial(&f.base, &f.config); /* once more changes nothing */
    assert_int_equal(f.base.cases[0].n, 4);
    assert_int_equal(f.base.cases[0].n_new, 0);
    for (int i = 0; i < 2; i++)
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 6.0f);
    grrl_cases_begin_trial(&f.base, &f.config);
    assert_int_equal(f.base.cases[0].n, 5); /* three ones and two sixes */
    assert_true(fabsf(f.base.cases[0].value - 3.0f) < 1e-5f);
}

/* The weight and value that all other objects add to the estimate of a context. */
static struct grrl_estimate added_by_others(const struct grrl_context *context)
{
    struct grrl_case_config config = f.config;
    struct grrl_estimate with;
    struct grrl_estimate without;
    grrl_cases_estimate(&f.base, &config, grrl_context_key(context), &with);
    config.general = 0.0f;
    grrl_cases_estimate(&f.base, &config, grrl_context_key(context), &without);
    return (struct grrl_estimate){.value = with.value - without.value,
                                  .weight = with.weight - without.weight};
}

/* What this object taught counts once, and doubt discounts it. From then on it is what another
 * object taught, and outlives doubt. */
static void what_all_objects_share_outlives_doubt(void **state)
{
    (void)state;
    struct grrl_context good = context(0, 0);
    struct grrl_context bad = context(2, 1);
    learn_an_object(&good, &bad);
    assert_int_equal(f.base.cases[0].n_all, 10);
    assert_int_equal(f.base.cases[0].n_found, 10);
    assert_int_equal(f.base.cases[1].n_found, 0);
    struct grrl_estimate added = added_by_others(&good);
    assert_true(fabsf(added.weight) < 1e-6f && fabsf(added.value) < 1e-6f);
    f.base.log_odds = -1.0f;
    grrl_cases_begin_trial(&f.base, &f.config);
    assert_in_range(f.base.cases[0].n, 1, f.config.memory - 1);
    f.base.log_odds = -1.0f;
    added = added_by_others(&good);
    assert_true(added.value > 0.05f);
    assert_true(fabsf(added.weight - 3.0f) < 1e-4f); /* and no more than that */
}

static void counts_of_a_full_case_are_halved(void **state)
{
    (void)state;
    struct grrl_context a = context(0, 0);
    for (int i = 0; i < GRRL_CASE_REWARDS; i++)
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), i % 5 == 0 ? 2.0f : 0.0f);
    assert_int_equal(f.base.cases[0].n_all, GRRL_CASE_REWARDS);
    assert_int_equal(f.base.cases[0].n_found, GRRL_CASE_REWARDS / 5);
    assert_true(fabsf(f.base.cases[0].value_all - 0.4f) < 1e-4f);
    (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 2.0f);
    assert_int_equal(f.base.cases[0].n_all, GRRL_CASE_REWARDS / 2 + 1);
    assert_int_equal(f.base.cases[0].n_found, GRRL_CASE_REWARDS / 10 + 1);
}

/* Some rewards in `n` contexts, in an order of their own. */
static void live(struct grrl_case_base *base, struct grrl_case *cases, unsigned n)
{
    grrl_cases_init(base, cases, CAPACITY);
    for (unsigned i = 0; i < n; i++) {
        struct grrl_context any = random_context();
        (void)grrl_cases_learn(base, &f.config, grrl_context_key(&any), (float)(i % 3));
    }
}

static void two_lives_merge_in_either_order(void **state)
{
    (void)state;
    static struct grrl_case cases[4][CAPACITY];
    struct grrl_case_base life[4];
    for (unsigned most = 5; most <= CAPACITY; most += 7) {
        grrl_random_init(&f.random, SEED, most);
        live(&life[0], cases[0], 14);
        live(&life[1], cases[1], 18);
        for (unsigned i = 0; i < 2; i++) {
            life[2 + i] = life[i];
            life[2 + i].cases = cases[2 + i];
            memcpy(cases[2 + i], cases[i], sizeof cases[i]);
        }
        assert_int_equal(grrl_cases_merge(&life[0], &life[1], &f.config, most), GRRL_OK);
        assert_int_equal(grrl_cases_merge(&life[3], &life[2], &f.config, most), GRRL_OK);
        assert_true(life[0].n > 0 && life[0].n <= most);
        assert_int_equal(life[0].n, life[3].n);
        assert_int_equal(life[0].clock, life[3].clock);
        assert_memory_equal(cases[0], cases[3], life[0].n * sizeof cases[0][0]);
    }
    life[0].capacity = life[0].n + life[1].n - 1;
    assert_int_equal(grrl_cases_merge(&life[0], &life[1], &f.config, CAPACITY), GRRL_ERR_FULL);
}

static void merged_rewards_are_pooled(void **state)
{
    (void)state;
    static struct grrl_case cases[CAPACITY];
    struct grrl_case_base other;
    struct grrl_context a = context(0, 0);
    grrl_cases_init(&other, cases, CAPACITY);
    for (int i = 0; i < 3; i++)
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 2.0f);
    (void)grrl_cases_learn(&other, &f.config, grrl_context_key(&a), 0.0f);
    assert_int_equal(grrl_cases_merge(&f.base, &other, &f.config, CAPACITY), GRRL_OK);
    assert_int_equal(f.base.n, 1);
    assert_int_equal(f.base.cases[0].n_all, 4);
    assert_int_equal(f.base.cases[0].n_found, 3);
    assert_true(fabsf(f.base.cases[0].value_all - 1.5f) < 1e-6f);
}

/* A merged life expects what all objects have in common, not what either life met last. */
static void a_merge_drops_rewards_of_the_latest_objects(void **state)
{
    (void)state;
    static struct grrl_case cases[CAPACITY];
    struct grrl_case_base other;
    struct grrl_context a = context(0, 0);
    grrl_cases_init(&other, cases, CAPACITY);
    for (int i = 0; i < 3; i++) {
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 2.0f);
        grrl_cases_begin_trial(&f.base, &f.config);
    }
    (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 2.0f);
    assert_int_equal(grrl_cases_merge(&f.base, &other, &f.config, CAPACITY), GRRL_OK);
    assert_int_equal(f.base.cases[0].n, 0);
    assert_int_equal(f.base.cases[0].n_new, 0);
    float prior = (f.config.prior + 4.0f * 2.0f) / (1.0f + 4.0f); /* of one and four rewards */
    assert_true(fabsf(estimate(&a) - prior) < 1e-6f);
}

static void the_best_founded_cases_outlive_a_merge(void **state)
{
    (void)state;
    static struct grrl_case cases[CAPACITY];
    struct grrl_case_base other;
    struct grrl_context often = context(0, 0);
    struct grrl_context once = context(2, 0);
    grrl_cases_init(&other, cases, CAPACITY);
    for (int i = 0; i < 3; i++)
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&often), 2.0f);
    for (int i = 0; i < 9; i++) { /* met later, each push in a context of its own */
        once.part[GRRL_CONTEXT_NEIGHBOUR_LENGTH] = (uint8_t)(i % 5);
        once.part[GRRL_CONTEXT_ASPECT] = (uint8_t)(i / 5);
        (void)grrl_cases_learn(&other, &f.config, grrl_context_key(&once), 0.0f);
    }
    assert_int_equal(grrl_cases_merge(&f.base, &other, &f.config, 2), GRRL_OK);
    assert_int_equal(f.base.n, 2);
    assert_int_equal(f.base.cases[0].n_all + f.base.cases[1].n_all, 4);
}

static void the_case_not_met_for_the_longest_time_makes_room(void **state)
{
    (void)state;
    struct grrl_context a = context(0, 0);
    struct grrl_context b = context(1, 0);
    struct grrl_context c = context(2, 0);
    grrl_cases_init(&f.base, f.cases, 2);
    assert_int_equal(grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 1.0f), 0);
    assert_int_equal(grrl_cases_learn(&f.base, &f.config, grrl_context_key(&b), 1.0f), 1);
    assert_int_equal(grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 1.0f), 0);
    assert_int_equal(grrl_cases_learn(&f.base, &f.config, grrl_context_key(&c), 1.0f), 1);
    assert_int_equal(f.base.n, 2);
    assert_int_equal(f.base.evictions, 1);
    assert_int_equal(f.base.high_water, 2);
    assert_int_equal(f.base.cases[1].key, grrl_context_key(&c));
    grrl_cases_init(&f.base, NULL, 0);
    assert_int_equal(grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), 1.0f),
                     GRRL_NO_CASE);
    assert_true(estimate(&a) == f.config.prior);
}

static void a_wrong_configuration_is_refused(void **state)
{
    (void)state;
    const char *field = NULL;
    assert_int_equal(grrl_case_config_check(&f.config, &field), GRRL_OK);
    f.config.mismatch = NAN;
    assert_int_equal(grrl_case_config_check(&f.config, &field), GRRL_ERR_ARGUMENT);
    assert_string_equal(field, "mismatch");
    grrl_case_config_default(&f.config);
    f.config.prior_weight = 0.0f;
    assert_int_equal(grrl_case_config_check(&f.config, &field), GRRL_ERR_ARGUMENT);
    assert_string_equal(field, "prior_weight");
    grrl_case_config_default(&f.config);
    f.config.confidence = -0.5f;
    assert_int_equal(grrl_case_config_check(&f.config, &field), GRRL_ERR_ARGUMENT);
    assert_string_equal(field, "confidence");
    grrl_case_config_default(&f.config);
    f.config.parts = GRRL_ALL_CONTEXT_PARTS + 1u;
    assert_int_equal(grrl_case_config_check(&f.config, &field), GRRL_ERR_ARGUMENT);
    assert_string_equal(field, "parts");
}

static struct memory_file file = {.calls_left = -1};

static void save_some(void)
{
    for (int i = 0; i < 12; i++) {
        struct grrl_context a = random_context();
        (void)grrl_cases_learn(&f.base, &f.config, grrl_context_key(&a), (float)(i % 3));
        if (i == 6)
            grrl_cases_begin_trial(&f.base, &f.config);
    }
    file.size = file.at = 0;
    const struct grrl_io io = memory_file_io(&file);
    assert_int_equal(grrl_cases_save(&f.base, &io), GRRL_OK);
}

/* Bytes of the file's header and of a case, each with its CRC. */
enum { HEADER = 20 + 4, CASE = 28 };

static void cases_come_back_from_a_file(void **state)
{
    (void)state;
    save_some();
    struct grrl_case cases[CAPACITY];
    struct grrl_case_base again;
    uint32_t lost;
    const struct grrl_io io = memory_file_io(&file);
    grrl_cases_init(&again, cases, CAPACITY);
    assert_int_equal(grrl_cases_load(&again, &io, &lost), GRRL_OK);
    assert_int_equal(file.at, file.size);
    assert_int_equal(again.n, f.base.n);
    assert_int_equal(again.clock, f.base.clock);
    assert_true(again.log_odds == f.base.log_odds);
    assert_memory_equal(again.cases, f.base.cases, f.base.n * sizeof f.base.cases[0]);
    grrl_cases_init(&again, cases, f.base.n - 1);
    file.at = 0;
    assert_int_equal(grrl_cases_load(&again, &io, &lost), GRRL_ERR_FULL);
    assert_int_equal(again.n, 0);
}

static void a_torn_file_gives_what_was_whole(void **state)
{
    (void)state;
    save_some();
    uint32_t lost;
    const struct grrl_io io = memory_file_io(&file);
    const size_t whole = file.size;
    const uint32_t total = f.base.n;
    const size_t cases_at = whole - total * (size_t)CASE;
    assert_true(total > 1);
    for (file.size = 0; file.size < whole; ++file.size) {
        uint32_t n = file.size > cases_at ? (uint32_t)((file.size - cases_at) / CASE) : 0;
        file.at = 0;
        assert_int_equal(grrl_cases_load(&f.base, &io, &lost), GRRL_ERR_IO);
        assert_int_equal(f.base.n, n);
        assert_int_equal(lost, file.size < HEADER ? 0 : total - n);
    }
}

static void a_damaged_file_is_refused(void **state)
{
    (void)state;
    save_some();
    uint32_t lost;
    const struct grrl_io io = memory_file_io(&file);
    const size_t whole = file.size;
    for (size_t i = 0; i < whole; i++) {
        file.bytes[i] ^= 0x40;
        file.at = 0;
        assert_int_not_equal(grrl_cases_load(&f.base, &io, &lost), GRRL_OK);
        assert_int_equal(f.base.n, 0);
        file.bytes[i] ^= 0x40;
    }
    file.at = 0;
    assert_int_equal(grrl_cases_load(&f.base, &io, &lost), GRRL_OK);
}

/* A whole file of version 1, without a case. */
static void an_older_file_is_told_from_a_damaged_one(void **state)
{
    (void)state;
    static const uint8_t older[] = {'G', 'R', 'R', 'L', 'c', 'a', 's', 0, 1,    0,    9,    0,
                                    0,   0,   0,   0,   0,   0,   0,   0, 0xc0, 0x50, 0xc1, 0xb2};
    memcpy(file.bytes, older, sizeof older);
    file.size = sizeof older;
    file.at = 0;
    uint32_t lost;
    const struct grrl_io io = memory_file_io(&file);
    assert_int_equal(grrl_cases_load(&f.base, &io, &lost), GRRL_ERR_VERSION);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(nothing_known_is_worth_the_prior, set_up),
        cmocka_unit_test_setup(an_estimate_is_the_weighted_mean_of_all_rewards, set_up),
        cmocka_unit_test_setup(parts_left_out_do_not_count, set_up),
        cmocka_unit_test_setup(the_latest_rewards_count, set_up),
        cmocka_unit_test_setup(refuted_expectations_weaken_older_rewards, set_up),
        cmocka_unit_test_setup(a_failure_without_doubt_weakens_nothing, set_up),
        cmocka_unit_test_setup(what_was_to_be_expected_raises_no_doubt, set_up),
        cmocka_unit_test_setup(nothing_known_can_not_be_doubted, set_up),
        cmocka_unit_test_setup(doubt_has_bounds, set_up),
        cmocka_unit_test_setup(newer_rewards_push_out_older_ones, set_up),
        cmocka_unit_test_setup(what_all_objects_share_outlives_doubt, set_up),
        cmocka_unit_test_setup(counts_of_a_full_case_are_halved, set_up),
        cmocka_unit_test_setup(two_lives_merge_in_either_order, set_up),
        cmocka_unit_test_setup(merged_rewards_are_pooled, set_up),
        cmocka_unit_test_setup(a_merge_drops_rewards_of_the_latest_objects, set_up),
        cmocka_unit_test_setup(the_best_founded_cases_outlive_a_merge, set_up),
        cmocka_unit_test_setup(the_case_not_met_for_the_longest_time_makes_room, set_up),
        cmocka_unit_test_setup(a_wrong_configuration_is_refused, set_up),
        cmocka_unit_test_setup(cases_come_back_from_a_file, set_up),
        cmocka_unit_test_setup(a_torn_file_gives_what_was_whole, set_up),
        cmocka_unit_test_setup(a_damaged_file_is_refused, set_up),
        cmocka_unit_test_setup(an_older_file_is_told_from_a_damaged_one, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
