/* The answers of the library against those of the Boost Graph Library, on larger graphs. */
#include "../support.h"
#include "bench.h"

enum { N_GRAPHS = 25000 }; /* two pairs each */

static void test_same_answers(void **state)
{
    (void)state;
    struct grrl_random random = support_random("boost");
    unsigned n_matching = 0;
    for (int i = 0; i < N_GRAPHS; i++) {
        uint8_t n = (uint8_t)(4 + grrl_random_below(&random, GRRL_MAX_LINKS - 3));
        struct grrl_graph target = support_graph(&random, n, 8, grrl_random_below(&random, 3), 2);
        struct grrl_graph whole = target;
        if (grrl_random_below(&random, 2) == 0) { /* another label, or two exchanged */
            uint8_t a = (uint8_t)grrl_random_below(&random, n);
            uint8_t b = (uint8_t)grrl_random_below(&random, n);
            grrl_label kept = whole.label[a];
            whole.label[a] = whole.label[b];
            whole.label[b] = kept;
        }
        uint8_t order[GRRL_MAX_LINKS];
        struct grrl_graph pattern = support_relabel(&random, &whole, order);
        struct grrl_graph part;
        grrl_graph_clear(&part);
        for (uint8_t v = 0; v < n - n / 4; v++) {
            assert_int_equal(grrl_graph_add_link(&part, whole.label[v], NULL), GRRL_OK);
            for (uint8_t u = 0; u < v; u++)
                if (grrl_graph_joint(&whole, u, v) != GRRL_NO_JOINT)
                    assert_int_equal(
                        grrl_graph_add_joint(&part, u, v,
                                             (enum grrl_joint_type)grrl_graph_joint(&whole, u, v)),
                        GRRL_OK);
        }
        const struct grrl_graph *const patterns[] = {&pattern, &part};
        void *boost_target = bench_boost.build(&target);
        struct grrl_match_plan target_plan;
        grrl_match_plan_of(&target_plan, &target, GRRL_ALL_PROPERTIES);
        for (int kind = 0; kind <= GRRL_MATCH_MONOMORPHISM; kind++) {
            void *boost_pattern = bench_boost.build(patterns[kind]);
            uint8_t map[GRRL_MAX_LINKS];
            enum grrl_status status =
                grrl_match_find((enum grrl_match_kind)kind, patterns[kind], &target,
                                GRRL_ALL_PROPERTIES, GRRL_MATCH_BUDGET, map);
            struct grrl_match_plan plan;
            grrl_match_plan_of(&plan, patterns[kind], GRRL_ALL_PROPERTIES);
            assert_int_equal(grrl_match_find_planned((enum grrl_match_kind)kind, &plan,
                                                     &target_plan, GRRL_MATCH_BUDGET, map),
                             status);
            int expected =
                bench_boost.match((enum grrl_match_kind)kind, boost_pattern, boost_target);
            assert_int_equal(status, expected == 1 ? GRRL_OK : GRRL_ERR_NONE);
            n_matching += status == GRRL_OK;
            bench_boost.destroy(boost_pattern);
        }
        bench_boost.destroy(boost_target);
    }
    assert_true(n_matching > N_GRAPHS / 2 && n_matching < 2 * N_GRAPHS - N_GRAPHS / 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_answers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
