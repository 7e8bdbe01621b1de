/* Matches against brute force, relabelling, budgets, fixed pairs, orbits. */
#include "grrl/structure/match.h"
#include "support.h"

enum { BIG_BUDGET = 100000000 };

/* Whether a map keeps what this kind of mapping must keep, straight from the definition. */
static bool is_mapping(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                       const struct grrl_graph *target, grrl_label mask, const uint8_t *map)
{
    if (kind == GRRL_MATCH_ISOMORPHISM && pattern->n != target->n)
        return false;
    for (uint8_t i = 0; i < pattern->n; i++) {
        grrl_label a = pattern->label[i];
        grrl_label b = target->label[map[i]];
        if ((a == GRRL_LABEL_BACKGROUND) != (b == GRRL_LABEL_BACKGROUND) || ((a ^ b) & mask) != 0)
            return false;
        for (uint8_t j = 0; j < i; j++) {
            int in_pattern = grrl_graph_joint(pattern, i, j);
            int in_target = grrl_graph_joint(target, map[i], map[j]);
            if (map[i] == map[j])
                return false;
            if (in_pattern != in_target &&
                (kind == GRRL_MATCH_ISOMORPHISM || in_pattern != GRRL_NO_JOINT))
                return false;
        }
    }
    return true;
}

/* A map as a number in base 8, to compare sets of maps. */
static uint32_t map_number(const uint8_t *map, uint8_t n)
{
    uint32_t number = 0;
    for (uint8_t i = 0; i < n; i++)
        number = number * 8 + map[i];
    return number;
}

/* All mappings by trying every map, as bits of a set indexed by map_number. */
static unsigned brute_force(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                            const struct grrl_graph *target, grrl_label mask, uint8_t *found)
{
    uint8_t map[8] = {0};
    unsigned n = 0;
    if (pattern->n > 0 && target->n == 0)
        return 0;
    for (;;) {
        if (is_mapping(kind, pattern, target, mask, map)) {
            found[map_number(map, pattern->n)] = 1;
            n++;
        }
        uint8_t i = 0;
        while (i < pattern->n && ++map[i] == target->n)
            map[i++] = 0;
        if (i == pattern->n)
            return n;
    }
}

static struct grrl_graph random_graph(struct grrl_random *random, uint8_t n)
{
    struct grrl_graph graph =
        support_graph(random, n, 4 + grrl_random_below(random, 5),
                      n > 1 ? grrl_random_below(random, 5) : 0, grrl_random_below(random, 2));
    if (n > 0 && grrl_random_below(random, 6) == 0)
        graph.label[grrl_random_below(random, n)] = GRRL_LABEL_BACKGROUND;
    return graph;
}

/* Part of a graph, relabelled: some links away, some joints away. */
static struct grrl_graph random_part(struct grrl_random *random, const struct grrl_graph *whole)
{
    uint8_t order[GRRL_MAX_LINKS];
    struct grrl_graph shuffled = support_relabel(random, whole, order);
    struct grrl_graph part;
    grrl_graph_clear(&part);
    uint8_t n = (uint8_t)grrl_random_below(random, whole->n + 1u);
    for (uint8_t i = 0; i < n; i++) {
        assert_int_equal(grrl_graph_add_link(&part, shuffled.label[i], NULL), GRRL_OK);
        for (uint8_t j = 0; j < i; j++) {
            int type = grrl_graph_joint(&shuffled, i, j);
            if (type != GRRL_NO_JOINT && grrl_random_below(random, 8) > 0)
                assert_int_equal(grrl_graph_add_joint(&part, i, j, (enum grrl_joint_type)type),
                                 GRRL_OK);
        }
    }
    return part;
}

static unsigned compare(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                        const struct grrl_graph *target, grrl_label mask)
{
    static uint8_t expected[1 << 18];
    memset(expected, 0, sizeof expected);
    unsigned n_expected = brute_force(kind, pattern, target, mask, expected);
    struct grrl_match match;
    grrl_match_begin(&match, kind, pattern, target, mask, BIG_BUDGET);
    unsigned n = 0;
    uint8_t map[GRRL_MAX_LINKS];
    enum grrl_status status;
    while ((status = grrl_match_next(&match, map)) == GRRL_OK) {
        uint32_t number = map_number(map, pattern->n);
        assert_int_equal(expected[number], 1); /* a mapping, and not seen before */
        expected[number] = 2;
        for (uint8_t i = pattern->n; i < GRRL_MAX_LINKS; i++)
            assert_int_equal(map[i], GRRL_UNMAPPED);
        n++;
    }
    assert_int_equal(status, GRRL_ERR_NONE);
    assert_int_equal(n, n_expected);
    assert_int_equal(grrl_match_next(&match, map), GRRL_ERR_NONE);
    return n;
}

