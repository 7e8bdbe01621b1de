/* Canonical forms: colour refinement, then a search where refinement leaves a choice. */
#include "grrl/structure/canonical.h"

#include <string.h>

#include "base/bits.h"

/*
 * An ordered partition of a component's vertices. cell[s] is the set of vertices at positions s ..
 * s + size - 1, or 0 where no cell starts. Splitting a cell moves no other cell.
 */
struct partition {
    uint32_t cell[GRRL_MAX_LINKS];
};

/* A component with ordered vertices, as rows of joints between positions. */
struct leaf {
    uint8_t order[GRRL_MAX_LINKS];
    uint32_t row[GRRL_JOINT_TYPES][GRRL_MAX_LINKS];
};

/* One level of the search: a partition, one of its cells, and that cell's untried vertices. */
struct level {
    struct partition partition;
    uint8_t start;
    uint8_t vertex; /* currently individualised */
    uint32_t untried;
    uint32_t tried;
    uint8_t orbit[GRRL_MAX_LINKS]; /* under automorphisms that fix the vertices of earlier levels */
};

struct search {
    const struct grrl_graph *graph;
    grrl_label mask;
    uint32_t vertices; /* of the component */
    uint32_t core;     /* vertices on loops or between loops */
    uint8_t n;
    uint32_t budget; /* refinements left */
    int depth;       /* levels in use */
    struct level levels[GRRL_MAX_LINKS];
    bool has_best;
    int best_depth;
    uint8_t best_path[GRRL_MAX_LINKS];
    struct leaf best;
};

/* --- refinement ------------------------------------------------------------------------------- */

/* Splits the cell at `start` by the number of joints of this type into the splitter, lowest count
 * first. Returns the starts of the fragments, or 0 if the cell stays whole. */
static uint32_t split_cell(const struct search *search, struct partition *partition, uint8_t start,
                           int type, uint32_t splitter)
{
    uint32_t by_count[GRRL_MAX_LINKS];
    uint32_t present = 0; /* counts that occur; all are below GRRL_MAX_LINKS */
    for (uint32_t rest = partition->cell[start]; rest != 0; rest &= rest - 1u) {
        uint8_t v = grrl_first_bit(rest);
        unsigned count = grrl_bit_count(search->graph->joined[type][v] & splitter);
        if ((present & grrl_bit(count)) == 0)
            by_count[count] = 0;
        present |= grrl_bit(count);
        by_count[count] |= grrl_bit(v);
    }
    if ((present & (present - 1u)) == 0)
        return 0;
    uint32_t fragments = 0;
    unsigned at = start;
    for (; present != 0; present &= present - 1u) {
        uint32_t fragment = by_count[grrl_first_bit(present)];
        partition->cell[at] = fragment;
        fragments |= grrl_bit(at);
        at += grrl_bit_count(fragment);
    }
    return fragments;
}

/*
 * Splits cells until all vertices of a cell have the same number of joints of each type into every
 * cell. pending: starts of the cells to split by. The result depends only on positions, never on
 * vertex numbers, so isomorphic graphs are refined alike.
 */
static bool refine(struct search *search, struct partition *partition, uint32_t pending)
{
    if (search->budget == 0)
        return false;
    search->budget--;
    while (pending != 0) {
        uint8_t by = grrl_first_bit(pending);
        pending &= pending - 1u;
        uint32_t splitter = partition->cell[by];
        for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
            uint32_t touched = 0;
            for (uint32_t rest = splitter; rest != 0; rest &= rest - 1u)
                touched |= search->graph->joined[type][grrl_first_bit(rest)];
            unsigned size;
            for (unsigned start = 0; start < search->n && touched != 0; start += size) {
                uint32_t cell = partition->cell[start];
                size = grrl_bit_count(cell);
                if (size > 1 && (cell & touched) != 0)
                    pending |= split_cell(search, partition, (uint8_t)start, type, splitter);
            }
        }
    }
    return true;
}

