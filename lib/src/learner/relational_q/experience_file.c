/* experience_file.c: the experience store as bytes. */
#include <string.h>

#include "base/bits.h"
#include "base/record.h"
#include "grrl/base/geometry.h"
#include "learner/legacy_store.h"
#include "learner/relational_q/experience_private.h"

/* The layout is described in experience.h. */
enum {
    FILE_VERSION = 3,
    OLD_VERSION = 2,
    HEADER_BYTES = 24,
    LINK_BYTES = 16,
    EXPERIENCE_BYTES = 26
};

_Static_assert(GRRL_RECORD_BYTES >= 1 + LINK_BYTES * GRRL_MAX_LINKS &&
                   (int)GRRL_RECORD_BYTES >= (int)EXPERIENCE_BYTES &&
                   (int)GRRL_RECORD_BYTES >= (int)HEADER_BYTES,
               "every record fits");
_Static_assert(GRRL_JOINT_TYPES == 2, "a new joint type is a new file version");

static const uint8_t magic[8] = {'G', 'R', 'R', 'L', 'e', 'x', 'p', 0};

enum grrl_status grrl_experience_save(const struct grrl_experience_store *store,
                                      const struct grrl_io *io)
{
    struct grrl_record record = {.io = io};
    memcpy(record.bytes, magic, sizeof magic);
    record.n = sizeof magic;
    grrl_record_put(&record, FILE_VERSION, 2);
    grrl_record_put(&record, GRRL_MAX_PROPERTIES, 1);
    grrl_record_put(&record, GRRL_DIRECTIONS, 1);
    grrl_record_put(&record, store->n_states, 4);
    grrl_record_put(&record, store->n_experiences, 4);
    grrl_record_put(&record, store->clock, 4);
    enum grrl_status status = grrl_record_write(&record);
    for (uint32_t i = 0; i < store->n_states && status == GRRL_OK; i++) {
        struct grrl_graph graph;
        grrl_experience_graph(&store->states[i], &graph);
        grrl_record_put(&record, graph.n, 1);
        for (uint8_t link = 0; link < graph.n; link++) {
            grrl_record_put(&record, graph.label[link], 8);
            grrl_record_put(&record, graph.joined[GRRL_REVOLUTE][link], 4);
            grrl_record_put(&record, graph.joined[GRRL_PRISMATIC][link], 4);
        }
        status = grrl_record_write(&record);
    }
    for (uint32_t i = 0; i < store->n_experiences && status == GRRL_OK; i++) {
        const struct grrl_experience *experience = &store->experiences[i];
        grrl_record_put(&record, experience->state, 4);
        grrl_record_put(&record, experience->link, 1);
        grrl_record_put(&record, experience->direction, 1);
        grrl_record_put(&record, experience->used_at, 4);
        grrl_record_put_float(&record, experience->q.value);
        grrl_record_put_float(&record, experience->q.mean);
        grrl_record_put_float(&record, experience->q.deviations);
        grrl_record_put(&record, experience->q.n, 4);
        status = grrl_record_write(&record);
    }
    return status;
}

struct header {
    uint32_t n_states;
    uint32_t n_experiences;
    uint32_t clock;
    bool is_old; /* a section of cases follows */
};

static enum grrl_status read_header(const struct grrl_experience_store *store,
                                    struct grrl_record *record, struct header *header)
{
    if (grrl_record_read(record, HEADER_BYTES + GRRL_RECORD_CRC_BYTES) != GRRL_OK)
        return GRRL_ERR_IO;
    if (memcmp(record->bytes, magic, sizeof magic) != 0)
        return grrl_legacy_is_cases(record->bytes) ? GRRL_ERR_POLICY : GRRL_ERR_FORMAT;
    record->n = sizeof magic;
    uint64_t version = grrl_record_take(record, 2);
    header->is_old = version == OLD_VERSION;
    if (version != FILE_VERSION && !header->is_old)
        return GRRL_ERR_VERSION;
    bool fits = grrl_record_take(record, 1) == GRRL_MAX_PROPERTIES;
    fits = grrl_record_take(record, 1) == GRRL_DIRECTIONS && fits;
    header->n_states = (uint32_t)grrl_record_take(record, 4);
    header->n_experiences = (uint32_t)grrl_record_take(record, 4);
    header->clock = (uint32_t)grrl_record_take(record, 4);
    if (grrl_record_check(record, HEADER_BYTES) != GRRL_OK)
        return GRRL_ERR_CORRUPT;
    if (!fits)
        return GRRL_ERR_VERSION;
    return header->n_states <= store->states_capacity &&
                   header->n_experiences <= store->experiences_capacity
               ? GRRL_OK
               : GRRL_ERR_FULL;
}

static bool is_label(grrl_label label)
{
    return label == GRRL_LABEL_BACKGROUND || GRRL_MAX_PROPERTIES == 8 ||
           label >> (8 * (GRRL_MAX_PROPERTIES % 8)) == 0;
}

/* Whether these numbers form an undirected graph with at most one joint between two links. */
static bool is_graph(const struct grrl_graph *graph)
{
    for (uint8_t i = 0; i < graph->n; i++) {
        uint32_t revolute = graph->joined[GRRL_REVOLUTE][i];
        uint32_t prismatic = graph->joined[GRRL_PRISMATIC][i];
        if ((revolute & prismatic) != 0 || !is_label(graph->label[i]) ||
            ((revolute | prismatic) & (grrl_bit(i) | ~grrl_bits_below(graph->n))) != 0)
            return false;
        for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
            for (uint8_t j = 0; j < i; j++)
                if ((graph->joined[type][i] >> j & 1u) != (graph->joined[type][j] >> i & 1u))
                    return false;
        }
    }
    return grrl_graph_joint_count(graph) <= GRRL_MAX_JOINTS;
}

