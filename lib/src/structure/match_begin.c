/*
 * A search without plans. It prepares a few sets per graph in some tens of nanoseconds; they
 * prevent nearly every dead end.
 *
 * Bit v of a set tells whether vertex v has a trait: it has the reference label, or joints of some
 * type to a vertex with that label, or two and more of some type. The sets of both graphs give each
 * pattern vertex its domain, the target vertices with compatible traits. Machines with vector
 * instructions handle four vertices at a time.
 */
#include <string.h>

#include "structure/match_private.h"

/* The traits of a vertex, for each type of joint: a joint to a vertex with the reference label, and
 * two or more joints. */
enum { TO_ALIKE, MORE = 2 };

/* a table, because few machines can shift vector lanes by different amounts */
static const uint32_t bit[32] = {
    1u << 0,  1u << 1,  1u << 2,  1u << 3,  1u << 4,  1u << 5,  1u << 6,  1u << 7,
    1u << 8,  1u << 9,  1u << 10, 1u << 11, 1u << 12, 1u << 13, 1u << 14, 1u << 15,
    1u << 16, 1u << 17, 1u << 18, 1u << 19, 1u << 20, 1u << 21, 1u << 22, 1u << 23,
    1u << 24, 1u << 25, 1u << 26, 1u << 27, 1u << 28, 1u << 29, 1u << 30, 1u << 31};

/* Half a label, which vector instructions compare faster. Equal labels have equal halves. */
static inline uint32_t half_of(grrl_label label)
{
    return (uint32_t)label;
}

static void find_traits(struct grrl_match_side *side, grrl_label reference)
{
    const struct grrl_graph *graph = side->graph;
    const uint32_t *revolute = graph->joined[GRRL_REVOLUTE];
    const uint32_t *prismatic = graph->joined[GRRL_PRISMATIC];
    const uint32_t half = half_of(reference);
    const unsigned n = graph->n;
    uint32_t alike = 0;
    uint32_t to_alike[GRRL_JOINT_TYPES] = {0};
    uint32_t more[GRRL_JOINT_TYPES] = {0};
    for (unsigned i = 0; i < n; i++) {
        const uint32_t is_alike = half_of(side->label[i]) == half ? UINT32_MAX : 0;
        const uint32_t r = revolute[i];
        const uint32_t p = prismatic[i];
        alike |= is_alike & bit[i];
        to_alike[0] |= is_alike & r;
        to_alike[1] |= is_alike & p;
        more[0] |= ((r & (r - 1u)) != 0 ? UINT32_MAX : 0) & bit[i];
        more[1] |= ((p & (p - 1u)) != 0 ? UINT32_MAX : 0) & bit[i];
    }
    side->alike = alike;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        side->trait[TO_ALIKE + type] = to_alike[type];
        side->trait[MORE + type] = more[type];
    }
}

void grrl_match_side_of(struct grrl_match_side *side, const struct grrl_graph *graph,
                        grrl_label mask, grrl_label reference)
{
    side->graph = graph;
    side->label = graph->label;
    if (mask != GRRL_ALL_PROPERTIES) {
        for (unsigned i = 0; i < graph->n; i++)
            side->masked[i] = grrl_label_masked(graph->label[i], mask);
        side->label = side->masked;
    }
    find_traits(side, reference);
}

static uint32_t count_ends(const struct grrl_graph *graph, int type)
{
    uint32_t ends = 0;
    for (unsigned i = 0; i < graph->n; i++)
        ends += grrl_bit_count(graph->joined[type][i]);
    return ends;
}

/* Whether equally many vertices have each trait, and there are as many joints of each type. */
static bool same_trait_counts(const struct grrl_match_side *a, const struct grrl_match_side *b)
{
    uint32_t differing = grrl_bit_count(a->alike) ^ grrl_bit_count(b->alike);
    for (int k = 0; k < GRRL_MATCH_TRAITS; k++) {
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
static inline bool find_domains(const struct grrl_match_side *pattern,
                                const struct grrl_match_side *target, bool exact,
                                uint32_t *restrict domains, uint8_t *first)
{
    const unsigned n = pattern->graph->n;
    const uint32_t alike = pattern->alike;
    const uint32_t others = grrl_bits_below(target->graph->n) & ~target->alike;
    const uint32_t differing = target->alike ^ others;
    int32_t fewest = INT32_MAX; /* with the vertex in its lowest byte */
    for (unsigned v = 0; v < n; v++) {
        uint32_t domain = others ^ (((alike & bit[v]) != 0 ? UINT32_MAX : 0) & differing);
        for (int k = 0; k < GRRL_MATCH_TRAITS; k++) {
            uint32_t lacks = (pattern->trait[k] & bit[v]) == 0 ? UINT32_MAX : 0;
            domain &= exact ? target->trait[k] ^ lacks : target->trait[k] | lacks;
        }
        domains[v] = domain;
        int32_t score = (int32_t)(grrl_bit_count(domain) << 8 | v);
        fewest = score < fewest ? score : fewest;
    }
    *first = n > 0 ? (uint8_t)(fewest & 0xff) : 0;
    return fewest > 0xff;
}

bool grrl_match_begin_sides(struct grrl_match *match, enum grrl_match_kind kind,
                            const struct grrl_match_side *pattern,
                            const struct grrl_match_side *target, uint32_t budget)
{
    const bool exact = kind == GRRL_MATCH_ISOMORPHISM;
    uint8_t first = 0;
    match->pattern = pattern->graph;
    match->target = target->graph;
    match->plan[0] = NULL;
    match->label[0] = pattern->label;
    match->label[1] = target->label;
    match->kind = kind;
    match->budget = budget;
    match->depth = GRRL_MATCH_FINISHED;
    if (exact ? pattern->graph->n != target->graph->n || !same_trait_counts(pattern, target)
              : pattern->graph->n > target->graph->n)
        return false;
    uint32_t *domains = match->own_allowed;
    domains[0] = 0; /* for a pattern without vertices */
    if (!(exact ? find_domains(pattern, target, true, domains, &first)
                : find_domains(pattern, target, false, domains, &first)))
        return false;
    match->allowed = domains;
    grrl_match_start_at(match, first);
    return true;
}

void grrl_match_begin(struct grrl_match *match, enum grrl_match_kind kind,
                      const struct grrl_graph *pattern, const struct grrl_graph *target,
                      grrl_label mask, uint32_t budget)
{
    struct grrl_match_side *own = match->own_side;
    grrl_label reference =
        pattern->n > 0 ? grrl_label_masked(pattern->label[0], mask) : GRRL_NO_PROPERTIES;
    grrl_match_side_of(&own[0], pattern, mask, reference);
    grrl_match_side_of(&own[1], target, mask, reference);
    (void)grrl_match_begin_sides(match, kind, &own[0], &own[1], budget);
}