/* Moves one vertex of a cell to the cell's first position, then refines. */
static bool individualise(struct search *search, struct partition *partition, uint8_t start,
                          uint8_t vertex)
{
    partition->cell[start + 1] = partition->cell[start] & ~grrl_bit(vertex);
    partition->cell[start] = grrl_bit(vertex);
    return refine(search, partition, grrl_bit(start));
}

/* The vertices left after repeatedly removing links with at most one joint. */
static uint32_t find_core(const struct grrl_graph *graph, uint32_t vertices)
{
    uint32_t core = vertices;
    uint32_t before;
    do {
        before = core;
        for (uint32_t rest = before; rest != 0; rest &= rest - 1u) {
            uint8_t v = grrl_first_bit(rest);
            if (grrl_bit_count(grrl_graph_neighbours(graph, v) & core) < 2)
                core &= ~grrl_bit(v);
        }
    } while (core != before);
    return core;
}

/* Cells by label; vertices outside the core come before those in it. */
static bool first_partition(struct search *search, struct partition *partition)
{
    memset(partition, 0, sizeof *partition);
    uint32_t starts = 0;
    unsigned at = 0;
    for (uint32_t rest = search->vertices; rest != 0;) {
        grrl_label smallest = UINT64_MAX;
        for (uint32_t v = rest; v != 0; v &= v - 1u) {
            grrl_label label = search->graph->label[grrl_first_bit(v)];
            label = grrl_label_masked(label, search->mask);
            smallest = label < smallest ? label : smallest;
        }
        uint32_t same = 0;
        for (uint32_t v = rest; v != 0; v &= v - 1u) {
            grrl_label label = search->graph->label[grrl_first_bit(v)];
            if (grrl_label_masked(label, search->mask) == smallest)
                same |= v & (0u - v);
        }
        rest &= ~same;
        const uint32_t parts[2] = {same & ~search->core, same & search->core};
        for (int i = 0; i < 2; i++) {
            if (parts[i] == 0)
                continue;
            partition->cell[at] = parts[i];
            starts |= grrl_bit(at);
            at += grrl_bit_count(parts[i]);
        }
    }
    return refine(search, partition, starts);
}

/* --- leaves ----------------------------------------------------------------------------------- */

static void fill_rows(const struct grrl_graph *graph, uint8_t n, struct leaf *leaf)
{
    uint8_t place[GRRL_MAX_LINKS] = {0};
    for (uint8_t i = 0; i < n; i++)
        place[leaf->order[i]] = i;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        for (uint8_t i = 0; i < n; i++) {
            uint32_t joined = graph->joined[type][leaf->order[i]];
            leaf->row[type][i] = 0;
            for (; joined != 0; joined &= joined - 1u)
                leaf->row[type][i] |= grrl_bit(place[grrl_first_bit(joined)]);
        }
    }
}

static int compare_rows(const struct leaf *a, const struct leaf *b, uint8_t n)
{
    for (uint8_t i = 0; i < n; i++)
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            if (a->row[type][i] != b->row[type][i])
                return a->row[type][i] < b->row[type][i] ? -1 : 1;
    return 0;
}

/*
 * Every vertex of the core has a position of its own. What hangs on the core, or a component that
 * is a tree, is a forest. Its vertices within one cell are symmetric, so any of them may come
 * first.
 */
static bool finish_trees(struct search *search, struct partition *partition)
{
    for (unsigned start = 0; start < search->n; start++) {
        while (grrl_bit_count(partition->cell[start]) > 1)
            if (!individualise(search, partition, (uint8_t)start,
                               grrl_first_bit(partition->cell[start])))
                return false;
    }
    return true;
}

/* --- search ----------------------------------------------------------------------------------- */

/* The first of the smallest core cells with more than one vertex; n if there is none. */
static uint8_t choose_cell(const struct search *search, const struct partition *partition)
{
    uint8_t chosen = search->n;
    unsigned chosen_size = GRRL_MAX_LINKS + 1;
    unsigned size;
    for (unsigned start = 0; start < search->n; start += size) {
        size = grrl_bit_count(partition->cell[start]);
        if (size > 1 && size < chosen_size && (partition->cell[start] & search->core) != 0) {
            chosen = (uint8_t)start;
            chosen_size = size;
        }
    }
    return chosen;
}

