/* The VF2 search with an explicit stack of masks, and orbits computed with it. */
#include "grrl/structure/match.h"

#include <assert.h>
#include <string.h>

#include "structure/match_private.h"

/* A depth that no search reaches: there is no further mapping. */
enum { FINISHED = GRRL_MAX_LINKS };

static bool same_counts(const struct grrl_match_plan *a, const struct grrl_match_plan *b)
{
    return a->graph->n == b->graph->n && a->joints[GRRL_REVOLUTE] == b->joints[GRRL_REVOLUTE] &&
           a->joints[GRRL_PRISMATIC] == b->joints[GRRL_PRISMATIC];
}

enum grrl_match_kind grrl_match_kind_for(enum grrl_match_kind kind,
                                         const struct grrl_match_plan *pattern,
                                         const struct grrl_match_plan *target)
{
    return same_counts(pattern, target) ? GRRL_MATCH_ISOMORPHISM : kind;
}

/*
 * The candidate targets at this depth: allowed, unused, and joined to the images of all mapped
 * neighbours by joints of the right types.
 */
static inline uint32_t open_depth(const struct grrl_match *match,
                                  const struct grrl_match_plan *order, size_t depth,
                                  uint32_t unused)
{
    const struct grrl_match_step *step = &order->step[depth];
    const struct grrl_graph *target = match->target->graph;
    uint32_t candidates = match->allowed[step->vertex] & unused;
    if (step->parent != GRRL_UNMAPPED)
        candidates &= target->joined[step->type][match->image[step->parent]];
    if (step->ties == 0)
        return candidates;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        uint32_t earlier = match->pattern->graph->joined[type][step->vertex];
        for (earlier &= order->earlier[depth]; earlier != 0; earlier &= earlier - 1u)
            candidates &= target->joined[type][match->image[grrl_first_bit(earlier)]];
    }
    return candidates;
}

/*
 * Checks one more pair, beyond what the candidates guarantee. The labels must be equal. For
 * isomorphism the colours must be equal too; for monomorphism no count of the target may be
 * smaller. An isomorphism needs no check for joints that only the target has: both have the same
 * number of joints.
 */
static inline bool is_feasible(const struct grrl_match_plan *pattern, uint8_t vertex,
                               const struct grrl_match_plan *target, uint8_t image, bool exact)
{
    uint32_t left = (target->growing[image] | GRRL_MATCH_GUARDS) - pattern->growing[vertex];
    bool fits = exact ? pattern->colour[vertex] == target->colour[image]
                      : (left & GRRL_MATCH_GUARDS) == GRRL_MATCH_GUARDS;
    return fits && pattern->label[vertex] == target->label[image];
}

/* Continues the search to the next mapping. Local copies keep the loop's state in registers. */
static inline enum grrl_status search(struct grrl_match *match, bool exact)
{
    const struct grrl_match_plan *pattern = match->pattern;
    const struct grrl_match_plan *target = match->target;
    const struct grrl_match_plan *order = match->order;
    const size_t last = pattern->graph->n - 1u;
    size_t depth = match->depth;
    uint32_t unused = match->unused;
    int64_t left = match->budget;
    uint32_t candidates = match->candidates[depth];
    uint8_t vertex = order->step[depth].vertex;
    enum grrl_status status;
    for (;;) {
        if (candidates == 0) {
            if (depth == 0) {
                depth = FINISHED;
                status = GRRL_ERR_NONE;
                break;
            }
            depth--;
            vertex = order->step[depth].vertex;
            unused |= grrl_bit(match->image[vertex]);
            candidates = match->candidates[depth];
            continue;
        }
        if (--left < 0) {
            left = 0;
            match->candidates[depth] = candidates;
            status = GRRL_ERR_UNDECIDED;
            break;
        }
        uint8_t image = grrl_first_bit(candidates);
        uint32_t taken = candidates & (0u - candidates);
        candidates ^= taken;
        if (!is_feasible(pattern, vertex, target, image, exact))
            continue;
        match->image[vertex] = image;
        match->candidates[depth] = candidates;
        if (depth == last) { /* the next call continues with the other candidates here */
            status = GRRL_OK;
            break;
        }
        unused ^= taken;
        depth++;
        vertex = order->step[depth].vertex;
        candidates = open_depth(match, order, depth, unused);
    }
    match->depth = (uint8_t)depth;
    match->unused = unused;
    match->budget = (uint32_t)left;
    return status;
}

static void start(struct grrl_match *match)
{
    match->depth = 0;
    match->unused = UINT32_MAX;
    if (match->pattern->graph->n > 0)
        match->candidates[0] = open_depth(match, match->order, 0, UINT32_MAX);
    memset(match->image, GRRL_UNMAPPED,
           sizeof match->image); /* entries beyond the pattern stay unmapped */
}

