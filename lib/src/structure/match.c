/* The VF2 search with an explicit stack of masks, and orbits computed with it. */
#include "grrl/structure/match.h"

#include <assert.h>
#include <string.h>

#include "structure/match_private.h"

/* How the candidates of a vertex are found, and what is checked beyond them. */
enum check {
    CHECK_COLOURS = GRRL_MATCH_ISOMORPHISM, /* planned: by colour; colours and labels are checked */
    CHECK_NOTHING = GRRL_MATCH_MONOMORPHISM, /* planned: by label and joints */
    CHECK_LABELS                             /* without plans: by traits; labels are checked */
};

/* An isomorphism needs no check for joints that only the target has: both have the same number of
 * joints. */
static inline bool is_feasible(const struct grrl_match *match, uint8_t vertex, uint8_t image,
                               enum check check)
{
    if (check == CHECK_NOTHING)
        return true;
    if (check == CHECK_LABELS)
        return match->label[0][vertex] == match->label[1][image];
    return match->plan[0]->colour[vertex] == match->plan[1]->colour[image] &&
           match->plan[0]->label[vertex] == match->plan[1]->label[image];
}

/* Chooses the vertex of the next step: a neighbour of mapped vertices, those of the last one last,
 * because its image is known last. */
static inline uint8_t choose_vertex(const struct grrl_graph *pattern,
                                    struct grrl_match_growth *growth)
{
    uint32_t choices = growth->frontier & ~growth->placed;
    if (choices == 0)
        choices = growth->recent & ~growth->placed;
    if (choices == 0)
        choices = grrl_bits_below(pattern->n) & ~growth->placed;
    growth->frontier |= growth->recent;
    growth->deepest++;
    return grrl_first_bit(choices);
}

/* The candidate targets of a vertex: allowed, unused, and joined to the images of all mapped
 * neighbours by joints of the right types. */
static inline uint32_t open_vertex(const struct grrl_match *match, uint8_t vertex,
                                   const uint8_t *image, struct grrl_match_growth *growth,
                                   uint32_t unused)
{
    const struct grrl_graph *pattern = match->pattern;
    uint32_t candidates = match->own_allowed[vertex] & unused;
    const uint32_t prismatic = pattern->joined[GRRL_PRISMATIC][vertex];
    growth->recent = pattern->joined[GRRL_REVOLUTE][vertex] | prismatic;
    for (uint32_t back = growth->recent & growth->placed; back != 0; back &= back - 1u) {
        uint8_t earlier = grrl_first_bit(back);
        candidates &= match->target->joined[prismatic >> earlier & 1u][image[earlier]];
    }
    return candidates;
}

/* The same for a planned step. */
static inline uint32_t open_step(const struct grrl_match *match, const struct grrl_match_step *step,
                                 const uint8_t *image, enum check check, uint32_t unused)
{
    const struct grrl_graph *target = match->target;
    uint32_t candidates = match->allowed[step->group[check]] & unused;
    if (check == CHECK_NOTHING)
        candidates &= match->plan[1]->at_least[step->degrees];
    if (step->parent != GRRL_UNMAPPED)
        candidates &= target->joined[step->type][image[step->parent]];
    for (uint32_t ties = step->ties; ties != 0; ties &= ties - 1u) {
        uint8_t earlier = grrl_first_bit(ties);
        unsigned type = match->pattern->joined[GRRL_PRISMATIC][step->vertex] >> earlier & 1u;
        candidates &= target->joined[type][image[earlier]];
    }
    return candidates;
}

/* Continues the search to the next mapping. Local copies keep the loop's state in registers. */
static inline enum grrl_status search(struct grrl_match *match, enum check check)
{
    const struct grrl_match_step *steps = match->step;
    const size_t last = match->pattern->n - 1u;
    uint8_t *restrict image_of = match->image;
    struct grrl_match_growth growth = {0};
    if (check == CHECK_LABELS)
        growth = match->growth;
    size_t depth = match->depth;
    uint32_t unused = match->unused;
    int64_t left = match->budget;
    uint32_t candidates = match->candidates[depth];
    uint8_t vertex = steps[depth].vertex;
    enum grrl_status status = GRRL_OK;
    for (;;) {
        if (candidates == 0) {
            if (depth == 0) {
                depth = GRRL_MATCH_FINISHED;
                status = GRRL_ERR_NONE;
                break;
            }
            depth--;
            vertex = steps[depth].vertex;
            unused |= grrl_bit(image_of[vertex]);
            growth.placed &= ~grrl_bit(vertex);
            candidates = match->candidates[depth];
            continue;
        }
        if (--left < 0) {
            match->candidates[depth] = candidates;
            status = GRRL_ERR_UNDECIDED;
            break;
        }
        uint8_t image = grrl_first_bit(candidates);
        candidates &= candidates - 1u;
        if (!is_feasible(match, vertex, image, check))
            continue;
        image_of[vertex] = image;
        match->candidates[depth] = candidates;
        if (depth == last)
            break; /* the next call continues with the other candidates here */
        unused &= ~grrl_bit(image);
        depth++;
        if (check == CHECK_LABELS) {
            growth.placed |= grrl_bit(vertex);
            if (depth > growth.deepest)
                match->own_step[depth].vertex = choose_vertex(match->pattern, &growth);
            vertex = match->own_step[depth].vertex;
            candidates = open_vertex(match, vertex, image_of, &growth, unused);
        } else {
            vertex = steps[depth].vertex;
            candidates = open_step(match, &steps[depth], image_of, check, unused);
        }
    }
    if (check == CHECK_LABELS)
        match->growth = growth;
    match->depth = (uint8_t)depth;
    match->unused = unused;
    match->budget = left < 0 ? 0 : (uint32_t)left;
    return status;
}

