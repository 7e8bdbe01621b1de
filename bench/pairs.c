/* Random pairs of structures for the matchers, and the clock and quantiles of all benchmarks. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench.h"
#include "grrl/structure/canonical.h"

double bench_now_ns(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e9 + (double)now.tv_nsec;
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

void bench_sort(double *values, size_t n)
{
    qsort(values, n, sizeof values[0], compare_numbers);
}

double bench_quantile(const double *sorted, size_t n, double share)
{
    return sorted[(size_t)(share * (double)(n - 1) + 0.5)];
}

static void must(enum grrl_status status)
{
    if (status != GRRL_OK)
        abort();
}

static enum grrl_joint_type random_type(struct grrl_random *random)
{
    return grrl_random_below(random, 2) == 0 ? GRRL_REVOLUTE : GRRL_PRISMATIC;
}

void bench_graph(struct grrl_random *random, enum bench_shape shape, uint8_t n,
                 struct grrl_graph *graph)
{
    grrl_graph_clear(graph);
    for (uint8_t i = 0; i < n; i++) {
        must(grrl_graph_add_link(graph, 1 + grrl_random_below(random, 2), NULL));
        uint8_t parent = i > 0 ? (uint8_t)(i - 1) : 0;
        if (shape != BENCH_CHAIN && i > 0)
            parent = (uint8_t)grrl_random_below(random, i);
        if (i > 0)
            must(grrl_graph_add_joint(graph, i, parent, random_type(random)));
    }
    for (int loops = shape == BENCH_LOOP ? 1 : shape == BENCH_LOOPS ? 2 : 0; loops > 0;) {
        uint8_t a = (uint8_t)grrl_random_below(random, n);
        uint8_t b = (uint8_t)grrl_random_below(random, n);
        if (a != b && grrl_graph_add_joint(graph, a, b, random_type(random)) == GRRL_OK)
            loops--;
    }
}

static void shuffled(struct grrl_random *random, const struct grrl_graph *graph,
                     struct grrl_graph *result)
{
    uint8_t order[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < graph->n; i++) {
        uint8_t j = (uint8_t)grrl_random_below(random, i + 1u);
        order[i] = order[j];
        order[j] = i;
    }
    grrl_graph_permute(graph, order, result);
}

/* Swaps the labels of two links or the types of two joints. */
static void exchange(struct grrl_random *random, struct grrl_graph *graph)
{
    uint8_t a = (uint8_t)grrl_random_below(random, graph->n);
    uint8_t b = (uint8_t)grrl_random_below(random, graph->n);
    if (grrl_random_below(random, 2) == 0) {
        grrl_label kept = graph->label[a];
        graph->label[a] = graph->label[b];
        graph->label[b] = kept;
        return;
    }
    uint8_t c = (uint8_t)grrl_random_below(random, graph->n);
    uint8_t d = (uint8_t)grrl_random_below(random, graph->n);
    if (a == b || c == d || grrl_graph_joint(graph, a, b) != GRRL_REVOLUTE ||
        grrl_graph_joint(graph, c, d) != GRRL_PRISMATIC)
        return;
    const uint8_t ends[4][2] = {{a, b}, {b, a}, {c, d}, {d, c}};
    for (int i = 0; i < 4; i++)
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            graph->joined[type][ends[i][0]] ^= UINT32_C(1) << ends[i][1];
}

/* Removes all but n links, in an order that keeps the rest connected. */
static void take_part(const struct grrl_graph *graph, uint8_t n, struct grrl_graph *part)
{
    *part = *graph;
    part->n = n;
    for (uint8_t i = 0; i < graph->n; i++) {
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            part->joined[type][i] = i < n ? graph->joined[type][i] & (UINT32_MAX >> (32 - n)) : 0;
        part->label[i] = i < n ? graph->label[i] : 0;
    }
}

static bool is_isomorphic(const struct grrl_graph *a, const struct grrl_graph *b)
{
    struct grrl_canonical form[2];
    must(grrl_canonical_of(a, GRRL_ALL_PROPERTIES, GRRL_CANONICAL_BUDGET, &form[0]));
    must(grrl_canonical_of(b, GRRL_ALL_PROPERTIES, GRRL_CANONICAL_BUDGET, &form[1]));
    return grrl_graph_equal(&form[0].graph, &form[1].graph, GRRL_ALL_PROPERTIES);
}

void bench_pair(struct grrl_random *random, enum bench_shape shape, enum bench_question question,
                uint8_t n, struct bench_pair *pair)
{
    pair->matches = question == BENCH_ISO_YES || question == BENCH_MONO_YES;
    bool whole = question == BENCH_ISO_YES || question == BENCH_ISO_NO;
    pair->kind = whole ? GRRL_MATCH_ISOMORPHISM : GRRL_MATCH_MONOMORPHISM;
    for (;;) {
        struct grrl_graph graph;
        struct grrl_graph part;
        bench_graph(random, shape, n, &graph);
        take_part(&graph, whole ? n : (uint8_t)(n - n / 4), &part);
        shuffled(random, &graph, &pair->target);
        if (!pair->matches)
            exchange(random, &part);
        shuffled(random, &part, &pair->pattern);
        uint8_t map[GRRL_MAX_LINKS];
        bool same = whole ? is_isomorphic(&pair->pattern, &pair->target)
                          : grrl_match_find(pair->kind, &pair->pattern, &pair->target,
                                            GRRL_ALL_PROPERTIES, 10000000, map) == GRRL_OK;
        if (same == pair->matches)
            return;
    }
}

/* Legs of three links around a hub, all joints revolute but one of the first leg. */
static void make_legs(uint8_t legs, uint8_t prismatic, struct grrl_graph *graph)
{
    grrl_graph_clear(graph);
    must(grrl_graph_add_link(graph, 1, NULL));
    for (uint8_t i = 0; i < 3 * legs; i++) {
        must(grrl_graph_add_link(graph, 1, NULL));
        must(grrl_graph_add_joint(graph, (uint8_t)(i + 1), i % 3 == 0 ? 0 : i,
                                  i == prismatic ? GRRL_PRISMATIC : GRRL_REVOLUTE));
    }
}

void bench_near_miss(uint8_t legs, struct bench_pair *pair)
{
    pair->kind = GRRL_MATCH_ISOMORPHISM;
    pair->matches = false;
    make_legs(legs, 1, &pair->pattern);
    make_legs(legs, 2, &pair->target);
}

void bench_near_part(uint8_t legs, struct bench_pair *pair)
{
    pair->kind = GRRL_MATCH_MONOMORPHISM;
    pair->matches = false;
    make_legs((uint8_t)(legs - 1), 1, &pair->pattern);
    make_legs(legs, 2, &pair->target);
}
