/*
 * igraph: its VF2 on coloured edges; LAD (Solnon, 2010) and bliss, which know only coloured
 * vertices, on graphs where every joint is a vertex too. Counts of links and joints are compared
 * first. bliss canonises both graphs in every query; LAD gets the vertices of the right colour as
 * domains, from lists made with the target.
 */
#include <igraph.h>
#include <stdlib.h>

#include "bench.h"

/* Colours of the vertices that stand for joints; labels are not negative. */
#define JOINT_COLOUR(type) (-1 - (igraph_integer_t)(type))

struct coloured {
    igraph_t graph;
    igraph_vector_int_t vertices;
    igraph_vector_int_t edges;
    unsigned joints[GRRL_JOINT_TYPES];
    uint8_t n_links;
    /* for LAD: the vertices of each colour, in order of first appearance */
    igraph_vector_int_t colours;
    igraph_vector_int_list_t members;
};

/* Adds the edge between two links, or a vertex and two edges. */
static void add_joint(struct coloured *built, igraph_vector_int_t *ends, igraph_integer_t a,
                      igraph_integer_t b, int type, bool as_vertex)
{
    built->joints[type]++;
    if (as_vertex) {
        igraph_integer_t joint = igraph_vector_int_size(&built->vertices);
        igraph_vector_int_push_back(&built->vertices, JOINT_COLOUR(type));
        igraph_vector_int_push_back(ends, a);
        igraph_vector_int_push_back(ends, joint);
        igraph_vector_int_push_back(ends, joint);
        igraph_vector_int_push_back(ends, b);
    } else {
        igraph_vector_int_push_back(ends, a);
        igraph_vector_int_push_back(ends, b);
        igraph_vector_int_push_back(&built->edges, type);
    }
}

static struct coloured *build(const struct grrl_graph *graph, bool joints_as_vertices)
{
    struct coloured *built = calloc(1, sizeof *built);
    if (built == NULL)
        abort();
    igraph_vector_int_t ends;
    igraph_vector_int_init(&ends, 0);
    igraph_vector_int_init(&built->vertices, 0);
    igraph_vector_int_init(&built->edges, 0);
    igraph_vector_int_init(&built->colours, 0);
    igraph_vector_int_list_init(&built->members, 0);
    built->n_links = graph->n;
    for (uint8_t i = 0; i < graph->n; i++)
        igraph_vector_int_push_back(&built->vertices, (igraph_integer_t)graph->label[i]);
    for (uint8_t i = 0; i < graph->n; i++)
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            for (uint8_t j = 0; j < i; j++)
                if ((graph->joined[type][i] >> j & 1u) != 0)
                    add_joint(built, &ends, i, j, type, joints_as_vertices);
    igraph_create(&built->graph, &ends, igraph_vector_int_size(&built->vertices),
                  IGRAPH_UNDIRECTED);
    igraph_vector_int_destroy(&ends);
    return built;
}

static void *build_links(const struct grrl_graph *graph)
{
    return build(graph, false);
}

static void *build_all(const struct grrl_graph *graph)
{
    return build(graph, true);
}

/* Also lists the vertices of each colour. */
static void *build_lists(const struct grrl_graph *graph)
{
    struct coloured *built = build(graph, true);
    igraph_integer_t n = igraph_vector_int_size(&built->vertices);
    for (igraph_integer_t v = 0; v < n; v++) {
        igraph_integer_t at;
        igraph_integer_t colour = VECTOR(built->vertices)[v];
        if (!igraph_vector_int_search(&built->colours, 0, colour, &at)) {
            at = igraph_vector_int_size(&built->colours);
            igraph_vector_int_push_back(&built->colours, colour);
            igraph_vector_int_list_push_back_new(&built->members, NULL);
        }
        igraph_vector_int_push_back(igraph_vector_int_list_get_ptr(&built->members, at), v);
    }
    return built;
}

static void destroy(void *graph)
{
    struct coloured *built = graph;
    igraph_destroy(&built->graph);
    igraph_vector_int_destroy(&built->vertices);
    igraph_vector_int_destroy(&built->edges);
    igraph_vector_int_destroy(&built->colours);
    igraph_vector_int_list_destroy(&built->members);
    free(built);
}

static bool counts_fit(enum grrl_match_kind kind, const struct coloured *a,
                       const struct coloured *b)
{
    bool exact = kind == GRRL_MATCH_ISOMORPHISM;
    bool fit = exact ? a->n_links == b->n_links : a->n_links <= b->n_links;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++)
        fit = fit &&
              (exact ? a->joints[type] == b->joints[type] : a->joints[type] <= b->joints[type]);
    return fit;
}

static int match_vf2(enum grrl_match_kind kind, const void *pattern, const void *target)
{
    const struct coloured *a = pattern;
    const struct coloured *b = target;
    igraph_bool_t found = 0;
    if (!counts_fit(kind, a, b))
        return 0;
    if (kind == GRRL_MATCH_ISOMORPHISM)
        igraph_isomorphic_vf2(&a->graph, &b->graph, &a->vertices, &b->vertices, &a->edges,
                              &b->edges, &found, NULL, NULL, NULL, NULL, NULL);
    else
        igraph_subisomorphic_vf2(&b->graph, &a->graph, &b->vertices, &a->vertices, &b->edges,
                                 &a->edges, &found, NULL, NULL, NULL, NULL, NULL);
    return found;
}

/* With equal counts, a mapping that keeps every joint is an isomorphism. */
static int match_lad(enum grrl_match_kind kind, const void *pattern, const void *target)
{
    const struct coloured *a = pattern;
    const struct coloured *b = target;
    igraph_bool_t found = 0;
    if (!counts_fit(kind, a, b))
        return 0;
    igraph_vector_int_list_t domains;
    igraph_vector_int_list_init(&domains, 0);
    igraph_integer_t n = igraph_vector_int_size(&a->vertices);
    bool all = true;
    for (igraph_integer_t v = 0; v < n && all; v++) {
        igraph_integer_t at;
        all = igraph_vector_int_search(&b->colours, 0, VECTOR(a->vertices)[v], &at);
        if (all)
            igraph_vector_int_list_push_back_copy(&domains,
                                                  igraph_vector_int_list_get_ptr(&b->members, at));
    }
    if (all)
        igraph_subisomorphic_lad(&a->graph, &b->graph, &domains, &found, NULL, NULL, 0, 0);
    igraph_vector_int_list_destroy(&domains);
    return found;
}

static int match_bliss(enum grrl_match_kind kind, const void *pattern, const void *target)
{
    const struct coloured *a = pattern;
    const struct coloured *b = target;
    igraph_bool_t found = 0;
    if (kind != GRRL_MATCH_ISOMORPHISM)
        return -1;
    if (counts_fit(kind, a, b))
        igraph_isomorphic_bliss(&a->graph, &b->graph, &a->vertices, &b->vertices, &found, NULL,
                                NULL, IGRAPH_BLISS_FL, NULL, NULL);
    return found;
}

const struct bench_peer bench_igraph = {"igraph", build_links, destroy, match_vf2};
const struct bench_peer bench_lad = {"igraph LAD", build_lists, destroy, match_lad};
const struct bench_peer bench_bliss = {"igraph bliss", build_all, destroy, match_bliss};
