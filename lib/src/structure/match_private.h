/*
 * match_private.h (private): what the parts of matching share.
 */
#ifndef GRRL_MATCH_PRIVATE_H
#define GRRL_MATCH_PRIVATE_H

#include "base/bits.h"
#include "grrl/structure/match.h"

/* The free bit above each count of grrl_match_plan.growing. */
#define GRRL_MATCH_GUARDS UINT32_C(0x80808080)

/* As grrl_graph_neighbours, without a call in the innermost loops. */
static inline uint32_t grrl_match_neighbours(const struct grrl_graph *graph, uint8_t vertex)
{
    return graph->joined[GRRL_REVOLUTE][vertex] | graph->joined[GRRL_PRISMATIC][vertex];
}

/*
 * One mapping as in grrl_match_find, by a search that needs nothing made beforehand.
 * GRRL_ERR_UNDECIDED: the budget is used up.
 */
enum grrl_status grrl_match_quick(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                                  const struct grrl_graph *target, grrl_label mask, uint32_t budget,
                                  uint8_t *map);

/* The part of a plan that pays for one enumeration: labels, joints, and degrees as the only growing
 * counts; then colours of both for isomorphism. No order, cells or signature. */
void grrl_match_glance(struct grrl_match_plan *plan, const struct grrl_graph *graph,
                       grrl_label mask);
void grrl_match_colour(struct grrl_match_plan *plan);

/* The steps of a pattern from a start outwards. first: the vertex to begin with. */
void grrl_match_order_from(struct grrl_match_plan *plan, uint8_t first);

/* The same from a vertex that few targets look like; plans as of grrl_match_glance. */
void grrl_match_order_glanced(struct grrl_match_plan *pattern, enum grrl_match_kind kind,
                              const struct grrl_match_plan *target);

/* Between graphs with the same numbers of links and joints either kind is an isomorphism. */
enum grrl_match_kind grrl_match_kind_for(enum grrl_match_kind kind,
                                         const struct grrl_match_plan *pattern,
                                         const struct grrl_match_plan *target);

/* What must hold before any search; false is certain. */
bool grrl_match_planned_may_fit(enum grrl_match_kind kind, const struct grrl_match_plan *pattern,
                                const struct grrl_match_plan *target);

#endif