static void test_against_brute_force(void **state)
{
    (void)state;
    struct grrl_random random = support_random("brute force");
    unsigned n_matching[2] = {0, 0};
    for (int i = 0; i < 1500; i++) {
        struct grrl_graph target = random_graph(&random, (uint8_t)grrl_random_below(&random, 7));
        struct grrl_graph pattern;
        uint8_t order[GRRL_MAX_LINKS];
        switch (grrl_random_below(&random, 3)) {
        case 0:
            pattern = random_graph(&random, (uint8_t)grrl_random_below(&random, 7));
            break;
        case 1:
            pattern = support_relabel(&random, &target, order);
            break;
        default:
            pattern = random_part(&random, &target);
            break;
        }
        grrl_label mask = grrl_random_below(&random, 2) ? GRRL_ALL_PROPERTIES : GRRL_NO_PROPERTIES;
        n_matching[0] += compare(GRRL_MATCH_ISOMORPHISM, &pattern, &target, mask) > 0;
        n_matching[1] += compare(GRRL_MATCH_MONOMORPHISM, &pattern, &target, mask) > 0;
    }
    assert_true(n_matching[0] > 400 && n_matching[0] < n_matching[1] && n_matching[1] < 1400);
}

/* Graphs of any size match their relabelled selves, whole and in part. */
static void test_relabelling(void **state)
{
    (void)state;
    struct grrl_random random = support_random("relabelling");
    for (int i = 0; i < 2000; i++) {
        uint8_t n = (uint8_t)(1 + grrl_random_below(&random, GRRL_MAX_LINKS));
        struct grrl_graph graph = support_graph(&random, n, 8, grrl_random_below(&random, 3), 2);
        uint8_t order[GRRL_MAX_LINKS];
        struct grrl_graph other = support_relabel(&random, &graph, order);
        struct grrl_match match;
        uint8_t map[GRRL_MAX_LINKS];
        grrl_match_begin(&match, GRRL_MATCH_ISOMORPHISM, &graph, &other, GRRL_ALL_PROPERTIES,
                         BIG_BUDGET);
        assert_int_equal(grrl_match_next(&match, map), GRRL_OK);
        assert_true(is_mapping(GRRL_MATCH_ISOMORPHISM, &graph, &other, GRRL_ALL_PROPERTIES, map));

        other.label[n - 1] = 9;
        grrl_match_begin(&match, GRRL_MATCH_ISOMORPHISM, &graph, &other, GRRL_ALL_PROPERTIES,
                         BIG_BUDGET);
        assert_int_equal(grrl_match_next(&match, map), GRRL_ERR_NONE);
        grrl_match_begin(&match, GRRL_MATCH_ISOMORPHISM, &graph, &other, ~(grrl_label)0xff,
                         BIG_BUDGET);
        assert_int_equal(grrl_match_next(&match, map), GRRL_OK);

        struct grrl_graph part = random_part(&random, &graph);
        grrl_match_begin(&match, GRRL_MATCH_MONOMORPHISM, &part, &graph, GRRL_ALL_PROPERTIES,
                         BIG_BUDGET);
        assert_int_equal(grrl_match_next(&match, map), GRRL_OK);
        assert_true(is_mapping(GRRL_MATCH_MONOMORPHISM, &part, &graph, GRRL_ALL_PROPERTIES, map));
    }
}

static void test_background(void **state)
{
    (void)state;
    struct grrl_graph a;
    grrl_graph_clear(&a);
    assert_int_equal(grrl_graph_add_link(&a, GRRL_LABEL_BACKGROUND, NULL), GRRL_OK);
    assert_int_equal(grrl_graph_add_link(&a, 1, NULL), GRRL_OK);
    assert_int_equal(grrl_graph_add_joint(&a, 0, 1, GRRL_REVOLUTE), GRRL_OK);
    struct grrl_match match;
    uint8_t map[GRRL_MAX_LINKS];
    grrl_match_begin(&match, GRRL_MATCH_MONOMORPHISM, &a, &a, GRRL_NO_PROPERTIES, 100);
    assert_int_equal(grrl_match_next(&match, map), GRRL_OK);
    assert_int_equal(map[0], 0);
    assert_int_equal(grrl_match_next(&match, map), GRRL_ERR_NONE);
}

/* With fewer steps than the search takes it is undecided, with exactly as many it is not. */
static void test_budget(void **state)
{
    (void)state;
    struct grrl_random random = support_random("budget");
    for (int i = 0; i < 200; i++) {
        struct grrl_graph target = support_graph(&random, 6, 8, 2, 1);
        struct grrl_graph pattern = random_part(&random, &target);
        if (pattern.n == 0)
            continue;
        struct grrl_match match;
        uint8_t map[GRRL_MAX_LINKS];
        grrl_match_begin(&match, GRRL_MATCH_MONOMORPHISM, &pattern, &target, GRRL_ALL_PROPERTIES,
                         BIG_BUDGET);
        unsigned n = 0;
        while (grrl_match_next(&match, map) == GRRL_OK)
            n++;
        uint32_t steps = BIG_BUDGET - match.budget;
        for (uint32_t budget = 0; budget <= steps; budget++) {
            grrl_match_begin(&match, GRRL_MATCH_MONOMORPHISM, &pattern, &target,
                             GRRL_ALL_PROPERTIES, budget);
            unsigned found = 0;
            enum grrl_status status;
            while ((status = grrl_match_next(&match, map)) == GRRL_OK)
                found++;
            assert_int_equal(status, budget < steps ? GRRL_ERR_UNDECIDED : GRRL_ERR_NONE);
            assert_int_equal(grrl_match_next(&match, map), status);
            assert_true(budget < steps ? found <= n : found == n);
        }
    }
}

