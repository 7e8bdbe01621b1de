/*
 * A single search without plans. It prepares a few sets per graph in some tens of nanoseconds; they
 * prevent nearly every dead end.
 *
 * Bit v of a set tells whether vertex v has a trait: it has the same label as the reference (the
 * pattern's first vertex), or joints of some type to any vertex or to one with that label. The
 * sets of both graphs give each pattern vertex its domain, the target vertices with compatible
 * traits. Machines with vector instructions handle four vertices at a time.
 */
#include <string.h>

#include "structure/match_private.h"

/*
 * The traits of a vertex, for each type of joint: a joint to a vertex labelled like the reference,
 * any joint, and two or more joints.
 */
enum { TRAITS = 3 * GRRL_JOINT_TYPES };

struct side {
    const struct grrl_graph *graph;
    const grrl_label *label; /* under the mask */
    uint32_t alike;          /* vertices labelled like the reference */
    uint32_t trait[TRAITS];  /* vertices with each trait */
    grrl_label masked[GRRL_MAX_LINKS];
};

struct quick {
    struct side pattern;
    struct side target;
    uint32_t domain[GRRL_MAX_LINKS];     /* per pattern vertex: targets with compatible traits */
    uint32_t candidates[GRRL_MAX_LINKS]; /* per depth: targets not yet tried */
    uint8_t vertex[GRRL_MAX_LINKS];      /* per depth, up to the deepest reached */
    uint8_t *image;                      /* per pattern vertex */
};

static void set_graph(struct side *side, const struct grrl_graph *graph, grrl_label mask)
{
    side->graph = graph;
    side->label = graph->label;
    if (mask == GRRL_ALL_PROPERTIES)
        return;
    for (unsigned i = 0; i < graph->n; i++)
        side->masked[i] = grrl_label_masked(graph->label[i], mask);
    side->label = side->masked;
}

static void find_traits(struct side *side, grrl_label reference)
{
    const struct grrl_graph *graph = side->graph;
    uint64_t to_alike = 0; /* revolute in the lower half, prismatic in the upper */
    uint64_t any = 0;
    uint64_t more = 0;
    uint64_t bit = 1;
    uint64_t alike = 0;
    for (unsigned i = 0; i < graph->n; i++, bit <<= 1) {
        uint64_t joined =
            graph->joined[GRRL_REVOLUTE][i] | (uint64_t)graph->joined[GRRL_PRISMATIC][i] << 32;
        uint64_t is_alike = 0u - (uint64_t)(side->label[i] == reference);
        alike |= bit & is_alike;
        to_alike |= joined & is_alike;
        more |= any & joined;
        any |= joined;
    }
    const uint64_t trait[TRAITS / GRRL_JOINT_TYPES] = {to_alike, any, more};
    for (size_t k = 0; k < TRAITS / GRRL_JOINT_TYPES; k++) {
        side->trait[2 * k] = (uint32_t)trait[k];
        side->trait[2 * k + 1] = (uint32_t)(trait[k] >> 32);
    }
    side->alike = (uint32_t)alike;
}

static uint32_t count_ends(const struct grrl_graph *graph, int type)
{
    uint32_t ends = 0;
    for (unsigned i = 0; i < graph->n; i++)
        ends += grrl_bit_count(graph->joined[type][i]);
    return ends;
}

/* Whether equally many vertices have each trait, and there are as many joints of each type. */
static bool same_trait_counts(const struct side *a, const struct side *b)
{
    uint32_t differing = grrl_bit_count(a->alike) ^ grrl_bit_count(b->alike);
    for (int k = 0; k < TRAITS; k++) {
        differing |=
            grrl_bit_count(a->trait[k] & a->alike) ^ grrl_bit_count(b->trait[k] & b->alike);
        differing |=
            grrl_bit_count(a->trait[k] & ~a->alike) ^ grrl_bit_count(b->trait[k] & ~b->alike);
    }
    if (differing != 0)
        return false;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++)
        if (count_ends(a->graph, type) != count_ends(b->graph, type))
            return false;
    return true;
}

