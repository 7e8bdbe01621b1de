/*
 * support.h: shared by the tests of terms and graphs.
 *
 * Random tests take their seed from the environment variable GRRL_TEST_SEED, or a fixed one, and
 * print it at the start.
 */
#ifndef GRRL_TESTS_SUPPORT_H
#define GRRL_TESTS_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/base/random.h"
#include "grrl/structure/graph.h"
#include "grrl/structure/term.h"

_Static_assert(GRRL_MAX_LINKS >= 10 && GRRL_MAX_JOINTS >= 16, "the structures of these tests fit");

static inline struct grrl_random support_random(const char *test)
{
    const char *given = getenv("GRRL_TEST_SEED");
    uint64_t seed = given != NULL ? strtoull(given, NULL, 10) : 20080625u;
    print_message("%s: GRRL_TEST_SEED=%llu\n", test, (unsigned long long)seed);
    struct grrl_random random;
    grrl_random_init(&random, seed, 1);
    return random;
}

static inline grrl_term support_parse(struct grrl_term_store *store, const char *text)
{
    grrl_term term = 0;
    struct grrl_term_error error;
    if (grrl_term_parse(store, text, strlen(text), &term, &error) != GRRL_OK)
        fail_msg("%s\n%u:%u: %s", text, error.line, error.column, error.message);
    return term;
}

static inline void support_assert_prints(const struct grrl_term_store *store, grrl_term term,
                                         const char *expected)
{
    char text[4096];
    size_t length = 0;
    assert_int_equal(grrl_term_print(store, term, sizeof text, text, &length), GRRL_OK);
    assert_string_equal(text, expected);
    assert_int_equal(length, strlen(expected));
}

static inline void support_shuffle(struct grrl_random *random, uint8_t *order, uint8_t n)
{
    for (uint8_t i = 0; i < n;
         i++) { /* i goes to a random place, and the item there goes to the end */
        uint8_t j = (uint8_t)grrl_random_below(random, i + 1u);
        if (j != i)
            order[i] = order[j];
        order[j] = i;
    }
}

/*
 * A random graph of n links: a forest in which each link is joined to an earlier one with
 * probability connect / 8, plus `loops` attempts to add a joint. Labels have 0 .. n_atoms at place
 * 0.
 */
static inline struct grrl_graph support_graph(struct grrl_random *random, uint8_t n,
                                              uint32_t connect, uint32_t loops, uint32_t n_atoms)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    for (uint8_t i = 0; i < n; i++) {
        assert_int_equal(grrl_graph_add_link(&graph, grrl_random_below(random, n_atoms + 1), NULL),
                         GRRL_OK);
        enum grrl_joint_type type = grrl_random_below(random, 2) ? GRRL_PRISMATIC : GRRL_REVOLUTE;
        if (i > 0 && grrl_random_below(random, 8) < connect)
            assert_int_equal(
                grrl_graph_add_joint(&graph, i, (uint8_t)grrl_random_below(random, i), type),
                GRRL_OK);
    }
    for (uint32_t i = 0; i < loops; i++) {
        enum grrl_joint_type type = grrl_random_below(random, 2) ? GRRL_PRISMATIC : GRRL_REVOLUTE;
        enum grrl_status status =
            grrl_graph_add_joint(&graph, (uint8_t)grrl_random_below(random, n),
                                 (uint8_t)grrl_random_below(random, n), type);
        (void)status; /* a pair that already has a joint stays as it is */
    }
    return graph;
}

static inline struct grrl_graph support_relabel(struct grrl_random *random,
                                                const struct grrl_graph *graph, uint8_t *order)
{
    struct grrl_graph relabelled;
    support_shuffle(random, order, graph->n);
    grrl_graph_permute(graph, order, &relabelled);
    return relabelled;
}

#endif
