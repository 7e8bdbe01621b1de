/*
 * canonical.h: one representative for all graphs of a structure, and its hash.
 *
 * Colour refinement with individualisation (McKay & Piperno, "Practical graph isomorphism, II",
 * 2014), one connected component at a time. Refinement alone resolves every tree that hangs on
 * resolved vertices, so the search branches only on vertices of loops. The usual kinematic
 * structures cost a few refinements.
 */
#ifndef GRRL_CANONICAL_H
#define GRRL_CANONICAL_H

#include "grrl/base/api.h"
#include "grrl/structure/graph.h"

GRRL_API_BEGIN

struct grrl_canonical {
    struct grrl_graph graph;       /* labels reduced to the mask */
    uint8_t order[GRRL_MAX_LINKS]; /* canonical vertex i is vertex order[i] of the input */
    uint32_t hash;                 /* of graph */
};

/*
 * Two graphs get the same `graph` (and hash) if and only if they are isomorphic under the mask.
 * GRRL_ERR_UNDECIDED beyond `budget` refinements (GRRL_CANONICAL_BUDGET is ample for mechanisms).
 */
GRRL_MUST_USE enum grrl_status grrl_canonical_of(const struct grrl_graph *graph, grrl_label mask,
                                                 uint32_t budget, struct grrl_canonical *canonical);

#ifndef GRRL_CANONICAL_BUDGET
#define GRRL_CANONICAL_BUDGET 2000
#endif

GRRL_API_END

#endif