void grrl_match_start(struct grrl_match *match, uint32_t candidates)
{
    match->depth = 0;
    match->unused = UINT32_MAX;
    match->candidates[0] = candidates;
    memset(match->image, GRRL_UNMAPPED,
           sizeof match->image); /* entries beyond the pattern stay unmapped */
}

void grrl_match_start_at(struct grrl_match *match, uint8_t vertex)
{
    match->own_step[0] = (struct grrl_match_step){.vertex = vertex, .parent = GRRL_UNMAPPED};
    match->step = match->own_step;
    match->growth =
        (struct grrl_match_growth){.recent = grrl_match_neighbours(match->pattern, vertex)};
    grrl_match_start(match, match->own_allowed[vertex]);
}

void grrl_match_start_planned(struct grrl_match *match, enum grrl_match_kind kind,
                              const struct grrl_match_plan *pattern,
                              const struct grrl_match_plan *target, uint32_t budget)
{
    match->pattern = pattern->graph;
    match->target = target->graph;
    match->plan[0] = pattern;
    match->plan[1] = target;
    match->step = pattern->step;
    match->kind = kind;
    match->budget = budget;
    const uint8_t first = pattern->step[0].vertex;
    if (pattern->graph->n == 0) {
        grrl_match_start(match, 0);
    } else if (kind == GRRL_MATCH_ISOMORPHISM) {
        match->allowed = target->cell;
        grrl_match_start(match, target->cell[pattern->rank[first]]);
    } else {
        match->allowed = match->own_allowed;
        unsigned at = 0;
        for (unsigned k = 0; k < pattern->n_labels; k++) {
            const grrl_label label = pattern->label[pattern->label_example[k]];
            while (at < target->n_labels && target->label[target->label_example[at]] < label)
                at++;
            bool both = at < target->n_labels && target->label[target->label_example[at]] == label;
            match->own_allowed[k] = both ? target->labelled[at] : 0;
        }
        const struct grrl_match_step *step = &pattern->step[0];
        uint32_t candidates =
            match->own_allowed[step->group[kind]] & target->at_least[step->degrees];
        grrl_match_start(match, candidates);
    }
}

void grrl_match_begin_planned(struct grrl_match *match, enum grrl_match_kind kind,
                              const struct grrl_match_plan *pattern,
                              const struct grrl_match_plan *target, uint32_t budget)
{
    kind = grrl_match_kind_for(kind, pattern, target);
    match->pattern = pattern->graph;
    match->target = target->graph;
    match->depth = GRRL_MATCH_FINISHED;
    if (grrl_match_planned_may_fit(kind, pattern, target))
        grrl_match_start_planned(match, kind, pattern, target, budget);
}

void grrl_match_fix(struct grrl_match *match, uint8_t pattern_vertex, uint8_t target_vertex)
{
    assert(pattern_vertex < match->pattern->n && target_vertex < match->target->n);
    if (match->depth == GRRL_MATCH_FINISHED)
        return;
    if (match->plan[0] == NULL) {
        match->own_allowed[pattern_vertex] &= grrl_bit(target_vertex);
        grrl_match_start_at(match, pattern_vertex);
        return;
    }
    uint32_t allowed[GRRL_MAX_LINKS]; /* per vertex instead of per group */
    const uint8_t n = match->pattern->n;
    for (uint8_t depth = 0; depth < n; depth++) {
        const struct grrl_match_step *step = &match->step[depth];
        allowed[step->vertex] = match->allowed[step->group[match->kind]];
    }
    allowed[pattern_vertex] &= grrl_bit(target_vertex);
    memcpy(match->own_allowed, allowed, n * sizeof allowed[0]);
    grrl_match_order_from(match->own_step, match->pattern, pattern_vertex);
    match->allowed = match->own_allowed;
    match->step = match->own_step;
    grrl_match_start(match, allowed[pattern_vertex]);
}

static enum grrl_status search_on(struct grrl_match *match)
{
    if (match->plan[0] == NULL)
        return search(match, CHECK_LABELS);
    return match->kind == GRRL_MATCH_ISOMORPHISM ? search(match, CHECK_COLOURS)
                                                 : search(match, CHECK_NOTHING);
}

enum grrl_status grrl_match_next(struct grrl_match *match, uint8_t *map)
{
    if (match->depth == GRRL_MATCH_FINISHED)
        return GRRL_ERR_NONE;
    if (match->pattern->n == 0) {
        match->depth = GRRL_MATCH_FINISHED; /* the empty mapping is reported once */
    } else {
        enum grrl_status status = search_on(match);
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
