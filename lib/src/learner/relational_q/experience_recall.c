/* experience_recall.c: the closest experience for each action of a state. */
#include <string.h>

#include "base/bits.h"
#include "learner/relational_q/closest.h"
#include "learner/relational_q/experience_private.h"

/*
 * How many mappings of one search are looked at before asking for each wanted pair of links on its
 * own: chains have few mappings, a star of n equal links has n factorial.
 */
#define MAPPINGS 32

/* One recall under way, and how it regards the stored state it has come to. */
struct job {
    const struct grrl_experience_store *store;
    const struct grrl_recall_config *config;
    const struct grrl_graph *current;
    const struct grrl_experience_state *described; /* the current state as it would be stored, */
    grrl_label places;                             /* and its properties in use, as mask bytes */
    struct grrl_recall *recall;
    uint32_t budget;                /* left for the stored state, */
    uint32_t steps;                 /* and for the sub-structures of the recall */
    uint32_t open[GRRL_DIRECTIONS]; /* per direction: links whose entry may still improve */
    uint32_t at_least[GRRL_JOINT_TYPES][GRRL_MAX_LINKS + 1]; /* current links with so many joints */

    const struct grrl_experience_state *stored;
    struct grrl_graph graph; /* of it */
    enum grrl_match_kind kind;
    bool forth; /* the stored state is the pattern, the current one the target */
    grrl_label mask;
    struct grrl_recall_entry offer; /* level, distance and dropped of all its matches */
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

/* Whether an experience of the offered closeness is closer than what the entry has. */
static bool improves(const struct job *job, uint32_t experience,
                     const struct grrl_recall_entry *entry)
{
    if (entry->experience == GRRL_NO_EXPERIENCE)
        return true;
    const struct grrl_recall_entry *offer = &job->offer;
    if (offer->level != entry->level)
        return offer->level < entry->level;
    if (offer->distance != entry->distance)
        return offer->distance < entry->distance;
    if (offer->dropped != entry->dropped)
        return offer->dropped < entry->dropped;
    uint32_t n = job->store->experiences[experience].q.n;
    uint32_t entry_n = job->store->experiences[entry->experience].q.n;
    return n != entry_n ? n > entry_n : experience < entry->experience;
}

/* Fills in at_least. */
static void count_joints(struct job *job)
{
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        for (uint8_t c = 0; c < job->current->n; c++) {
            unsigned degree = grrl_bit_count(job->current->joined[type][c]);
            for (unsigned k = 0; k <= degree; k++)
                job->at_least[type][k] |= grrl_bit(c);
        }
    }
}

/* Current links that stored link v could be bound to, as far as degrees tell. */
static uint32_t could_bind(const struct job *job, uint8_t v)
{
    uint32_t links = UINT32_MAX;
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        unsigned degree = grrl_bit_count(job->graph.joined[type][v]);
        if (job->forth)
            links &= job->at_least[type][degree];
        if (!job->forth || job->kind == GRRL_MATCH_ISOMORPHISM)
            links &= ~job->at_least[type][degree + 1];
    }
    return links;
}

/* The bindings that would bring a closer experience for some action; false if there are none. */
static bool wanted_bindings(const struct job *job, struct binding *wanted)
{
    clear_binding(wanted, job->graph.n);
    bool any = false;
    for (uint32_t i = job->stored->first; i != GRRL_NO_EXPERIENCE;
         i = job->store->experiences[i].next) {
        const struct grrl_experience *experience = &job->store->experiences[i];
        const uint8_t v = experience->link;
        const grrl_label label = grrl_label_masked(job->graph.label[v], job->mask);
        uint32_t links = job->open[experience->direction] & could_bind(job, v);
        for (; links != 0; links &= links - 1u) {
            uint8_t c = grrl_first_bit(links);
            if (grrl_label_masked(job->current->label[c], job->mask) == label &&
                improves(job, i, &job->recall->entry[c][experience->direction])) {
                wanted->to[v] |= grrl_bit(c);
                any = true;
            }
        }
    }
    return any;
}

