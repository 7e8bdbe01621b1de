/* Precomputes for each graph: colours, counts and the search order. */
#include <string.h>

#include "structure/match_private.h"

/* Rounds of colour refinement: a vertex's colour covers everything within this many joints. */
enum { ROUNDS = 4 };

/* Odd numbers without a pattern (the first digits of the golden ratio, and xxHash's primes). */
#define SPREAD_LOW UINT32_C(0x9e3779b1)
#define SPREAD_HIGH UINT32_C(0x85ebca77)
#define SPREAD_REVOLUTE UINT32_C(0xc2b2ae3d)
#define SPREAD_PRISMATIC UINT32_C(0x27d4eb2f)

static inline uint32_t spread(uint32_t x)
{
    x ^= x >> 16;
    x *= UINT32_C(0x7feb352d); /* Wellons, "lowbias32" */
    return x ^ x >> 15;
}

static inline uint32_t hash_label(grrl_label label)
{
    return (uint32_t)label * SPREAD_LOW + (uint32_t)(label >> 32) * SPREAD_HIGH;
}

/* Sets labels, joints, and degrees as the first two growing counts. */
static void count_joints(struct grrl_match_plan *plan, const struct grrl_graph *graph,
                         grrl_label mask)
{
    uint32_t ends[GRRL_JOINT_TYPES] = {0};
    plan->graph = graph;
    for (unsigned i = 0; i < graph->n; i++)
        plan->label[i] = grrl_label_masked(graph->label[i], mask);
    for (unsigned i = 0; i < graph->n; i++) {
        uint32_t revolute = grrl_bit_count(graph->joined[GRRL_REVOLUTE][i]);
        uint32_t prismatic = grrl_bit_count(graph->joined[GRRL_PRISMATIC][i]);
        ends[GRRL_REVOLUTE] += revolute;
        ends[GRRL_PRISMATIC] += prismatic;
        plan->growing[i] = revolute | prismatic << 8;
    }
    for (int type = 0; type < GRRL_JOINT_TYPES; type++)
        plan->joints[type] = (uint8_t)(ends[type] / 2);
}

/* Sets each vertex's colour from its label and degrees. */
static void colour(struct grrl_match_plan *plan)
{
    for (unsigned i = 0; i < plan->graph->n; i++)
        plan->colour[i] = spread(hash_label(plan->label[i]) + plan->growing[i] * SPREAD_REVOLUTE);
}

void grrl_match_order_from(struct grrl_match_step *step, const struct grrl_graph *graph,
                           uint8_t first)
{
    uint32_t placed = 0;
    unsigned tail = 0;
    unsigned head = 0;
    while (tail < graph->n) {
        uint8_t start = tail == 0 ? first : grrl_first_bit(grrl_bits_below(graph->n) & ~placed);
        step[tail++] = (struct grrl_match_step){
            .vertex = start, .parent = GRRL_UNMAPPED, .group = {start, start}};
        placed |= grrl_bit(start);
        for (; head < tail; head++) {
            uint8_t parent = step[head].vertex;
            for (uint8_t type = 0; type < GRRL_JOINT_TYPES; type++) {
                uint32_t fresh = graph->joined[type][parent] & ~placed;
                for (; fresh != 0; fresh &= fresh - 1u) {
                    uint8_t vertex = grrl_first_bit(fresh);
                    uint32_t back = grrl_match_neighbours(graph, vertex) & placed;
                    step[tail++] = (struct grrl_match_step){.vertex = vertex,
                                                            .parent = parent,
                                                            .type = type,
                                                            .group = {vertex, vertex},
                                                            .ties = back & ~grrl_bit(parent)};
                    placed |= grrl_bit(vertex);
                }
            }
        }
    }
}

/* Mixes the colours of the neighbours into each colour, by the types of the joints to them. */
static void refine_colours(struct grrl_match_plan *plan)
{
    static const uint32_t factor[GRRL_JOINT_TYPES] = {SPREAD_REVOLUTE, SPREAD_PRISMATIC};
    uint32_t before[GRRL_MAX_LINKS];
    memcpy(before, plan->colour, sizeof before[0] * plan->graph->n);
    for (unsigned i = 0; i < plan->graph->n; i++) {
        uint32_t mixed = before[i] * SPREAD_LOW;
        for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
            uint32_t rest = plan->graph->joined[type][i];
            for (; rest != 0; rest &= rest - 1u)
                mixed += spread(before[grrl_first_bit(rest)] * factor[type]);
        }
        plan->colour[i] = spread(mixed);
    }
}

/* Adds the other growing counts: links within two joints, and the highest degree of a neighbour. */
static void count_surroundings(struct grrl_match_plan *plan)
{
    const struct grrl_graph *graph = plan->graph;
    uint32_t degrees[GRRL_MAX_LINKS];
    memcpy(degrees, plan->growing, sizeof degrees[0] * graph->n);
    for (uint8_t i = 0; i < graph->n; i++) {
        uint32_t within = grrl_bit(i);
        uint32_t most = 0;
        for (uint32_t rest = grrl_match_neighbours(graph, i); rest != 0; rest &= rest - 1u) {
            uint8_t v = grrl_first_bit(rest);
            uint32_t degree = (degrees[v] & 0xffu) + (degrees[v] >> 8);
            most = degree > most ? degree : most;
            within |= grrl_match_neighbours(graph, v) | grrl_bit(v);
        }
        plan->growing[i] = degrees[i] | grrl_bit_count(within) << 16 | most << 24;
    }
}

