/*
 * match.h: VF2 graph matching without recursion or heap, bounded by a node budget.
 *
 * Cordella, Foggia, Sansone, Vento, "An improved algorithm for matching large graphs" (2001), the
 * paper's reference 5: a partial mapping grows pair by pair under feasibility rules (consistency
 * with the mapped neighbours, look-ahead on the rest). Here the candidates of a pair are one row of
 * a joint type's adjacency masks, and the look-ahead is a number of each vertex made beforehand:
 * its colour under colour refinement for isomorphism, counts that can only grow in a larger
 * structure for monomorphism.
 *
 * One answer: grrl_match_find, or grrl_match_find_planned for graphs that are matched often: each
 * has a plan made once by grrl_match_plan_of. All mappings: grrl_match_begin (or
 * grrl_match_begin_planned), grrl_match_fix if wanted, then grrl_match_next until it no longer
 * returns GRRL_OK.
 */
#ifndef GRRL_MATCH_H
#define GRRL_MATCH_H

#include "grrl/base/api.h"
#include "grrl/structure/graph.h"
#include "grrl/structure/signature.h"

GRRL_API_BEGIN

enum grrl_match_kind {
    GRRL_MATCH_ISOMORPHISM, /* one to one and onto, edges and non-edges kept */
    GRRL_MATCH_MONOMORPHISM /* the pattern's links into the target's, every edge of the pattern kept
                             */
};

/* No vertex, in a mapping. */
enum { GRRL_UNMAPPED = 0xff };

/* Search steps (candidate pairs tried) before a search gives up as undecided. */
#ifndef GRRL_MATCH_BUDGET
#define GRRL_MATCH_BUDGET 20000
#endif

/* One vertex of a pattern in the order of the search. */
struct grrl_match_step {
    /* private */
    uint8_t vertex;
    uint8_t parent; /* an earlier neighbour, GRRL_UNMAPPED at the start of a component */
    uint8_t type;   /* of the joint to it */
    uint8_t ties;   /* further earlier neighbours: the vertex closes loops */
};

/* What matching needs of a graph under a mask, whether it is the pattern or the target. */
struct grrl_match_plan {
    /* private */
    const struct grrl_graph *graph;
    uint8_t joints[GRRL_JOINT_TYPES];
    uint8_t rank[GRRL_MAX_LINKS]; /* of a vertex's colour among the colours */
    uint32_t hash;                /* of the colours: equal for isomorphic graphs */
    struct grrl_signature monotone;
    grrl_label label[GRRL_MAX_LINKS]; /* under the mask */
    uint32_t colour[GRRL_MAX_LINKS];  /* per vertex: label and surroundings */
    uint32_t growing[GRRL_MAX_LINKS]; /* per vertex: four counts, none smaller in a larger graph */
    uint32_t cell[GRRL_MAX_LINKS];    /* per rank: the vertices of that colour */
    uint32_t earlier[GRRL_MAX_LINKS]; /* per step: the vertices of the steps before */
    struct grrl_match_step step[GRRL_MAX_LINKS];
};

struct grrl_match {
    /* private */
    const struct grrl_match_plan *pattern;
    const struct grrl_match_plan *target;
    const struct grrl_match_plan *order; /* whose steps are taken */
    enum grrl_match_kind kind;
    uint32_t budget;                     /* steps left */
    int depth;                           /* vertices mapped; negative: no further mapping */
    uint32_t used;                       /* their images */
    uint32_t allowed[GRRL_MAX_LINKS];    /* per pattern vertex: targets */
    uint32_t candidates[GRRL_MAX_LINKS]; /* per depth: targets not yet tried */
    uint8_t image[GRRL_MAX_LINKS];       /* per pattern vertex */
    struct grrl_match_plan own[2];       /* of graphs that came without */
};

/*
 * Makes the plan of a graph, which must outlive it and stay as it is; mask says which properties
 * count. Cost: a few hundred nanoseconds, linear in links and joints but for a sort of the links.
 */
void grrl_match_plan_of(struct grrl_match_plan *plan, const struct grrl_graph *graph,
                        grrl_label mask);

/*
 * One mapping of pattern into target, or that there is none: map[i] (GRRL_MAX_LINKS of them) is the
 * target vertex of pattern vertex i. mask says which properties count. GRRL_OK; GRRL_ERR_NONE.
 *
 * Where another method answers for certain, a search of a few hundred steps is followed by it:
 * canonical forms (canonical.h) for isomorphism, grrl_match_tree for a tree in a forest; both take
 * microseconds. Anything else is GRRL_ERR_UNDECIDED beyond `budget` search steps.
 */
GRRL_MUST_USE enum grrl_status grrl_match_find(enum grrl_match_kind kind,
                                               const struct grrl_graph *pattern,
                                               const struct grrl_graph *target, grrl_label mask,
                                               uint32_t budget, uint8_t *map);

/* The same with plans made under the same mask. */
GRRL_MUST_USE enum grrl_status grrl_match_find_planned(enum grrl_match_kind kind,
                                                       const struct grrl_match_plan *pattern,
                                                       const struct grrl_match_plan *target,
                                                       uint32_t budget, uint8_t *map);

/*
 * Prepares a search for mappings of pattern into target. Both graphs must outlive the search. mask
 * says which properties count. budget: search steps over all calls of grrl_match_next. A match may
 * not be copied.
 */
void grrl_match_begin(struct grrl_match *match, enum grrl_match_kind kind,
                      const struct grrl_graph *pattern, const struct grrl_graph *target,
                      grrl_label mask, uint32_t budget);

/* The same with plans made under the same mask, which must outlive the search. */
void grrl_match_begin_planned(struct grrl_match *match, enum grrl_match_kind kind,
                              const struct grrl_match_plan *pattern,
                              const struct grrl_match_plan *target, uint32_t budget);

/* Only mappings that send this vertex of the pattern to that one of the target; between begin and
 * the first next, as often as wanted. */
void grrl_match_fix(struct grrl_match *match, uint8_t pattern_vertex, uint8_t target_vertex);

/*
 * The next mapping, as in grrl_match_find.
 * GRRL_OK; GRRL_ERR_NONE: no further mapping; GRRL_ERR_UNDECIDED: the budget is used up.
 */
GRRL_MUST_USE enum grrl_status grrl_match_next(struct grrl_match *match, uint8_t *map);

/*
 * All targets that some mapping (monomorphism) of a tree into a forest sends one vertex of it to,
 * as a bit mask; map, if not NULL, is one of the mappings, if there is any. Plans made under the
 * same mask. GRRL_ERR_UNDECIDED: the pattern is no tree, or the target no forest. Without a search:
 * rooted subtrees from the leaves inwards, children to neighbours by bipartite matching (Matula,
 * "Subtree isomorphism in O(n^5/2)", 1978; here O(n^3) at worst, with 4 n bytes for each link of
 * stack).
 */
GRRL_MUST_USE enum grrl_status grrl_match_tree(const struct grrl_match_plan *pattern,
                                               const struct grrl_match_plan *target,
                                               uint8_t pattern_vertex, uint32_t *images,
                                               uint8_t *map);

/*
 * Orbits of the automorphism group: orbit[i] is the smallest vertex that some automorphism maps i
 * onto. budget: search steps for each pair of vertices. GRRL_ERR_UNDECIDED: some pair could not be
 * decided within it and was taken as not symmetric.
 */
GRRL_MUST_USE enum grrl_status grrl_match_orbits(const struct grrl_graph *graph, grrl_label mask,
                                                 uint32_t budget, uint8_t *orbit);

GRRL_API_END

#endif
