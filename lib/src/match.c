#include "grrl/match.h"

#include <assert.h>
#include <string.h>

#include "bits.h"

enum { FINISHED = -1 };

/* As grrl_graph_neighbours, without a call in the innermost loops. */
static inline uint32_t neighbours_of(const struct grrl_graph *graph, uint8_t vertex)
{
    return graph->joined[GRRL_REVOLUTE][vertex] | graph->joined[GRRL_PRISMATIC][vertex];
}

static inline unsigned degree(const struct grrl_graph *graph, int type, uint8_t vertex)
{
    return grrl_bit_count(graph->joined[type][vertex]);
}

/* No mapping can exist: there are too few targets, or another number where it must be the same. */
static bool counts_differ(const struct grrl_match *match)
{
    uint8_t n = match->pattern->n;
    if (match->kind == GRRL_MATCH_ISOMORPHISM)
        return n != match->target->n;
    return n > match->target->n;
}

/*
 * Which targets have the degrees of a pattern vertex: of each type as many joints for isomorphism,
 * at least as many for monomorphism. by_degree[t][d] is first made the set of targets of degree d
 * (isomorphism) or of degree d and more (monomorphism).
 */
static void restrict_degrees(struct grrl_match *match)
{
    uint32_t by_degree[GRRL_JOINT_TYPES][GRRL_MAX_LINKS];
    memset(by_degree, 0, sizeof by_degree);
    bool exact = match->kind == GRRL_MATCH_ISOMORPHISM;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        for (uint8_t v = 0; v < match->target->n; v++) {
            unsigned d = degree(match->target, type, v);
            by_degree[type][d] |= grrl_bit(v);
            while (!exact && d > 0)
                by_degree[type][--d] |= grrl_bit(v);
        }
        for (uint8_t v = 0; v < match->pattern->n; v++)
            match->compatible[v] &= by_degree[type][degree(match->pattern, type, v)];
    }
}

/* Which targets have the label of a pattern vertex; there are few different labels, so that each
 * is compared with the targets once. */
static void restrict_labels(struct grrl_match *match, grrl_label mask)
{
    grrl_label known[GRRL_MAX_LINKS];
    uint32_t owners[GRRL_MAX_LINKS];
    uint8_t n_known = 0;
    for (uint8_t v = 0; v < match->pattern->n; v++) {
        grrl_label label = grrl_label_masked(match->pattern->label[v], mask);
        uint8_t k = 0;
        while (k < n_known && known[k] != label)
            k++;
        if (k == n_known) {
            known[k] = label;
            owners[k] = 0;
            for (uint8_t t = 0; t < match->target->n; t++)
                if (grrl_label_masked(match->target->label[t], mask) == label)
                    owners[k] |= grrl_bit(t);
            n_known++;
        }
        match->compatible[v] = owners[k];
    }
}

/*
 * Orders the pattern: each vertex a neighbour of earlier ones where there is one, of several of
 * them if possible, then the fewest compatible targets, then the most joints.
 */
static void order_pattern(struct grrl_match *match)
{
    const struct grrl_graph *pattern = match->pattern;
    uint32_t rank[GRRL_MAX_LINKS]; /* smaller comes first; the vertex is in the lowest byte, so that
                                      the smallest is found without a branch */
    for (uint8_t v = 0; v < pattern->n; v++)
        rank[v] = grrl_bit_count(match->compatible[v]) << 16 |
                  (32u - grrl_bit_count(neighbours_of(pattern, v))) << 8 | v;
    uint32_t placed = 0;
    uint32_t frontier = 0; /* neighbours of placed vertices, */
    uint32_t tied = 0;     /* and of them those of two or more */
    for (uint8_t depth = 0; depth < pattern->n; depth++) {
        uint32_t choices = tied != 0 ? tied : frontier;
        if (choices == 0)
            choices = grrl_bits_below(pattern->n) & ~placed;
        uint32_t smallest = UINT32_MAX;
        for (; choices != 0; choices &= choices - 1u) {
            uint32_t other = rank[grrl_first_bit(choices)];
            smallest = other < smallest ? other : smallest;
        }
        uint8_t best = (uint8_t)(smallest & 0xffu);
        uint32_t neighbours = neighbours_of(pattern, best);
        match->order[depth] = best;
        match->earlier[depth] = placed;
        uint32_t again = neighbours & frontier; /* none on a tree */
        match->terminal[depth] = again == 0 ? 0 : (uint8_t)grrl_bit_count(again);
        placed |= grrl_bit(best);
        tied = (tied | again) & ~placed;
        frontier = (frontier | neighbours) & ~placed;
    }
}

/* The targets worth trying at this depth: compatible, unused, joined to the images of all mapped
 * neighbours by joints of the right types. */
static void open_depth(struct grrl_match *match, int depth)
{
    uint8_t vertex = match->order[depth];
    uint32_t candidates = match->compatible[vertex] & ~match->used;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        uint32_t neighbours = match->pattern->joined[type][vertex] & match->earlier[depth];
        uint32_t images = 0;
        for (; neighbours != 0; neighbours &= neighbours - 1u) {
            uint8_t image = match->image[grrl_first_bit(neighbours)];
            images |= grrl_bit(image);
            candidates &= match->target->joined[type][image];
        }
        match->wanted[type][depth] = images;
    }
    match->candidates[depth] = candidates;
}

