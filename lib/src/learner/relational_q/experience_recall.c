/* experience_recall.c: the closest experience for each action of a state. */
#include <string.h>

#include "base/bits.h"
#include "learner/relational_q/closest.h"
#include "learner/relational_q/experience_private.h"
#include "structure/match_private.h"

/*
 * How many mappings of one search to examine before searching for each wanted pair of links
 * separately. Chains have few mappings; a star of n equal links has n factorial.
 */
#define MAPPINGS 32

/* The current state prepared for searches under one mask. */
struct our_side {
    bool made;
    grrl_label mask;
    struct grrl_match_side side;
};

/* The state of one recall, and of the stored state under examination. */
struct job {
    const struct grrl_experience_store *store;
    const struct grrl_recall_config *config;
    const struct grrl_graph *current;
    const struct grrl_experience_state *described; /* the current state as it would be stored */
    grrl_label places;                             /* its properties in use, as mask bytes */
    struct grrl_recall *recall;
    uint32_t budget;                   /* steps left for the stored state */
    uint32_t steps;                    /* steps left for sub-structures, over the whole recall */
    uint32_t open[GRRL_DIRECTIONS];    /* per direction: links whose entry may still improve */
    uint32_t unknown[GRRL_DIRECTIONS]; /* those of them without an entry */
    struct our_side our_sides[2];      /* with all properties, and with some dropped */

    const struct grrl_experience_state *stored;
    struct grrl_graph graph; /* of the stored state */
    enum grrl_match_kind kind;
    bool stored_is_pattern; /* false: the current one is the pattern */
    grrl_label mask;
    const struct grrl_match_side *our; /* side of the current state */
    const struct grrl_match_side *theirs;
    struct grrl_recall_entry closeness; /* level, distance and dropped of all its matches */
};

/* Current links for each link of the stored state. */
struct binding {
    uint32_t to[GRRL_MAX_LINKS];
};

static void clear_binding(struct binding *binding, uint8_t n)
{
    for (uint8_t v = 0; v < n; v++)
        binding->to[v] = 0;
}

/* Whether an experience at the match's closeness is closer than the entry's. */
static bool improves(const struct job *job, uint32_t experience,
                     const struct grrl_recall_entry *entry)
{
    if (entry->experience == GRRL_NO_EXPERIENCE)
        return true;
    const struct grrl_recall_entry *closeness = &job->closeness;
    if (closeness->level != entry->level)
        return closeness->level < entry->level;
    if (closeness->distance != entry->distance)
        return closeness->distance < entry->distance;
    if (closeness->dropped != entry->dropped)
        return closeness->dropped < entry->dropped;
    uint32_t n = job->store->experiences[experience].q.n;
    uint32_t entry_n = job->store->experiences[entry->experience].q.n;
    return n != entry_n ? n > entry_n : experience < entry->experience;
}

/* Current links with this label under the job's mask. */
static uint32_t labelled(const struct job *job, grrl_label label)
{
    uint32_t links = 0;
    for (uint8_t c = 0; c < job->current->n; c++)
        if (grrl_label_masked(job->current->label[c], job->mask) == label)
            links |= grrl_bit(c);
    return links;
}

/* Finds the bindings that would give some action a closer experience; false if there are none. */
static bool wanted_bindings(const struct job *job, struct binding *wanted)
{
    const bool exact = job->kind == GRRL_MATCH_ISOMORPHISM;
    uint32_t all = 0;
    clear_binding(wanted, job->graph.n);
    for (uint32_t i = job->stored->first; i != GRRL_NO_EXPERIENCE;
         i = job->store->experiences[i].next) {
        const struct grrl_experience *experience = &job->store->experiences[i];
        const uint8_t v = experience->link;
        const unsigned direction = experience->direction;
        uint32_t links =
            job->open[direction] &
            (job->stored_is_pattern ? grrl_match_images(job->theirs, v, job->our, exact)
                                    : grrl_match_preimages(job->our, job->theirs, v, exact));
        if (links != 0 && job->mask != GRRL_NO_PROPERTIES)
            links &= labelled(job, job->theirs->label[v]);
        uint32_t known = links & ~job->unknown[direction];
        for (; known != 0; known &= known - 1u) {
            uint8_t c = grrl_first_bit(known);
            if (!improves(job, i, &job->recall->entry[c][direction]))
                links &= ~grrl_bit(c);
        }
        wanted->to[v] |= links;
        all |= links;
    }
    return all != 0;
}

