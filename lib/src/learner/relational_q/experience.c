/* experience.c: the store: hash tables, updates and eviction. */
#include "learner/relational_q/experience_private.h"

#include <assert.h>
#include <string.h>

#include "base/bits.h"
#include "grrl/base/geometry.h"

_Static_assert(GRRL_MAX_JOINTS > 64 ||
                   sizeof(struct grrl_experience_state) + sizeof(struct grrl_experience_row) <= 512,
               "a stored state and its row in the index");

void grrl_experience_init(struct grrl_experience_store *store, struct grrl_experience_state *states,
                          uint32_t states_capacity, struct grrl_experience *experiences,
                          uint32_t experiences_capacity)
{
    *store = (struct grrl_experience_store){.states = states,
                                            .experiences = experiences,
                                            .states_capacity = states_capacity,
                                            .experiences_capacity = experiences_capacity};
    for (uint32_t i = 0; i < states_capacity; i++)
        for (int table = 0; table < GRRL_EXPERIENCE_TABLES; table++)
            states[i].head[table] = GRRL_NO_STATE;
}

void grrl_experience_clear(struct grrl_experience_store *store)
{
    struct grrl_experience_index *index = store->index;
    grrl_experience_init(store, store->states, store->states_capacity, store->experiences,
                         store->experiences_capacity);
    store->index = index;
    if (index != NULL)
        grrl_experience_index_clear(index);
}

void grrl_experience_use_index(struct grrl_experience_store *store,
                               struct grrl_experience_index *index,
                               struct grrl_experience_row *rows)
{
    store->index = index;
    index->rows = rows;
    grrl_experience_index_clear(index);
    for (uint32_t i = 0; i < store->n_states; i++)
        grrl_experience_index_add(index, &store->states[i], i);
}

void grrl_experience_graph(const struct grrl_experience_state *state, struct grrl_graph *graph)
{
    grrl_graph_clear(graph);
    graph->n = state->n;
    memcpy(graph->label, state->label, state->n * sizeof state->label[0]);
    unsigned n_edges = (unsigned)state->joints[GRRL_REVOLUTE] + state->joints[GRRL_PRISMATIC];
    for (unsigned i = 0; i < n_edges; i++) {
        unsigned type = state->edge[i] >> 10;
        unsigned a = state->edge[i] >> 5 & 31u;
        unsigned b = state->edge[i] & 31u;
        graph->joined[type][a] |= grrl_bit(b);
        graph->joined[type][b] |= grrl_bit(a);
    }
}

bool grrl_experience_describe(const struct grrl_graph *graph, struct grrl_experience_state *state,
                              uint8_t *order)
{
    struct grrl_canonical bare;
    struct grrl_canonical full;
    if (grrl_canonical_of(graph, GRRL_NO_PROPERTIES, GRRL_CANONICAL_BUDGET, &bare) != GRRL_OK ||
        grrl_canonical_of(graph, GRRL_ALL_PROPERTIES, GRRL_CANONICAL_BUDGET, &full) != GRRL_OK)
        return false;
    memset(state, 0, sizeof *state);
    state->key[GRRL_TABLE_EXACT] = full.hash;
    state->key[GRRL_TABLE_SHAPE] = bare.hash;
    state->first = GRRL_NO_EXPERIENCE;
    state->n = graph->n;
    memcpy(state->label, full.graph.label, graph->n * sizeof state->label[0]);
    unsigned n_edges = 0;
    for (unsigned a = 0; a < graph->n; a++) {
        for (unsigned type = 0; type < GRRL_JOINT_TYPES; type++) {
            uint32_t lower = full.graph.joined[type][a] & (grrl_bit(a) - 1u);
            for (; lower != 0; lower &= lower - 1u) {
                state->edge[n_edges++] = (uint16_t)(type << 10 | a << 5 | grrl_first_bit(lower));
                state->joints[type]++;
            }
        }
    }
    grrl_signature_of(graph, GRRL_ALL_PROPERTIES, &state->signature);
    grrl_paths_of(graph, &state->paths);
    if (order != NULL)
        memcpy(order, full.order, graph->n);
    return true;
}

/* --- tables ----------------------------------------------------------------------------------- */

static uint32_t *bucket_of(const struct grrl_experience_store *store, int table, uint32_t key)
{
    uint32_t spread = key * UINT32_C(0x9e3779b1);
    return &store->states[(uint64_t)spread * store->states_capacity >> 32].head[table];
}

static uint32_t skip_others(const struct grrl_experience_store *store, int table, uint32_t key,
                            uint32_t i)
{
    while (i != GRRL_NO_STATE && store->states[i].key[table] != key)
        i = store->states[i].chain[table];
    return i;
}

uint32_t grrl_experience_first_in(const struct grrl_experience_store *store, int table,
                                  uint32_t key)
{
    return store->n_states == 0 ? GRRL_NO_STATE
                                : skip_others(store, table, key, *bucket_of(store, table, key));
}

