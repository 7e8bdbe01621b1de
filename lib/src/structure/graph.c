/* Vertices, joints, neighbours and orders of a graph. */
#include "grrl/structure/graph.h"

#include <assert.h>
#include <string.h>

#include "base/bits.h"

void grrl_graph_clear(struct grrl_graph *graph)
{
    memset(graph, 0, sizeof *graph);
}

enum grrl_status grrl_graph_add_link(struct grrl_graph *graph, grrl_label label, uint8_t *index)
{
    if (graph->n == GRRL_MAX_LINKS)
        return GRRL_ERR_FULL;
    uint8_t added = graph->n++;
    graph->label[added] = label;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++)
        graph->joined[type][added] = 0;
    if (index != NULL)
        *index = added;
    return GRRL_OK;
}

enum grrl_status grrl_graph_add_joint(struct grrl_graph *graph, uint8_t a, uint8_t b,
                                      enum grrl_joint_type type)
{
    if (a >= graph->n || b >= graph->n || (type != GRRL_REVOLUTE && type != GRRL_PRISMATIC))
        return GRRL_ERR_ARGUMENT;
    if (a == b || grrl_graph_joint(graph, a, b) != GRRL_NO_JOINT)
        return GRRL_ERR_STRUCTURE;
    if (grrl_graph_joint_count(graph) == GRRL_MAX_JOINTS)
        return GRRL_ERR_FULL;
    graph->joined[type][a] |= grrl_bit(b);
    graph->joined[type][b] |= grrl_bit(a);
    return GRRL_OK;
}

int grrl_graph_joint(const struct grrl_graph *graph, uint8_t a, uint8_t b)
{
    assert(a < graph->n && b < graph->n);
    for (int type = 0; type < GRRL_JOINT_TYPES; type++)
        if ((graph->joined[type][a] & grrl_bit(b)) != 0)
            return type;
    return GRRL_NO_JOINT;
}

uint32_t grrl_graph_neighbours(const struct grrl_graph *graph, uint8_t link)
{
    assert(link < graph->n);
    uint32_t all = 0;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++)
        all |= graph->joined[type][link];
    return all;
}

unsigned grrl_graph_joint_count(const struct grrl_graph *graph)
{
    unsigned ends = 0;
    for (uint8_t i = 0; i < graph->n; i++)
        ends += grrl_bit_count(grrl_graph_neighbours(graph, i));
    return ends / 2;
}

void grrl_graph_permute(const struct grrl_graph *graph, const uint8_t *order,
                        struct grrl_graph *permuted)
{
    assert(graph != permuted);
    uint8_t place[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < graph->n; i++)
        place[order[i]] = i;
    grrl_graph_clear(permuted);
    permuted->n = graph->n;
    for (uint8_t i = 0; i < graph->n; i++) {
        permuted->label[i] = graph->label[order[i]];
        for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
            uint32_t joined = graph->joined[type][order[i]];
            for (; joined != 0; joined &= joined - 1u)
                permuted->joined[type][i] |= grrl_bit(place[grrl_first_bit(joined)]);
        }
    }
}

bool grrl_graph_equal(const struct grrl_graph *a, const struct grrl_graph *b, grrl_label mask)
{
    if (a->n != b->n)
        return false;
    if (mask == GRRL_ALL_PROPERTIES) { /* as for canonical forms: whole arrays at a time */
        bool equal = memcmp(a->label, b->label, a->n * sizeof a->label[0]) == 0;
        for (int type = 0; type < GRRL_JOINT_TYPES && equal; type++)
            equal = memcmp(a->joined[type], b->joined[type], a->n * sizeof a->joined[0][0]) == 0;
        return equal;
    }
    for (uint8_t i = 0; i < a->n; i++) {
        if (grrl_label_masked(a->label[i], mask) != grrl_label_masked(b->label[i], mask))
            return false;
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            if (a->joined[type][i] != b->joined[type][i])
                return false;
    }
    return true;
}

uint32_t grrl_graph_component(const struct grrl_graph *graph, uint8_t link)
{
    uint32_t component = grrl_bit(link);
    uint32_t fresh = component;
    while (fresh != 0) {
        uint32_t reached = 0;
        for (; fresh != 0; fresh &= fresh - 1u)
            reached |= grrl_graph_neighbours(graph, grrl_first_bit(fresh));
        fresh = reached & ~component;
        component |= fresh;
    }
    return component;
}
