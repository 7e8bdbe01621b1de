/* solid_bodies.h: the bodies of a model after its pieces have been joined. */
#ifndef GRRL_PERCEIVE_SOLID_BODIES_H
#define GRRL_PERCEIVE_SOLID_BODIES_H

#include "solids.h"

/*
 * Makes one body of all that belong to the same, at the place of the first. into: for each body the
 * first one of its solid, or itself; solid: whether what belongs to that is a solid, of which
 * place, axis and size are computed, and whose joints are dropped.
 */
void grrl_solids_renumber(const uint8_t *into, const bool *solid, struct grrl_model *model,
                          struct grrl_solids *solids);

#endif
