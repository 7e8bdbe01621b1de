/* One answer, whatever it takes: against the search of grrl_match_next, which test_match.c holds
 * against brute force. */
#include "grrl/structure/match.h"
#include "support.h"

enum { BIG_BUDGET = 100000000 };

static struct grrl_graph random_graph(struct grrl_random *random)
{
    uint8_t n = (uint8_t)(1 + grrl_random_below(random, GRRL_MAX_LINKS));
    return support_graph(random, n, 6 + grrl_random_below(random, 3), grrl_random_below(random, 3),
                         grrl_random_below(random, 2));
}

/* A graph without its links from n on and without some of its joints, relabelled. */
static struct grrl_graph random_part(struct grrl_random *random, const struct grrl_graph *whole,
                                     uint8_t n)
{
    uint8_t order[GRRL_MAX_LINKS];
    struct grrl_graph part;
    grrl_graph_clear(&part);
    for (uint8_t i = 0; i < n; i++) {
        assert_int_equal(grrl_graph_add_link(&part, whole->label[i], NULL), GRRL_OK);
        for (uint8_t j = 0; j < i; j++) {
            int type = grrl_graph_joint(whole, i, j);
            if (type != GRRL_NO_JOINT && grrl_random_below(random, 16) > 0)
                assert_int_equal(grrl_graph_add_joint(&part, i, j, (enum grrl_joint_type)type),
                                 GRRL_OK);
        }
    }
    return support_relabel(random, &part, order);
}

static bool keeps_joints(const struct grrl_graph *pattern, const struct grrl_graph *target,
                         grrl_label mask, const uint8_t *map)
{
    uint32_t used = 0;
    for (uint8_t i = 0; i < pattern->n; i++) {
        if ((used >> map[i] & 1u) != 0 || grrl_label_masked(pattern->label[i], mask) !=
                                              grrl_label_masked(target->label[map[i]], mask))
            return false;
        used |= UINT32_C(1) << map[i];
        for (uint8_t j = 0; j < i; j++) {
            int type = grrl_graph_joint(pattern, i, j);
            if (type != GRRL_NO_JOINT && grrl_graph_joint(target, map[i], map[j]) != type)
                return false;
        }
    }
    return true;
}

static enum grrl_status search_for(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                                   const struct grrl_graph *target, grrl_label mask)
{
    struct grrl_match match;
    uint8_t map[GRRL_MAX_LINKS];
    grrl_match_begin(&match, kind, pattern, target, mask, BIG_BUDGET);
    return grrl_match_next(&match, map);
}

/* The number of mappings, with plans or without. */
static unsigned count_mappings(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                               const struct grrl_graph *target, bool planned)
{
    struct grrl_match_plan plans[2];
    struct grrl_match match;
    uint8_t map[GRRL_MAX_LINKS];
    unsigned n = 0;
    grrl_match_plan_of(&plans[0], pattern, GRRL_ALL_PROPERTIES);
    grrl_match_plan_of(&plans[1], target, GRRL_ALL_PROPERTIES);
    if (planned)
        grrl_match_begin_planned(&match, kind, &plans[0], &plans[1], 20000);
    else
        grrl_match_begin(&match, kind, pattern, target, GRRL_ALL_PROPERTIES, 20000);
    while (grrl_match_next(&match, map) == GRRL_OK)
        n++;
    return match.budget > 0 ? n : 0;
}

static void test_every_way_gives_the_same(void **state)
{
    (void)state;
    struct grrl_random random = support_random("every way");
    unsigned n_found[2] = {0, 0};
    for (int i = 0; i < 20000; i++) {
        struct grrl_graph target = random_graph(&random);
        uint8_t n = (uint8_t)(target.n - grrl_random_below(&random, target.n / 3u + 1u));
        struct grrl_graph pattern = random_part(&random, &target, n);
        if (grrl_random_below(&random, 2) == 0)
            pattern.label[0] ^= 1;
        grrl_label mask = grrl_random_below(&random, 4) ? GRRL_ALL_PROPERTIES : GRRL_NO_PROPERTIES;
        struct grrl_match_plan plans[2];
        grrl_match_plan_of(&plans[0], &pattern, mask);
        grrl_match_plan_of(&plans[1], &target, mask);
        for (int kind = 0; kind <= GRRL_MATCH_MONOMORPHISM; kind++) {
            uint8_t map[GRRL_MAX_LINKS];
            enum grrl_match_kind k = (enum grrl_match_kind)kind;
            enum grrl_status expected = search_for(k, &pattern, &target, mask);
            assert_int_equal(grrl_match_find(k, &pattern, &target, mask, 200000, map), expected);
            assert_true(expected != GRRL_OK || keeps_joints(&pattern, &target, mask, map));
            assert_int_equal(grrl_match_find_planned(k, &plans[0], &plans[1], 200000, map),
                             expected);
            assert_true(expected != GRRL_OK || keeps_joints(&pattern, &target, mask, map));
            n_found[kind] += expected == GRRL_OK;
            if (i % 20 == 0 && pattern.n < 8)
                assert_int_equal(count_mappings(k, &pattern, &target, true),
                                 count_mappings(k, &pattern, &target, false));
        }
    }
    assert_true(n_found[0] > 500 && n_found[1] > 5000 && n_found[1] < 15000);
}

