/* The closest of many states, against sorting them all. */
#include "learner/relational_q/closest.h"
#include "support.h"

enum { MANY = 2000 };

struct offer {
    unsigned distance;
    uint32_t state;
};

static int compare(const void *a, const void *b)
{
    const struct offer *x = a;
    const struct offer *y = b;
    if (x->distance != y->distance)
        return x->distance < y->distance ? -1 : 1;
    return x->state < y->state ? -1 : x->state > y->state;
}

static void test_closest_are_kept(void **state)
{
    (void)state;
    static const unsigned mosts[] = {1, 2, 3, 32, GRRL_RECALL_STATES};
    struct grrl_random random = support_random("closest");
    for (unsigned round = 0; round < 200; round++) {
        static struct offer offers[MANY];
        unsigned n = grrl_random_below(&random, MANY + 1);
        unsigned farthest = 1 + grrl_random_below(&random, UINT8_MAX);
        struct grrl_closest closest;
        grrl_closest_clear(&closest, mosts[round % 5]);
        for (uint32_t i = 0; i < n; i++) { /* 7919 is prime: each number once, in no order */
            offers[i].distance = grrl_random_below(&random, farthest + 1);
            offers[i].state = round % 2 == 0 ? i : i * 7919 % MANY;
            if (grrl_closest_accepts(&closest, offers[i].distance, offers[i].state))
                grrl_closest_add(&closest, offers[i].distance, offers[i].state);
        }
        qsort(offers, n, sizeof offers[0], compare);
        grrl_closest_sort(&closest);
        assert_int_equal(closest.n, n < closest.most ? n : closest.most);
        for (unsigned i = 0; i < closest.n; i++) {
            assert_int_equal(closest.state[i], offers[i].state);
            assert_int_equal(closest.distance[i], offers[i].distance);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_closest_are_kept)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
