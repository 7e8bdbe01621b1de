#include "experience_private.h"

#include <assert.h>
#include <string.h>

#include "bits.h"
#include "grrl/geometry.h"

void grrl_experience_init(struct grrl_experience_store *store, struct grrl_experience_state *states,
                          uint16_t states_capacity, struct grrl_experience *experiences,
                          uint16_t experiences_capacity)
{
    assert(states_capacity >= 1 && experiences_capacity >= 1);
    *store = (struct grrl_experience_store){.states = states,
                                            .experiences = experiences,
                                            .states_capacity = states_capacity,
                                            .experiences_capacity = experiences_capacity};
}

bool grrl_experience_describe(const struct grrl_graph *graph, struct grrl_canonical *canonical,
                              uint32_t *shape)
{
    struct grrl_canonical bare;
    if (grrl_canonical(graph, GRRL_NO_PROPERTIES, GRRL_CANONICAL_BUDGET, &bare) != GRRL_OK ||
        grrl_canonical(graph, GRRL_ALL_PROPERTIES, GRRL_CANONICAL_BUDGET, canonical) != GRRL_OK) {
        return false;
    }
    *shape = bare.hash;
    return true;
}

void grrl_experience_count_joints(const struct grrl_graph *graph, uint8_t *joints)
{
    for (int type = 0; type < GRRL_JOINT_TYPES; ++type) {
        unsigned ends = 0;
        for (uint8_t i = 0; i < graph->n; ++i) {
            ends += grrl_bit_count(graph->joined[type][i]);
        }
        joints[type] = (uint8_t)(ends / 2);
    }
}

int grrl_experience_find_state(const struct grrl_experience_store *store,
                               const struct grrl_canonical *canonical)
{
    for (uint16_t i = 0; i < store->n_states; ++i) {
        if (store->states[i].hash == canonical->hash &&
            grrl_graph_equal(&store->states[i].graph, &canonical->graph, GRRL_ALL_PROPERTIES)) {
            return i;
        }
    }
    return GRRL_NO_STATE;
}

uint16_t grrl_experience_find(const struct grrl_experience_store *store, uint16_t state,
                              uint8_t link, uint8_t direction)
{
    uint16_t i = store->states[state].first;
    while (i != GRRL_NO_EXPERIENCE &&
           (store->experiences[i].link != link || store->experiences[i].direction != direction)) {
        i = store->experiences[i].next;
    }
    return i;
}

uint16_t grrl_experience_add_state(struct grrl_experience_store *store,
                                   const struct grrl_canonical *canonical, uint32_t shape)
{
    assert(store->n_states < store->states_capacity);
    struct grrl_experience_state *added = &store->states[store->n_states];
    memset(added, 0, sizeof *added);
    added->hash = canonical->hash;
    added->shape = shape;
    added->first = GRRL_NO_EXPERIENCE;
    added->graph = canonical->graph;
    grrl_experience_count_joints(&added->graph, added->joints);
    return store->n_states++;
}

uint16_t grrl_experience_add(struct grrl_experience_store *store, uint16_t state, uint8_t link,
                             uint8_t direction)
{
    assert(store->n_experiences < store->experiences_capacity);
    uint16_t index = store->n_experiences++;
    if (store->n_experiences > store->high_water) {
        store->high_water = store->n_experiences;
    }
    struct grrl_experience_state *owner = &store->states[state];
    store->experiences[index] = (struct grrl_experience){
        .state = state, .next = owner->first, .link = link, .direction = direction};
    owner->first = index;
    ++owner->experiences;
    return index;
}

/* The place in the state's list that holds `index`. */
static uint16_t *reference_to(struct grrl_experience_store *store, uint16_t state, uint16_t index)
{
    uint16_t *reference = &store->states[state].first;
    while (*reference != index) {
        reference = &store->experiences[*reference].next;
    }
    return reference;
}

static void remove_state(struct grrl_experience_store *store, uint16_t state)
{
    uint16_t last = --store->n_states;
    if (state == last) {
        return;
    }
    store->states[state] = store->states[last];
    for (uint16_t i = store->states[state].first; i != GRRL_NO_EXPERIENCE;
         i = store->experiences[i].next) {
        store->experiences[i].state = state;
    }
}

static void remove_experience(struct grrl_experience_store *store, uint16_t index)
{
    uint16_t state = store->experiences[index].state;
    *reference_to(store, state, index) = store->experiences[index].next;
    uint16_t last = --store->n_experiences;
    if (index != last) {
        *reference_to(store, store->experiences[last].state, last) = index;
        store->experiences[index] = store->experiences[last];
    }
    ++store->evictions;
    if (--store->states[state].experiences == 0) {
        remove_state(store, state);
    }
}

