/* PCG32 against its reference, and the distribution of its numbers. */
#include "grrl/base/random.h"
#include "support.h"

/* The first numbers of the reference implementation's demo: seed 42, stream 54. */
static void test_reference(void **state)
{
    (void)state;
    static const uint32_t expected[] = {0xa15c02b7, 0x7b47f409, 0xba1d3330,
                                        0x83d2f293, 0xbfa4784b, 0xcbed606e};
    struct grrl_random random;
    grrl_random_init(&random, 42, 54);
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++)
        assert_int_equal(grrl_random_next(&random), expected[i]);
}

static void test_streams_differ(void **state)
{
    (void)state;
    struct grrl_random a;
    struct grrl_random b;
    grrl_random_init(&a, 42, 1);
    grrl_random_init(&b, 42, 2);
    unsigned n_equal = 0;
    for (int i = 0; i < 1000; i++)
        n_equal += grrl_random_next(&a) == grrl_random_next(&b);
    assert_true(n_equal <= 1);
}

static void test_below(void **state)
{
    (void)state;
    struct grrl_random random = support_random("below");
    for (uint32_t count = 1; count <= 6; count++) {
        unsigned seen[6] = {0};
        for (int i = 0; i < 6000; i++) {
            uint32_t value = grrl_random_below(&random, count);
            assert_true(value < count);
            seen[value]++;
        }
        /* 1000 or more expected: 30 % off is ten standard deviations */
        for (uint32_t k = 0; k < count; k++)
            assert_in_range(seen[k], 4200 / count, 7800 / count);
    }
    unsigned n_high = 0;
    for (int i = 0; i < 3000; i++) {
        uint32_t value = grrl_random_below(&random, 0xc0000000u);
        assert_true(value < 0xc0000000u);
        n_high += value >= 0x80000000u; /* a plain remainder would give a quarter, not a third */
    }
    assert_in_range(n_high, 875, 1125);
}

/* Of the 2^32 values, as many of the smallest are drawn again as would bias the remainder: for a
 * count of three, zero alone. */
static void test_below_draws_again(void **state)
{
    (void)state;
    struct grrl_random random;
    random.increment = 1;
    random.state = UINT64_C(1) << 27;
    struct grrl_random other = random;
    assert_int_equal(grrl_random_next(&other), 1);
    assert_int_equal(grrl_random_below(&random, 3), 1);
    assert_true(random.state == other.state);

    random.state = 0;
    other = random;
    uint32_t first = grrl_random_next(&other);
    assert_int_equal(first, 0);
    uint32_t value = first;
    while (value == 0)
        value = grrl_random_next(&other);
    assert_int_equal(grrl_random_below(&random, 3), value % 3);
    assert_true(random.state == other.state);
}

static void test_uniform(void **state)
{
    (void)state;
    struct grrl_random random = support_random("uniform");
    double sum = 0;
    unsigned n_low = 0;
    for (int i = 0; i < 10000; i++) {
        float value = grrl_random_uniform(&random);
        assert_true(value >= 0.0f && value < 1.0f);
        sum += (double)value;
        n_low += value < 0.1f;
    }
    assert_true(sum > 4800 && sum < 5200);
    assert_in_range(n_low, 800, 1200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference), cmocka_unit_test(test_streams_differ),
        cmocka_unit_test(test_below),     cmocka_unit_test(test_below_draws_again),
        cmocka_unit_test(test_uniform),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