static void add_mapping(const struct job *job, const uint8_t *map, struct binding *found)
{
    uint8_t n = job->stored_is_pattern ? job->graph.n : job->current->n;
    for (uint8_t i = 0; i < n; i++) {
        uint8_t v = job->stored_is_pattern ? i : map[i];
        uint8_t c = job->stored_is_pattern ? map[i] : i;
        found->to[v] |= grrl_bit(c);
    }
}

static bool covers(const struct binding *found, const struct binding *wanted, uint8_t n)
{
    for (uint8_t v = 0; v < n; v++)
        if ((wanted->to[v] & ~found->to[v]) != 0)
            return false;
    return true;
}

/* The label of some link, which few others may have. */
static grrl_label reference_of(const struct job *job)
{
    return job->current->n > 0 ? grrl_label_masked(job->current->label[0], job->mask)
                               : GRRL_NO_PROPERTIES;
}

static const struct grrl_match_side *our_side(struct job *job)
{
    struct our_side *our = &job->our_sides[job->mask != GRRL_ALL_PROPERTIES];
    if (!our->made || our->mask != job->mask)
        grrl_match_side_of(&our->side, job->current, job->mask, reference_of(job));
    our->made = true;
    our->mask = job->mask;
    return &our->side;
}

static bool begin(const struct job *job, struct grrl_match *match)
{
    return grrl_match_begin_sides(match, job->kind, job->stored_is_pattern ? job->theirs : job->our,
                                  job->stored_is_pattern ? job->our : job->theirs, job->budget);
}

/* Searches for a mapping through each wanted pair that none has been found for. */
static void find_pairs(struct job *job, const struct binding *wanted, struct binding *found)
{
    for (uint8_t v = 0; v < job->graph.n; v++) {
        uint32_t missing = wanted->to[v];
        for (; missing != 0 && job->budget > 0; missing &= missing - 1u) {
            uint8_t c = grrl_first_bit(missing);
            if ((found->to[v] & grrl_bit(c)) != 0)
                continue;
            struct grrl_match match;
            uint8_t map[GRRL_MAX_LINKS];
            (void)begin(job, &match); /* true, as it was for all mappings */
            grrl_match_fix(&match, job->stored_is_pattern ? v : c, job->stored_is_pattern ? c : v);
            if (grrl_match_next(&match, map) == GRRL_OK)
                add_mapping(job, map, found);
            job->budget = match.budget;
        }
    }
}

static void find_bindings(struct job *job, struct grrl_match *match, const struct binding *wanted,
                          struct binding *found)
{
    clear_binding(found, job->graph.n);
    for (int i = 0; i < MAPPINGS; i++) {
        uint8_t map[GRRL_MAX_LINKS];
        enum grrl_status status = grrl_match_next(match, map);
        job->budget = match->budget;
        if (status != GRRL_OK)
            return;
        add_mapping(job, map, found);
        if (covers(found, wanted, job->graph.n))
            return;
    }
    find_pairs(job, wanted, found);
}

