/*
 * signature.h: counts of a structure that can only grow when links or joints are added.
 *
 * If a graph is a sub-structure of another, each of its counts is at most the other's; so most
 * pairs are told apart without a search. Seven bits a count, full at 127, eight counts a word, so
 * that a comparison of eight is one subtraction.
 */
#ifndef GRRL_SIGNATURE_H
#define GRRL_SIGNATURE_H

#include "grrl/base/api.h"
#include "grrl/structure/graph.h"

GRRL_API_BEGIN

/*
 * The first two words are about the shape: links; joints by type; links with two or more revolute,
 * two or more prismatic, three or more joints; four or more; loops; then pairs of joints at one
 * link by types (three counts), chains of three joints by types (five counts). The others count
 * under the mask: links by label, joints by type and labels, pairs of joints by types and labels;
 * labels share counts by a hash.
 */
enum { GRRL_SIGNATURE_SHAPE = 2, GRRL_SIGNATURE_WORDS = 5 };

struct grrl_signature {
    /* private */
    uint64_t word[GRRL_SIGNATURE_WORDS];
};

/* mask: the properties that count. Cost: linear in the pairs of joints that share a link. */
void grrl_signature_of(const struct grrl_graph *graph, grrl_label mask,
                       struct grrl_signature *signature);

/* Whether a graph with the first signature could be a sub-structure of one with the second, made
 * under the same mask; shape_only: whatever the properties. False is certain. */
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
 * What longer paths tell of the shape, whatever the properties: three bits for how many chains of
 * four joints there are by types, and for three joints at one link by types, full at seven; one bit
 * for whether there is a chain of five or six joints by types, and for whether there are two.
 */
enum { GRRL_PATH_COUNTS = 2, GRRL_PATH_WORDS = 5 };

struct grrl_paths {
    /* private */
    uint32_t word[GRRL_PATH_WORDS];
};

/* Cost: a step for each chain of up to six joints, at most some thousands; beyond, all is full. */
void grrl_paths_of(const struct grrl_graph *graph, struct grrl_paths *paths);

/* Whether a graph with the first could be a sub-structure of one with the second. False is
 * certain. */
static inline bool grrl_paths_within(const struct grrl_paths *part, const struct grrl_paths *whole)
{
    const uint32_t full = UINT32_C(0x88888888);
    uint32_t fits = full;
    uint32_t lacking = 0;
    for (int i = 0; i < GRRL_PATH_COUNTS; i++)
        fits &= (whole->word[i] | full) - part->word[i];
    for (int i = GRRL_PATH_COUNTS; i < GRRL_PATH_WORDS; i++)
        lacking |= part->word[i] & ~whole->word[i];
    return (((fits & full) ^ full) | lacking) == 0;
}

GRRL_API_END

#endif
