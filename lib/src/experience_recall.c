#include <string.h>

#include "bits.h"
#include "experience_private.h"

/*
 * How many mappings of one search are looked at before asking for each wanted pair of links on its
 * own: chains have few mappings, a star of n equal links has n factorial.
 */
#define MAPPINGS 32

/* One recall under way, and how it regards the stored state it has come to. */
struct job {
    const struct grrl_experience_store *store;
    const struct grrl_graph *current;
    struct grrl_recall *recall;
    uint32_t budget; /* left for the stored state, */
    uint32_t steps;  /* and for the sub-structures of the recall */

    const struct grrl_experience_state *stored;
    struct grrl_graph graph; /* of it */
    enum grrl_match_kind kind;
    bool forth; /* the stored state is the pattern, the current one the target */
    grrl_label mask;
    struct grrl_recall_entry offer; /* level, distance and dropped of all its matches */
};

/* Current links for each stored link. */
struct binding {
    uint32_t to[GRRL_MAX_LINKS];
};

/* Whether an experience of the offered closeness is closer than what the entry has. */
static bool improves(const struct job *job, uint32_t experience,
                     const struct grrl_recall_entry *entry)
{
    if (entry->experience == GRRL_NO_EXPERIENCE) {
        return true;
    }
    const struct grrl_recall_entry *offer = &job->offer;
    if (offer->level != entry->level) {
        return offer->level < entry->level;
    }
    if (offer->distance != entry->distance) {
        return offer->distance < entry->distance;
    }
    if (offer->dropped != entry->dropped) {
        return offer->dropped < entry->dropped;
    }
    uint32_t n = job->store->experiences[experience].q.n;
    uint32_t entry_n = job->store->experiences[entry->experience].q.n;
    return n != entry_n ? n > entry_n : experience < entry->experience;
}

/* Whether stored link v could be bound to current link c, as far as label and degrees tell. */
static bool could_bind(const struct job *job, uint8_t v, uint8_t c)
{
    const struct grrl_graph *stored = &job->graph;
    if (grrl_label_masked(stored->label[v], job->mask) !=
        grrl_label_masked(job->current->label[c], job->mask)) {
        return false;
    }
    for (int type = 0; type < GRRL_JOINT_TYPES; ++type) {
        unsigned degree_v = grrl_bit_count(stored->joined[type][v]);
        unsigned degree_c = grrl_bit_count(job->current->joined[type][c]);
        if (degree_v != degree_c &&
            (job->kind == GRRL_MATCH_ISOMORPHISM || (degree_v < degree_c) != job->forth)) {
            return false;
        }
    }
    return true;
}

/* The bindings that would bring a closer experience for some action; false if there are none. */
static bool wanted_bindings(const struct job *job, struct binding *wanted)
{
    memset(wanted, 0, sizeof *wanted);
    bool any = false;
    for (uint32_t i = job->stored->first; i != GRRL_NO_EXPERIENCE;
         i = job->store->experiences[i].next) {
        const struct grrl_experience *experience = &job->store->experiences[i];
        for (uint8_t c = 0; c < job->current->n; ++c) {
            if (improves(job, i, &job->recall->entry[c][experience->direction]) &&
                could_bind(job, experience->link, c)) {
                wanted->to[experience->link] |= grrl_bit(c);
                any = true;
            }
        }
    }
    return any;
}

static void add_mapping(const struct job *job, const uint8_t *map, struct binding *found)
{
    uint8_t n = job->forth ? job->graph.n : job->current->n;
    for (uint8_t i = 0; i < n; ++i) {
        uint8_t v = job->forth ? i : map[i];
        uint8_t c = job->forth ? map[i] : i;
        found->to[v] |= grrl_bit(c);
    }
}

static bool covers(const struct binding *found, const struct binding *wanted, uint8_t n)
{
    for (uint8_t v = 0; v < n; ++v) {
        if ((wanted->to[v] & ~found->to[v]) != 0) {
            return false;
        }
    }
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
    for (uint8_t v = 0; v < job->graph.n; ++v) {
        uint32_t missing = wanted->to[v];
        for (; missing != 0 && job->budget > 0; missing &= missing - 1u) {
            uint8_t c = grrl_first_bit(missing);
            if ((found->to[v] & grrl_bit(c)) != 0) {
                continue;
            }
            struct grrl_match match;
            uint8_t map[GRRL_MAX_LINKS];
            begin(job, &match);
            grrl_match_fix(&match, job->forth ? v : c, job->forth ? c : v);
            if (grrl_match_next(&match, map) == GRRL_OK) {
                add_mapping(job, map, found);
            }
            job->budget = match.budget;
        }
    }
}

