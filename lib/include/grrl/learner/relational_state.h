/*
 * relational_state.h: turns perception's estimate into the learner's state: a graph with links and
 * their properties as vertices and joints as edges (paper, section III).
 *
 * A new link property is one more place in the label: set it in grrl_relational_state_of, and name
 * its atoms in term.h.
 */
#ifndef GRRL_LEARNER_RELATIONAL_STATE_H
#define GRRL_LEARNER_RELATIONAL_STATE_H

#include "grrl/base/api.h"
#include "grrl/perception/perception.h"
#include "grrl/structure/graph.h"

GRRL_API_BEGIN

/* The size of a link: GRRL_PROPERTY_LARGE if its length is at least `large_m`, else
 * GRRL_PROPERTY_SMALL. */
grrl_property grrl_size_of(const struct grrl_body *body, float large_m);

/* The state of a model: vertex i is body i, and edges are in order of discovery. names and edges as
 * in grrl_graph_from_term; either may be NULL. */
void grrl_relational_state_of(const struct grrl_model *model, float large_m,
                              struct grrl_graph *state, struct grrl_name *names,
                              struct grrl_edge *edges);

/* The structure of a model as a term, D(lb, ..), with links named fn and their properties. Statuses
 * as for grrl_graph_to_term. */
GRRL_MUST_USE enum grrl_status grrl_relational_term_of(const struct grrl_model *model,
                                                       float large_m, struct grrl_term_store *store,
                                                       grrl_term *term);

GRRL_API_END

#endif