static enum grrl_status read_state(struct grrl_experience_store *store, struct grrl_record *record)
{
    if (grrl_record_read(record, 1) != GRRL_OK)
        return GRRL_ERR_IO;
    uint8_t n = (uint8_t)grrl_record_take(record, 1);
    if (n == 0 || n > 32)
        return GRRL_ERR_CORRUPT;
    if (n > GRRL_MAX_LINKS)
        return GRRL_ERR_VERSION;
    size_t size = (size_t)n * LINK_BYTES;
    if (grrl_record_read(record, size + GRRL_RECORD_CRC_BYTES) != GRRL_OK)
        return GRRL_ERR_IO;
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    graph.n = n;
    for (uint8_t i = 0; i < n; i++) {
        graph.label[i] = grrl_record_take(record, 8);
        graph.joined[GRRL_REVOLUTE][i] = (uint32_t)grrl_record_take(record, 4);
        graph.joined[GRRL_PRISMATIC][i] = (uint32_t)grrl_record_take(record, 4);
    }
    if (grrl_record_check(record, 1 + size) != GRRL_OK || !is_graph(&graph))
        return GRRL_ERR_CORRUPT;
    struct grrl_experience_state described;
    if (!grrl_experience_describe(&graph, &described, NULL))
        return GRRL_ERR_CORRUPT;
    struct grrl_graph canonical;
    grrl_experience_graph(&described, &canonical);
    if (!grrl_graph_equal(&graph, &canonical, GRRL_ALL_PROPERTIES) ||
        grrl_experience_find_state(store, &described) != GRRL_NO_STATE)
        return GRRL_ERR_CORRUPT;
    (void)grrl_experience_add_state(store, &described);
    return GRRL_OK;
}

static bool is_target(float x)
{
    return x >= -GRRL_MAX_TARGET && x <= GRRL_MAX_TARGET;
}

static enum grrl_status read_experience(struct grrl_experience_store *store,
                                        struct grrl_record *record, uint32_t clock)
{
    if (grrl_record_read(record, EXPERIENCE_BYTES + GRRL_RECORD_CRC_BYTES) != GRRL_OK)
        return GRRL_ERR_IO;
    uint32_t state = (uint32_t)grrl_record_take(record, 4);
    uint8_t link = (uint8_t)grrl_record_take(record, 1);
    uint8_t direction = (uint8_t)grrl_record_take(record, 1);
    uint32_t used_at = (uint32_t)grrl_record_take(record, 4);
    struct grrl_q q = {.value = grrl_record_take_float(record)};
    q.mean = grrl_record_take_float(record);
    q.deviations = grrl_record_take_float(record);
    q.n = (uint32_t)grrl_record_take(record, 4);
    bool fine = grrl_record_check(record, EXPERIENCE_BYTES) == GRRL_OK && state < store->n_states &&
                link < store->states[state < store->n_states ? state : 0].n &&
                direction < GRRL_DIRECTIONS && used_at <= clock && is_target(q.value) &&
                is_target(q.mean) && grrl_is_finite(q.deviations) && q.deviations >= 0.0f &&
                q.n > 0 &&
                grrl_experience_find(store, state, link, direction) == GRRL_NO_EXPERIENCE;
    if (!fine)
        return GRRL_ERR_CORRUPT;
    uint32_t index = grrl_experience_add(store, state, link, direction);
    store->experiences[index].used_at = used_at;
    store->experiences[index].q = q;
    return GRRL_OK;
}

static enum grrl_status read_all(struct grrl_experience_store *store, const struct grrl_io *io,
                                 struct header *header)
{
    struct grrl_record record = {.io = io};
    enum grrl_status status = read_header(store, &record, header);
    for (uint32_t i = 0; status == GRRL_OK && i < header->n_states; i++)
        status = read_state(store, &record);
    for (uint32_t i = 0; status == GRRL_OK && i < header->n_experiences; i++)
        status = read_experience(store, &record, header->clock);
    for (uint32_t i = 0; status == GRRL_OK && i < store->n_states; i++)
        status = store->states[i].experiences > 0 ? GRRL_OK : GRRL_ERR_CORRUPT;
    return status == GRRL_OK && header->is_old ? grrl_legacy_skip_cases(io) : status;
}

static void drop_unused_states(struct grrl_experience_store *store)
{
    for (uint32_t state = store->n_states; state-- > 0;)
        if (store->states[state].experiences == 0)
            grrl_experience_remove_state(store, state);
}

enum grrl_status grrl_experience_load(struct grrl_experience_store *store, const struct grrl_io *io,
                                      uint32_t *lost)
{
    struct header header = {0};
    grrl_experience_clear(store);
    enum grrl_status status = read_all(store, io, &header);
    *lost = 0;
    if (status != GRRL_OK && status != GRRL_ERR_IO) {
        grrl_experience_clear(store);
        return status;
    }
    if (status == GRRL_ERR_IO) {
        *lost = header.n_experiences - store->n_experiences;
        drop_unused_states(store);
    }
    store->clock = header.clock;
    return status;
}
