/*
 * signature.h: counts of a structure that can only grow when links or joints are added.
 *
 * If one graph is a sub-structure of another, each of its counts is at most the other's. This rules
 * out most pairs without a search. A count has seven bits and saturates at 127; a word holds eight
 * counts, so one subtraction compares eight.
 */
#ifndef GRRL_SIGNATURE_H
#define GRRL_SIGNATURE_H

#include "grrl/base/api.h"
#include "grrl/structure/graph.h"

GRRL_API_BEGIN

/*
 * The first two words describe the shape: links; joints by type; links with two or more revolute,
 * two or more prismatic, three or more joints; four or more; loops; then pairs of joints at one
 * link by types (three counts) and chains of three joints by types (five counts). The other words
 * count under the mask: links by label, joints by type and labels, pairs of joints by types and
 * labels. A hash assigns labels to counts, so labels may share one.
 */
enum { GRRL_SIGNATURE_SHAPE = 2, GRRL_SIGNATURE_WORDS = 5 };

struct grrl_signature {
    /* private */
    uint64_t word[GRRL_SIGNATURE_WORDS];
};

/* mask: the properties that count. Cost: linear in the pairs of joints that share a link. */
void grrl_signature_of(const struct grrl_graph *graph, grrl_label mask,
                       struct grrl_signature *signature);

/* Whether a graph with signature `part` could be a sub-structure of one with signature `whole`.
 * Both must be made under the same mask; shape_only ignores the properties. False is certain. */
static inline bool grrl_signature_within(const struct grrl_signature *part,
                                         const struct grrl_signature *whole, bool shape_only)
{
    const uint64_t full = UINT64_C(0x8080808080808080);
    uint64_t fits = full;
    for (int i = 0; i < (shape_only ? GRRL_SIGNATURE_SHAPE : GRRL_SIGNATURE_WORDS); i++)
        fits &= (whole->word[i] | full) - part->word[i];
    return (fits & full) == full;
}

/*
 * Counts of longer paths, ignoring the properties. Three bits each, saturating at seven: chains of
 * four joints by types, and three joints at one link by types. One bit each: whether there is at
 * least one chain of five or six joints by types, and whether there are at least two.
 */
enum { GRRL_PATH_COUNTS = 2, GRRL_PATH_WORDS = 5 };

struct grrl_paths {
    /* private */
    uint32_t word[GRRL_PATH_WORDS];
};

/* Cost: one step for each chain of up to six joints, at most a few thousand; beyond that all counts
 * saturate. */
void grrl_paths_of(const struct grrl_graph *graph, struct grrl_paths *paths);

/* The counts of `part` and `whole` alone, which rule out most. */
static inline bool grrl_paths_counts_within(const struct grrl_paths *part,
                                            const struct grrl_paths *whole)
{
    const uint64_t full = UINT64_C(0x8888888888888888);
    uint64_t of_part = part->word[0] | (uint64_t)part->word[1] << 32;
    uint64_t of_whole = whole->word[0] | (uint64_t)whole->word[1] << 32;
    return (((of_whole | full) - of_part) & full) == full;
}

/* Whether a graph with paths `part` could be a sub-structure of one with `whole`.
 * False is certain. */
static inline bool grrl_paths_within(const struct grrl_paths *part, const struct grrl_paths *whole)
{
    uint32_t lacking = 0;
    for (int i = GRRL_PATH_COUNTS; i < GRRL_PATH_WORDS; i++)
        lacking |= part->word[i] & ~whole->word[i];
    return grrl_paths_counts_within(part, whole) & (lacking == 0);
}

GRRL_API_END

#endif
