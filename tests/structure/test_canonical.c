/* Canonical forms against brute force, relabelled and symmetric graphs. */
#include "grrl/structure/canonical.h"
#include "support.h"

static struct grrl_canonical canonical_of(const struct grrl_graph *graph, grrl_label mask)
{
    struct grrl_canonical canonical;
    assert_int_equal(grrl_canonical_of(graph, mask, GRRL_CANONICAL_BUDGET, &canonical), GRRL_OK);
    struct grrl_graph permuted;
    grrl_graph_permute(graph, canonical.order, &permuted);
    for (uint8_t i = 0; i < graph->n; i++)
        permuted.label[i] = grrl_label_masked(permuted.label[i], mask);
    assert_memory_equal(&permuted, &canonical.graph, sizeof permuted);
    return canonical;
}

static bool same_canonical(const struct grrl_canonical *a, const struct grrl_canonical *b)
{
    bool same = grrl_graph_equal(&a->graph, &b->graph, GRRL_ALL_PROPERTIES);
    assert_true(!same || a->hash == b->hash);
    return same;
}

/* Isomorphism by trying every order of the vertices (Heap's algorithm). */
static bool brute_force(const struct grrl_graph *a, const struct grrl_graph *b, grrl_label mask)
{
    if (a->n != b->n)
        return false;
    uint8_t order[8];
    uint8_t counter[8] = {0};
    for (uint8_t i = 0; i < a->n; i++)
        order[i] = i;
    struct grrl_graph permuted;
    grrl_graph_permute(a, order, &permuted);
    if (grrl_graph_equal(&permuted, b, mask))
        return true;
    for (uint8_t i = 1; i < a->n;) {
        if (counter[i] == i) {
            counter[i++] = 0;
            continue;
        }
        uint8_t j = i % 2 == 0 ? 0 : counter[i];
        uint8_t kept = order[i];
        order[i] = order[j];
        order[j] = kept;
        counter[i]++;
        i = 1;
        grrl_graph_permute(a, order, &permuted);
        if (grrl_graph_equal(&permuted, b, mask))
            return true;
    }
    return false;
}

/* All 729 graphs of four links with both types of joints, every pair of them. */
static void test_all_of_four_links(void **state)
{
    (void)state;
    enum { N_GRAPHS = 729 };
    static struct grrl_graph graphs[N_GRAPHS];
    static struct grrl_canonical canonical[N_GRAPHS];
    unsigned n_classes = 0;
    for (int i = 0; i < N_GRAPHS; i++) {
        grrl_graph_clear(&graphs[i]);
        for (int k = 0; k < 4; k++)
            assert_int_equal(grrl_graph_add_link(&graphs[i], 0, NULL), GRRL_OK);
        int digits = i;
        for (uint8_t b = 1; b < 4; b++)
            for (uint8_t a = 0; a < b; a++, digits /= 3)
                if (digits % 3 != 0)
                    assert_int_equal(
                        grrl_graph_add_joint(&graphs[i], a, b,
                                             digits % 3 == 1 ? GRRL_REVOLUTE : GRRL_PRISMATIC),
                        GRRL_OK);
        canonical[i] = canonical_of(&graphs[i], GRRL_ALL_PROPERTIES);
        bool is_new = true;
        for (int j = 0; j < i; j++) {
            bool same = same_canonical(&canonical[i], &canonical[j]);
            assert_int_equal(same, brute_force(&graphs[i], &graphs[j], GRRL_ALL_PROPERTIES));
            is_new = is_new && !same;
        }
        n_classes += is_new;
    }
    assert_int_equal(n_classes, 66); /* OEIS A004102: edges of three kinds on four points */
}