uint32_t grrl_experience_next_in(const struct grrl_experience_store *store, int table, uint32_t key,
                                 uint32_t from)
{
    return skip_others(store, table, key, store->states[from].chain[table]);
}

/* Adds a state to its buckets and the index, or removes it. */
static void link_state(struct grrl_experience_store *store, uint32_t state)
{
    for (int table = 0; table < GRRL_EXPERIENCE_TABLES; table++) {
        uint32_t *head = bucket_of(store, table, store->states[state].key[table]);
        store->states[state].chain[table] = *head;
        *head = state;
    }
    if (store->index != NULL)
        grrl_experience_index_add(store->index, &store->states[state], state);
}

static void unlink_state(struct grrl_experience_store *store, uint32_t state)
{
    for (int table = 0; table < GRRL_EXPERIENCE_TABLES; table++) {
        uint32_t *reference = bucket_of(store, table, store->states[state].key[table]);
        while (*reference != state)
            reference = &store->states[*reference].chain[table];
        *reference = store->states[state].chain[table];
    }
    if (store->index != NULL)
        grrl_experience_index_remove(store->index, &store->states[state], state);
}

static bool same_structure(const struct grrl_experience_state *a,
                           const struct grrl_experience_state *b)
{
    unsigned n_edges = (unsigned)a->joints[GRRL_REVOLUTE] + a->joints[GRRL_PRISMATIC];
    return a->n == b->n && memcmp(a->joints, b->joints, sizeof a->joints) == 0 &&
           memcmp(a->edge, b->edge, n_edges * sizeof a->edge[0]) == 0 &&
           memcmp(a->label, b->label, a->n * sizeof a->label[0]) == 0;
}

uint32_t grrl_experience_find_state(const struct grrl_experience_store *store,
                                    const struct grrl_experience_state *described)
{
    uint32_t key = described->key[GRRL_TABLE_EXACT];
    uint32_t i = grrl_experience_first_in(store, GRRL_TABLE_EXACT, key);
    while (i != GRRL_NO_STATE && !same_structure(&store->states[i], described))
        i = grrl_experience_next_in(store, GRRL_TABLE_EXACT, key, i);
    return i;
}

/* Moves a state to another place; the bucket heads stay with the place. */
static void copy_state(struct grrl_experience_state *place,
                       const struct grrl_experience_state *state)
{
    uint32_t head[GRRL_EXPERIENCE_TABLES];
    memcpy(head, place->head, sizeof head);
    *place = *state;
    memcpy(place->head, head, sizeof head);
}

uint32_t grrl_experience_find(const struct grrl_experience_store *store, uint32_t state,
                              uint8_t link, uint8_t direction)
{
    uint32_t i = store->states[state].first;
    while (i != GRRL_NO_EXPERIENCE &&
           (store->experiences[i].link != link || store->experiences[i].direction != direction))
        i = store->experiences[i].next;
    return i;
}

uint32_t grrl_experience_add_state(struct grrl_experience_store *store,
                                   const struct grrl_experience_state *described)
{
    assert(store->n_states < store->states_capacity);
    uint32_t added = store->n_states++;
    copy_state(&store->states[added], described);
    link_state(store, added);
    return added;
}

uint32_t grrl_experience_add(struct grrl_experience_store *store, uint32_t state, uint8_t link,
                             uint8_t direction)
{
    assert(store->n_experiences < store->experiences_capacity);
    uint32_t index = store->n_experiences++;
    if (store->n_experiences > store->high_water)
        store->high_water = store->n_experiences;
    struct grrl_experience_state *owner = &store->states[state];
    store->experiences[index] = (struct grrl_experience){
        .state = state, .next = owner->first, .link = link, .direction = direction};
    owner->first = index;
    owner->experiences++;
    return index;
}

/* The list element that holds `index`. */
static uint32_t *list_element(struct grrl_experience_store *store, uint32_t state, uint32_t index)
{
    uint32_t *reference = &store->states[state].first;
    while (*reference != index)
        reference = &store->experiences[*reference].next;
    return reference;
}

void grrl_experience_remove_state(struct grrl_experience_store *store, uint32_t state)
{
    uint32_t last = --store->n_states;
    unlink_state(store, state);
    if (state == last)
        return;
    unlink_state(store, last);
    copy_state(&store->states[state], &store->states[last]);
    link_state(store, state);
    for (uint32_t i = store->states[state].first; i != GRRL_NO_EXPERIENCE;
         i = store->experiences[i].next)
        store->experiences[i].state = state;
}

