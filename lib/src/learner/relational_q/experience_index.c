/* experience_index.c: stored states, indexed by their numbers of links and joints. */
#include <assert.h>
#include <string.h>

#include "learner/relational_q/closest.h"
#include "learner/relational_q/experience_private.h"

/* Links and joints of each type are the lowest counts of a signature. */
#define SIZE_BYTES UINT64_C(0xffffff)

static uint64_t size_of(unsigned links, unsigned revolute, unsigned prismatic)
{
    return links | (uint64_t)revolute << 8 | (uint64_t)prismatic << 16;
}

static uint32_t cell_of(uint64_t counts)
{
    uint32_t spread = (uint32_t)(counts & SIZE_BYTES) * UINT32_C(0x9e3779b1);
    return (uint32_t)((uint64_t)spread * GRRL_EXPERIENCE_CELLS >> 32);
}

/* Joints beyond one per link: in a connected structure one less than its loops. */
static int spare_joints(unsigned links, unsigned revolute, unsigned prismatic)
{
    return (int)(revolute + prismatic) - (int)links;
}

void grrl_experience_index_clear(struct grrl_experience_index *index)
{
    memset(index->start, 0, sizeof index->start);
    memset(index->most, 0, sizeof index->most);
    index->fewest_spare = INT8_MAX;
    index->most_spare = INT8_MIN;
}

/* Each later cell makes room by moving its first row to its end. */
void grrl_experience_index_add(struct grrl_experience_index *index,
                               const struct grrl_experience_state *state, uint32_t number)
{
    uint64_t counts = state->signature.word[0];
    uint32_t cell = cell_of(counts);
    uint32_t open = index->start[GRRL_EXPERIENCE_CELLS]++;
    for (uint32_t behind = GRRL_EXPERIENCE_CELLS - 1; behind > cell; --behind) {
        uint32_t first = index->start[behind]++;
        if (first != open) {
            index->rows[open] = index->rows[first];
            open = first;
        }
    }
    index->rows[open] = (struct grrl_experience_row){counts, state->paths, number};
    for (int i = 0; i < 1 + GRRL_JOINT_TYPES; i++) {
        uint8_t size = (uint8_t)(counts >> 8 * i);
        index->most[i] = size > index->most[i] ? size : index->most[i];
    }
    const int spare = spare_joints(state->n, state->joints[0], state->joints[1]);
    index->fewest_spare = (int8_t)(spare < index->fewest_spare ? spare : index->fewest_spare);
    index->most_spare = (int8_t)(spare > index->most_spare ? spare : index->most_spare);
}

void grrl_experience_index_remove(struct grrl_experience_index *index,
                                  const struct grrl_experience_state *state, uint32_t number)
{
    uint32_t cell = cell_of(state->signature.word[0]);
    uint32_t open = index->start[cell];
    while (index->rows[open].state != number)
        open++;
    assert(open < index->start[cell + 1]);
    for (uint32_t behind = cell + 1; behind <= GRRL_EXPERIENCE_CELLS; behind++) {
        uint32_t last = --index->start[behind];
        if (last != open) {
            index->rows[open] = index->rows[last];
            open = last;
        }
    }
}

/* Searches the states of one size, all larger than the current one or all smaller. */
static inline void search_cell(const struct grrl_experience_index *index, uint64_t size,
                               bool larger, const struct grrl_experience_state *current,
                               unsigned distance, struct grrl_closest *closest)
{
    const uint64_t own = current->signature.word[0];
    const struct grrl_paths paths = current->paths;
    uint32_t cell = cell_of(size);
    for (uint32_t i = index->start[cell]; i < index->start[cell + 1]; i++) {
        const struct grrl_experience_row *row = &index->rows[i];
        bool fits = larger ? grrl_experience_fits(own, &paths, row->counts, &row->paths)
                           : grrl_experience_fits(row->counts, &row->paths, own, &paths);
        if (fits && (row->counts & SIZE_BYTES) == size &&
            grrl_closest_accepts(closest, distance, row->state))
            grrl_closest_add(closest, distance, row->state);
    }
}

/* Whether a state of this size may be there. A cell holds states of other sizes, too, so a size
 * that none has would cost a search. */
static bool may_hold(const struct grrl_experience_index *index, unsigned links, unsigned revolute,
                     unsigned prismatic)
{
    const int spare = spare_joints(links, revolute, prismatic);
    return links <= index->most[0] && revolute <= index->most[1] && prismatic <= index->most[2] &&
           spare >= index->fewest_spare && spare <= index->most_spare;
}

void grrl_experience_index_find(const struct grrl_experience_index *index,
                                const struct grrl_experience_state *current, unsigned distance,
                                struct grrl_closest *closest)
{
    const unsigned n = current->n;
    const unsigned r = current->joints[GRRL_REVOLUTE];
    const unsigned p = current->joints[GRRL_PRISMATIC];
    for (unsigned links = 0; links <= distance; links++) {
        for (unsigned revolute = 0; links + revolute <= distance; revolute++) {
            unsigned prismatic = distance - links - revolute;
            if (links <= n && revolute <= r && prismatic <= p &&
                may_hold(index, n - links, r - revolute, p - prismatic))
                search_cell(index, size_of(n - links, r - revolute, p - prismatic), false, current,
                            distance, closest);
            if (may_hold(index, n + links, r + revolute, p + prismatic))
                search_cell(index, size_of(n + links, r + revolute, p + prismatic), true, current,
                            distance, closest);
        }
    }
    grrl_closest_sort(closest);
}

unsigned grrl_experience_index_reach(const struct grrl_experience_index *index,
                                     const struct grrl_experience_state *current)
{
    const unsigned own[] = {current->n, current->joints[GRRL_REVOLUTE],
                            current->joints[GRRL_PRISMATIC]};
    unsigned less = 0;
    unsigned more = 0;
    for (int i = 0; i < 1 + GRRL_JOINT_TYPES; i++) {
        less += own[i];
        more += index->most[i] > own[i] ? index->most[i] - own[i] : 0;
    }
    return less > more ? less : more;
}