static void evict_experience(struct grrl_experience_store *store)
{
    uint16_t oldest = 0;
    for (uint16_t i = 1; i < store->n_experiences; ++i) {
        if (store->experiences[i].used_at < store->experiences[oldest].used_at) {
            oldest = i;
        }
    }
    remove_experience(store, oldest);
}

/* The order in a list depends on the store's history, which a file does not have; this does not. */
static uint16_t highest_of(const struct grrl_experience_store *store, uint16_t state)
{
    uint16_t highest = store->states[state].first;
    for (uint16_t i = highest; i != GRRL_NO_EXPERIENCE; i = store->experiences[i].next) {
        highest = i > highest ? i : highest;
    }
    return highest;
}

static void evict_state(struct grrl_experience_store *store)
{
    uint16_t oldest = 0;
    uint32_t oldest_used_at = UINT32_MAX;
    for (uint16_t state = 0; state < store->n_states; ++state) {
        uint32_t used_at = 0;
        for (uint16_t i = store->states[state].first; i != GRRL_NO_EXPERIENCE;
             i = store->experiences[i].next) {
            used_at =
                store->experiences[i].used_at > used_at ? store->experiences[i].used_at : used_at;
        }
        if (used_at < oldest_used_at) {
            oldest = state;
            oldest_used_at = used_at;
        }
    }
    for (uint16_t left = store->states[oldest].experiences; left > 0; --left) {
        remove_experience(store, highest_of(store, oldest));
    }
}

/* The entry of a canonical state's action, made if there is none, and room for it if needed. */
static uint16_t find_or_make(struct grrl_experience_store *store,
                             const struct grrl_canonical *canonical, uint32_t shape, uint8_t link,
                             uint8_t direction)
{
    int state = grrl_experience_find_state(store, canonical);
    if (state != GRRL_NO_STATE) {
        uint16_t known = grrl_experience_find(store, (uint16_t)state, link, direction);
        if (known != GRRL_NO_EXPERIENCE) {
            return known;
        }
    }
    if (store->n_experiences == store->experiences_capacity) {
        evict_experience(store);
        state = grrl_experience_find_state(store, canonical); /* may have moved, or gone with it */
    }
    if (state == GRRL_NO_STATE) {
        if (store->n_states == store->states_capacity) {
            evict_state(store);
        }
        state = grrl_experience_add_state(store, canonical, shape);
    }
    return grrl_experience_add(store, (uint16_t)state, link, direction);
}

/* Welford's running mean and sum of squared deviations, and the Q-learning estimate. */
static void meet(struct grrl_q *q, float target, float alpha)
{
    q->value = q->n == 0 ? target : (1.0f - alpha) * q->value + alpha * target;
    if (q->n < UINT32_MAX) {
        ++q->n;
    }
    float off = target - q->mean;
    q->mean += off / (float)q->n;
    q->deviations += off * (target - q->mean);
}

enum grrl_status grrl_experience_update(struct grrl_experience_store *store,
                                        const struct grrl_graph *state, uint8_t link,
                                        uint8_t direction, float target, float alpha,
                                        uint16_t *index)
{
    if (link >= state->n || direction >= GRRL_DIRECTIONS || !(alpha > 0.0f && alpha <= 1.0f)) {
        return GRRL_ERR_ARGUMENT;
    }
    if (!(target >= -GRRL_MAX_TARGET && target <= GRRL_MAX_TARGET)) {
        return GRRL_ERR_NUMBER;
    }
    struct grrl_canonical canonical;
    uint32_t shape;
    if (!grrl_experience_describe(state, &canonical, &shape)) {
        return GRRL_ERR_UNDECIDED;
    }
    uint8_t vertex = 0;
    while (canonical.order[vertex] != link) {
        ++vertex;
    }
    /* An undecided pair counts as not symmetric: two entries for one action, but no wrong one. */
    uint8_t orbit[GRRL_MAX_LINKS];
    enum grrl_status symmetry =
        grrl_match_orbits(&canonical.graph, GRRL_ALL_PROPERTIES, GRRL_MATCH_BUDGET, orbit);
    (void)symmetry;
    uint16_t entry = find_or_make(store, &canonical, shape, orbit[vertex], direction);
    meet(&store->experiences[entry].q, target, alpha);
    grrl_experience_touch(store, entry);
    if (index != NULL) {
        *index = entry;
    }
    return GRRL_OK;
}

void grrl_experience_touch(struct grrl_experience_store *store, uint16_t index)
{
    assert(index < store->n_experiences);
    store->experiences[index].used_at = ++store->clock;
}
