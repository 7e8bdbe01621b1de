/*
 * match.h: VF2 graph matching without recursion or heap, bounded by a node budget.
 *
 * Cordella, Foggia, Sansone, Vento, "An improved algorithm for matching large graphs" (2001), the
 * paper's reference 5: a partial mapping grows pair by pair under feasibility rules (consistency
 * with the mapped neighbours, look-ahead on the rest), here on bit masks.
 *
 * Order of calls: grrl_match_begin, then grrl_match_next until it no longer returns GRRL_OK.
 */
#ifndef GRRL_MATCH_H
#define GRRL_MATCH_H

#include "grrl/graph.h"

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

struct grrl_match {
    /* private */
    const struct grrl_graph *pattern;
    const struct grrl_graph *target;
    enum grrl_match_kind kind;
    uint32_t budget; /* steps left */
    int depth;       /* vertices mapped; negative: no further mapping */
    uint32_t used;   /* their images */
    uint32_t
        compatible[GRRL_MAX_LINKS];   /* per pattern vertex: targets whose label and degrees fit */
    uint8_t order[GRRL_MAX_LINKS];    /* pattern vertices, most constrained first */
    uint8_t image[GRRL_MAX_LINKS];    /* per pattern vertex */
    uint8_t terminal[GRRL_MAX_LINKS]; /* per depth: later neighbours that touch mapped vertices */
    uint32_t earlier[GRRL_MAX_LINKS]; /* per depth: pattern vertices mapped before it */
    uint32_t candidates[GRRL_MAX_LINKS];               /* per depth: targets not yet tried */
    uint32_t reached[GRRL_MAX_LINKS];                  /* per depth: targets that touch an image */
    uint32_t wanted[GRRL_JOINT_TYPES][GRRL_MAX_LINKS]; /* per depth: images of the neighbours */
};

/*
 * Prepares a search for mappings of pattern into target. Both graphs must outlive the search. mask
 * says which properties count. budget: search steps over all calls of grrl_match_next.
 */
void grrl_match_begin(struct grrl_match *match, enum grrl_match_kind kind,
                      const struct grrl_graph *pattern, const struct grrl_graph *target,
                      grrl_label mask, uint32_t budget);

/* Only mappings that send this vertex of the pattern to that one of the target; between begin and
 * the first next, as often as wanted. */
void grrl_match_fix(struct grrl_match *match, uint8_t pattern_vertex, uint8_t target_vertex);

/*
 * The next mapping: map[i] (GRRL_MAX_LINKS of them) is the target vertex of pattern vertex i.
 * GRRL_OK; GRRL_ERR_NONE: no further mapping; GRRL_ERR_UNDECIDED: the budget is used up.
 */
GRRL_MUST_USE enum grrl_status grrl_match_next(struct grrl_match *match, uint8_t *map);

/*
 * Orbits of the automorphism group: orbit[i] is the smallest vertex that some automorphism maps i
 * onto. budget: search steps for each pair of vertices. GRRL_ERR_UNDECIDED: some pair could not be
 * decided within it and was taken as not symmetric.
 */
GRRL_MUST_USE enum grrl_status grrl_match_orbits(const struct grrl_graph *graph, grrl_label mask,
                                                 uint32_t budget, uint8_t *orbit);

#endif
