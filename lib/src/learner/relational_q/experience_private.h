/*
 * experience_private.h (private): shared by the files of the experience store.
 *
 * Invariants. Each state is in the bucket of each of its keys; the list of bucket b begins at
 * states[b].head, for every b below the capacity, even where there is no state. States 0 ..
 * n_states - 1 are canonical and distinct, and each has a list of at least one experience.
 * Experiences 0 .. n_experiences - 1 are each in the list of their state, and no two of one state
 * share link and direction.
 */
#ifndef GRRL_EXPERIENCE_PRIVATE_H
#define GRRL_EXPERIENCE_PRIVATE_H

#include <stdbool.h>

#include "grrl/learner/relational_q/experience.h"

#define GRRL_NO_STATE UINT32_MAX

/* The tables of a store. */
enum { GRRL_TABLE_EXACT, GRRL_TABLE_SHAPE };

/* Whether a state could be a sub-structure of another, judged by counts and ignoring properties.
 * The counts of paths come first and in a branch of their own: they rule out nine in ten. */
static inline bool grrl_experience_fits(uint64_t part, const struct grrl_paths *part_paths,
                                        uint64_t whole, const struct grrl_paths *whole_paths)
{
    const uint64_t guards = UINT64_C(0x8080808080808080);
    return grrl_paths_counts_within(part_paths, whole_paths) &&
           ((((whole | guards) - part) & guards) == guards) &
               grrl_paths_within(part_paths, whole_paths);
}

/* Fills in what is stored of a state, except its places in tables and lists. False if its canonical
 * form is undecided. order, if not NULL, is set so that canonical link i is link order[i] of the
 * graph. */
bool grrl_experience_describe(const struct grrl_graph *graph, struct grrl_experience_state *state,
                              uint8_t *order);

/* The first state with this key, or the next one after `from`; GRRL_NO_STATE at the end. */
uint32_t grrl_experience_first_in(const struct grrl_experience_store *store, int table,
                                  uint32_t key);
uint32_t grrl_experience_next_in(const struct grrl_experience_store *store, int table, uint32_t key,
                                 uint32_t from);

/* The stored state with the same structure and properties, or GRRL_NO_STATE. */
uint32_t grrl_experience_find_state(const struct grrl_experience_store *store,
                                    const struct grrl_experience_state *described);

/* The experience of a state's action, or GRRL_NO_EXPERIENCE. */
uint32_t grrl_experience_find(const struct grrl_experience_store *store, uint32_t state,
                              uint8_t link, uint8_t direction);

/* Appends; there must be room. A new state needs an experience before the store is used again. */
uint32_t grrl_experience_add_state(struct grrl_experience_store *store,
                                   const struct grrl_experience_state *described);
uint32_t grrl_experience_add(struct grrl_experience_store *store, uint32_t state, uint8_t link,
                             uint8_t direction);

/* Removes a state without experiences; the last state moves into the gap. */
void grrl_experience_remove_state(struct grrl_experience_store *store, uint32_t state);

/* --- the index (experience_index.c) --- */

/* Empties an index, adds a state, removes a state. */
void grrl_experience_index_clear(struct grrl_experience_index *index);
void grrl_experience_index_add(struct grrl_experience_index *index,
                               const struct grrl_experience_state *state, uint32_t number);
void grrl_experience_index_remove(struct grrl_experience_index *index,
                                  const struct grrl_experience_state *state, uint32_t number);

/* Adds to the closest states those that could be a sub- or super-structure of the current one at
 * this distance in links and joints, and sorts them. */
struct grrl_closest;
void grrl_experience_index_find(const struct grrl_experience_index *index,
                                const struct grrl_experience_state *current, unsigned distance,
                                struct grrl_closest *closest);

/* No state is more distant than this. */
unsigned grrl_experience_index_reach(const struct grrl_experience_index *index,
                                     const struct grrl_experience_state *current);

#endif