static void remove_experience(struct grrl_experience_store *store, uint32_t index)
{
    uint32_t state = store->experiences[index].state;
    *list_element(store, state, index) = store->experiences[index].next;
    uint32_t last = --store->n_experiences;
    if (index != last) {
        *list_element(store, store->experiences[last].state, last) = index;
        store->experiences[index] = store->experiences[last];
    }
    store->evictions++;
    if (--store->states[state].experiences == 0)
        grrl_experience_remove_state(store, state);
}

static void evict_experience(struct grrl_experience_store *store)
{
    uint32_t oldest = 0;
    for (uint32_t i = 1; i < store->n_experiences; i++)
        if (store->experiences[i].used_at < store->experiences[oldest].used_at)
            oldest = i;
    remove_experience(store, oldest);
}

/* Removal goes by index, because the order in a list depends on the store's history, which a file
 * does not keep. */
static uint32_t highest_of(const struct grrl_experience_store *store, uint32_t state)
{
    uint32_t highest = store->states[state].first;
    for (uint32_t i = highest; i != GRRL_NO_EXPERIENCE; i = store->experiences[i].next)
        highest = i > highest ? i : highest;
    return highest;
}

static void evict_state(struct grrl_experience_store *store)
{
    uint32_t oldest = 0;
    uint32_t oldest_used_at = UINT32_MAX;
    for (uint32_t state = 0; state < store->n_states; state++) {
        uint32_t used_at = 0;
        for (uint32_t i = store->states[state].first; i != GRRL_NO_EXPERIENCE;
             i = store->experiences[i].next) {
            used_at =
                store->experiences[i].used_at > used_at ? store->experiences[i].used_at : used_at;
        }
        if (used_at < oldest_used_at) {
            oldest = state;
            oldest_used_at = used_at;
        }
    }
    for (uint32_t left = store->states[oldest].experiences; left > 0; --left)
        remove_experience(store, highest_of(store, oldest));
}

/* Finds the experience of a canonical state's action, or makes one and evicts if necessary. */
static uint32_t find_or_make(struct grrl_experience_store *store,
                             const struct grrl_experience_state *described, uint8_t link,
                             uint8_t direction)
{
    uint32_t state = grrl_experience_find_state(store, described);
    if (state != GRRL_NO_STATE) {
        uint32_t known = grrl_experience_find(store, state, link, direction);
        if (known != GRRL_NO_EXPERIENCE)
            return known;
    }
    if (store->n_experiences == store->experiences_capacity) {
        evict_experience(store);
        state =
            grrl_experience_find_state(store, described); /* may have moved, or been removed too */
    }
    if (state == GRRL_NO_STATE) {
        if (store->n_states == store->states_capacity)
            evict_state(store);
        state = grrl_experience_add_state(store, described);
    }
    return grrl_experience_add(store, state, link, direction);
}

/* Updates the Q estimate, and Welford's running mean and sum of squared deviations. */
static void update_q(struct grrl_q *q, float target, float alpha)
{
    q->value = q->n == 0 ? target : (1.0f - alpha) * q->value + alpha * target;
    if (q->n < UINT32_MAX)
        q->n++;
    float off = target - q->mean;
    q->mean += off / (float)q->n;
    q->deviations += off * (target - q->mean);
}

enum grrl_status grrl_experience_update(struct grrl_experience_store *store,
                                        const struct grrl_graph *state, uint8_t link,
                                        uint8_t direction, float target, float alpha,
                                        uint32_t *index)
{
    if (link >= state->n || direction >= GRRL_DIRECTIONS || !(alpha > 0.0f && alpha <= 1.0f))
        return GRRL_ERR_ARGUMENT;
    if (!(target >= -GRRL_MAX_TARGET && target <= GRRL_MAX_TARGET))
        return GRRL_ERR_NUMBER;
    if (store->states_capacity == 0 || store->experiences_capacity == 0)
        return GRRL_ERR_FULL;
    struct grrl_experience_state described;
    uint8_t order[GRRL_MAX_LINKS];
    if (!grrl_experience_describe(state, &described, order))
        return GRRL_ERR_UNDECIDED;
    uint8_t vertex = 0;
    while (order[vertex] != link)
        vertex++;
    /* An undecided pair counts as not symmetric. That costs a second entry for one action, never a
     * wrong one. */
    uint8_t orbit[GRRL_MAX_LINKS];
    struct grrl_graph graph;
    grrl_experience_graph(&described, &graph);
    enum grrl_status symmetry =
        grrl_match_orbits(&graph, GRRL_ALL_PROPERTIES, GRRL_MATCH_BUDGET, orbit);
    (void)symmetry;
    uint32_t entry = find_or_make(store, &described, orbit[vertex], direction);
    update_q(&store->experiences[entry].q, target, alpha);
    grrl_experience_touch(store, entry);
    if (index != NULL)
        *index = entry;
    return GRRL_OK;
}

void grrl_experience_touch(struct grrl_experience_store *store, uint32_t index)
{
    assert(index < store->n_experiences);
    store->experiences[index].used_at = ++store->clock;
}
