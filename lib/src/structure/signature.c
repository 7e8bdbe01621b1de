/* Computes the counts of a structure, and compares them. */
#include "grrl/structure/signature.h"

#include "base/bits.h"

enum { MOST = 127, COUNTS = 8 };

/* Counts being packed into a signature. */
struct counts {
    uint32_t of[GRRL_SIGNATURE_WORDS][COUNTS];
};

enum shape_count {
    LINKS,
    REVOLUTE,
    PRISMATIC,
    TWO_REVOLUTE,
    TWO_PRISMATIC,
    THREE_JOINTS,
    FOUR_JOINTS,
    LOOPS
};

/* Which of the eight counts of a word a number goes to. */
static unsigned bucket(uint64_t number)
{
    return (unsigned)(number * UINT64_C(0x9e3779b97f4a7c15) >> 61);
}

/* Hashes a label, so that a sum of hashes distinguishes sets of labels. */
static uint64_t label_number(grrl_label label)
{
    label ^= label >> 29;
    label *= UINT64_C(0xbf58476d1ce4e5b9); /* splitmix64 */
    return label ^ label >> 32;
}

/* Counts pairs of joints at one link, and chains of three joints, both by types. */
static void count_paths(const struct grrl_graph *graph, uint32_t *count)
{
    uint32_t degree[GRRL_MAX_LINKS][GRRL_JOINT_TYPES];
    for (uint8_t i = 0; i < graph->n; i++) {
        uint32_t r = degree[i][0] = grrl_bit_count(graph->joined[GRRL_REVOLUTE][i]);
        uint32_t p = degree[i][1] = grrl_bit_count(graph->joined[GRRL_PRISMATIC][i]);
        count[0] += r * (r - (r > 0)) / 2;
        count[1] += r * p;
        count[2] += p * (p - (p > 0)) / 2;
        for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
            uint32_t lower = graph->joined[type][i] & (grrl_bit(i) - 1u);
            for (; lower != 0; lower &= lower - 1u) {
                const uint32_t *b = degree[grrl_first_bit(lower)];
                uint32_t r_a = r - (type == GRRL_REVOLUTE);
                uint32_t p_a = p - (type == GRRL_PRISMATIC);
                uint32_t r_b = b[0] - (type == GRRL_REVOLUTE);
                uint32_t p_b = b[1] - (type == GRRL_PRISMATIC);
                uint32_t same = r_a * r_b;
                uint32_t mixed = r_a * p_b + p_a * r_b;
                uint32_t other = p_a * p_b;
                count[type == GRRL_REVOLUTE ? 3 : 6] += same;
                count[type == GRRL_REVOLUTE ? 4 : 7] += mixed;
                count[type == GRRL_REVOLUTE ? 5 : 7] += other;
            }
        }
    }
}

static void count_shape(const struct grrl_graph *graph, uint32_t *count)
{
    uint32_t seen = 0;
    uint32_t components = 0;
    uint32_t ends[GRRL_JOINT_TYPES] = {0};
    for (uint8_t i = 0; i < graph->n; i++) {
        uint32_t r = grrl_bit_count(graph->joined[GRRL_REVOLUTE][i]);
        uint32_t p = grrl_bit_count(graph->joined[GRRL_PRISMATIC][i]);
        ends[GRRL_REVOLUTE] += r;
        ends[GRRL_PRISMATIC] += p;
        count[TWO_REVOLUTE] += r >= 2;
        count[TWO_PRISMATIC] += p >= 2;
        count[THREE_JOINTS] += r + p >= 3;
        count[FOUR_JOINTS] += r + p >= 4;
        if ((seen & grrl_bit(i)) == 0) {
            seen |= grrl_graph_component(graph, i);
            components++;
        }
    }
    count[LINKS] = graph->n;
    count[REVOLUTE] = ends[GRRL_REVOLUTE] / 2;
    count[PRISMATIC] = ends[GRRL_PRISMATIC] / 2;
    count[LOOPS] = count[REVOLUTE] + count[PRISMATIC] + components - graph->n;
}

/* Counts links by label, and joints and pairs of joints at a link by labels and types. */
static void count_labels(const struct grrl_graph *graph, grrl_label mask, struct counts *counts)
{
    uint64_t own[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < graph->n; i++) {
        own[i] = label_number(grrl_label_masked(graph->label[i], mask));
        counts->of[2][bucket(own[i])]++;
    }
    for (uint8_t i = 0; i < graph->n; i++) {
        uint64_t arm[GRRL_MAX_LINKS];
        unsigned n_arms = 0;
        for (uint64_t type = 0; type < GRRL_JOINT_TYPES; type++) {
            for (uint32_t rest = graph->joined[type][i]; rest != 0; rest &= rest - 1u) {
                uint8_t v = grrl_first_bit(rest);
                if (v < i)
                    counts->of[3][bucket(own[i] + own[v] + type)]++;
                arm[n_arms] = label_number(own[v] + type);
                for (unsigned k = 0; k < n_arms; k++)
                    counts->of[4][bucket(own[i] * 3 + arm[k] + arm[n_arms])]++;
                n_arms++;
            }
        }
    }
}

void grrl_signature_of(const struct grrl_graph *graph, grrl_label mask,
                       struct grrl_signature *signature)
{
    struct counts counts = {0};
    count_shape(graph, counts.of[0]);
    count_paths(graph, counts.of[1]);
    count_labels(graph, mask, &counts);
    for (int word = 0; word < GRRL_SIGNATURE_WORDS; word++) {
        signature->word[word] = 0;
        for (int i = 0; i < COUNTS; i++) {
            uint64_t count = counts.of[word][i] < MOST ? counts.of[word][i] : MOST;
            signature->word[word] |= count << (8 * i);
        }
    }
}
