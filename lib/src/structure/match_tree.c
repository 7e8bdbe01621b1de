/* Matches a tree into a forest in polynomial time, by pairing children. */
#include <string.h>

#include "structure/match_private.h"

/* Children of a pattern vertex on one side, neighbours of a target vertex on the other. */
struct pairing {
    uint8_t child[GRRL_MAX_LINKS];
    uint32_t suitable[GRRL_MAX_LINKS]; /* per child: neighbours it could be mapped to */
    uint8_t taken[GRRL_MAX_LINKS];     /* per child: its neighbour */
    uint8_t owner[GRRL_MAX_LINKS];     /* per neighbour in `owned`: its child */
    uint32_t owned;
    uint8_t n;
};

/*
 * spare[p][t] concerns the part of the pattern that hangs on p, seen from the root, mapped with p
 * on t. It holds the neighbours of t that the mapping does not need, and t itself if there is a
 * mapping at all.
 */
struct tree_search {
    const struct grrl_match_plan *pattern;
    const struct grrl_match_plan *target;
    struct grrl_match_step step[GRRL_MAX_LINKS]; /* from the root outwards */
    uint8_t parent[GRRL_MAX_LINKS];
    uint32_t spare[GRRL_MAX_LINKS][GRRL_MAX_LINKS];
};

static bool is_forest(const struct grrl_match_plan *plan, unsigned max_components)
{
    unsigned components = 0;
    uint32_t rest = grrl_bits_below(plan->graph->n);
    for (; rest != 0; rest &= ~grrl_graph_component(plan->graph, grrl_first_bit(rest)))
        components++;
    unsigned joints = (unsigned)plan->joints[GRRL_REVOLUTE] + plan->joints[GRRL_PRISMATIC];
    return components <= max_components && joints + components == plan->graph->n;
}

static bool is_compatible(const struct tree_search *search, uint8_t p, uint8_t t)
{
    uint32_t left = (search->target->growing[t] | GRRL_MATCH_GUARDS) - search->pattern->growing[p];
    return (left & GRRL_MATCH_GUARDS) == GRRL_MATCH_GUARDS &&
           search->pattern->label[p] == search->target->label[t];
}

/* Lists the children of p and the neighbours suitable for each; false if a child has none. */
static bool list_children(const struct tree_search *search, uint8_t p, uint8_t t,
                          struct pairing *pairing)
{
    const struct grrl_graph *pattern = search->pattern->graph;
    const struct grrl_graph *target = search->target->graph;
    pairing->n = 0;
    pairing->owned = 0;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        uint32_t children = pattern->joined[type][p];
        if (search->parent[p] != GRRL_UNMAPPED)
            children &= ~grrl_bit(search->parent[p]);
        for (; children != 0; children &= children - 1u) {
            uint8_t child = grrl_first_bit(children);
            uint32_t suitable = 0;
            for (uint32_t rest = target->joined[type][t]; rest != 0; rest &= rest - 1u)
                if ((search->spare[child][grrl_first_bit(rest)] & grrl_bit(t)) != 0)
                    suitable |= rest & (0u - rest);
            if (suitable == 0)
                return false;
            pairing->child[pairing->n] = child;
            pairing->suitable[pairing->n++] = suitable;
        }
    }
    return true;
}

/* Pairs one more child, moving others if needed (a breadth-first augmenting path). On failure
 * nothing changes. */
