/* structure.hpp: the structures that the supervisor compares: the truth and a model message. */
#ifndef GRRL_SIM_STRUCTURE_HPP
#define GRRL_SIM_STRUCTURE_HPP

#include "object.hpp"
#include "wire.h"

namespace grrl_sim
{

/* The structure to be found: the truth without links fixed to the table, which are never seen. */
grrl_graph visible_structure(const ObjectSpec &object);

/* The structure of a model. False if it is not valid, or exceeds a graph's capacity. */
bool structure_of(const grrl_model_t &model, grrl_graph &graph);

} // namespace grrl_sim

#endif
