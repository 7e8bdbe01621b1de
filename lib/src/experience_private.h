/*
 * experience_private.h (private): what the parts of the experience store share.
 *
 * Invariants: states 0 .. n_states - 1 are canonical, all different, each with a list of at least
 * one experience; experiences 0 .. n_experiences - 1 are each in the list of their state, no two of
 * one state with the same link and direction.
 */
#ifndef GRRL_EXPERIENCE_PRIVATE_H
#define GRRL_EXPERIENCE_PRIVATE_H

#include <stdbool.h>

#include "grrl/experience.h"

enum { GRRL_NO_STATE = -1 };

/* The canonical form and the hash without properties; false if undecided. */
bool grrl_experience_describe(const struct grrl_graph *graph, struct grrl_canonical *canonical,
                              uint32_t *shape);

/* Joints of each type, GRRL_JOINT_TYPES numbers. */
void grrl_experience_count_joints(const struct grrl_graph *graph, uint8_t *joints);

/* The stored state with this canonical form, or GRRL_NO_STATE. */
int grrl_experience_find_state(const struct grrl_experience_store *store,
                               const struct grrl_canonical *canonical);

/* The experience of a state's action, or GRRL_NO_EXPERIENCE. */
uint16_t grrl_experience_find(const struct grrl_experience_store *store, uint16_t state,
                              uint8_t link, uint8_t direction);

/* Appends, with room for it. A state must get an experience before the store is used again. */
uint16_t grrl_experience_add_state(struct grrl_experience_store *store,
                                   const struct grrl_canonical *canonical, uint32_t shape);
uint16_t grrl_experience_add(struct grrl_experience_store *store, uint16_t state, uint8_t link,
                             uint8_t direction);

#endif
