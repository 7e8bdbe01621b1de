/* Counts long chains of joints, and triples of joints at a link, by joint types. */
#include <string.h>

#include "base/bits.h"
#include "grrl/structure/signature.h"

/* Shortest and longest chains counted, in joints, and the limit on the number of chains. */
enum { SHORTEST = 4, LONGEST = 6, MAX_CHAINS = 4096, FULL = 7 };

/* A chain of joints that starts at one link. */
struct chain {
    const struct grrl_graph *graph;
    unsigned joints;
    uint32_t seen;                 /* its links */
    uint32_t untried[LONGEST + 1]; /* per link of the chain: neighbours still to try */
    uint8_t link[LONGEST + 1];
    uint32_t types[LONGEST + 1];    /* up to each link: bit i is set if joint i is prismatic */
    uint32_t reversed[LONGEST + 1]; /* the same, read from the other end */
};

static void add_count(struct grrl_paths *paths, unsigned place, uint32_t more)
{
    uint32_t *word = &paths->word[place / 8];
    unsigned shift = place % 8 * 4;
    uint32_t count = (*word >> shift & 0xfu) + more;
    *word = (*word & ~(UINT32_C(0xf) << shift)) | (count < FULL ? count : FULL) << shift;
}

/* Reads the types from both ends. The first chain of some types sets the bit of the smaller number,
 * the second chain that of the larger one. */
static void add_chain(struct grrl_paths *paths, unsigned joints, uint32_t types, uint32_t reversed)
{
    uint32_t smaller = types < reversed ? types : reversed;
    uint32_t larger = types < reversed ? reversed : types;
    if (joints == SHORTEST) {
        add_count(paths, smaller, 1);
        return;
    }
    unsigned first = GRRL_PATH_COUNTS + (joints == LONGEST ? 1 : 0);
    if ((paths->word[first + smaller / 32] >> smaller % 32 & 1u) != 0)
        paths->word[first + larger / 32] |= grrl_bit(larger % 32);
    paths->word[first + smaller / 32] |= grrl_bit(smaller % 32);
}

/* Counts three joints at one link, by how many are prismatic. They use places that no chain takes:
 * read from the other end, these types give smaller numbers. */
static void add_stars(struct grrl_paths *paths, const struct grrl_graph *graph, uint8_t link)
{
    static const uint8_t place[4] = {4, 8, 10, 12};
    uint32_t r = grrl_bit_count(graph->joined[GRRL_REVOLUTE][link]);
    uint32_t p = grrl_bit_count(graph->joined[GRRL_PRISMATIC][link]);
    add_count(paths, place[0], r > 2 ? r * (r - 1) * (r - 2) / 6 : 0);
    add_count(paths, place[1], r > 1 ? r * (r - 1) * p / 2 : 0);
    add_count(paths, place[2], p > 1 ? p * (p - 1) * r / 2 : 0);
    add_count(paths, place[3], p > 2 ? p * (p - 1) * (p - 2) / 6 : 0);
}

/* Advances to the next chain, depth first; 0 joints: no further chain from this start. */
static void next_chain(struct chain *chain)
{
    while (chain->untried[chain->joints] == 0) {
        chain->seen &= ~grrl_bit(chain->link[chain->joints]);
        if (chain->joints == 0)
            return;
        chain->joints--;
    }
    unsigned at = chain->joints++;
    uint8_t link = grrl_first_bit(chain->untried[at]);
    uint32_t prismatic = chain->graph->joined[GRRL_PRISMATIC][link] >> chain->link[at] & 1u;
    chain->untried[at] &= chain->untried[at] - 1u;
    chain->link[at + 1] = link;
    chain->types[at + 1] = chain->types[at] | prismatic << at;
    chain->reversed[at + 1] = chain->reversed[at] << 1 | prismatic;
    chain->seen |= grrl_bit(link);
    chain->untried[at + 1] =
        at + 1 < LONGEST ? grrl_graph_neighbours(chain->graph, link) & ~chain->seen : 0;
}

void grrl_paths_of(const struct grrl_graph *graph, struct grrl_paths *paths)
{
    unsigned chains = 0;
    memset(paths, 0, sizeof *paths);
    for (uint8_t start = 0; start < graph->n; start++) {
        struct chain chain = {.graph = graph, .seen = grrl_bit(start)};
        chain.link[0] = start;
        chain.untried[0] = grrl_graph_neighbours(graph, start);
        add_stars(paths, graph, start);
        for (next_chain(&chain); chain.joints > 0; next_chain(&chain)) {
            unsigned end = chain.joints;
            if (++chains > MAX_CHAINS) { /* so has any larger structure, which then saturates too */
                memset(paths, 0x77, GRRL_PATH_COUNTS * sizeof paths->word[0]);
                memset(&paths->word[GRRL_PATH_COUNTS], 0xff,
                       (GRRL_PATH_WORDS - GRRL_PATH_COUNTS) * sizeof paths->word[0]);
                return;
            }
            if (end >= SHORTEST && chain.link[end] > start)
                add_chain(paths, end, chain.types[end], chain.reversed[end]);
        }
    }
}