static void add_mapping(const struct job *job, const uint8_t *map, struct binding *found)
{
    uint8_t n = job->forth ? job->graph.n : job->current->n;
    for (uint8_t i = 0; i < n; i++) {
        uint8_t v = job->forth ? i : map[i];
        uint8_t c = job->forth ? map[i] : i;
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

static void begin(const struct job *job, struct grrl_match *match)
{
    const struct grrl_graph *stored = &job->graph;
    grrl_match_begin(match, job->kind, job->forth ? stored : job->current,
                     job->forth ? job->current : stored, job->mask, job->budget);
}

/* Asks for one mapping through each wanted pair that is not yet known to have one. */
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
            begin(job, &match);
            grrl_match_fix(&match, job->forth ? v : c, job->forth ? c : v);
            if (grrl_match_next(&match, map) == GRRL_OK)
                add_mapping(job, map, found);
            job->budget = match.budget;
        }
    }
}

static void find_bindings(struct job *job, const struct binding *wanted, struct binding *found)
{
    clear_binding(found, job->graph.n);
    struct grrl_match match;
    begin(job, &match);
    for (int i = 0; i < MAPPINGS; i++) {
        uint8_t map[GRRL_MAX_LINKS];
        enum grrl_status status = grrl_match_next(&match, map);
        job->budget = match.budget;
        if (status != GRRL_OK)
            return;
        add_mapping(job, map, found);
        if (covers(found, wanted, job->graph.n))
            return;
    }
    find_pairs(job, wanted, found);
}