/* Enters the experiences of the stored state, under the job's kind, mask and closeness. */
static void match_stored(struct job *job)
{
    struct grrl_match_side theirs;
    struct grrl_match match;
    struct binding wanted;
    struct binding found;
    if (job->budget == 0)
        return;
    grrl_match_side_of(&theirs, &job->graph, job->mask, reference_of(job));
    job->theirs = &theirs;
    job->our = our_side(job);
    if (!wanted_bindings(job, &wanted) || !begin(job, &match))
        return;
    find_bindings(job, &match, &wanted, &found);
    for (uint32_t i = job->stored->first; i != GRRL_NO_EXPERIENCE;
         i = job->store->experiences[i].next) {
        const struct grrl_experience *experience = &job->store->experiences[i];
        uint32_t links = found.to[experience->link] & wanted.to[experience->link];
        for (; links != 0; links &= links - 1u) {
            struct grrl_recall_entry *entry =
                &job->recall->entry[grrl_first_bit(links)][experience->direction];
            if (improves(job, i, entry)) {
                *entry = job->closeness;
                entry->experience = i;
                entry->stored_link = experience->link;
                job->unknown[experience->direction] &= ~(links & (0u - links));
            }
        }
    }
}

/* Places of properties in use, as mask bytes. */
static grrl_label places_in_use(const struct grrl_graph *graph)
{
    grrl_label used = 0;
    for (uint8_t i = 0; i < graph->n; i++)
        used |= graph->label[i] == GRRL_LABEL_BACKGROUND ? 0 : graph->label[i];
    grrl_label places = 0;
    for (unsigned place = 0; place < GRRL_MAX_PROPERTIES; place++) {
        grrl_label byte = UINT64_C(0xff) << (8 * place);
        places |= (used & byte) != 0 ? byte : 0;
    }
    return places;
}

/* The places without the last of them. */
static grrl_label drop_last(grrl_label places)
{
    grrl_label last = UINT64_C(0xff) << (8 * (GRRL_MAX_PROPERTIES - 1));
    while ((places & last) == 0)
        last >>= 8;
    return places & ~last;
}

/* Compares isomorphic states with fewer and fewer properties. */
static void match_relaxed(struct job *job)
{
    grrl_label places = job->places | places_in_use(&job->graph);
    job->closeness = (struct grrl_recall_entry){.level = GRRL_RECALL_RELAXED};
    while (places != 0) {
        places = drop_last(places);
        job->mask = places;
        job->closeness.dropped++;
        match_stored(job);
    }
}

/* Compares with all properties, then with none. */
static void match_substructure(struct job *job, uint8_t distance)
{
    grrl_label places = job->places | places_in_use(&job->graph);
    job->closeness =
        (struct grrl_recall_entry){.level = GRRL_RECALL_SUBSTRUCTURE, .distance = distance};
    job->mask = GRRL_ALL_PROPERTIES;
    const struct grrl_signature *stored = &job->stored->signature;
    const struct grrl_signature *current = &job->described->signature;
    if (job->stored_is_pattern ? grrl_signature_within(stored, current, false)
                               : grrl_signature_within(current, stored, false))
        match_stored(job);
    for (; places != 0; places = drop_last(places))
        job->closeness.dropped++;
    if (job->closeness.dropped > 0 && !job->config->strict) {
        job->mask = GRRL_NO_PROPERTIES;
        match_stored(job);
    }
}

static void load_state(struct job *job, uint32_t state)
{
    job->stored = &job->store->states[state];
    job->budget = job->config->budget;
    grrl_experience_graph(job->stored, &job->graph);
}

static void match_isomorphic(struct job *job)
{
    const struct grrl_experience_state *current = job->described;
    job->kind = GRRL_MATCH_ISOMORPHISM;
    job->stored_is_pattern = true;
    uint32_t exact = grrl_experience_find_state(job->store, current);
    if (exact != GRRL_NO_STATE) {
        load_state(job, exact);
        job->mask = GRRL_ALL_PROPERTIES;
        job->closeness = (struct grrl_recall_entry){.level = GRRL_RECALL_EXACT};
        match_stored(job);
    }
    if (job->config->deepest < GRRL_RECALL_RELAXED || job->config->strict)
        return;
    uint32_t shape = current->key[GRRL_TABLE_SHAPE];
    uint32_t i = grrl_experience_first_in(job->store, GRRL_TABLE_SHAPE, shape);
    for (; i != GRRL_NO_STATE;
         i = grrl_experience_next_in(job->store, GRRL_TABLE_SHAPE, shape, i)) {
        const struct grrl_experience_state *stored = &job->store->states[i];
        if (stored->n == current->n &&
            memcmp(stored->joints, current->joints, sizeof current->joints) == 0) {
            load_state(job, i);
            match_relaxed(job);
        }
    }
}