static void find_bindings(struct job *job, const struct binding *wanted, struct binding *found)
{
    memset(found, 0, sizeof *found);
    struct grrl_match match;
    begin(job, &match);
    for (int i = 0; i < MAPPINGS; ++i) {
        uint8_t map[GRRL_MAX_LINKS];
        enum grrl_status status = grrl_match_next(&match, map);
        job->budget = match.budget;
        if (status != GRRL_OK) {
            return;
        }
        add_mapping(job, map, found);
        if (covers(found, wanted, job->graph.n)) {
            return;
        }
    }
    find_pairs(job, wanted, found);
}

/* Enters what the stored state knows, under the kind, mask and closeness of the job. */
static void consult(struct job *job)
{
    struct binding wanted;
    if (job->budget == 0 || !wanted_bindings(job, &wanted)) {
        return;
    }
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
    for (uint8_t i = 0; i < graph->n; ++i) {
        used |= graph->label[i] == GRRL_LABEL_BACKGROUND ? 0 : graph->label[i];
    }
    grrl_label places = 0;
    for (unsigned place = 0; place < GRRL_MAX_PROPERTIES; ++place) {
        grrl_label byte = UINT64_C(0xff) << (8 * place);
        places |= (used & byte) != 0 ? byte : 0;
    }
    return places;
}

/* The places without the last of them. */
static grrl_label drop_last(grrl_label places)
{
    grrl_label last = UINT64_C(0xff) << (8 * (GRRL_MAX_PROPERTIES - 1));
    while ((places & last) == 0) {
        last >>= 8;
    }
    return places & ~last;
}

/* Isomorphic without properties: ever fewer of them. */
static void consult_relaxed(struct job *job, grrl_label current_places)
{
    grrl_label places = current_places | places_in_use(&job->graph);
    job->offer = (struct grrl_recall_entry){.level = GRRL_RECALL_RELAXED};
    while (places != 0) {
        places = drop_last(places);
        job->mask = places;
        ++job->offer.dropped;
        consult(job);
    }
}

/* With all properties, then with none. */
static void consult_substructure(struct job *job, const struct grrl_experience_state *current,
                                 grrl_label current_places, uint8_t distance)
{
    grrl_label places = current_places | places_in_use(&job->graph);
    job->offer =
        (struct grrl_recall_entry){.level = GRRL_RECALL_SUBSTRUCTURE, .distance = distance};
    job->mask = GRRL_ALL_PROPERTIES;
    const struct grrl_signature *stored = &job->stored->signature;
    if (job->forth ? grrl_signature_within(stored, &current->signature, false)
                   : grrl_signature_within(&current->signature, stored, false)) {
        consult(job);
    }
    for (; places != 0; places = drop_last(places)) {
        ++job->offer.dropped;
    }
    if (job->offer.dropped > 0) {
        job->mask = GRRL_NO_PROPERTIES;
        consult(job);
    }
}

static void take_state(struct job *job, uint32_t state, const struct grrl_recall_config *config)
{
    job->stored = &job->store->states[state];
    job->budget = config->budget;
    grrl_experience_graph(job->stored, &job->graph);
}

static void consult_isomorphic(struct job *job, const struct grrl_recall_config *config,
                               const struct grrl_experience_state *current, grrl_label places)
{
    job->kind = GRRL_MATCH_ISOMORPHISM;
    job->forth = true;
    uint32_t exact = grrl_experience_find_state(job->store, current);
    if (exact != GRRL_NO_STATE) {
        take_state(job, exact, config);
        job->mask = GRRL_ALL_PROPERTIES;
        job->offer = (struct grrl_recall_entry){.level = GRRL_RECALL_EXACT};
        consult(job);
    }
    if (config->deepest < GRRL_RECALL_RELAXED) {
        return;
    }
    uint32_t shape = current->key[GRRL_TABLE_SHAPE];
    uint32_t i = grrl_experience_first_in(job->store, GRRL_TABLE_SHAPE, shape);
    for (; i != GRRL_NO_STATE;
         i = grrl_experience_next_in(job->store, GRRL_TABLE_SHAPE, shape, i)) {
        const struct grrl_experience_state *stored = &job->store->states[i];
        if (stored->n == current->n &&
            memcmp(stored->joints, current->joints, sizeof current->joints) == 0) {
            take_state(job, i, config);
            consult_relaxed(job, places);
        }
    }
}

/* --- sub-structures --------------------------------------------------------------------------- */

/* The states closest to the current one, as far as signatures tell. */
struct nearest {
    unsigned n;
    unsigned limit; /* distances from here on have no room */
    uint32_t state[GRRL_RECALL_STATES];
    uint8_t distance[GRRL_RECALL_STATES];
};