static void test_against_brute_force(void **state)
{
    (void)state;
    struct grrl_random random = support_random("brute force");
    unsigned n_same = 0;
    for (int i = 0; i < 6000; i++) {
        uint8_t n = (uint8_t)grrl_random_below(&random, 7);
        uint32_t connect = 4 + grrl_random_below(&random, 5);
        uint32_t loops = n > 1 ? grrl_random_below(&random, 8) : 0;
        struct grrl_graph a = support_graph(&random, n, connect, loops, 1);
        uint8_t order[GRRL_MAX_LINKS];
        struct grrl_graph b = grrl_random_below(&random, 4) == 0
                                  ? support_graph(&random, n, connect, loops, 1)
                                  : support_relabel(&random, &a, order);
        if (n > 1 && grrl_random_below(&random, 2)) { /* move one joint, change one label */
            uint8_t k = (uint8_t)grrl_random_below(&random, n);
            for (uint8_t j = 0; j < n; j++) {
                if (j == k || grrl_graph_joint(&b, j, k) != GRRL_REVOLUTE)
                    continue;
                b.joined[GRRL_REVOLUTE][j] ^= 1u << k;
                b.joined[GRRL_REVOLUTE][k] ^= 1u << j;
                enum grrl_status status =
                    grrl_graph_add_joint(&b, j, (uint8_t)((k + 1) % n), GRRL_REVOLUTE);
                (void)status; /* or take it away only */
                break;
            }
            if (grrl_random_below(&random, 4) == 0)
                b.label[k] = GRRL_LABEL_BACKGROUND;
        }
        grrl_label mask = grrl_random_below(&random, 2) ? GRRL_ALL_PROPERTIES : GRRL_NO_PROPERTIES;
        struct grrl_canonical of_a = canonical_of(&a, mask);
        struct grrl_canonical of_b = canonical_of(&b, mask);
        bool same = brute_force(&a, &b, mask);
        assert_int_equal(same_canonical(&of_a, &of_b), same);
        n_same += same;
    }
    assert_true(n_same > 1500 && n_same < 4500);
}

static void assert_relabelling_invariant(struct grrl_random *random, const struct grrl_graph *graph,
                                         int n_times)
{
    struct grrl_canonical first = canonical_of(graph, GRRL_ALL_PROPERTIES);
    for (int i = 0; i < n_times; i++) {
        uint8_t order[GRRL_MAX_LINKS];
        struct grrl_graph other = support_relabel(random, graph, order);
        struct grrl_canonical again = canonical_of(&other, GRRL_ALL_PROPERTIES);
        assert_true(same_canonical(&first, &again));
    }
}

static void test_large_relabelled(void **state)
{
    (void)state;
    struct grrl_random random = support_random("relabelled");
    for (int i = 0; i < 2000; i++) {
        uint8_t n = (uint8_t)(2 + grrl_random_below(&random, GRRL_MAX_LINKS - 1));
        struct grrl_graph graph =
            support_graph(&random, n, 5 + grrl_random_below(&random, 4),
                          grrl_random_below(&random, n), grrl_random_below(&random, 3));
        assert_relabelling_invariant(&random, &graph, 4);
    }
}

/* n links of one kind without joints. */
static struct grrl_graph links(uint8_t n)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    for (uint8_t i = 0; i < n; i++)
        assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
    return graph;
}

static void join(struct grrl_graph *graph, int a, int b)
{
    assert_int_equal(grrl_graph_add_joint(graph, (uint8_t)a, (uint8_t)b, GRRL_REVOLUTE), GRRL_OK);
}

/* Structures with so many automorphisms that a search without them would be factorial. */
static void test_symmetric(void **state)
{
    (void)state;
    struct grrl_random random = support_random("symmetric");
    struct grrl_graph loop = links(GRRL_MAX_LINKS);
    for (int i = 0; i < GRRL_MAX_LINKS; i++)
        join(&loop, i, (i + 1) % GRRL_MAX_LINKS);
    struct grrl_graph triangles = links((GRRL_MAX_LINKS - 1) / 2 * 2 + 1);
    for (int i = 1; i < triangles.n; i += 2) {
        join(&triangles, 0, i);
        join(&triangles, 0, i + 1);
        join(&triangles, i, i + 1);
    }
    struct grrl_graph star = links(GRRL_MAX_LINKS);
    struct grrl_graph legs = links(GRRL_MAX_LINKS);
    for (int i = 1; i < GRRL_MAX_LINKS; i++) {
        join(&star, 0, i);
        join(&legs, i < 6 ? 0 : i - 5, i); /* five legs, in turn one link longer */
    }
    struct grrl_graph bipartite = links(8);
    for (int i = 0; i < 16; i++)
        join(&bipartite, i / 4, 4 + i % 4);
    struct grrl_graph separate = links(GRRL_MAX_LINKS);
    struct grrl_graph empty = links(GRRL_MAX_LINKS);
    for (int i = 0; i + 2 < GRRL_MAX_LINKS; i += 3) {
        join(&separate, i, i + 1);
        join(&separate, i + 1, i + 2);
        join(&separate, i, i + 2);
    }
    const struct grrl_graph *const graphs[] = {&loop,      &triangles, &star, &legs,
                                               &bipartite, &separate,  &empty};
    for (size_t i = 0; i < sizeof graphs / sizeof graphs[0]; i++)
        assert_relabelling_invariant(&random, graphs[i], 20);
}