static void join_orbits(uint8_t *orbit, uint8_t a, uint8_t b)
{
    uint8_t kept = orbit[a] < orbit[b] ? orbit[a] : orbit[b];
    uint8_t dropped = orbit[a] < orbit[b] ? orbit[b] : orbit[a];
    for (uint8_t i = 0; i < GRRL_MAX_LINKS; i++)
        if (orbit[i] == dropped)
            orbit[i] = kept;
}

/*
 * A leaf equal to the best one reveals an automorphism. It fixes the common part of the two paths,
 * so it merges orbits there. It also maps the subtree already searched through the best leaf onto
 * the subtree of this leaf, so this subtree is done.
 */
static void use_automorphism(struct search *search, const struct leaf *leaf)
{
    int common = 0;
    while (common < search->depth && common < search->best_depth &&
           search->levels[common].vertex == search->best_path[common])
        common++;
    for (int depth = 0; depth <= common && depth < search->depth; depth++)
        for (uint8_t i = 0; i < search->n; i++)
            join_orbits(search->levels[depth].orbit, search->best.order[i], leaf->order[i]);
    if (common + 1 < search->depth)
        search->depth = common + 1;
}

static bool visit_leaf(struct search *search, struct partition *partition)
{
    if (!finish_trees(search, partition))
        return false;
    struct leaf leaf;
    for (uint8_t i = 0; i < search->n; i++)
        leaf.order[i] = grrl_first_bit(partition->cell[i]);
    fill_rows(search->graph, search->n, &leaf);
    int order = search->has_best ? compare_rows(&leaf, &search->best, search->n) : -1;
    if (order == 0) {
        use_automorphism(search, &leaf);
    } else if (order < 0) {
        search->has_best = true;
        search->best = leaf;
        search->best_depth = search->depth;
        for (int i = 0; i < search->depth; i++)
            search->best_path[i] = search->levels[i].vertex;
    }
    return true;
}

/* Opens a level for the partition, or visits it if it is a leaf. */
static bool descend(struct search *search, struct partition *partition)
{
    uint8_t start = choose_cell(search, partition);
    if (start == search->n)
        return visit_leaf(search, partition);
    struct level *level = &search->levels[search->depth++];
    level->partition = *partition;
    level->start = start;
    level->untried = partition->cell[start];
    level->tried = 0;
    for (uint8_t i = 0; i < GRRL_MAX_LINKS; i++)
        level->orbit[i] = i;
    return true;
}

/* Whether an automorphism maps this vertex onto one already tried at this level. */
static bool is_symmetric(const struct level *level, uint8_t vertex)
{
    for (uint32_t rest = level->tried; rest != 0; rest &= rest - 1u)
        if (level->orbit[grrl_first_bit(rest)] == level->orbit[vertex])
            return true;
    return false;
}

/* Finds the canonical order of one component, in search->best. */
static enum grrl_status search_component(struct search *search, uint32_t vertices)
{
    search->vertices = vertices;
    search->core = find_core(search->graph, vertices);
    search->n = (uint8_t)grrl_bit_count(vertices);
    search->depth = 0;
    search->has_best = false;
    struct partition partition;
    bool within = first_partition(search, &partition) && descend(search, &partition);
    while (within && search->depth > 0) {
        struct level *level = &search->levels[search->depth - 1];
        if (level->untried == 0) {
            search->depth--;
            continue;
        }
        level->vertex = grrl_first_bit(level->untried);
        level->untried &= level->untried - 1u;
        if (is_symmetric(level, level->vertex))
            continue;
        level->tried |= grrl_bit(level->vertex);
        partition = level->partition;
        within = individualise(search, &partition, level->start, level->vertex) &&
                 descend(search, &partition);
    }
    return within ? GRRL_OK : GRRL_ERR_UNDECIDED;
}

