/*
 * A single search, without plans: what it needs to know of two graphs is made in some tens of
 * nanoseconds, and keeps it from nearly every wrong turn.
 *
 * Bit v of a set is whether something holds of vertex v: that it is labelled like the reference
 * (the pattern's first vertex), or that it has a joint of some type to vertices that are or are not
 * labelled so. The sets of both graphs give the domain of each vertex of the pattern, the targets
 * that look like it, for four vertices at a time where the machine has instructions for that.
 */
#include <string.h>

#include "structure/match_private.h"

/*
 * What a vertex has, each by the type of joint: one to a vertex labelled like the reference, one to
 * another vertex, and two or more joints.
 */
enum { LOOKS = 3 * GRRL_JOINT_TYPES };

struct side {
    const struct grrl_graph *graph;
    const grrl_label *label; /* under the mask */
    uint32_t alike;          /* vertices labelled like the reference, */
    uint32_t look[LOOKS];    /* and with such joints */
    grrl_label masked[GRRL_MAX_LINKS];
};

struct quick {
    struct side pattern;
    struct side target;
    uint32_t domain[GRRL_MAX_LINKS];     /* per pattern vertex: targets that look like it */
    uint32_t candidates[GRRL_MAX_LINKS]; /* per depth: targets not yet tried */
    uint8_t vertex[GRRL_MAX_LINKS];      /* per depth, as deep as the search has been */
    uint8_t *image;                      /* per pattern vertex */
};

static void take_graph(struct side *side, const struct grrl_graph *graph, grrl_label mask)
{
    side->graph = graph;
    side->label = graph->label;
    if (mask == GRRL_ALL_PROPERTIES)
        return;
    for (unsigned i = 0; i < graph->n; i++)
        side->masked[i] = grrl_label_masked(graph->label[i], mask);
    side->label = side->masked;
}

static void look_around(struct side *side, grrl_label reference)
{
    const struct grrl_graph *graph = side->graph;
    uint64_t to_alike = 0; /* revolute in the lower half, prismatic in the upper */
    uint64_t to_others = 0;
    uint64_t more = 0;
    uint32_t alike = 0;
    for (unsigned i = 0; i < graph->n; i++) {
        uint64_t joined =
            graph->joined[GRRL_REVOLUTE][i] | (uint64_t)graph->joined[GRRL_PRISMATIC][i] << 32;
        uint64_t is_alike = side->label[i] == reference;
        uint64_t others = is_alike - 1u;
        alike |= (uint32_t)is_alike << i;
        more |= (to_alike | to_others) & joined;
        to_others |= joined & others;
        to_alike |= joined & ~others;
    }
    const uint64_t look[LOOKS / GRRL_JOINT_TYPES] = {to_alike, to_others, more};
    for (size_t k = 0; k < LOOKS / GRRL_JOINT_TYPES; k++) {
        side->look[2 * k] = (uint32_t)look[k];
        side->look[2 * k + 1] = (uint32_t)(look[k] >> 32);
    }
    side->alike = alike;
}

static uint32_t count_ends(const struct grrl_graph *graph, int type)
{
    uint32_t ends = 0;
    for (unsigned i = 0; i < graph->n; i++)
        ends += grrl_bit_count(graph->joined[type][i]);
    return ends;
}

/* Whether as many vertices have each look, and there are as many joints of each type. */
static bool looks_the_same(const struct side *a, const struct side *b)
{
    uint32_t differing = grrl_bit_count(a->alike) ^ grrl_bit_count(b->alike);
    for (int k = 0; k < LOOKS; k++) {
        differing |= grrl_bit_count(a->look[k] & a->alike) ^ grrl_bit_count(b->look[k] & b->alike);
        differing |=
            grrl_bit_count(a->look[k] & ~a->alike) ^ grrl_bit_count(b->look[k] & ~b->alike);
    }
    if (differing != 0)
        return false;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++)
        if (count_ends(a->graph, type) != count_ends(b->graph, type))
            return false;
    return true;
}

