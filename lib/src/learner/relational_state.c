/* relational_state.c: perception's model as a labelled graph. */
#include "grrl/learner/relational_state.h"

#include <string.h>

grrl_property grrl_size_of(const struct grrl_body *body, float large_m)
{
    return body->length_m >= large_m ? GRRL_PROPERTY_LARGE : GRRL_PROPERTY_SMALL;
}

void grrl_relational_state_of(const struct grrl_model *model, float large_m,
                              struct grrl_graph *state, struct grrl_name *names,
                              struct grrl_edge *edges)
{
    memset(state, 0, sizeof *state);
    state->n = model->n_bodies;
    for (uint8_t i = 0; i < model->n_bodies; i++) {
        state->label[i] = grrl_size_of(&model->body[i], large_m); /* place 0 */
        if (names != NULL)
            names[i] = (struct grrl_name){GRRL_NAME_FEATURES, model->body[i].number};
    }
    for (uint8_t i = 0; i < model->n_joints; i++) {
        const struct grrl_joint *joint = &model->joint[i];
        state->joined[joint->type][joint->a] |= UINT32_C(1) << joint->b;
        state->joined[joint->type][joint->b] |= UINT32_C(1) << joint->a;
        if (edges != NULL)
            edges[i] = (struct grrl_edge){joint->a, joint->b, joint->type};
    }
}

enum grrl_status grrl_relational_term_of(const struct grrl_model *model, float large_m,
                                         struct grrl_term_store *store, grrl_term *term)
{
    struct grrl_graph graph;
    struct grrl_name names[GRRL_MAX_LINKS];
    struct grrl_edge edges[GRRL_MAX_JOINTS];
    grrl_relational_state_of(model, large_m, &graph, names, edges);
    return grrl_graph_to_term(store, &graph, names, edges, model->n_joints, true, term);
}