/* Computes the domains and the vertex with the smallest one; false if some domain is empty. */
static inline bool find_domains(struct quick *quick, bool exact, uint8_t *first)
{
    /* a table, because few machines can shift vector lanes by different amounts */
    static const uint32_t bit[32] = {
        1u << 0,  1u << 1,  1u << 2,  1u << 3,  1u << 4,  1u << 5,  1u << 6,  1u << 7,
        1u << 8,  1u << 9,  1u << 10, 1u << 11, 1u << 12, 1u << 13, 1u << 14, 1u << 15,
        1u << 16, 1u << 17, 1u << 18, 1u << 19, 1u << 20, 1u << 21, 1u << 22, 1u << 23,
        1u << 24, 1u << 25, 1u << 26, 1u << 27, 1u << 28, 1u << 29, 1u << 30, 1u << 31};
    const struct side *pattern = &quick->pattern;
    const struct side *target = &quick->target;
    const unsigned n = pattern->graph->n;
    const uint32_t all = grrl_bits_below(target->graph->n);
    int32_t fewest = INT32_MAX; /* with the vertex in its lowest byte */
    for (unsigned v = 0; v < n; v++) {
        uint32_t lacks = (pattern->alike & bit[v]) == 0 ? UINT32_MAX : 0;
        uint32_t domain = all & (target->alike ^ lacks);
        for (int k = 0; k < TRAITS; k++) {
            lacks = (pattern->trait[k] & bit[v]) == 0 ? UINT32_MAX : 0;
            domain &= exact ? target->trait[k] ^ lacks : target->trait[k] | lacks;
        }
        quick->domain[v] = domain;
        int32_t score = (int32_t)(grrl_bit_count(domain) << 8 | v);
        fewest = score < fewest ? score : fewest;
    }
    *first = (uint8_t)(fewest & 0xff);
    return fewest > 0xff;
}

/* Target vertices that are free and joined to the images of the vertex's placed neighbours. */
static inline uint32_t find_candidates(const struct quick *quick, uint8_t vertex, uint32_t unplaced,
                                       uint32_t unused)
{
    const struct grrl_graph *pattern = quick->pattern.graph;
    const struct grrl_graph *target = quick->target.graph;
    uint32_t candidates = quick->domain[vertex] & unused;
    uint32_t prismatic = pattern->joined[GRRL_PRISMATIC][vertex];
    uint32_t back = (pattern->joined[GRRL_REVOLUTE][vertex] | prismatic) & ~unplaced;
    for (; back != 0; back &= back - 1u) {
        uint8_t earlier = grrl_first_bit(back);
        candidates &= target->joined[prismatic >> earlier & 1u][quick->image[earlier]];
    }
    return candidates;
}

/* Chooses the order of the vertices during the search: neighbours of placed vertices, those of the
 * most recent one last, because its image is known last. */
static enum grrl_status search(struct quick *quick, uint8_t first, uint32_t budget)
{
    const struct grrl_graph *pattern = quick->pattern.graph;
    const grrl_label *label = quick->pattern.label;
    const grrl_label *target_label = quick->target.label;
    uint8_t *image_of = quick->image;
    int64_t left = budget;
    size_t depth = 0;
    size_t deepest = 0;
    uint32_t unplaced = grrl_bits_below(pattern->n);
    uint32_t unused = UINT32_MAX;
    uint32_t frontier = 0;
    uint8_t vertex = quick->vertex[0] = first;
    uint32_t candidates = quick->domain[first];
    for (;;) {
        if (candidates == 0) {
            if (depth == 0)
                return GRRL_ERR_NONE;
            vertex = quick->vertex[--depth];
            unplaced |= grrl_bit(vertex);
            unused |= grrl_bit(image_of[vertex]);
            candidates = quick->candidates[depth];
            continue;
        }
        if (--left < 0)
            return GRRL_ERR_UNDECIDED;
        uint8_t image = grrl_first_bit(candidates);
        uint32_t taken = candidates & (0u - candidates);
        candidates ^= taken;
        if (label[vertex] != target_label[image])
            continue;
        image_of[vertex] = image;
        quick->candidates[depth] = candidates;
        unplaced &= ~grrl_bit(vertex);
        unused ^= taken;
        if (unplaced == 0)
            return GRRL_OK;
        if (++depth > deepest) {
            uint32_t older = frontier & unplaced;
            frontier = older | (grrl_match_neighbours(pattern, vertex) & unplaced);
            uint32_t choices = older != 0 ? older : frontier;
            quick->vertex[depth] = grrl_first_bit(choices != 0 ? choices : unplaced);
            deepest = depth;
        }
        vertex = quick->vertex[depth];
        candidates = find_candidates(quick, vertex, unplaced, unused);
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
    set_graph(&quick.pattern, pattern, mask);
    set_graph(&quick.target, target, mask);
    find_traits(&quick.pattern, quick.pattern.label[0]);
    find_traits(&quick.target, quick.pattern.label[0]);
    if (exact && !same_trait_counts(&quick.pattern, &quick.target))
        return GRRL_ERR_NONE;
    if (!(exact ? find_domains(&quick, true, &first) : find_domains(&quick, false, &first)))
        return GRRL_ERR_NONE;
    return search(&quick, first, budget);
}
