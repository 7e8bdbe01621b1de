/*
 * match.h: VF2 graph matching without recursion or heap, bounded by a node budget.
 *
 * Cordella, Foggia, Sansone, Vento, "An improved algorithm for matching large graphs" (2001),
 * reference 5 of the paper. A partial mapping grows pair by pair under feasibility rules:
 * consistency with the mapped neighbours, and look-ahead over the rest. Here the candidates for a
 * pair come from one row of a joint type's adjacency masks. The look-ahead is one number per
 * vertex, computed beforehand: for isomorphism its colour under colour refinement, for monomorphism
 * counts that can only grow in a larger structure.
 *
 * For one answer call grrl_match_find, or grrl_match_find_planned for graphs that are matched
 * often; grrl_match_plan_of makes a graph's plan once. For all mappings call grrl_match_begin (or
 * grrl_match_begin_planned), grrl_match_fix if needed, then grrl_match_next until it no longer
 * returns GRRL_OK.
 */
#ifndef GRRL_MATCH_H
#define GRRL_MATCH_H

#include <stddef.h>

#include "grrl/base/api.h"
#include "grrl/structure/graph.h"
#include "grrl/structure/signature.h"

GRRL_API_BEGIN

enum grrl_match_kind {
    GRRL_MATCH_ISOMORPHISM, /* one to one and onto, preserving edges and non-edges */
    GRRL_MATCH_MONOMORPHISM /* one to one, preserving every edge of the pattern */
};

/* In a mapping: no vertex. */
enum { GRRL_UNMAPPED = 0xff };

/* Search steps (candidate pairs tried) before the search gives up as undecided. */
#ifndef GRRL_MATCH_BUDGET
#define GRRL_MATCH_BUDGET 20000
#endif

/* Numbers of joints told apart: 0, 1, 2, and 3 or more of each type. */
enum { GRRL_MATCH_DEGREES = 4 * 4 };

/* One pattern vertex, in search order. */
struct grrl_match_step {
    /* private */
    uint8_t vertex;
    uint8_t parent;   /* an earlier neighbour; GRRL_UNMAPPED at the start of a component */
    uint8_t type;     /* of the joint to it */
    uint8_t degrees;  /* joints of both types, see match_private.h */
    uint8_t group[2]; /* per kind: of the vertices with the same targets, see grrl_match.allowed */
    uint32_t ties;    /* further earlier neighbours: the vertex closes loops */
};

/* What matching precomputes for a graph under a mask; serves as pattern or target. */
struct grrl_match_plan {
    /* private */
    const struct grrl_graph *graph;
    uint8_t joints[GRRL_JOINT_TYPES];
    uint8_t n_labels;                      /* different labels */
    uint8_t rank[GRRL_MAX_LINKS];          /* rank of a vertex's colour among all colours */
    uint8_t label_group[GRRL_MAX_LINKS];   /* rank of a vertex's label among all labels */
    uint8_t label_example[GRRL_MAX_LINKS]; /* per label, by rank: a vertex with it */
    uint32_t hash;                         /* of the colours: equal for isomorphic graphs */
    struct grrl_signature monotone;
    grrl_label label[GRRL_MAX_LINKS];  /* under the mask */
    uint32_t labelled[GRRL_MAX_LINKS]; /* per label, by rank: the vertices with it */
    uint32_t colour[GRRL_MAX_LINKS];   /* per vertex: hash of its label and surroundings */
    uint32_t growing[GRRL_MAX_LINKS]; /* per vertex: four counts, never smaller in a larger graph */
    uint32_t cell[GRRL_MAX_LINKS];    /* per rank: the vertices of that colour */
    uint32_t
        at_least[GRRL_MATCH_DEGREES]; /* the vertices with at least so many joints of each type */
    struct grrl_match_step step[GRRL_MAX_LINKS];
};

/* Traits of a vertex, see match_begin.c. */
enum { GRRL_MATCH_TRAITS = 2 * GRRL_JOINT_TYPES };

/* What a search without plans needs of one graph under a mask. */
struct grrl_match_side {
    /* private */
    const struct grrl_graph *graph;
    const grrl_label *label;           /* under the mask */
    uint32_t alike;                    /* vertices with the reference label */
    uint32_t trait[GRRL_MATCH_TRAITS]; /* vertices with each trait */
    grrl_label masked[GRRL_MAX_LINKS];
};

/* What a search that chooses its steps on the way knows of them. */
struct grrl_match_growth {
    /* private */
    size_t deepest;    /* depth of the last one chosen */
    uint32_t recent;   /* neighbours of its vertex */
    uint32_t frontier; /* neighbours of all others */
    uint32_t placed;   /* mapped vertices */
};