/* Pairs that colour refinement cannot tell apart. */
static void test_alike_to_refinement(void **state)
{
    (void)state;
    struct grrl_random random = support_random("alike");
    struct grrl_graph prism = links(6);
    struct grrl_graph utility = links(6);
    for (int i = 0; i < 3; i++) {
        join(&prism, i, (i + 1) % 3);
        join(&prism, 3 + i, 3 + (i + 1) % 3);
        join(&prism, i, 3 + i);
        for (int j = 0; j < 3; j++)
            join(&utility, i, 3 + j);
    }
    struct grrl_graph petersen = links(10);
    struct grrl_graph drum = links(10);
    for (int i = 0; i < 5; i++) {
        join(&petersen, i, (i + 1) % 5);
        join(&petersen, 5 + i, 5 + (i + 2) % 5);
        join(&petersen, i, 5 + i);
        join(&drum, i, (i + 1) % 5);
        join(&drum, 5 + i, 5 + (i + 1) % 5);
        join(&drum, i, 5 + i);
    }
    struct grrl_graph hexagon = links(6);
    struct grrl_graph two = links(6);
    for (int i = 0; i < 6; i++) {
        join(&hexagon, i, (i + 1) % 6);
        join(&two, i, i / 3 * 3 + (i + 1) % 3);
    }
    const struct grrl_graph *const pairs[][2] = {
        {&prism, &utility}, {&petersen, &drum}, {&hexagon, &two}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        assert_relabelling_invariant(&random, pairs[i][0], 50);
        assert_relabelling_invariant(&random, pairs[i][1], 50);
        struct grrl_canonical a = canonical_of(pairs[i][0], GRRL_ALL_PROPERTIES);
        struct grrl_canonical b = canonical_of(pairs[i][1], GRRL_ALL_PROPERTIES);
        assert_false(same_canonical(&a, &b));
    }
}

/* What is symmetric is searched once: the refinements that some structures take, and no more, are
 * few next to the 5! to 10! orders of their links. With fewer the form is undecided. */
static void test_few_refinements(void **state)
{
    (void)state;
    struct grrl_graph loop = links(5);
    struct grrl_graph complete = links(5);
    struct grrl_graph bipartite = links(8);
    struct grrl_graph cube = links(8);
    struct grrl_graph petersen = links(10);
    struct grrl_graph star = links(10);
    for (int i = 1; i < 10; i++)
        join(&star, 0, i);
    for (int i = 0; i < 5; i++) {
        join(&loop, i, (i + 1) % 5);
        join(&petersen, i, (i + 1) % 5);
        join(&petersen, 5 + i, 5 + (i + 2) % 5);
        join(&petersen, i, 5 + i);
        for (int j = 0; j < i; j++)
            join(&complete, i, j);
    }
    for (int i = 0; i < 16; i++)
        join(&bipartite, i / 4, 4 + i % 4);
    for (int i = 0; i < 8; i++)
        for (int bit = 1; bit < 8; bit *= 2)
            if ((i & bit) == 0)
                join(&cube, i, i | bit);
    const struct {
        const struct grrl_graph *graph;
        uint32_t refinements;
    } cases[] = {{&loop, 6},  {&complete, 15}, {&bipartite, 34},
                 {&cube, 10}, {&petersen, 15}, {&star, 9}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct grrl_canonical canonical;
        uint32_t budget = 0;
        while (grrl_canonical_of(cases[i].graph, GRRL_ALL_PROPERTIES, budget, &canonical) ==
               GRRL_ERR_UNDECIDED)
            budget++;
        assert_in_range(budget, 3, cases[i].refinements);
        struct grrl_canonical plenty = canonical_of(cases[i].graph, GRRL_ALL_PROPERTIES);
        assert_true(same_canonical(&canonical, &plenty));
    }
}

static void fill_stack(uint8_t value)
{
    volatile uint8_t bytes[16384];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = value;
}

/* Three joints at each of ten links, at random: refinement sees no difference between links, and
 * most have no symmetry. */
static struct grrl_graph random_cubic(struct grrl_random *random)
{
    struct grrl_graph graph = links(10);
    uint8_t ends[30];
    uint8_t order[30];
    do {
        graph = links(10);
        support_shuffle(random, order, 30);
        for (int i = 0; i < 30; i++)
            ends[i] = order[i] / 3;
        for (int i = 0; i < 30; i += 2) {
            enum grrl_status status =
                grrl_graph_add_joint(&graph, ends[i], ends[i + 1], GRRL_REVOLUTE);
            (void)status; /* a pair that is joined, or one link twice: then once more */
        }
    } while (grrl_graph_joint_count(&graph) != 15);
    return graph;
}