/* Enters what the stored state knows, under the kind, mask and closeness of the job. */
static void consult(struct job *job)
{
    struct binding wanted;
    if (job->budget == 0 || !wanted_bindings(job, &wanted))
        return;
    struct binding found;
    find_bindings(job, &wanted, &found);
    for (uint32_t i = job->stored->first; i != GRRL_NO_EXPERIENCE;
         i = job->store->experiences[i].next) {
        const struct grrl_experience *experience = &job->store->experiences[i];
        uint32_t links = found.to[experience->link] & wanted.to[experience->link];
        for (; links != 0; links &= links - 1u) {
            struct grrl_recall_entry *entry =
                &job->recall->entry[grrl_first_bit(links)][experience->direction];
            if (improves(job, i, entry)) {
                *entry = job->offer;
                entry->experience = i;
                entry->stored_link = experience->link;
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

/* Isomorphic without properties: ever fewer of them. */
static void consult_relaxed(struct job *job)
{
    grrl_label places = job->places | places_in_use(&job->graph);
    job->offer = (struct grrl_recall_entry){.level = GRRL_RECALL_RELAXED};
    while (places != 0) {
        places = drop_last(places);
        job->mask = places;
        job->offer.dropped++;
        consult(job);
    }
}

/* With all properties, then with none. */
static void consult_substructure(struct job *job, uint8_t distance)
{
    grrl_label places = job->places | places_in_use(&job->graph);
    job->offer =
        (struct grrl_recall_entry){.level = GRRL_RECALL_SUBSTRUCTURE, .distance = distance};
    job->mask = GRRL_ALL_PROPERTIES;
    const struct grrl_signature *stored = &job->stored->signature;
    const struct grrl_signature *current = &job->described->signature;
    if (job->forth ? grrl_signature_within(stored, current, false)
                   : grrl_signature_within(current, stored, false))
        consult(job);
    for (; places != 0; places = drop_last(places))
        job->offer.dropped++;
    if (job->offer.dropped > 0 && !job->config->strict) {
        job->mask = GRRL_NO_PROPERTIES;
        consult(job);
    }
}

static void take_state(struct job *job, uint32_t state)
{
    job->stored = &job->store->states[state];
    job->budget = job->config->budget;
    grrl_experience_graph(job->stored, &job->graph);
}

static void consult_isomorphic(struct job *job)
{
    const struct grrl_experience_state *current = job->described;
    job->kind = GRRL_MATCH_ISOMORPHISM;
    job->forth = true;
    uint32_t exact = grrl_experience_find_state(job->store, current);
    if (exact != GRRL_NO_STATE) {
        take_state(job, exact);
        job->mask = GRRL_ALL_PROPERTIES;
        job->offer = (struct grrl_recall_entry){.level = GRRL_RECALL_EXACT};
        consult(job);
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
            take_state(job, i);
            consult_relaxed(job);
        }
    }
}

/* --- sub-structures --------------------------------------------------------------------------- */

/* No two states differ by more links and joints. */
enum { FARTHEST = GRRL_MAX_LINKS + GRRL_MAX_JOINTS };

_Static_assert(FARTHEST <= UINT8_MAX && GRRL_MAX_JOINTS <= INT8_MAX,
               "distances are bytes, and signatures count all links and joints");

/* Links and joints, as a signature has them. */
static unsigned size_of(uint64_t counts)
{
    return (unsigned)((counts & 0xffu) + (counts >> 8 & 0xffu) + (counts >> 16 & 0xffu));
}

_Static_assert(offsetof(struct grrl_experience_state, signature.word[1]) <= 32,
               "half a cache line is all that a scan reads of a state");

/* Without an index: of all states that fit, in one pass. With as many links and joints as the
 * current one a state is isomorphic or nothing: not wanted here. */
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
        if (distance == 0 || !grrl_closest_wants(closest, distance, i))
            continue;
        if (larger ? grrl_experience_fits(own_counts, &current->paths, counts, &stored->paths)
                   : grrl_experience_fits(counts, &stored->paths, own_counts, &current->paths))
            grrl_closest_add(closest, distance, i);
    }
    grrl_closest_sort(closest);
}

/* What states of the next distance could still improve: what has no entry. False: nothing. */
static bool find_open(struct job *job)
{
    bool any = false;
    for (int direction = 0; direction < GRRL_DIRECTIONS; direction++) {
        job->open[direction] = 0;
        for (uint8_t link = 0; link < job->current->n; link++) {
            if (job->recall->entry[link][direction].experience == GRRL_NO_EXPERIENCE) {
                job->open[direction] |= grrl_bit(link);
                any = true;
            }
        }
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

static void consult_part(struct job *job, uint32_t state, uint8_t distance)
{
    if (!knows_open_direction(job, &job->store->states[state]))
        return;
    take_state(job, state);
    job->budget = job->budget < job->steps ? job->budget : job->steps;
    const uint32_t granted = job->budget;
    job->forth =
        size_of(job->stored->signature.word[0]) < size_of(job->described->signature.word[0]);
    consult_substructure(job, distance);
    job->steps -= granted - job->budget;
}

/* Asks for the first lines of a state, then for what these lead to. */
static void ask_for_state(const struct grrl_experience_state *state)
{
    grrl_prefetch(state);
    grrl_prefetch(&state->first);
}

static void ask_for_links(const struct grrl_experience_store *store,
                          const struct grrl_experience_state *state)
{
    enum { LINE_BYTES = 64 };
    grrl_prefetch(&store->experiences[state->first]);
    grrl_prefetch(state->edge);
    for (unsigned i = 0; i < state->n; i += LINE_BYTES / sizeof state->label[0])
        grrl_prefetch(&state->label[i]);
}

/* Consults some of the list. Of thousands of states few are in a cache: the memory of each is asked
 * for some states ahead. */
static void consult_listed(struct job *job, const struct grrl_closest *closest, unsigned from,
                           unsigned to)
{
    enum { FAR = 8, NEAR = 4 };
    const struct grrl_experience_state *states = job->store->states;
    for (unsigned k = from; k < to + FAR; k++) {
        if (k < to)
            ask_for_state(&states[closest->state[k]]);
        if (k >= from + FAR - NEAR && k < to + FAR - NEAR)
            ask_for_links(job->store, &states[closest->state[k - (FAR - NEAR)]]);
        if (k >= from + FAR)
            consult_part(job, closest->state[k - FAR], closest->distance[k - FAR]);
    }
}

/* The closest states first, so that the others need a search only for what is still open. */
static void consult_parts(struct job *job)
{
    const struct grrl_experience_index *index = job->store->index;
    struct grrl_closest closest;
    unsigned to = 0; /* so many of the list are done */
    unsigned reach = FARTHEST;
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
        consult_listed(job, &closest, from, to);
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
        job.open[direction] = grrl_bits_below(state->n);
    count_joints(&job);
    consult_isomorphic(&job);
    if (config->deepest >= GRRL_RECALL_SUBSTRUCTURE)
        consult_parts(&job);
}