static void test_fixed_pairs(void **state)
{
    (void)state;
    struct grrl_random random = support_random("fixed pairs");
    for (int i = 0; i < 500; i++) {
        struct grrl_graph target = random_graph(&random, 5);
        struct grrl_graph pattern = random_part(&random, &target);
        if (pattern.n == 0)
            continue;
        unsigned n_to[5] = {0};
        uint8_t from = (uint8_t)grrl_random_below(&random, pattern.n);
        struct grrl_match match;
        uint8_t map[GRRL_MAX_LINKS];
        grrl_match_begin(&match, GRRL_MATCH_MONOMORPHISM, &pattern, &target, GRRL_ALL_PROPERTIES,
                         BIG_BUDGET);
        while (grrl_match_next(&match, map) == GRRL_OK)
            n_to[map[from]]++;
        for (uint8_t to = 0; to < 5; to++) {
            grrl_match_begin(&match, GRRL_MATCH_MONOMORPHISM, &pattern, &target,
                             GRRL_ALL_PROPERTIES, BIG_BUDGET);
            grrl_match_fix(&match, from, to);
            unsigned n = 0;
            for (; grrl_match_next(&match, map) == GRRL_OK; n++)
                assert_int_equal(map[from], to);
            assert_int_equal(n, n_to[to]);
        }
    }
}

static void test_orbits(void **state)
{
    (void)state;
    struct grrl_random random = support_random("orbits");
    unsigned n_symmetric = 0;
    for (int i = 0; i < 1000; i++) {
        uint8_t n = (uint8_t)(1 + grrl_random_below(&random, 6));
        struct grrl_graph graph = random_graph(&random, n);
        static uint8_t all[1 << 18];
        memset(all, 0, sizeof all);
        n_symmetric +=
            brute_force(GRRL_MATCH_ISOMORPHISM, &graph, &graph, GRRL_ALL_PROPERTIES, all) > 1;
        uint8_t expected[8];
        for (uint8_t k = 0; k < n; k++)
            expected[k] = k;
        for (uint32_t number = 0; number < 1u << 3 * n; number++)
            for (uint8_t k = 0; all[number] && k < n; k++) {
                uint8_t image = (uint8_t)(number >> 3 * (n - 1 - k) & 7u);
                if (image < expected[k])
                    expected[k] = image;
            }
        uint8_t orbit[GRRL_MAX_LINKS];
        assert_int_equal(grrl_match_orbits(&graph, GRRL_ALL_PROPERTIES, BIG_BUDGET, orbit),
                         GRRL_OK);
        assert_memory_equal(orbit, expected, n);
    }
    assert_true(n_symmetric > 100);

    struct grrl_graph chain = support_graph(&random, 2, 8, 0, 0);
    uint8_t orbit[GRRL_MAX_LINKS];
    assert_int_equal(grrl_match_orbits(&chain, GRRL_ALL_PROPERTIES, 1, orbit), GRRL_ERR_UNDECIDED);
    assert_int_equal(orbit[1], 1);
    assert_int_equal(grrl_match_orbits(&chain, GRRL_ALL_PROPERTIES, 2, orbit), GRRL_OK);
    assert_int_equal(orbit[1], 0);

    struct grrl_graph loops; /* of three and of four links: one colour, two orbits */
    grrl_graph_clear(&loops);
    for (uint8_t i = 0; i < 7; i++)
        assert_int_equal(grrl_graph_add_link(&loops, 0, NULL), GRRL_OK);
    for (uint8_t i = 0; i < 7; i++)
        assert_int_equal(grrl_graph_add_joint(&loops, i,
                                              (uint8_t)(i < 3 ? (i + 1) % 3 : 3 + (i - 2) % 4),
                                              GRRL_REVOLUTE),
                         GRRL_OK);
    const uint8_t expected[7] = {0, 0, 0, 3, 3, 3, 3};
    assert_int_equal(grrl_match_orbits(&loops, GRRL_ALL_PROPERTIES, BIG_BUDGET, orbit), GRRL_OK);
    assert_memory_equal(orbit, expected, sizeof expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_brute_force), cmocka_unit_test(test_relabelling),
        cmocka_unit_test(test_background),          cmocka_unit_test(test_budget),
        cmocka_unit_test(test_fixed_pairs),         cmocka_unit_test(test_orbits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