/* The images of each vertex of a tree, against a search for each pair. */
static void test_trees(void **state)
{
    (void)state;
    struct grrl_random random = support_random("trees");
    unsigned n_images = 0;
    for (int i = 0; i < 1500; i++) {
        uint8_t n = (uint8_t)(1 + grrl_random_below(&random, GRRL_MAX_LINKS));
        struct grrl_graph target = support_graph(&random, n, 7 + grrl_random_below(&random, 2), 0,
                                                 grrl_random_below(&random, 2));
        struct grrl_graph pattern =
            support_graph(&random, (uint8_t)(1 + grrl_random_below(&random, 5)), 8, 0,
                          grrl_random_below(&random, 2));
        struct grrl_match_plan plans[2];
        grrl_match_plan_of(&plans[0], &pattern, GRRL_ALL_PROPERTIES);
        grrl_match_plan_of(&plans[1], &target, GRRL_ALL_PROPERTIES);
        for (uint8_t p = 0; p < pattern.n; p++) {
            uint32_t images;
            uint8_t map[GRRL_MAX_LINKS];
            assert_int_equal(grrl_match_tree(&plans[0], &plans[1], p, &images, map), GRRL_OK);
            assert_true(images == 0 || keeps_joints(&pattern, &target, GRRL_ALL_PROPERTIES, map));
            for (uint8_t t = 0; t < n; t++) {
                struct grrl_match match;
                grrl_match_begin(&match, GRRL_MATCH_MONOMORPHISM, &pattern, &target,
                                 GRRL_ALL_PROPERTIES, BIG_BUDGET);
                grrl_match_fix(&match, p, t);
                enum grrl_status status = grrl_match_next(&match, map);
                assert_int_equal((images >> t & 1u) != 0, status == GRRL_OK);
                n_images += status == GRRL_OK;
            }
        }
    }
    assert_true(n_images > 1000);
    struct grrl_graph loop = support_graph(&random, 3, 0, 0, 0);
    for (uint8_t i = 0; i < 3; i++)
        assert_int_equal(grrl_graph_add_joint(&loop, i, (uint8_t)((i + 1) % 3), GRRL_REVOLUTE),
                         GRRL_OK);
    struct grrl_match_plan plan;
    uint32_t images;
    grrl_match_plan_of(&plan, &loop, GRRL_ALL_PROPERTIES);
    assert_int_equal(grrl_match_tree(&plan, &plan, 0, &images, NULL), GRRL_ERR_UNDECIDED);
    struct grrl_graph chain = support_graph(&random, 2, 8, 0, 0);
    struct grrl_graph nothing = support_graph(&random, 0, 0, 0, 0);
    struct grrl_match_plan of_chain;
    struct grrl_match_plan of_nothing;
    grrl_match_plan_of(&of_chain, &chain, GRRL_ALL_PROPERTIES);
    grrl_match_plan_of(&of_nothing, &nothing, GRRL_ALL_PROPERTIES);
    assert_int_equal(grrl_match_tree(&of_chain, &plan, 0, &images, NULL), GRRL_ERR_UNDECIDED);
    assert_int_equal(grrl_match_tree(&of_nothing, &plan, 0, &images, NULL), GRRL_ERR_UNDECIDED);
    assert_int_equal(grrl_match_tree(&of_chain, &of_chain, 0, &images, NULL), GRRL_OK);
    assert_int_equal(images, 3);
}

/* Legs around a hub; joint `prismatic` of the first leg is of the other type. */
static struct grrl_graph legs(uint8_t n_legs, uint8_t length, uint8_t prismatic)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
    for (uint8_t i = 0; i < n_legs * length; i++) {
        assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
        assert_int_equal(grrl_graph_add_joint(&graph, (uint8_t)(i + 1), i % length == 0 ? 0 : i,
                                              i == prismatic ? GRRL_PRISMATIC : GRRL_REVOLUTE),
                         GRRL_OK);
    }
    return graph;
}

