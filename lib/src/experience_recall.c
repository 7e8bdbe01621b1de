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
    uint32_t budget; /* left for the stored state */

    const struct grrl_experience_state *stored;
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
static bool improves(const struct job *job, uint16_t experience,
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
    const struct grrl_graph *stored = &job->stored->graph;
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
    for (uint16_t i = job->stored->first; i != GRRL_NO_EXPERIENCE;
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
    uint8_t n = job->forth ? job->stored->graph.n : job->current->n;
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
    const struct grrl_graph *stored = &job->stored->graph;
    grrl_match_begin(match, job->kind, job->forth ? stored : job->current,
                     job->forth ? job->current : stored, job->mask, job->budget);
}

/* Asks for one mapping through each wanted pair that is not yet known to have one. */
static void find_pairs(struct job *job, const struct binding *wanted, struct binding *found)
{
    for (uint8_t v = 0; v < job->stored->graph.n; ++v) {
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
        if (covers(found, wanted, job->stored->graph.n)) {
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
    for (uint16_t i = job->stored->first; i != GRRL_NO_EXPERIENCE;
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
    grrl_label places = current_places | places_in_use(&job->stored->graph);
    job->offer = (struct grrl_recall_entry){.level = GRRL_RECALL_RELAXED};
    while (places != 0) {
        places = drop_last(places);
        job->mask = places;
        ++job->offer.dropped;
        consult(job);
    }
}

/* With all properties, then with none. */
static void consult_substructure(struct job *job, grrl_label current_places, uint8_t distance)
{
    grrl_label places = current_places | places_in_use(&job->stored->graph);
    job->offer =
        (struct grrl_recall_entry){.level = GRRL_RECALL_SUBSTRUCTURE, .distance = distance};
    job->mask = GRRL_ALL_PROPERTIES;
    consult(job);
    for (; places != 0; places = drop_last(places)) {
        ++job->offer.dropped;
    }
    if (job->offer.dropped > 0) {
        job->mask = GRRL_NO_PROPERTIES;
        consult(job);
    }
}

/* The current state as the stored ones are described. */
struct description {
    struct grrl_canonical canonical;
    uint32_t shape;
    uint8_t joints[GRRL_JOINT_TYPES];
    grrl_label places;
};

static bool same_shape(const struct grrl_experience_state *stored,
                       const struct description *current)
{
    return stored->shape == current->shape && stored->graph.n == current->canonical.graph.n &&
           memcmp(stored->joints, current->joints, sizeof current->joints) == 0;
}

/*
 * Links and joints one of the two has more, 0 if neither can be a part of the other; *forth tells
 * whether the stored state is the part. With the same counts they are isomorphic or nothing.
 */
static unsigned part_distance(const struct grrl_experience_state *stored,
                              const struct description *current, bool *forth)
{
    int more = (int)current->canonical.graph.n - (int)stored->graph.n;
    int distance = more;
    bool within = more >= 0;
    bool around = more <= 0;
    for (int type = 0; type < GRRL_JOINT_TYPES; ++type) {
        more = (int)current->joints[type] - (int)stored->joints[type];
        distance += more;
        within = within && more >= 0;
        around = around && more <= 0;
    }
    *forth = within;
    if (within == around) {
        return 0;
    }
    return (unsigned)(within ? distance : -distance);
}

static void consult_isomorphic(struct job *job, const struct grrl_recall_config *config,
                               const struct description *current)
{
    job->kind = GRRL_MATCH_ISOMORPHISM;
    job->forth = true;
    int exact = grrl_experience_find_state(job->store, &current->canonical);
    if (exact != GRRL_NO_STATE) {
        job->stored = &job->store->states[exact];
        job->budget = config->budget;
        job->mask = GRRL_ALL_PROPERTIES;
        job->offer = (struct grrl_recall_entry){.level = GRRL_RECALL_EXACT};
        consult(job);
    }
    for (uint16_t i = 0; i < job->store->n_states && config->deepest >= GRRL_RECALL_RELAXED; ++i) {
        job->stored = &job->store->states[i];
        if (same_shape(job->stored, current)) {
            job->budget = config->budget;
            consult_relaxed(job, current->places);
        }
    }
}

/* The closest states first, so that the others need a search only for what is still open. */
static void consult_parts(struct job *job, const struct grrl_recall_config *config,
                          const struct description *current)
{
    job->kind = GRRL_MATCH_MONOMORPHISM;
    unsigned distance = 0;
    unsigned next = 1;
    while (next > distance) {
        distance = next;
        for (uint16_t i = 0; i < job->store->n_states; ++i) {
            job->stored = &job->store->states[i];
            unsigned d = part_distance(job->stored, current, &job->forth);
            if (d == distance) {
                job->budget = config->budget;
                consult_substructure(job, current->places, (uint8_t)d);
            } else if (d > distance && (next == distance || d < next)) {
                next = d;
            }
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
    struct description current;
    if (store->n_states == 0 ||
        !grrl_experience_describe(state, &current.canonical, &current.shape)) {
        return;
    }
    grrl_experience_count_joints(state, current.joints);
    current.places = places_in_use(state);
    struct job job = {.store = store, .current = state, .recall = recall};
    consult_isomorphic(&job, config, &current);
    if (config->deepest >= GRRL_RECALL_SUBSTRUCTURE) {
        consult_parts(&job, config, &current);
    }
}