struct grrl_match {
    /* private */
    const struct grrl_graph *pattern;
    const struct grrl_graph *target;
    const struct grrl_match_plan *plan[2]; /* of both, or NULL */
    const grrl_label *label[2];            /* of both, without plans */
    const uint32_t *allowed;               /* per group of pattern vertices: permitted targets */
    const struct grrl_match_step *step;    /* per depth */
    enum grrl_match_kind kind;
    uint32_t budget; /* search steps left */
    uint8_t depth;   /* vertices mapped; GRRL_MAX_LINKS: no further mapping */
    uint32_t unused; /* targets not in use */
    struct grrl_match_growth growth;
    uint32_t candidates[GRRL_MAX_LINKS]; /* per depth: targets not yet tried */
    uint8_t image[GRRL_MAX_LINKS];       /* per pattern vertex */
    /* made for this search */
    uint32_t own_allowed[GRRL_MAX_LINKS];
    struct grrl_match_step own_step[GRRL_MAX_LINKS];
    struct grrl_match_side own_side[2];
};

/*
 * Makes the plan of a graph. The graph must outlive the plan and must not change; mask selects the
 * properties that count. Cost: a few hundred nanoseconds, linear in links and joints except for a
 * sort of the links.
 */
void grrl_match_plan_of(struct grrl_match_plan *plan, const struct grrl_graph *graph,
                        grrl_label mask);

/*
 * Finds one mapping of pattern into target, or shows that there is none. map[i] (GRRL_MAX_LINKS of
 * them) is the target vertex of pattern vertex i. mask selects the properties that count. GRRL_OK;
 * GRRL_ERR_NONE.
 *
 * If a search of a few hundred steps does not answer, an exact method follows where one exists:
 * canonical forms (canonical.h) for isomorphism, grrl_match_tree for a tree in a forest. Both take
 * microseconds. Otherwise the result is GRRL_ERR_UNDECIDED beyond `budget` search steps.
 */
GRRL_MUST_USE enum grrl_status grrl_match_find(enum grrl_match_kind kind,
                                               const struct grrl_graph *pattern,
                                               const struct grrl_graph *target, grrl_label mask,
                                               uint32_t budget, uint8_t *map);

/* Like grrl_match_find, with plans made under the same mask. */
GRRL_MUST_USE enum grrl_status grrl_match_find_planned(enum grrl_match_kind kind,
                                                       const struct grrl_match_plan *pattern,
                                                       const struct grrl_match_plan *target,
                                                       uint32_t budget, uint8_t *map);

/*
 * Prepares a search for mappings of pattern into target. Both graphs must outlive the search. mask
 * selects the properties that count. budget: search steps over all calls of grrl_match_next. A
 * match must not be copied.
 */
void grrl_match_begin(struct grrl_match *match, enum grrl_match_kind kind,
                      const struct grrl_graph *pattern, const struct grrl_graph *target,
                      grrl_label mask, uint32_t budget);

/*
 * The same for a graph that is matched with many others: grrl_match_side_of prepares its side once.
 * Both sides must be made under the same mask and reference, any label under that mask; one that
 * some vertices have and others have not rules out most. False: there is no mapping.
 */
void grrl_match_side_of(struct grrl_match_side *side, const struct grrl_graph *graph,
                        grrl_label mask, grrl_label reference);
bool grrl_match_begin_sides(struct grrl_match *match, enum grrl_match_kind kind,
                            const struct grrl_match_side *pattern,
                            const struct grrl_match_side *target, uint32_t budget);

/* Like grrl_match_begin, with plans made under the same mask, which must outlive the search. */
void grrl_match_begin_planned(struct grrl_match *match, enum grrl_match_kind kind,
                              const struct grrl_match_plan *pattern,
                              const struct grrl_match_plan *target, uint32_t budget);

/* Restricts the search to mappings of this pattern vertex to this target vertex. May be called
 * repeatedly between begin and the first next. */
void grrl_match_fix(struct grrl_match *match, uint8_t pattern_vertex, uint8_t target_vertex);

/*
 * Finds the next mapping, as in grrl_match_find. GRRL_OK; GRRL_ERR_NONE: no further mapping;
 * GRRL_ERR_UNDECIDED: the budget is used up.
 */
GRRL_MUST_USE enum grrl_status grrl_match_next(struct grrl_match *match, uint8_t *map);

/*
 * Finds every target vertex onto which some mapping (monomorphism) of a tree into a forest sends
 * pattern_vertex, as a bit mask in *images. map, if not NULL, receives one of the mappings, if
 * there is any. Both plans must be made under the same mask. GRRL_ERR_UNDECIDED: the pattern is not
 * a tree, or the target not a forest. The method needs no search: it works on rooted subtrees from
 * the leaves inwards and assigns children to neighbours by bipartite matching (Matula, "Subtree
 * isomorphism in O(n^5/2)", 1978). Cost: O(n^3) at worst, and 4 n bytes of stack per link.
 */
GRRL_MUST_USE enum grrl_status grrl_match_tree(const struct grrl_match_plan *pattern,
                                               const struct grrl_match_plan *target,
                                               uint8_t pattern_vertex, uint32_t *images,
                                               uint8_t *map);

/*
 * Computes the orbits of the automorphism group: orbit[i] is the smallest vertex onto which some
 * automorphism maps i. budget: search steps for each pair of vertices. GRRL_ERR_UNDECIDED: some
 * pair stayed undecided within it and is treated as not symmetric.
 */
GRRL_MUST_USE enum grrl_status grrl_match_orbits(const struct grrl_graph *graph, grrl_label mask,
                                                 uint32_t budget, uint8_t *orbit);

GRRL_API_END

#endif
