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