void grrl_match_begin(struct grrl_match *match, enum grrl_match_kind kind,
                      const struct grrl_graph *pattern, const struct grrl_graph *target,
                      grrl_label mask, uint32_t budget)
{
    struct grrl_match_plan *own = match->own;
    match->pattern = &own[0];
    match->target = &own[1];
    match->order = &own[0];
    match->budget = budget;
    match->depth = FINISHED;
    own[0].graph = pattern;
    own[1].graph = target;
    if (pattern->n > target->n || (kind == GRRL_MATCH_ISOMORPHISM && pattern->n < target->n))
        return;
    grrl_match_plan_partly(&own[0], pattern, mask);
    grrl_match_plan_partly(&own[1], target, mask);
    match->kind = grrl_match_kind_for(kind, &own[0], &own[1]);
    if (match->kind == GRRL_MATCH_ISOMORPHISM) {
        if (!same_counts(&own[0], &own[1]))
            return;
        grrl_match_colour(&own[0]);
        grrl_match_colour(&own[1]);
        if (own[0].hash != own[1].hash)
            return;
    } else if (own[0].joints[GRRL_REVOLUTE] > own[1].joints[GRRL_REVOLUTE] ||
               own[0].joints[GRRL_PRISMATIC] > own[1].joints[GRRL_PRISMATIC]) {
        return;
    }
    if (pattern->n > 0)
        grrl_match_order_partly(&own[0], match->kind, &own[1]);
    for (uint8_t v = 0; v < pattern->n; v++)
        match->allowed[v] = grrl_bits_below(target->n);
    start(match);
}

void grrl_match_start_planned(struct grrl_match *match, enum grrl_match_kind kind,
                              const struct grrl_match_plan *pattern,
                              const struct grrl_match_plan *target, uint32_t budget)
{
    const uint8_t n = pattern->graph->n;
    match->pattern = pattern;
    match->target = target;
    match->order = pattern;
    match->kind = kind;
    match->budget = budget;
    if (kind == GRRL_MATCH_ISOMORPHISM) {
        for (uint8_t v = 0; v < n; v++)
            match->allowed[v] = target->cell[pattern->rank[v]];
    } else if (n > 0) {
        for (uint8_t v = 0; v < GRRL_MAX_LINKS; v++)
            match->allowed[v] = grrl_bits_below(target->graph->n);
        /* no image restricts the first vertex, so its joints do */
        const uint8_t first = pattern->step[0].vertex;
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            match->allowed[first] &=
                target->at_least[type][grrl_match_degree(pattern, first, type)];
    }
    start(match);
}

void grrl_match_begin_planned(struct grrl_match *match, enum grrl_match_kind kind,
                              const struct grrl_match_plan *pattern,
                              const struct grrl_match_plan *target, uint32_t budget)
{
    kind = grrl_match_kind_for(kind, pattern, target);
    match->pattern = pattern;
    match->target = target;
    match->depth = FINISHED;
    if (grrl_match_planned_may_fit(kind, pattern, target))
        grrl_match_start_planned(match, kind, pattern, target, budget);
}

void grrl_match_fix(struct grrl_match *match, uint8_t pattern_vertex, uint8_t target_vertex)
{
    assert(pattern_vertex < match->pattern->graph->n && target_vertex < match->target->graph->n);
    if (match->depth == FINISHED)
        return;
    match->allowed[pattern_vertex] &= grrl_bit(target_vertex);
    match->own[0].graph = match->pattern->graph;
    grrl_match_order_from(&match->own[0], pattern_vertex);
    match->order = &match->own[0];
    start(match);
}

enum grrl_status grrl_match_next(struct grrl_match *match, uint8_t *map)
{
    uint8_t n = match->pattern->graph->n;
    if (match->depth == FINISHED)
        return GRRL_ERR_NONE;
    if (n == 0) {
        match->depth = FINISHED; /* the empty mapping is reported once */
    } else {
        enum grrl_status status =
            match->kind == GRRL_MATCH_ISOMORPHISM ? search(match, true) : search(match, false);
        if (status != GRRL_OK)
            return status;
    }
    memcpy(map, match->image, sizeof match->image);
    return GRRL_OK;
}

/* Merges the orbits of i and map[i] for every i; the smallest vertex names the orbit. */
static void merge_orbits(uint8_t *orbit, const uint8_t *map, uint8_t n)
{
    for (uint8_t i = 0; i < n; i++) {
        uint8_t a = orbit[i];
        uint8_t b = orbit[map[i]];
        uint8_t kept = a < b ? a : b;
        for (uint8_t k = 0; a != b && k < n; k++)
            if (orbit[k] == a || orbit[k] == b)
                orbit[k] = kept;
    }
}

enum grrl_status grrl_match_orbits(const struct grrl_graph *graph, grrl_label mask, uint32_t budget,
                                   uint8_t *orbit)
{
    enum grrl_status result = GRRL_OK;
    struct grrl_match_plan plan;
    grrl_match_plan_of(&plan, graph, mask);
    for (uint8_t i = 0; i < graph->n; i++)
        orbit[i] = i;
    for (uint8_t i = 1; i < graph->n; i++) {
        uint32_t alike = plan.cell[plan.rank[i]] & (grrl_bit(i) - 1u);
        for (; alike != 0 && orbit[i] == i; alike &= alike - 1u) {
            uint8_t j = grrl_first_bit(alike);
            if (orbit[j] != j)
                continue; /* only the smallest vertex represents its orbit */
            struct grrl_match match;
            uint8_t map[GRRL_MAX_LINKS];
            grrl_match_begin_planned(&match, GRRL_MATCH_ISOMORPHISM, &plan, &plan, budget);
            grrl_match_fix(&match, j, i);
            enum grrl_status status = grrl_match_next(&match, map);
            if (status == GRRL_OK)
                merge_orbits(orbit, map, graph->n);
            else if (status == GRRL_ERR_UNDECIDED)
                result = status;
        }
    }
    return result;
}