/* Mechanisms of equal legs with one unequal leg: plain search takes factorial time. */
static void test_near_misses(void **state)
{
    (void)state;
    const uint8_t n = (GRRL_MAX_LINKS - 1) / 3;
    struct grrl_graph a = legs(n, 3, 1);
    struct grrl_graph b = legs(n, 3, 2);
    struct grrl_graph fewer = legs((uint8_t)(n - 1), 3, 1);
    struct grrl_graph same = legs((uint8_t)(n - 1), 3, 2);
    uint8_t map[GRRL_MAX_LINKS];
    const enum grrl_match_kind iso = GRRL_MATCH_ISOMORPHISM;
    const enum grrl_match_kind mono = GRRL_MATCH_MONOMORPHISM;
    assert_int_equal(grrl_match_find(iso, &a, &b, GRRL_ALL_PROPERTIES, 1000, map), GRRL_ERR_NONE);
    assert_int_equal(grrl_match_find(mono, &a, &b, GRRL_ALL_PROPERTIES, 1000, map), GRRL_ERR_NONE);
    assert_int_equal(grrl_match_find(mono, &fewer, &b, GRRL_ALL_PROPERTIES, 1000, map),
                     GRRL_ERR_NONE);
    assert_int_equal(grrl_match_find(mono, &same, &b, GRRL_ALL_PROPERTIES, 1000, map), GRRL_OK);
    assert_true(keeps_joints(&same, &b, GRRL_ALL_PROPERTIES, map));
    assert_int_equal(grrl_match_find(iso, &a, &a, GRRL_ALL_PROPERTIES, 1000, map), GRRL_OK);
}

/* A ring of twice n links, each joined to the next and to the one opposite (a Moebius ladder), or
 * the same as two rings of n that rungs join (a prism): colour refinement sees no difference. */
static struct grrl_graph ladder(uint8_t n, bool is_prism)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    for (uint8_t i = 0; i < 2 * n; i++)
        assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
    for (uint8_t i = 0; i < 2 * n; i++) {
        uint8_t next = (uint8_t)((i + 1) % (2 * n));
        if (is_prism)
            next = (uint8_t)(i / n * n + (i + 1) % n);
        assert_int_equal(grrl_graph_add_joint(&graph, i, next, GRRL_REVOLUTE), GRRL_OK);
        if (i < n)
            assert_int_equal(grrl_graph_add_joint(&graph, i, (uint8_t)(i + n), GRRL_REVOLUTE),
                             GRRL_OK);
    }
    return graph;
}

/* Beyond a short search, isomorphism is decided by canonical forms; a part with loops is not
 * decided without the budget for a long one. */
static void test_loops_alike(void **state)
{
    (void)state;
    struct grrl_random random = support_random("loops alike");
    unsigned n_undecided = 0;
    for (uint8_t n = 3; 2 * n <= GRRL_MAX_LINKS && 3 * n <= GRRL_MAX_JOINTS; n++) {
        struct grrl_graph moebius = ladder(n, false);
        struct grrl_graph prism = ladder(n, true);
        for (int i = 0; i < 20; i++) {
            uint8_t order[GRRL_MAX_LINKS];
            uint8_t map[GRRL_MAX_LINKS];
            struct grrl_graph other = support_relabel(&random, &prism, order);
            const enum grrl_match_kind iso = GRRL_MATCH_ISOMORPHISM;
            assert_int_equal(grrl_match_find(iso, &moebius, &other, GRRL_ALL_PROPERTIES, 1000, map),
                             GRRL_ERR_NONE);
            assert_int_equal(grrl_match_find(iso, &prism, &other, GRRL_ALL_PROPERTIES, 1000, map),
                             GRRL_OK);
            assert_true(keeps_joints(&prism, &other, GRRL_ALL_PROPERTIES, map));
            struct grrl_graph part = random_part(&random, &moebius, (uint8_t)(2 * n - 1));
            const enum grrl_match_kind mono = GRRL_MATCH_MONOMORPHISM;
            enum grrl_status expected = search_for(mono, &part, &other, GRRL_ALL_PROPERTIES);
            enum grrl_status status =
                grrl_match_find(mono, &part, &other, GRRL_ALL_PROPERTIES, 10, map);
            assert_true(status == expected || status == GRRL_ERR_UNDECIDED);
            n_undecided += status == GRRL_ERR_UNDECIDED;
            assert_int_equal(
                grrl_match_find(mono, &part, &other, GRRL_ALL_PROPERTIES, BIG_BUDGET, map),
                expected);
            assert_true(expected != GRRL_OK ||
                        keeps_joints(&part, &other, GRRL_ALL_PROPERTIES, map));
        }
    }
    assert_true(n_undecided > 10);
}

