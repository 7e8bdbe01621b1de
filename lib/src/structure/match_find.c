/* Finds one mapping by the cheapest method: search, canonical forms or trees. */
#include <string.h>

#include "grrl/structure/canonical.h"
#include "structure/match_private.h"

/* Search steps before an exact method takes over or, without plans, before plans are made. A search
 * without dead ends takes one step per link. */
enum { QUICK_STEPS = 8 * GRRL_MAX_LINKS };

/* Finds an isomorphism by canonical forms. */
static enum grrl_status find_canonical(const struct grrl_match_plan *pattern,
                                       const struct grrl_match_plan *target, uint8_t *map)
{
    struct grrl_canonical form[2];
    for (int i = 0; i < 2; i++) {
        const struct grrl_match_plan *plan = i == 0 ? pattern : target;
        struct grrl_graph graph = *plan->graph;
        memcpy(graph.label, plan->label, sizeof graph.label[0] * graph.n); /* under the mask */
        enum grrl_status status =
            grrl_canonical_of(&graph, GRRL_ALL_PROPERTIES, GRRL_CANONICAL_BUDGET, &form[i]);
        if (status != GRRL_OK)
            return status;
    }
    if (!grrl_graph_equal(&form[0].graph, &form[1].graph, GRRL_ALL_PROPERTIES))
        return GRRL_ERR_NONE;
    memset(map, GRRL_UNMAPPED, GRRL_MAX_LINKS);
    for (uint8_t i = 0; i < form[0].graph.n; i++)
        map[form[0].order[i]] = form[1].order[i];
    return GRRL_OK;
}

enum grrl_status grrl_match_find_planned(enum grrl_match_kind kind,
                                         const struct grrl_match_plan *pattern,
                                         const struct grrl_match_plan *target, uint32_t budget,
                                         uint8_t *map)
{
    kind = grrl_match_kind_for(kind, pattern, target);
    if (!grrl_match_planned_may_fit(kind, pattern, target))
        return GRRL_ERR_NONE;
    uint32_t quick = budget < QUICK_STEPS ? budget : QUICK_STEPS;
    struct grrl_match match;
    grrl_match_start_planned(&match, kind, pattern, target, quick);
    enum grrl_status status = grrl_match_next(&match, map);
    if (status != GRRL_ERR_UNDECIDED)
        return status;
    uint32_t images;
    if (kind == GRRL_MATCH_ISOMORPHISM)
        status = find_canonical(pattern, target, map);
    else if (grrl_match_tree(pattern, target, pattern->step[0].vertex, &images, map) == GRRL_OK)
        status = images != 0 ? GRRL_OK : GRRL_ERR_NONE;
    if (status != GRRL_ERR_UNDECIDED)
        return status;
    match.budget = budget - quick;
    return grrl_match_next(&match, map);
}

enum grrl_status grrl_match_find(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                                 const struct grrl_graph *target, grrl_label mask, uint32_t budget,
                                 uint8_t *map)
{
    uint32_t first = budget < QUICK_STEPS ? budget : QUICK_STEPS;
    struct grrl_match match;
    grrl_match_begin(&match, kind, pattern, target, mask, first);
    enum grrl_status status = grrl_match_next(&match, map);
    if (status != GRRL_ERR_UNDECIDED)
        return status;
    struct grrl_match_plan plan[2];
    grrl_match_plan_of(&plan[0], pattern, mask);
    grrl_match_plan_of(&plan[1], target, mask);
    return grrl_match_find_planned(kind, &plan[0], &plan[1], budget - first, map);
}