/* The domains, and the vertex with the fewest targets; false: some vertex has none. */
static inline bool find_domains(struct quick *quick, bool exact, uint8_t *first)
{
    /* a table: few machines shift the lanes of a vector by different amounts */
    static const uint32_t bit[32] = {
        1u << 0,  1u << 1,  1u << 2,  1u << 3,  1u << 4,  1u << 5,  1u << 6,  1u << 7,
        1u << 8,  1u << 9,  1u << 10, 1u << 11, 1u << 12, 1u << 13, 1u << 14, 1u << 15,
        1u << 16, 1u << 17, 1u << 18, 1u << 19, 1u << 20, 1u << 21, 1u << 22, 1u << 23,
        1u << 24, 1u << 25, 1u << 26, 1u << 27, 1u << 28, 1u << 29, 1u << 30, 1u << 31};
    const struct side *pattern = &quick->pattern;
    const struct side *target = &quick->target;
    const unsigned n = pattern->graph->n;
    const uint32_t all = grrl_bits_below(target->graph->n);
    int32_t fewest = INT32_MAX; /* with the vertex in the lowest byte */
    for (unsigned v = 0; v < n; v++) {
        uint32_t has_not = (pattern->alike & bit[v]) == 0 ? UINT32_MAX : 0;
        uint32_t domain = all & (target->alike ^ has_not);
        for (int k = 0; k < LOOKS; k++) {
            has_not = (pattern->look[k] & bit[v]) == 0 ? UINT32_MAX : 0;
            domain &= exact ? target->look[k] ^ has_not : target->look[k] | has_not;
        }
        quick->domain[v] = domain;
        int32_t score = (int32_t)(grrl_bit_count(domain) << 8 | v);
        fewest = score < fewest ? score : fewest;
    }
    *first = (uint8_t)(fewest & 0xff);
    return fewest > 0xff;
}

/* Targets for a vertex that are free and joined to the images of its placed neighbours. */
static inline uint32_t find_candidates(const struct quick *quick, uint8_t vertex, uint32_t placed,
                                       uint32_t used)
{
    const struct grrl_graph *pattern = quick->pattern.graph;
    const struct grrl_graph *target = quick->target.graph;
    uint32_t candidates = quick->domain[vertex] & ~used;
    uint32_t prismatic = pattern->joined[GRRL_PRISMATIC][vertex];
    uint32_t back = (pattern->joined[GRRL_REVOLUTE][vertex] | prismatic) & placed;
    for (; back != 0; back &= back - 1u) {
        uint8_t earlier = grrl_first_bit(back);
        candidates &= target->joined[prismatic >> earlier & 1u][quick->image[earlier]];
    }
    return candidates;
}

/* The order of the vertices is made on the way: neighbours of placed ones, those of the latest
 * last, since its image is the last to be known. */
static enum grrl_status search(struct quick *quick, uint8_t first, uint32_t budget)
{
    const struct grrl_graph *pattern = quick->pattern.graph;
    const grrl_label *label = quick->pattern.label;
    const grrl_label *target_label = quick->target.label;
    const uint32_t all = grrl_bits_below(pattern->n);
    uint8_t *image_of = quick->image;
    unsigned depth = 0;
    unsigned deepest = 0;
    uint32_t placed = 0;
    uint32_t used = 0;
    uint32_t frontier = 0;
    uint8_t vertex = quick->vertex[0] = first;
    uint32_t candidates = quick->domain[first];
    for (;;) {
        if (candidates == 0) {
            if (depth == 0)
                return GRRL_ERR_NONE;
            vertex = quick->vertex[--depth];
            placed &= ~grrl_bit(vertex);
            used &= ~grrl_bit(image_of[vertex]);
            candidates = quick->candidates[depth];
            continue;
        }
        if (budget == 0)
            return GRRL_ERR_UNDECIDED;
        budget--;
        uint8_t image = grrl_first_bit(candidates);
        candidates &= candidates - 1u;
        if (label[vertex] != target_label[image])
            continue;
        image_of[vertex] = image;
        quick->candidates[depth] = candidates;
        placed |= grrl_bit(vertex);
        used |= grrl_bit(image);
        if (placed == all)
            return GRRL_OK;
        if (++depth > deepest) {
            uint32_t older = frontier & ~placed;
            frontier = older | (grrl_match_neighbours(pattern, vertex) & ~placed);
            uint32_t choices = older != 0 ? older : frontier;
            quick->vertex[depth] = grrl_first_bit(choices != 0 ? choices : all & ~placed);
            deepest = depth;
        }
        vertex = quick->vertex[depth];
        candidates = find_candidates(quick, vertex, placed, used);
    }
}

enum grrl_status grrl_match_quick(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                                  const struct grrl_graph *target, grrl_label mask, uint32_t budget,
                                  uint8_t *map)
{
    const bool exact = kind == GRRL_MATCH_ISOMORPHISM;
    struct quick quick;
    uint8_t first;
    if (exact ? pattern->n != target->n : pattern->n > target->n)
        return GRRL_ERR_NONE;
    memset(map, GRRL_UNMAPPED, GRRL_MAX_LINKS);
    if (pattern->n == 0)
        return GRRL_OK;
    quick.image = map;
    take_graph(&quick.pattern, pattern, mask);
    take_graph(&quick.target, target, mask);
    look_around(&quick.pattern, quick.pattern.label[0]);
    look_around(&quick.target, quick.pattern.label[0]);
    if (exact && !looks_the_same(&quick.pattern, &quick.target))
        return GRRL_ERR_NONE;
    if (!(exact ? find_domains(&quick, true, &first) : find_domains(&quick, false, &first)))
        return GRRL_ERR_NONE;
    return search(&quick, first, budget);
}
