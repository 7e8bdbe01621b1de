/* Canonical forms neither collide nor split: all small graphs, and many larger ones. */
#include "grrl/structure/canonical.h"
#include "grrl/structure/match.h"
#include "support.h"

static struct grrl_canonical canonical_of(const struct grrl_graph *graph)
{
    struct grrl_canonical canonical;
    assert_int_equal(
        grrl_canonical_of(graph, GRRL_ALL_PROPERTIES, GRRL_CANONICAL_BUDGET, &canonical), GRRL_OK);
    return canonical;
}

enum { FEW = 5, PAIRS = FEW * (FEW - 1) / 2, JOINTS = 59049 /* 3^PAIRS */ };

static uint32_t power(uint32_t base, unsigned exponent)
{
    uint32_t result = 1;
    for (; exponent > 0; exponent--)
        result *= base;
    return result;
}

/* The pairs of links as digits in base 3: none, revolute, prismatic. */
static struct grrl_graph numbered(uint8_t n, uint32_t joints)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    for (uint8_t b = 0; b < n; b++) {
        assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
        for (uint8_t a = 0; a < b; a++, joints /= 3)
            if (joints % 3 != 0)
                assert_int_equal(
                    grrl_graph_add_joint(&graph, a, b,
                                         joints % 3 == 1 ? GRRL_REVOLUTE : GRRL_PRISMATIC),
                    GRRL_OK);
    }
    return graph;
}

/* The number of a graph, and bit i of its labels for that of link i. */
static uint32_t number_of(const struct grrl_graph *graph, uint32_t *labels)
{
    uint32_t joints = 0;
    uint32_t digit = 1;
    *labels = 0;
    for (uint8_t b = 0; b < graph->n; b++) {
        *labels |= (uint32_t)graph->label[b] << b;
        for (uint8_t a = 0; a < b; a++, digit *= 3)
            joints += digit * ((graph->joined[GRRL_REVOLUTE][b] >> a & 1u) +
                               2 * (graph->joined[GRRL_PRISMATIC][b] >> a & 1u));
    }
    return joints;
}

/* Visits the cycle of a permutation that an element is on; false if that was done before. */
static bool visit_cycle(const uint8_t *to, uint8_t start, uint32_t *visited)
{
    if ((*visited >> start & 1u) != 0)
        return false;
    for (uint8_t at = start; (*visited >> at & 1u) == 0; at = to[at])
        *visited |= UINT32_C(1) << at;
    return true;
}

/* Graphs that a permutation of the links leaves as they are: each cycle of links shares one of the
 * labels, each cycle of pairs one of no joint, revolute, prismatic. */
static uint32_t count_fixed(const uint8_t *to, uint8_t n, uint32_t n_labels)
{
    uint32_t fixed = 1;
    uint32_t visited = 0;
    uint8_t pair_to[PAIRS];
    for (uint8_t b = 0, pair = 0; b < n; b++) {
        fixed *= visit_cycle(to, b, &visited) ? n_labels : 1;
        for (uint8_t a = 0; a < b; a++, pair++) {
            uint8_t high = to[a] > to[b] ? to[a] : to[b];
            uint8_t low = to[a] > to[b] ? to[b] : to[a];
            pair_to[pair] = (uint8_t)(high * (high - 1) / 2 + low);
        }
    }
    visited = 0;
    for (uint8_t pair = 0; pair < n * (n - 1) / 2; pair++)
        fixed *= visit_cycle(pair_to, pair, &visited) ? 3 : 1;
    return fixed;
}

/* Burnside's lemma: the classes of graphs under relabelling, without looking at any graph. */
static uint32_t burnside(uint8_t n, uint32_t n_labels)
{
    uint32_t sum = 0;
    uint32_t n_permutations = 0;
    for (uint32_t code = 0; code < power(n, n); code++) {
        uint8_t to[FEW];
        uint32_t images = 0;
        for (uint32_t i = 0, rest = code; i < n; i++, rest /= n) {
            to[i] = (uint8_t)(rest % n);
            images |= UINT32_C(1) << to[i];
        }
        if (images != (UINT32_C(1) << n) - 1u)
            continue; /* two links with one image: no permutation */
        n_permutations++;
        sum += count_fixed(to, n, n_labels);
    }
    assert_int_equal(sum % n_permutations, 0);
    return sum / n_permutations;
}

/*
 * All graphs with n links, each with its links labelled 0 or 1 in each way, under a mask. Each form
 * is its graph with the links in another order, so that no two classes share one; and there are as
 * many forms as classes, so that no class has two.
 */
static void check_all(uint8_t n, grrl_label mask)
{
    static bool is_form[JOINTS][1u << FEW];
    const bool labelled = (mask & 1u) != 0;
    uint32_t n_forms = 0;
    memset(is_form, 0, sizeof is_form);
    for (uint32_t joints = 0; joints < power(3, n * (n - 1u) / 2); joints++) {
        struct grrl_graph graph = numbered(n, joints);
        for (uint32_t labels = 0; labels < UINT32_C(1) << n; labels++) {
            for (uint8_t i = 0; i < n; i++)
                graph.label[i] = labels >> i & 1u;
            struct grrl_canonical form;
            assert_int_equal(grrl_canonical_of(&graph, mask, GRRL_CANONICAL_BUDGET, &form),
                             GRRL_OK);
            struct grrl_graph ordered;
            uint32_t vertices = 0;
            for (uint8_t i = 0; i < n; i++)
                vertices |= UINT32_C(1) << form.order[i];
            assert_int_equal(vertices, (UINT32_C(1) << n) - 1u);
            grrl_graph_permute(&graph, form.order, &ordered);
            assert_true(grrl_graph_equal(&ordered, &form.graph, mask));
            uint32_t form_labels;
            uint32_t form_joints = number_of(&form.graph, &form_labels);
            assert_true(labelled || form_labels == 0);
            n_forms += !is_form[form_joints][form_labels];
            is_form[form_joints][form_labels] = true;
        }
    }
    assert_int_equal(n_forms, burnside(n, labelled ? 2 : 1));
}

static void test_all_up_to_five_links(void **state)
{
    (void)state;
    assert_int_equal(burnside(5, 1), 792); /* OEIS A004102 */
    for (uint8_t n = 1; n <= FEW; n++) {
        check_all(n, GRRL_ALL_PROPERTIES);
        check_all(n, GRRL_NO_PROPERTIES);
    }
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