static bool pair_child(struct pairing *pairing, uint8_t child, uint32_t forbidden)
{
    uint8_t queue[GRRL_MAX_LINKS];
    uint8_t reached_by[GRRL_MAX_LINKS];
    uint32_t reached = forbidden;
    unsigned tail = 0;
    queue[tail++] = child;
    for (unsigned head = 0; head < tail; head++) {
        uint32_t fresh = pairing->suitable[queue[head]] & ~reached;
        uint32_t open = fresh & ~pairing->owned;
        if (open != 0) {
            uint8_t neighbour = grrl_first_bit(open);
            reached_by[neighbour] = queue[head];
            pairing->owned |= grrl_bit(neighbour);
            for (;;) {
                uint8_t by = reached_by[neighbour];
                uint8_t left = pairing->taken[by];
                pairing->owner[neighbour] = by;
                pairing->taken[by] = neighbour;
                if (by == child)
                    return true;
                neighbour = left;
            }
        }
        reached |= fresh;
        for (; fresh != 0; fresh &= fresh - 1u) {
            uint8_t neighbour = grrl_first_bit(fresh);
            reached_by[neighbour] = queue[head];
            queue[tail++] = pairing->owner[neighbour];
        }
    }
    return false;
}

static bool pair_all(struct pairing *pairing, uint32_t forbidden)
{
    for (uint8_t i = 0; i < pairing->n; i++)
        if (!pair_child(pairing, i, forbidden))
            return false;
    return true;
}

/* Computes spare[p][t], given the values for the children of p. */
static uint32_t spare_neighbours(const struct tree_search *search, uint8_t p, uint8_t t)
{
    struct pairing pairing;
    if (!is_compatible(search, p, t) || !list_children(search, p, t, &pairing) ||
        !pair_all(&pairing, 0))
        return 0;
    uint32_t neighbours = grrl_match_neighbours(search->target->graph, t);
    uint32_t free_now = grrl_bit(t) | (neighbours & ~pairing.owned);
    for (uint32_t rest = neighbours & pairing.owned; rest != 0; rest &= rest - 1u) {
        uint8_t neighbour = grrl_first_bit(rest);
        if ((pairing.owned & grrl_bit(neighbour)) == 0) {
            free_now |= grrl_bit(neighbour); /* freed when another child took its place */
            continue;
        }
        pairing.owned &= ~grrl_bit(neighbour);
        if (pair_child(&pairing, pairing.owner[neighbour], grrl_bit(neighbour)))
            free_now |= grrl_bit(neighbour);
        else
            pairing.owned |= grrl_bit(neighbour);
    }
    return free_now;
}

/* Writes one mapping that sends the root to this target, from the root outwards. */
static void write_map(const struct tree_search *search, uint8_t root_image, uint8_t *map)
{
    memset(map, GRRL_UNMAPPED, GRRL_MAX_LINKS);
    map[search->step[0].vertex] = root_image;
    for (uint8_t i = 0; i < search->pattern->graph->n; i++) {
        uint8_t p = search->step[i].vertex;
        uint8_t parent = search->parent[p];
        struct pairing pairing;
        bool paired = list_children(search, p, map[p], &pairing) &&
                      pair_all(&pairing, parent == GRRL_UNMAPPED ? 0 : grrl_bit(map[parent]));
        for (uint8_t k = 0; paired && k < pairing.n; k++)
            map[pairing.child[k]] = pairing.taken[k];
    }
}

enum grrl_status grrl_match_tree(const struct grrl_match_plan *pattern,
                                 const struct grrl_match_plan *target, uint8_t pattern_vertex,
                                 uint32_t *images, uint8_t *map)
{
    uint8_t n = pattern->graph->n;
    if (n == 0 || !is_forest(pattern, 1) || !is_forest(target, GRRL_MAX_LINKS))
        return GRRL_ERR_UNDECIDED;
    struct tree_search search;
    search.pattern = pattern;
    search.target = target;
    grrl_match_order_from(search.step, pattern->graph, pattern_vertex);
    *images = 0;
    for (uint8_t i = n; i-- > 0;) {
        uint8_t p = search.step[i].vertex;
        search.parent[p] = search.step[i].parent;
        for (uint8_t t = 0; t < target->graph->n; t++) {
            search.spare[p][t] = spare_neighbours(&search, p, t);
            if (i == 0 && search.spare[p][t] != 0)
                *images |= grrl_bit(t);
        }
    }
    if (map != NULL && *images != 0)
        write_map(&search, grrl_first_bit(*images), map);
    return GRRL_OK;
}