/* A part with loops takes as many steps as the search for it, and with one fewer is undecided. */
static void test_budget_is_exact(void **state)
{
    (void)state;
    struct grrl_random random = support_random("budget is exact");
    struct grrl_graph prism = ladder(5, true);
    unsigned n_long = 0;
    for (int i = 0; i < 300; i++) {
        struct grrl_graph moebius = ladder(5, false);
        struct grrl_graph part = random_part(&random, &moebius, 10);
        struct grrl_match_plan plans[2];
        struct grrl_match match;
        uint8_t map[GRRL_MAX_LINKS];
        const enum grrl_match_kind mono = GRRL_MATCH_MONOMORPHISM;
        grrl_match_plan_of(&plans[0], &part, GRRL_ALL_PROPERTIES);
        grrl_match_plan_of(&plans[1], &prism, GRRL_ALL_PROPERTIES);
        grrl_match_begin_planned(&match, mono, &plans[0], &plans[1], BIG_BUDGET);
        enum grrl_status expected = grrl_match_next(&match, map);
        uint32_t steps = BIG_BUDGET - match.budget;
        if (steps == 0 || match.kind != mono ||
            grrl_match_tree(&plans[0], &plans[1], 0, &(uint32_t){0}, NULL) == GRRL_OK)
            continue;
        assert_int_equal(grrl_match_find_planned(mono, &plans[0], &plans[1], steps, map), expected);
        assert_int_equal(grrl_match_find_planned(mono, &plans[0], &plans[1], steps - 1, map),
                         GRRL_ERR_UNDECIDED);
        n_long += steps > 8 * GRRL_MAX_LINKS; /* more than the first, short search takes */
    }
    print_message("%u long searches\n", n_long);
    assert_true(n_long > 10);
}

/* A budget of nothing leaves the answers that need no search. */
static void test_without_a_budget(void **state)
{
    (void)state;
    struct grrl_random random = support_random("without a budget");
    for (int i = 0; i < 500; i++) {
        struct grrl_graph target = random_graph(&random);
        struct grrl_graph pattern = random_part(&random, &target, target.n);
        for (int kind = 0; kind <= GRRL_MATCH_MONOMORPHISM; kind++) {
            uint8_t map[GRRL_MAX_LINKS];
            enum grrl_match_kind k = (enum grrl_match_kind)kind;
            enum grrl_status expected = search_for(k, &pattern, &target, GRRL_ALL_PROPERTIES);
            enum grrl_status status =
                grrl_match_find(k, &pattern, &target, GRRL_ALL_PROPERTIES, 0, map);
            assert_true(status == expected ||
                        (status == GRRL_ERR_UNDECIDED && k == GRRL_MATCH_MONOMORPHISM));
            assert_true(status != GRRL_OK ||
                        keeps_joints(&pattern, &target, GRRL_ALL_PROPERTIES, map));
        }
    }
}

/* A structure that links and joints are added to keeps what was a part of it, in its counts too. */
static void test_a_part_stays_a_part(void **state)
{
    (void)state;
    struct grrl_random random = support_random("a part stays");
    for (int i = 0; i < 3000; i++) {
        struct grrl_graph target = random_graph(&random);
        uint8_t n = (uint8_t)(1 + grrl_random_below(&random, target.n));
        struct grrl_graph part = random_part(&random, &target, n);
        for (int more = 0; more < 4; more++) {
            struct grrl_signature small;
            struct grrl_signature large;
            uint8_t map[GRRL_MAX_LINKS];
            grrl_signature_of(&part, GRRL_ALL_PROPERTIES, &small);
            grrl_signature_of(&target, GRRL_ALL_PROPERTIES, &large);
            assert_true(grrl_signature_within(&small, &large, false));
            struct grrl_paths few;
            struct grrl_paths many;
            grrl_paths_of(&part, &few);
            grrl_paths_of(&target, &many);
            assert_true(grrl_paths_within(&few, &many));
            assert_true(grrl_signature_within(&small, &large, true));
            assert_int_equal(grrl_match_find(GRRL_MATCH_MONOMORPHISM, &part, &target,
                                             GRRL_ALL_PROPERTIES, BIG_BUDGET, map),
                             GRRL_OK);
            uint8_t added;
            if (grrl_graph_add_link(&target, grrl_random_below(&random, 3), &added) != GRRL_OK)
                added = 0;
            enum grrl_status status = grrl_graph_add_joint(
                &target, added, (uint8_t)grrl_random_below(&random, target.n),
                grrl_random_below(&random, 2) ? GRRL_PRISMATIC : GRRL_REVOLUTE);
            (void)status; /* a joint that is there already stays */
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_way_gives_the_same),
        cmocka_unit_test(test_trees),
        cmocka_unit_test(test_near_misses),
        cmocka_unit_test(test_loops_alike),
        cmocka_unit_test(test_budget_is_exact),
        cmocka_unit_test(test_without_a_budget),
        cmocka_unit_test(test_a_part_stays_a_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