static void count_degrees(struct grrl_match_plan *plan)
{
    memset(plan->at_least, 0, sizeof plan->at_least);
    for (uint8_t i = 0; i < plan->graph->n; i++) {
        const unsigned degrees = grrl_match_degrees(plan, i);
        for (unsigned revolute = 0; revolute <= degrees / 4; revolute++)
            for (unsigned prismatic = 0; prismatic <= degrees % 4; prismatic++)
                plan->at_least[revolute * 4 + prismatic] |= grrl_bit(i);
    }
}

/* Ranks the different labels by value. */
static void rank_labels(struct grrl_match_plan *plan)
{
    unsigned n_labels = 0;
    memset(plan->labelled, 0, sizeof plan->labelled);
    for (uint8_t i = 0; i < plan->graph->n; i++) {
        unsigned at = 0;
        while (at < n_labels && plan->label[plan->label_example[at]] < plan->label[i])
            at++;
        if (at == n_labels || plan->label[plan->label_example[at]] != plan->label[i]) {
            for (unsigned k = n_labels++; k > at; k--) {
                plan->label_example[k] = plan->label_example[k - 1];
                plan->labelled[k] = plan->labelled[k - 1];
            }
            plan->label_example[at] = i;
            plan->labelled[at] = 0;
        }
        plan->labelled[at] |= grrl_bit(i);
    }
    plan->n_labels = (uint8_t)n_labels;
    for (unsigned k = 0; k < n_labels; k++)
        for (uint32_t rest = plan->labelled[k]; rest != 0; rest &= rest - 1u)
            plan->label_group[grrl_first_bit(rest)] = (uint8_t)k;
}

/* Ranks the colours by value; each cell is the set of vertices of one colour. */
static void rank_colours(struct grrl_match_plan *plan)
{
    uint64_t sorted[GRRL_MAX_LINKS];
    uint8_t n = plan->graph->n;
    for (uint8_t i = 0; i < n; i++) {
        uint64_t inserted = (uint64_t)plan->colour[i] << 8 | i;
        unsigned at = i;
        for (; at > 0 && sorted[at - 1] > inserted; at--)
            sorted[at] = sorted[at - 1];
        sorted[at] = inserted;
    }
    uint8_t rank = 0;
    uint32_t hash = n;
    memset(plan->cell, 0, sizeof plan->cell);
    for (uint8_t i = 0; i < n; i++) {
        rank = (uint8_t)(rank + (i > 0 && sorted[i] >> 8 != sorted[i - 1] >> 8));
        uint8_t vertex = (uint8_t)(sorted[i] & 0xffu);
        plan->rank[vertex] = rank;
        plan->cell[rank] |= grrl_bit(vertex);
        hash = spread(hash * SPREAD_LOW + (uint32_t)(sorted[i] >> 8));
    }
    plan->hash = hash;
}

/*
 * Orders a pattern's vertices. Neighbours of earlier vertices come first, those of several before
 * those of one; then the rarest colour, then the most joints.
 */
static void order_planned(struct grrl_match_plan *plan)
{
    const struct grrl_graph *graph = plan->graph;
    uint32_t score[GRRL_MAX_LINKS]; /* smaller comes first; the vertex is in the lowest byte */
    for (uint8_t v = 0; v < graph->n; v++)
        score[v] = grrl_bit_count(plan->cell[plan->rank[v]]) << 16 |
                   (32u - grrl_bit_count(grrl_match_neighbours(graph, v))) << 8 | v;
    uint32_t placed = 0;
    uint32_t frontier = 0; /* neighbours of placed vertices */
    uint32_t tied = 0;     /* those with two or more placed neighbours */
    uint8_t parent[GRRL_MAX_LINKS];
    for (uint8_t depth = 0; depth < graph->n; depth++) {
        uint32_t choices = tied != 0 ? tied : frontier;
        bool starts = choices == 0;
        if (starts)
            choices = grrl_bits_below(graph->n) & ~placed;
        uint32_t smallest = UINT32_MAX;
        for (; choices != 0; choices &= choices - 1u) {
            uint32_t other = score[grrl_first_bit(choices)];
            smallest = other < smallest ? other : smallest;
        }
        uint8_t best = (uint8_t)(smallest & 0xffu);
        uint8_t from = starts ? GRRL_UNMAPPED : parent[best];
        plan->step[depth] = (struct grrl_match_step){
            .vertex = best,
            .parent = from,
            .type = !starts && (graph->joined[GRRL_PRISMATIC][best] & grrl_bit(from)) != 0,
            .degrees = grrl_match_degrees(plan, best),
            .group = {plan->rank[best], plan->label_group[best]},
            .ties = starts ? 0 : grrl_match_neighbours(graph, best) & placed & ~grrl_bit(from)};
        placed |= grrl_bit(best);
        uint32_t neighbours = grrl_match_neighbours(graph, best) & ~placed;
        for (uint32_t rest = neighbours & ~frontier; rest != 0; rest &= rest - 1u)
            parent[grrl_first_bit(rest)] = best;
        tied = (tied | (neighbours & frontier)) & ~placed;
        frontier = (frontier | neighbours) & ~placed;
    }
}

void grrl_match_plan_of(struct grrl_match_plan *plan, const struct grrl_graph *graph,
                        grrl_label mask)
{
    count_joints(plan, graph, mask);
    colour(plan);
    for (int round = 0; round < ROUNDS; round++)
        refine_colours(plan);
    count_surroundings(plan);
    count_degrees(plan);
    rank_colours(plan);
    rank_labels(plan);
    order_planned(plan);
    grrl_signature_of(graph, mask, &plan->monotone);
}
