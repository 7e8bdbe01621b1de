/*
 * match_private.h (private): what the parts of matching share.
 */
#ifndef GRRL_MATCH_PRIVATE_H
#define GRRL_MATCH_PRIVATE_H

#include "base/bits.h"
#include "grrl/structure/match.h"

/* The free bit above each count of grrl_match_plan.growing. */
#define GRRL_MATCH_GUARDS UINT32_C(0x80808080)

/* Like grrl_graph_neighbours, but inline for the innermost loops. */
static inline uint32_t grrl_match_neighbours(const struct grrl_graph *graph, uint8_t vertex)
{
    return graph->joined[GRRL_REVOLUTE][vertex] | graph->joined[GRRL_PRISMATIC][vertex];
}

/* A vertex's joints of a type, at most GRRL_MATCH_DEGREES - 1. */
static inline unsigned grrl_match_degree(const struct grrl_match_plan *plan, uint8_t vertex,
                                         int type)
{
    unsigned degree = plan->growing[vertex] >> 8 * type & 0xffu;
    return degree < GRRL_MATCH_DEGREES ? degree : GRRL_MATCH_DEGREES - 1;
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
enum grrl_match_kind grrl_match_kind_for(enum grrl_match_kind kind,
                                         const struct grrl_match_plan *pattern,
                                         const struct grrl_match_plan *target);

/* Like grrl_match_begin_planned, for a kind by grrl_match_kind_for and plans that may fit. */
void grrl_match_start_planned(struct grrl_match *match, enum grrl_match_kind kind,
                              const struct grrl_match_plan *pattern,
                              const struct grrl_match_plan *target, uint32_t budget);

/* A necessary condition, checked before any search; false is certain. */
bool grrl_match_planned_may_fit(enum grrl_match_kind kind, const struct grrl_match_plan *pattern,
                                const struct grrl_match_plan *target);

#endif
