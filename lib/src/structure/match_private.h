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

/*
 * Finds one mapping as in grrl_match_find, by a search that needs no plan. GRRL_ERR_UNDECIDED: the
 * budget is used up.
 */
enum grrl_status grrl_match_quick(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                                  const struct grrl_graph *target, grrl_label mask, uint32_t budget,
                                  uint8_t *map);

/* Makes the part of a plan that pays off for a single enumeration: labels, joints, and degrees as
 * the only growing counts. Isomorphism also needs the colours of both. No order, cells or
 * signature. */
void grrl_match_plan_partly(struct grrl_match_plan *plan, const struct grrl_graph *graph,
                            grrl_label mask);
void grrl_match_colour(struct grrl_match_plan *plan);

/* Orders the steps of a pattern outwards from the vertex `first`. */
void grrl_match_order_from(struct grrl_match_plan *plan, uint8_t first);

/* Like grrl_match_order_from, starting at a vertex that few targets resemble; for plans of
 * grrl_match_plan_partly. */
void grrl_match_order_partly(struct grrl_match_plan *pattern, enum grrl_match_kind kind,
                             const struct grrl_match_plan *target);

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
