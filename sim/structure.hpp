/* structure.hpp: what the supervisor compares: the truth, and a model on the wire. */
#ifndef GRRL_SIM_STRUCTURE_HPP
#define GRRL_SIM_STRUCTURE_HPP

#include "object.hpp"
#include "wire.h"

namespace grrl_sim
{

/* The structure to be found: the truth without what is glued to the table and never seen. */
grrl_graph visible_structure(const ObjectSpec &object);

/* The structure a model claims. False if it is none, or larger than a graph can be. */
bool structure_of(const grrl_model_t &model, grrl_graph &graph);

} // namespace grrl_sim

#endif