/* Makes room for one at this distance: of the farthest the youngest go. False: it is no closer. */
static bool make_room(struct nearest *nearest, unsigned distance)
{
    unsigned farthest = 0;
    for (unsigned i = 0; i < nearest->n; ++i) {
        farthest = nearest->distance[i] > farthest ? nearest->distance[i] : farthest;
    }
    nearest->limit = farthest;
    if (distance >= farthest) {
        return false;
    }
    unsigned to_go = GRRL_RECALL_STATES / 4 + 1; /* some at a time: this is rare */
    unsigned kept = nearest->n;
    for (unsigned i = nearest->n; i-- > 0;) {
        if (nearest->distance[i] == farthest && to_go > 0) {
            --to_go;
            --kept;
            nearest->distance[i] = 0; /* gone */
        }
    }
    unsigned at = 0;
    for (unsigned i = 0; i < nearest->n; ++i) {
        if (nearest->distance[i] != 0) {
            nearest->state[at] = nearest->state[i];
            nearest->distance[at++] = nearest->distance[i];
        }
    }
    nearest->n = kept;
    return true;
}

/* Links and joints one of the two has more; each count is one of the lowest bytes of the word. */
static unsigned distance_between(uint64_t larger, uint64_t smaller)
{
    uint64_t more = larger - smaller;
    return (unsigned)((more & 0xffu) + (more >> 8 & 0xffu) + (more >> 16 & 0xffu));
}

static uint64_t word_of(const struct grrl_experience_store *store, unsigned word, uint32_t state)
{
    return store->index != NULL ? store->index[(size_t)word * store->states_capacity + state]
                                : store->states[state].signature.word[word];
}

/* Whether the counts of the shape allow one to be within the other. */
static bool fits_within(uint64_t part, uint64_t whole)
{
    const uint64_t guards = UINT64_C(0x8080808080808080);
    return (((whole | guards) - part) & guards) == guards;
}

/* With equal counts of links and joints they are isomorphic or nothing: not wanted here. */
static void find_nearest(const struct grrl_experience_store *store,
                         const struct grrl_signature *current, struct nearest *nearest)
{
    const uint64_t counts = current->word[0];
    nearest->n = 0;
    nearest->limit = UINT8_MAX + 1u;
    for (uint32_t i = 0; i < store->n_states; ++i) {
        uint64_t stored = word_of(store, 0, i);
        bool within = fits_within(stored, counts);
        if (!within && !fits_within(counts, stored)) {
            continue;
        }
        unsigned distance =
            within ? distance_between(counts, stored) : distance_between(stored, counts);
        if (distance == 0 || distance >= nearest->limit) {
            continue;
        }
        uint64_t paths = word_of(store, 1, i);
        if (within ? !fits_within(paths, current->word[1])
                   : !fits_within(current->word[1], paths)) {
            continue;
        }
        if (nearest->n == GRRL_RECALL_STATES && !make_room(nearest, distance)) {
            continue;
        }
        nearest->state[nearest->n] = i;
        nearest->distance[nearest->n++] = (uint8_t)distance;
    }
}

/* Whether every action has an entry. */
static bool is_complete(const struct grrl_recall *recall)
{
    for (uint8_t link = 0; link < recall->n_links; ++link) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; ++direction) {
            if (recall->entry[link][direction].experience == GRRL_NO_EXPERIENCE) {
                return false;
            }
        }
    }
    return true;
}

/* The closest states first, so that the others need a search only for what is still open. */
static void consult_parts(struct job *job, const struct grrl_recall_config *config,
                          const struct grrl_experience_state *current, grrl_label places)
{
    struct nearest nearest;
    find_nearest(job->store, &current->signature, &nearest);
    job->kind = GRRL_MATCH_MONOMORPHISM;
    unsigned left = nearest.n;
    job->steps = GRRL_RECALL_STEPS;
    for (unsigned distance = 1; left > 0 && !is_complete(job->recall); ++distance) {
        for (unsigned k = 0; k < nearest.n; ++k) {
            if (nearest.distance[k] != distance) {
                continue;
            }
            --left;
            take_state(job, nearest.state[k], config);
            job->budget = job->budget < job->steps ? job->budget : job->steps;
            const uint32_t granted = job->budget;
            job->forth = fits_within(job->stored->signature.word[0], current->signature.word[0]);
            consult_substructure(job, current, places, (uint8_t)distance);
            job->steps -= granted - job->budget;
        }
    }
}

void grrl_experience_recall(const struct grrl_experience_store *store,
                            const struct grrl_graph *state, const struct grrl_recall_config *config,
                            struct grrl_recall *recall)
{
    recall->n_links = state->n;
    for (int link = 0; link < GRRL_MAX_LINKS; ++link) {
        for (int direction = 0; direction < GRRL_DIRECTIONS; ++direction) {
            recall->entry[link][direction] =
                (struct grrl_recall_entry){.experience = GRRL_NO_EXPERIENCE};
        }
    }
    struct grrl_experience_state current;
    if (store->n_states == 0 || !grrl_experience_describe(state, &current, NULL)) {
        return;
    }
    grrl_label places = places_in_use(state);
    struct job job = {.store = store, .current = state, .recall = recall};
    consult_isomorphic(&job, config, &current, places);
    if (config->deepest >= GRRL_RECALL_SUBSTRUCTURE) {
        consult_parts(&job, config, &current, places);
    }
}