/* --- sub-structures --------------------------------------------------------------------------- */

/* No two states differ by more links and joints than this. */
enum { MAX_DISTANCE = GRRL_MAX_LINKS + GRRL_MAX_JOINTS };

_Static_assert(MAX_DISTANCE <= UINT8_MAX && GRRL_MAX_JOINTS <= INT8_MAX,
               "distances are bytes, and signatures count all links and joints");

/* The number of links and joints, from a signature's counts. */
static unsigned size_of(uint64_t counts)
{
    return (unsigned)((counts & 0xffu) + (counts >> 8 & 0xffu) + (counts >> 16 & 0xffu));
}

_Static_assert(offsetof(struct grrl_experience_state, signature.word[1]) <= 32,
               "half a cache line is all that a scan reads of a state");

/* Finds the closest states without an index, in one pass. A state with as many links and joints as
 * the current one is isomorphic or no match, so it is skipped here. */
static void scan_states(const struct grrl_experience_store *store,
                        const struct grrl_experience_state *current, struct grrl_closest *closest)
{
    enum { AHEAD = 16 }; /* a state takes a few nanoseconds, memory a hundred */
    const uint64_t own_counts = current->signature.word[0];
    const unsigned own = size_of(own_counts);
    for (uint32_t i = 0; i < store->n_states; i++) {
        if (i + AHEAD < store->n_states)
            grrl_prefetch(&store->states[i + AHEAD]);
        const struct grrl_experience_state *stored = &store->states[i];
        const uint64_t counts = stored->signature.word[0];
        const unsigned size = size_of(counts);
        const bool larger = size > own;
        const unsigned distance = larger ? size - own : own - size;
        if (distance == 0 || !grrl_closest_accepts(closest, distance, i))
            continue;
        if (larger ? grrl_experience_fits(own_counts, &current->paths, counts, &stored->paths)
                   : grrl_experience_fits(counts, &stored->paths, own_counts, &current->paths))
            grrl_closest_add(closest, distance, i);
    }
    grrl_closest_sort(closest);
}

/* Actions without an entry are the only ones that more distant states could improve.
 * False: none. */
static bool find_open(struct job *job)
{
    bool any = false;
    for (int direction = 0; direction < GRRL_DIRECTIONS; direction++) {
        job->open[direction] = job->unknown[direction];
        any = any || job->open[direction] != 0;
    }
    return any;
}

static bool knows_open_direction(const struct job *job, const struct grrl_experience_state *stored)
{
    for (uint32_t i = stored->first; i != GRRL_NO_EXPERIENCE; i = job->store->experiences[i].next)
        if (job->open[job->store->experiences[i].direction] != 0)
            return true;
    return false;
}

static void match_part(struct job *job, uint32_t state, uint8_t distance)
{
    const struct grrl_experience_state *stored = &job->store->states[state];
    const struct grrl_signature *own = &job->described->signature;
    job->stored_is_pattern = size_of(stored->signature.word[0]) < size_of(own->word[0]);
    if (!(job->stored_is_pattern ? grrl_signature_within(&stored->signature, own, true)
                                 : grrl_signature_within(own, &stored->signature, true)) ||
        !knows_open_direction(job, stored))
        return;
    load_state(job, state);
    job->budget = job->budget < job->steps ? job->budget : job->steps;
    const uint32_t granted = job->budget;
    match_substructure(job, distance);
    job->steps -= granted - job->budget;
}

