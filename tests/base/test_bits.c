/* Sets of links as bits, against going through them one by one. */
#include "base/bits.h"
#include "support.h"

static void test_sets(void **state)
{
    (void)state;
    struct grrl_random random = support_random("sets");
    for (unsigned n = 0; n <= 32; n++) {
        uint32_t below = 0;
        for (unsigned i = 0; i < n; i++)
            below |= grrl_bit(i);
        assert_int_equal(grrl_bits_below(n), below);
        assert_int_equal(grrl_bit_count(below), n);
    }
    for (int k = 0; k < 10000; k++) {
        uint32_t set = grrl_random_next(&random) & grrl_random_next(&random);
        unsigned first = 32;
        unsigned count = 0;
        for (unsigned i = 32; i-- > 0;) {
            count += set >> i & 1u;
            first = (set >> i & 1u) != 0 ? i : first;
        }
        assert_int_equal(grrl_bit_count(set), count);
        if (set != 0)
            assert_int_equal(grrl_first_bit(set), first);
    }
    assert_int_equal(grrl_bit_count(UINT32_MAX), 32);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
