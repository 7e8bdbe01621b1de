/* Canonical forms neither collide nor split: all small graphs, and many larger ones. */
#include "grrl/canonical.h"
#include "grrl/match.h"
#include "support.h"

static struct grrl_canonical canonical_of(const struct grrl_graph *graph)
{
    struct grrl_canonical canonical;
    assert_int_equal(grrl_canonical(graph, GRRL_ALL_PROPERTIES, GRRL_CANONICAL_BUDGET, &canonical),
                     GRRL_OK);
    return canonical;
}

/* The pairs of links as digits in base 3: none, revolute, prismatic; the labels as bits. */
static struct grrl_graph numbered(uint8_t n, uint32_t joints, uint32_t labels)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    for (uint8_t b = 0; b < n; b++) {
        assert_int_equal(grrl_graph_add_link(&graph, labels >> b & 1u, NULL), GRRL_OK);
        for (uint8_t a = 0; a < b; a++, joints /= 3)
            if (joints % 3 != 0)
                assert_int_equal(
                    grrl_graph_add_joint(&graph, a, b,
                                         joints % 3 == 1 ? GRRL_REVOLUTE : GRRL_PRISMATIC),
                    GRRL_OK);
    }
    return graph;
}

/* Forms are canonical graphs themselves, so each class shows as exactly one fixed point. */
static unsigned count_classes(uint8_t n, uint32_t n_joints, uint32_t n_labels)
{
    unsigned n_classes = 0;
    for (uint32_t joints = 0; joints < n_joints; joints++) {
        for (uint32_t labels = 0; labels < n_labels; labels++) {
            struct grrl_graph graph = numbered(n, joints, labels);
            struct grrl_canonical form = canonical_of(&graph);
            n_classes += grrl_graph_equal(&graph, &form.graph, GRRL_ALL_PROPERTIES);
        }
    }
    return n_classes;
}

static void test_all_up_to_five_links(void **state)
{
    (void)state;
    /* OEIS A004102: graphs with edges of two kinds, or none, on so many points. A form that
     * collided would be missing here, a class that split would count twice. */
    assert_int_equal(count_classes(1, 1, 1), 1);
    assert_int_equal(count_classes(2, 3, 1), 3);
    assert_int_equal(count_classes(3, 27, 1), 10);
    assert_int_equal(count_classes(4, 729, 1), 66);
    assert_int_equal(count_classes(5, 59049, 1), 792);
    /* with two labels, by Burnside's lemma */
    assert_int_equal(count_classes(1, 1, 2), 2);
    assert_int_equal(count_classes(2, 3, 4), 9);
    assert_int_equal(count_classes(3, 27, 8), 56);
}

static void test_many_larger(void **state)
{
    (void)state;
    struct grrl_random random = support_random("larger");
    unsigned n_same = 0;
    for (int i = 0; i < 100000; i++) {
        uint8_t n = (uint8_t)(6 + grrl_random_below(&random, GRRL_MAX_LINKS - 5));
        struct grrl_graph graph = support_graph(&random, n, 7 + grrl_random_below(&random, 2),
                                                grrl_random_below(&random, 4), 1);
        uint8_t order[GRRL_MAX_LINKS];
        struct grrl_graph other = support_relabel(&random, &graph, order);
        bool changed = grrl_random_below(&random, 2) == 0;
        if (changed) { /* two labels exchanged: often the same structure all the same */
            uint8_t a = (uint8_t)grrl_random_below(&random, n);
            uint8_t b = (uint8_t)grrl_random_below(&random, n);
            grrl_label kept = other.label[a];
            other.label[a] = other.label[b];
            other.label[b] = kept;
        }
        struct grrl_canonical forms[2] = {canonical_of(&graph), canonical_of(&other)};
        bool same = grrl_graph_equal(&forms[0].graph, &forms[1].graph, GRRL_ALL_PROPERTIES);
        struct grrl_match match;
        uint8_t map[GRRL_MAX_LINKS];
        grrl_match_begin(&match, GRRL_MATCH_ISOMORPHISM, &graph, &other, GRRL_ALL_PROPERTIES,
                         100000000);
        assert_int_equal(same, grrl_match_next(&match, map) == GRRL_OK);
        assert_true(same || changed);
        assert_true(!same || forms[0].hash == forms[1].hash);
        n_same += same;
    }
    assert_true(n_same > 50000 && n_same < 95000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_up_to_five_links),
        cmocka_unit_test(test_many_larger),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