/* --- components side by side ------------------------------------------------------------------ */

/* By size, labels and rows. Two components compare equal if and only if they are isomorphic. */
static int compare_components(const struct search *search, const uint8_t *a, uint8_t n_a,
                              const uint8_t *b, uint8_t n_b)
{
    if (n_a != n_b)
        return n_a < n_b ? -1 : 1;
    for (uint8_t i = 0; i < n_a; i++) {
        grrl_label in_a = grrl_label_masked(search->graph->label[a[i]], search->mask);
        grrl_label in_b = grrl_label_masked(search->graph->label[b[i]], search->mask);
        if (in_a != in_b)
            return in_a < in_b ? -1 : 1;
    }
    struct leaf leaf_a;
    struct leaf leaf_b;
    memcpy(leaf_a.order, a, n_a);
    memcpy(leaf_b.order, b, n_b);
    fill_rows(search->graph, n_a, &leaf_a);
    fill_rows(search->graph, n_b, &leaf_b);
    return compare_rows(&leaf_a, &leaf_b, n_a);
}

/* Inserts the component in search->best among the sorted ones before it in `order`. */
static void insert_component(const struct search *search, uint8_t *order, uint8_t *sizes,
                             uint8_t *n_components, uint8_t *n_placed)
{
    uint8_t at = *n_placed;
    uint8_t i = *n_components;
    while (i > 0) {
        const uint8_t *previous = order + at - sizes[i - 1];
        if (compare_components(search, previous, sizes[i - 1], search->best.order, search->n) <= 0)
            break;
        at = (uint8_t)(at - sizes[i - 1]);
        sizes[i] = sizes[i - 1];
        i--;
    }
    memmove(order + at + search->n, order + at, (size_t)(*n_placed - at));
    memcpy(order + at, search->best.order, search->n);
    sizes[i] = search->n;
    (*n_components)++;
    *n_placed = (uint8_t)(*n_placed + search->n);
}

/* FNV-1a over the bytes of a number, lowest byte first on every machine. */
static uint32_t hash_number(uint32_t hash, uint64_t number, int bytes)
{
    for (int i = 0; i < bytes; i++) {
        hash ^= (uint32_t)(number >> (8 * i) & 0xffu);
        hash *= UINT32_C(16777619);
    }
    return hash;
}

static uint32_t hash_graph(const struct grrl_graph *graph)
{
    uint32_t hash = hash_number(UINT32_C(2166136261), graph->n, 1);
    for (uint8_t i = 0; i < graph->n; i++) {
        hash = hash_number(hash, graph->label[i], 8);
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            hash = hash_number(hash, graph->joined[type][i], 4);
    }
    return hash;
}

enum grrl_status grrl_canonical_of(const struct grrl_graph *graph, grrl_label mask, uint32_t budget,
                                   struct grrl_canonical *canonical)
{
    struct search search;
    search.graph = graph;
    search.mask = mask;
    search.budget = budget;
    uint8_t order[GRRL_MAX_LINKS];
    uint8_t sizes[GRRL_MAX_LINKS];
    uint8_t n_components = 0;
    uint8_t n_placed = 0;
    for (uint32_t rest = grrl_bits_below(graph->n); rest != 0;) {
        uint32_t component = grrl_graph_component(graph, grrl_first_bit(rest));
        enum grrl_status status = search_component(&search, component);
        if (status != GRRL_OK)
            return status;
        insert_component(&search, order, sizes, &n_components, &n_placed);
        rest &= ~component;
    }
    grrl_graph_permute(graph, order, &canonical->graph);
    for (uint8_t i = 0; i < graph->n; i++)
        canonical->graph.label[i] = grrl_label_masked(canonical->graph.label[i], mask);
    memcpy(canonical->order, order, graph->n);
    canonical->hash = hash_graph(&canonical->graph);
    return GRRL_OK;
}
