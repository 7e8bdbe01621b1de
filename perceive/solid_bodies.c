/* solid_bodies.c: the bodies of a model after its pieces have been joined. */
#include "solid_bodies.h"

#include <math.h>

#include "grrl/base/geometry.h"

/* Place, axis and size of a solid from its features. */
static void describe(struct grrl_model *model, uint8_t b)
{
    struct grrl_body *body = &model->body[b];
    double n = 0.0;
    double mean[2] = {0.0, 0.0};
    double spread[3] = {0.0, 0.0, 0.0};
    for (uint16_t i = 0; i < model->n_features; i++) {
        if (model->feature_body[i] == b) {
            n += 1.0;
            mean[0] += (double)model->feature_m[i].x;
            mean[1] += (double)model->feature_m[i].y;
        }
    }
    body->n_features = (uint16_t)n;
    body->centroid_m = (struct grrl_vec2){(float)(mean[0] / n), (float)(mean[1] / n)};
    for (uint16_t i = 0; i < model->n_features; i++) {
        if (model->feature_body[i] == b) {
            struct grrl_vec2 d = grrl_vec2_sub(model->feature_m[i], body->centroid_m);
            spread[0] += (double)(d.x * d.x);
            spread[1] += (double)(d.x * d.y);
            spread[2] += (double)(d.y * d.y);
        }
    }
    double angle = 0.5 * atan2(2.0 * spread[1], spread[0] - spread[2]);
    body->axis = (struct grrl_vec2){(float)cos(angle), (float)sin(angle)};
    float low[2] = {0.0f, 0.0f};
    float high[2] = {0.0f, 0.0f};
    for (uint16_t i = 0; i < model->n_features; i++) {
        if (model->feature_body[i] != b)
            continue;
        struct grrl_vec2 d = grrl_vec2_sub(model->feature_m[i], body->centroid_m);
        const float at[2] = {grrl_vec2_dot(body->axis, d), grrl_vec2_cross(body->axis, d)};
        for (int k = 0; k < 2; k++) {
            low[k] = at[k] < low[k] ? at[k] : low[k];
            high[k] = at[k] > high[k] ? at[k] : high[k];
        }
    }
    body->length_m = high[0] - low[0];
    body->width_m = high[1] - low[1];
}

void grrl_solids_renumber(const uint8_t *into, const bool *solid, struct grrl_model *model,
                          struct grrl_solids *solids)
{
    uint8_t new_of[GRRL_MAX_LINKS];
    uint8_t n = 0;
    for (uint8_t b = 0; b < model->n_bodies; b++) {
        if (into[b] == b) {
            new_of[b] = n;
            solids->origin[n] = b;
            solids->solid[n] = solid[b];
            model->body[n++] = model->body[b];
        }
        new_of[b] = new_of[into[b]]; /* a piece comes after the one it is joined to */
    }
    uint8_t n_joints = 0;
    for (uint8_t j = 0; j < model->n_joints; j++) {
        struct grrl_joint joint = model->joint[j];
        joint.a = new_of[joint.a];
        joint.b = new_of[joint.b];
        if (!solids->solid[joint.a] && !solids->solid[joint.b])
            model->joint[n_joints++] = joint;
    }
    for (uint16_t i = 0; i < model->n_features; i++)
        if (model->feature_body[i] < model->n_bodies)
            model->feature_body[i] = new_of[model->feature_body[i]];
    model->n_joints = n_joints;
    model->n_bodies = n;
    for (uint8_t b = 0; b < n; b++)
        if (solids->solid[b])
            describe(model, b);
}
