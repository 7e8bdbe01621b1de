/*
 * match_private.h (private): what the parts of matching share.
 */
#ifndef GRRL_MATCH_PRIVATE_H
#define GRRL_MATCH_PRIVATE_H

#include <string.h>

#include "base/bits.h"
#include "grrl/structure/match.h"

/* The free bit above each count of grrl_match_plan.growing. */
#define GRRL_MATCH_GUARDS UINT32_C(0x80808080)

/* Like grrl_graph_neighbours, but inline for the innermost loops. */
static inline uint32_t grrl_match_neighbours(const struct grrl_graph *graph, uint8_t vertex)
{
    return graph->joined[GRRL_REVOLUTE][vertex] | graph->joined[GRRL_PRISMATIC][vertex];
}

/* A vertex's joints as a number: 4 for each revolute one, 1 for each prismatic one, at most 3 of
 * each type. */
static inline uint8_t grrl_match_degrees(const struct grrl_match_plan *plan, uint8_t vertex)
{
    unsigned revolute = plan->growing[vertex] & 0xffu;
    unsigned prismatic = plan->growing[vertex] >> 8 & 0xffu;
    return (uint8_t)((revolute < 3 ? revolute : 3) * 4 + (prismatic < 3 ? prismatic : 3));
}

/* Target vertices that could be the image of a pattern vertex, judged by their traits. */
static inline uint32_t grrl_match_images(const struct grrl_match_side *pattern, uint8_t vertex,
                                         const struct grrl_match_side *target, bool exact)
{
    uint32_t images = grrl_bits_below(target->graph->n) &
                      (target->alike ^ ((pattern->alike >> vertex & 1u) - 1u));
    for (int k = 0; k < GRRL_MATCH_TRAITS; k++) {
        uint32_t lacks = (pattern->trait[k] >> vertex & 1u) - 1u;
        images &= exact ? target->trait[k] ^ lacks : target->trait[k] | lacks;
    }
    return images;
}

/* Pattern vertices whose image could be a target vertex. */
static inline uint32_t grrl_match_preimages(const struct grrl_match_side *pattern,
                                            const struct grrl_match_side *target, uint8_t vertex,
                                            bool exact)
{
    uint32_t preimages = grrl_bits_below(pattern->graph->n) &
                         (pattern->alike ^ ((target->alike >> vertex & 1u) - 1u));
    for (int k = 0; k < GRRL_MATCH_TRAITS; k++) {
        uint32_t has = 0u - (target->trait[k] >> vertex & 1u);
        preimages &= exact ? ~(pattern->trait[k] ^ has) : ~pattern->trait[k] | has;
    }
    return preimages;
}

/* Whether the search has ended, see match.c. */
enum { GRRL_MATCH_FINISHED = GRRL_MAX_LINKS };

/* Prepares the first step of a search; allowed and step are set. */
void grrl_match_start(struct grrl_match *match, uint32_t candidates);

/* The same for a search that chooses its steps on the way, the first of them at this vertex. */
void grrl_match_start_at(struct grrl_match *match, uint8_t vertex);

/* Orders the steps of a graph outwards from the vertex `first`. */
void grrl_match_order_from(struct grrl_match_step *step, const struct grrl_graph *graph,
                           uint8_t first);

/* Between graphs with equal numbers of links and joints, either kind is an isomorphism. */
static inline enum grrl_match_kind grrl_match_kind_for(enum grrl_match_kind kind,
                                                       const struct grrl_match_plan *pattern,
                                                       const struct grrl_match_plan *target)
{
    bool same = pattern->graph->n == target->graph->n &&
                memcmp(pattern->joints, target->joints, sizeof target->joints) == 0;
    return same ? GRRL_MATCH_ISOMORPHISM : kind;
}

/* A necessary condition, checked before any search; false is certain. */
static inline bool grrl_match_planned_may_fit(enum grrl_match_kind kind,
                                              const struct grrl_match_plan *pattern,
                                              const struct grrl_match_plan *target)
{
    if (kind == GRRL_MATCH_ISOMORPHISM)
        return pattern->hash == target->hash && pattern->graph->n == target->graph->n &&
               memcmp(pattern->joints, target->joints, sizeof target->joints) == 0;
    return pattern->graph->n <= target->graph->n &&
           grrl_signature_within(&pattern->monotone, &target->monotone, false);
}

/* Like grrl_match_begin_planned, for a kind by grrl_match_kind_for and plans that may fit. */
void grrl_match_start_planned(struct grrl_match *match, enum grrl_match_kind kind,
                              const struct grrl_match_plan *pattern,
                              const struct grrl_match_plan *target, uint32_t budget);

#endif