/* Whatever lies in memory before a search, links that only look alike are all tried. */
static void test_only_alike(void **state)
{
    (void)state;
    struct grrl_random random = support_random("only alike");
    void (*volatile fill)(uint8_t) = fill_stack; /* a call that no compiler leaves out */
    for (int i = 0; i < 300; i++) {
        struct grrl_graph graph = random_cubic(&random);
        uint8_t order[GRRL_MAX_LINKS];
        struct grrl_graph other = support_relabel(&random, &graph, order);
        for (unsigned value = 0; value < 256; value += 255) {
            fill((uint8_t)value);
            struct grrl_canonical a = canonical_of(&graph, GRRL_ALL_PROPERTIES);
            fill((uint8_t)value);
            struct grrl_canonical b = canonical_of(&other, GRRL_ALL_PROPERTIES);
            assert_true(same_canonical(&a, &b));
        }
    }
}

static void test_hash(void **state)
{
    (void)state;
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    assert_int_equal(grrl_graph_add_link(&graph, GRRL_PROPERTY_LARGE, NULL), GRRL_OK);
    assert_int_equal(grrl_graph_add_link(&graph, GRRL_PROPERTY_SMALL, NULL), GRRL_OK);
    assert_int_equal(grrl_graph_add_joint(&graph, 0, 1, GRRL_PRISMATIC), GRRL_OK);
    struct grrl_canonical canonical = canonical_of(&graph, GRRL_ALL_PROPERTIES);
    assert_int_equal(canonical.order[0], 1);
    /* FNV-1a of n, then label and rows of each link, least significant bytes first */
    assert_int_equal(canonical.hash, 0x81c25775u);
    assert_int_not_equal(canonical_of(&graph, GRRL_NO_PROPERTIES).hash, canonical.hash);
}

/* Components stand side by side by size, then by their labels, then by their joints: stores of
 * experiences keep this order. */
static void test_order_of_components(void **state)
{
    (void)state;
    struct grrl_graph graph = links(9);
    graph.label[0] = 2;
    graph.label[1] = 1;
    join(&graph, 2, 3);
    join(&graph, 4, 5);
    join(&graph, 6, 7);
    graph.label[2] = 1;
    graph.label[3] = 2;
    graph.label[4] = 1;
    graph.label[5] = 1;
    assert_int_equal(grrl_graph_add_joint(&graph, 7, 8, GRRL_PRISMATIC), GRRL_OK);
    struct grrl_canonical canonical = canonical_of(&graph, GRRL_ALL_PROPERTIES);
    const uint8_t expected[6] = {1, 0, 4, 5, 2, 3};
    for (int i = 0; i < 6; i++)
        assert_true(canonical.graph.label[i] == graph.label[expected[i]]);
    assert_int_equal(canonical.order[0], 1);
    assert_int_equal(canonical.order[1], 0);
    assert_int_equal(canonical.order[4], 2);
    assert_int_equal(canonical.order[5], 3);
}

static void test_budget(void **state)
{
    (void)state;
    struct grrl_graph graph = links(2);
    join(&graph, 0, 1);
    struct grrl_canonical canonical;
    memset(&canonical, 0x55, sizeof canonical);
    struct grrl_canonical before = canonical;
    /* one refinement leaves both links in one cell, a second tells them apart */
    assert_int_equal(grrl_canonical_of(&graph, GRRL_ALL_PROPERTIES, 0, &canonical),
                     GRRL_ERR_UNDECIDED);
    assert_int_equal(grrl_canonical_of(&graph, GRRL_ALL_PROPERTIES, 1, &canonical),
                     GRRL_ERR_UNDECIDED);
    assert_memory_equal(&canonical, &before, sizeof canonical);
    assert_int_equal(grrl_canonical_of(&graph, GRRL_ALL_PROPERTIES, 2, &canonical), GRRL_OK);
    graph.label[0] = 1;
    assert_int_equal(grrl_canonical_of(&graph, GRRL_ALL_PROPERTIES, 1, &canonical), GRRL_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_of_four_links),   cmocka_unit_test(test_against_brute_force),
        cmocka_unit_test(test_large_relabelled),    cmocka_unit_test(test_symmetric),
        cmocka_unit_test(test_alike_to_refinement), cmocka_unit_test(test_few_refinements),
        cmocka_unit_test(test_only_alike),          cmocka_unit_test(test_hash),
        cmocka_unit_test(test_order_of_components), cmocka_unit_test(test_budget),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
