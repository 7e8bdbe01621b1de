/* igraph: igraph_isomorphic_vf2 and igraph_subisomorphic_vf2. */
#include <igraph.h>
#include <stdlib.h>

#include "bench.h"

struct coloured {
    igraph_t graph;
    igraph_vector_int_t links;
    igraph_vector_int_t joints;
};

static void *build(const struct grrl_graph *graph)
{
    struct coloured *built = malloc(sizeof *built);
    if (built == NULL)
        abort();
    igraph_vector_int_t ends;
    igraph_vector_int_init(&ends, 0);
    igraph_vector_int_init(&built->links, 0);
    igraph_vector_int_init(&built->joints, 0);
    for (uint8_t i = 0; i < graph->n; i++) {
        igraph_vector_int_push_back(&built->links, (igraph_integer_t)graph->label[i]);
        for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
            for (uint8_t j = 0; j < i; j++) {
                if ((graph->joined[type][i] >> j & 1u) == 0)
                    continue;
                igraph_vector_int_push_back(&ends, i);
                igraph_vector_int_push_back(&ends, j);
                igraph_vector_int_push_back(&built->joints, type);
            }
        }
    }
    igraph_create(&built->graph, &ends, graph->n, IGRAPH_UNDIRECTED);
    igraph_vector_int_destroy(&ends);
    return built;
}

static void destroy(void *graph)
{
    struct coloured *built = graph;
    igraph_destroy(&built->graph);
    igraph_vector_int_destroy(&built->links);
    igraph_vector_int_destroy(&built->joints);
    free(built);
}

static int match(enum grrl_match_kind kind, const void *pattern, const void *target)
{
    const struct coloured *a = pattern;
    const struct coloured *b = target;
    igraph_bool_t found = 0;
    if (kind == GRRL_MATCH_ISOMORPHISM)
        igraph_isomorphic_vf2(&a->graph, &b->graph, &a->links, &b->links, &a->joints, &b->joints,
                              &found, NULL, NULL, NULL, NULL, NULL);
    else
        igraph_subisomorphic_vf2(&b->graph, &a->graph, &b->links, &a->links, &b->joints, &a->joints,
                                 &found, NULL, NULL, NULL, NULL, NULL);
    return found;
}

const struct bench_peer bench_igraph = {"igraph", build, destroy, match};