void grrl_match_begin(struct grrl_match *match, enum grrl_match_kind kind,
                      const struct grrl_graph *pattern, const struct grrl_graph *target,
                      grrl_label mask, uint32_t budget)
{
    match->pattern = pattern;
    match->target = target;
    match->kind = kind;
    match->budget = budget;
    match->depth = FINISHED;
    match->used = 0;
    if (counts_differ(match))
        return;
    restrict_labels(match, mask);
    restrict_degrees(match);
    for (uint8_t v = 0; v < pattern->n; v++)
        if (match->compatible[v] == 0)
            return;
    match->depth = 0;
    if (pattern->n == 0)
        return;
    order_pattern(match);
    match->reached[0] = 0;
    open_depth(match, 0);
}

void grrl_match_fix(struct grrl_match *match, uint8_t pattern_vertex, uint8_t target_vertex)
{
    assert(pattern_vertex < match->pattern->n && target_vertex < match->target->n);
    if (match->depth == FINISHED)
        return;
    match->compatible[pattern_vertex] &= grrl_bit(target_vertex);
    if (match->compatible[pattern_vertex] == 0) {
        match->depth = FINISHED;
        return;
    }
    order_pattern(match);
    open_depth(match, 0);
}

/*
 * The rules of VF2 for one more pair, beyond what the candidates guarantee. Isomorphism: the target
 * has no joints to images that the pattern lacks. Monomorphism: enough joints remain for those the
 * pattern still has. Both: as many (at least as many) unmapped neighbours that touch mapped ones.
 */
static bool is_feasible(const struct grrl_match *match, int depth, uint8_t target)
{
    uint8_t vertex = match->order[depth];
    bool exact = match->kind == GRRL_MATCH_ISOMORPHISM;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        uint32_t joined = match->target->joined[type][target];
        if (exact) {
            if ((joined & match->used) != match->wanted[type][depth])
                return false;
            continue;
        }
        uint32_t remaining = match->pattern->joined[type][vertex] & ~match->earlier[depth];
        if (remaining != 0 && grrl_bit_count(joined & ~match->used) < grrl_bit_count(remaining))
            return false;
    }
    uint32_t terminal = neighbours_of(match->target, target) & match->reached[depth];
    unsigned needed = match->terminal[depth];
    if (exact)
        return grrl_bit_count(terminal & ~match->used) == needed;
    return needed == 0 || grrl_bit_count(terminal & ~match->used) >= needed;
}

static enum grrl_status give_mapping(const struct grrl_match *match, uint8_t *map)
{
    memset(map, GRRL_UNMAPPED, GRRL_MAX_LINKS);
    memcpy(map, match->image, match->pattern->n);
    return GRRL_OK;
}

enum grrl_status grrl_match_next(struct grrl_match *match, uint8_t *map)
{
    int depth = match->depth;
    int last = match->pattern->n - 1;
    if (depth == FINISHED)
        return GRRL_ERR_NONE;
    if (last < 0) {
        match->depth = FINISHED; /* the empty mapping, once */
        return give_mapping(match, map);
    }
    for (;;) {
        if (match->candidates[depth] == 0) {
            if (depth == 0) {
                match->depth = FINISHED;
                return GRRL_ERR_NONE;
            }
            depth--;
            match->used &= ~grrl_bit(match->image[match->order[depth]]);
            continue;
        }
        if (match->budget == 0) {
            match->depth = depth;
            return GRRL_ERR_UNDECIDED;
        }
        match->budget--;
        uint8_t target = grrl_first_bit(match->candidates[depth]);
        match->candidates[depth] &= match->candidates[depth] - 1u;
        if (!is_feasible(match, depth, target))
            continue;
        match->image[match->order[depth]] = target;
        if (depth == last) {
            match->depth = depth; /* the next call goes on with the other candidates here */
            return give_mapping(match, map);
        }
        match->used |= grrl_bit(target);
        match->reached[depth + 1] = match->reached[depth] | neighbours_of(match->target, target);
        depth++;
        open_depth(match, depth);
    }
}

/* Joins the orbits of i and map[i] for every i, keeping the smallest vertex as the name. */
static void merge_orbits(uint8_t *orbit, const uint8_t *map, uint8_t n)
{
    for (uint8_t i = 0; i < n; i++) {
        uint8_t a = orbit[i];
        uint8_t b = orbit[map[i]];
        uint8_t kept = a < b ? a : b;
        for (uint8_t k = 0; k < n; k++)
            if (orbit[k] == a || orbit[k] == b)
                orbit[k] = kept;
    }
}

enum grrl_status grrl_match_orbits(const struct grrl_graph *graph, grrl_label mask, uint32_t budget,
                                   uint8_t *orbit)
{
    enum grrl_status result = GRRL_OK;
    struct grrl_match all;
    grrl_match_begin(&all, GRRL_MATCH_ISOMORPHISM, graph, graph, mask, budget);
    for (uint8_t i = 0; i < graph->n; i++)
        orbit[i] = i;
    for (uint8_t i = 1; i < graph->n; i++) {
        for (uint8_t j = 0; j < i && orbit[i] == i; j++) {
            if (orbit[j] != j)
                continue; /* the smallest of its orbit stands for it */
            struct grrl_match match = all;
            grrl_match_fix(&match, j, i);
            uint8_t map[GRRL_MAX_LINKS];
            enum grrl_status status = grrl_match_next(&match, map);
            if (status == GRRL_OK)
                merge_orbits(orbit, map, graph->n);
            else if (status == GRRL_ERR_UNDECIDED)
                result = status;
        }
    }
    return result;
}