/* Prefetches the first cache lines of a state. */
static void prefetch_state(const struct grrl_experience_state *state)
{
    grrl_prefetch(state);
    grrl_prefetch(&state->first);
}

/* Prefetches its links, and its experiences as if they had been made one after another. */
static void prefetch_links(const struct grrl_experience_store *store,
                           const struct grrl_experience_state *state)
{
    enum { LINE_BYTES = 64 };
    for (unsigned i = 0; i < state->experiences && i <= state->first; i += 2)
        grrl_prefetch(&store->experiences[state->first - i]);
    grrl_prefetch(state->edge);
    for (unsigned i = 0; i < state->n; i += LINE_BYTES / sizeof state->label[0])
        grrl_prefetch(&state->label[i]);
}

/* Examines part of the list. Of thousands of states few are in a cache, so the memory of each is
 * prefetched a few states ahead. */
static void match_listed(struct job *job, const struct grrl_closest *closest, unsigned from,
                         unsigned to)
{
    enum { FAR = 8, NEAR = 4 };
    const struct grrl_experience_state *states = job->store->states;
    for (unsigned k = from; k < to + FAR; k++) {
        if (k < to)
            prefetch_state(&states[closest->state[k]]);
        if (k >= from + FAR - NEAR && k < to + FAR - NEAR)
            prefetch_links(job->store, &states[closest->state[k - (FAR - NEAR)]]);
        if (k >= from + FAR)
            match_part(job, closest->state[k - FAR], closest->distance[k - FAR]);
    }
}

/* Takes the closest states first, so that later states are searched only for actions still open. */
static void match_parts(struct job *job)
{
    const struct grrl_experience_index *index = job->store->index;
    struct grrl_closest closest;
    unsigned to = 0; /* entries of the list that are done */
    unsigned reach = MAX_DISTANCE;
    unsigned left =
        job->config->states < GRRL_RECALL_STATES ? job->config->states : GRRL_RECALL_STATES;
    job->kind = GRRL_MATCH_MONOMORPHISM;
    job->steps = GRRL_RECALL_STEPS;
    if (left == 0 || !find_open(job))
        return;
    if (index != NULL) {
        reach = grrl_experience_index_reach(index, job->described);
    } else {
        grrl_closest_clear(&closest, left);
        scan_states(job->store, job->described, &closest);
        left = closest.n;
    }
    for (unsigned d = 1; d <= reach && left > 0 && find_open(job); d++) {
        if (index != NULL) {
            grrl_closest_clear(&closest, left);
            grrl_experience_index_find(index, job->described, d, &closest);
            to = 0;
        }
        const unsigned from = to;
        while (to < closest.n && closest.distance[to] == d)
            to++;
        match_listed(job, &closest, from, to);
        left -= to - from;
    }
}

void grrl_experience_recall(const struct grrl_experience_store *store,
                            const struct grrl_graph *state, const struct grrl_recall_config *config,
                            struct grrl_recall *recall)
{
    recall->n_links = state->n;
    for (int link = 0; link < GRRL_MAX_LINKS; link++) {
        for (int direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            recall->entry[link][direction] =
                (struct grrl_recall_entry){.experience = GRRL_NO_EXPERIENCE};
        }
    }
    struct grrl_experience_state current;
    if (store->n_states == 0 || !grrl_experience_describe(state, &current, NULL))
        return;
    struct job job = {.store = store,
                      .config = config,
                      .current = state,
                      .described = &current,
                      .places = places_in_use(state),
                      .recall = recall};
    for (int direction = 0; direction < GRRL_DIRECTIONS; direction++)
        job.open[direction] = job.unknown[direction] = grrl_bits_below(state->n);
    match_isomorphic(&job);
    if (config->deepest >= GRRL_RECALL_SUBSTRUCTURE)
        match_parts(&job);
}
