/* Measures the time to build one graph: for the library from a term, for a peer from its usual
 * input. */
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"

enum { MAX_NODES = 8 * GRRL_MAX_LINKS, SWEEPS = 21 };

struct described {
    struct grrl_graph graph;
    struct grrl_term_store store;
    struct grrl_term_node nodes[MAX_NODES];
    grrl_term term;
};

static void describe(struct described *described)
{
    struct grrl_name names[GRRL_MAX_LINKS];
    for (uint16_t i = 0; i < GRRL_MAX_LINKS; i++)
        names[i] = (struct grrl_name){GRRL_NAME_LINK, (uint16_t)(i + 1)};
    grrl_term_store_init(&described->store, described->nodes, MAX_NODES);
    if (grrl_graph_to_term(&described->store, &described->graph, names, NULL, 0, false,
                           &described->term) != GRRL_OK)
        abort();
}

static double read_terms(const struct described *described, unsigned n)
{
    double start = bench_now_ns();
    for (unsigned i = 0; i < n; i++) {
        struct grrl_graph graph;
        struct grrl_name names[GRRL_MAX_LINKS];
        if (grrl_graph_from_term(&described[i].store, described[i].term, &graph, names, NULL, NULL,
                                 NULL) != GRRL_OK ||
            graph.n != described[i].graph.n)
            abort();
    }
    return (bench_now_ns() - start) / n;
}

static double build(const struct bench_peer *peer, const struct described *described, unsigned n)
{
    double start = bench_now_ns();
    for (unsigned i = 0; i < n; i++)
        peer->destroy(peer->build(&described[i].graph));
    return (bench_now_ns() - start) / n;
}

double bench_build(const struct bench_peer *peer, uint8_t links)
{
    enum { N_GRAPHS = 64 };
    static struct described described[N_GRAPHS];
    struct grrl_random random;
    double spent[SWEEPS];
    grrl_random_init(&random, 20080625u, links);
    for (int i = 0; i < N_GRAPHS; i++) {
        bench_graph(&random, (enum bench_shape)(i % BENCH_SHAPES), links, &described[i].graph);
        describe(&described[i]);
    }
    for (int s = 0; s < SWEEPS; s++)
        spent[s] =
            peer == NULL ? read_terms(described, N_GRAPHS) : build(peer, described, N_GRAPHS);
    bench_sort(spent, SWEEPS);
    return bench_quantile(spent, SWEEPS, 0.5);
}
