/* grounding.c: directions relative to a link, and the line of a push. */
#include "grrl/learner/grounding.h"

#include "grrl/structure/term.h"

/* A joint closer to the middle than this share of the length does not belong to either end. */
#define MIDDLE 0.15f

/* Sides whose lengths differ by less than this share count as equally heavy, so that noise does not
 * decide. */
#define EQUAL_LENGTH 0.05f

/* If a feature blocks the start, the start moves back in these steps, up to this distance. */
#define BACK_STEP_M 0.005f
#define BACK_STEPS 80

/* A feature exactly at the clearance does not block the start. */
#define EDGE_M 0.0001f

void grrl_grounding_config_default(struct grrl_grounding_config *config)
{
    *config = (struct grrl_grounding_config){.finger_radius_m = 0.01f,
                                             .clearance_m = 0.015f,
                                             .travel_m = 0.03f,
                                             .speed_m_s = 0.08f,
                                             .force_n = 10.0f,
                                             .timeout_s = 2.5f};
}

static bool is_positive(float x)
{
    return grrl_is_finite(x) && x > 0.0f;
}

enum grrl_status grrl_grounding_config_check(const struct grrl_grounding_config *config)
{
    bool fine = is_positive(config->finger_radius_m) && is_positive(config->clearance_m) &&
                is_positive(config->travel_m) && is_positive(config->speed_m_s) &&
                is_positive(config->force_n) && is_positive(config->timeout_s);
    return fine ? GRRL_OK : GRRL_ERR_ARGUMENT;
}

/* The bodies that joints connect to `from` without passing through `without`. */
static uint32_t reach(const struct grrl_model *model, uint32_t from, uint32_t without)
{
    uint32_t before;
    do {
        before = from;
        for (uint8_t j = 0; j < model->n_joints; j++) {
            uint32_t a = UINT32_C(1) << model->joint[j].a;
            uint32_t b = UINT32_C(1) << model->joint[j].b;
            if ((from & (a | b)) != 0)
                from |= (a | b) & ~without;
        }
    } while (from != before);
    return from;
}

/* What hangs on one end of a link. */
struct end {
    uint32_t bodies;
    uint8_t first_joint; /* lowest index */
    unsigned links;
    float length_m;
};

/*
 * The position along the axis at which the joint holds the body: its pivot, or the neighbour's
 * position if the pivot is in the middle. A sliding axis has no position, so the neighbour decides.
 */
static float joint_place(const struct grrl_body *body, const struct grrl_body *neighbour,
                         const struct grrl_joint *joint)
{
    struct grrl_vec2 arm = grrl_vec2_sub(joint->point_m, body->centroid_m);
    float place = grrl_vec2_dot(arm, body->axis);
    float middle = MIDDLE * body->length_m;
    if (joint->type == GRRL_REVOLUTE && (place > middle || place < -middle))
        return place;
    return grrl_vec2_dot(grrl_vec2_sub(neighbour->centroid_m, body->centroid_m), body->axis);
}

static void measure_end(const struct grrl_model *model, uint8_t body, struct end *end)
{
    end->bodies = reach(model, end->bodies, UINT32_C(1) << body);
    end->links = 0;
    end->length_m = 0.0f;
    for (uint8_t i = 0; i < model->n_bodies; i++) {
        if ((end->bodies >> i & 1u) != 0) {
            end->links++;
            end->length_m += model->body[i].length_m;
        }
    }
}

/* Whether forward points away from the far end (the one against the axis). */
static bool far_end_holds(const struct end *near, const struct end *far)
{
    if (near->links != far->links)
        return far->links > near->links;
    float difference = far->length_m - near->length_m;
    float equal = EQUAL_LENGTH * (far->length_m + near->length_m);
    if (difference > equal || difference < -equal)
        return difference > 0.0f;
    return far->first_joint <= near->first_joint;
}

static struct grrl_vec2 forward_axis(const struct grrl_model *model, uint8_t body)
{
    const struct grrl_body *self = &model->body[body];
    struct end ends[2] = {{.first_joint = UINT8_MAX}, {.first_joint = UINT8_MAX}};
    for (uint8_t j = 0; j < model->n_joints; j++) {
        const struct grrl_joint *joint = &model->joint[j];
        if (joint->a != body && joint->b != body)
            continue;
        uint8_t other = joint->a == body ? joint->b : joint->a;
        float place = joint_place(self, &model->body[other], joint);
        if (place == 0.0f)
            continue;
        struct end *end = &ends[place < 0.0f ? 1 : 0];
        end->bodies |= UINT32_C(1) << other;
        end->first_joint = j < end->first_joint ? j : end->first_joint;
    }
    measure_end(model, body, &ends[0]);
    measure_end(model, body, &ends[1]);
    return far_end_holds(&ends[0], &ends[1]) ? self->axis : grrl_vec2_scale(self->axis, -1.0f);
}

/* The vector from the body's centroid to that of all features of the rest of its object; zero if
 * there is no rest. */
static struct grrl_vec2 towards_rest(const struct grrl_model *model, uint8_t body)
{
    uint32_t self = UINT32_C(1) << body;
    uint32_t rest = reach(model, self, 0) & ~self;
    struct grrl_vec2 sum = {0.0f, 0.0f};
    for (uint8_t i = 0; i < model->n_bodies; i++) {
        if ((rest >> i & 1u) != 0) {
            struct grrl_vec2 arm =
                grrl_vec2_sub(model->body[i].centroid_m, model->body[body].centroid_m);
            sum = grrl_vec2_add(sum, grrl_vec2_scale(arm, (float)model->body[i].n_features));
        }
    }
    return sum;
}

enum grrl_status grrl_grounding_frame(const struct grrl_model *model, uint8_t body,
                                      struct grrl_link_frame *frame)
{
    if (body >= model->n_bodies)
        return GRRL_ERR_ARGUMENT;
    struct grrl_vec2 forward = forward_axis(model, body);
    struct grrl_vec2 side = {-forward.y, forward.x};
    if (grrl_vec2_dot(side, towards_rest(model, body)) < 0.0f)
        side = grrl_vec2_scale(side, -1.0f);
    *frame = (struct grrl_link_frame){forward, side};
    return GRRL_OK;
}

struct grrl_vec2 grrl_grounding_direction(const struct grrl_link_frame *frame, uint8_t direction)
{
    float angle_rad = (float)grrl_direction_deg[direction] * (GRRL_PI / 180.0f);
    return grrl_vec2_add(grrl_vec2_scale(frame->forward, grrl_cos(angle_rad)),
                         grrl_vec2_scale(frame->side, grrl_sin(angle_rad)));
}

/* A body's extent along a push: distances from its centroid. */
struct span {
    float rear_m;
    float fore_m;
};

/* The rearmost feature is the one the tool meets: the rearmost within the tool's width, if there is
 * one. */
static struct span span_along(const struct grrl_model *model, uint8_t body,
                              struct grrl_vec2 direction, float radius_m)
{
    struct grrl_vec2 centroid = model->body[body].centroid_m;
    struct span all = {0.0f, 0.0f};
    float met = 0.0f;
    bool any = false;
    bool any_met = false;
    for (uint16_t i = 0; i < model->n_features; i++) {
        if (model->feature_body[i] != body)
            continue;
        struct grrl_vec2 arm = grrl_vec2_sub(model->feature_m[i], centroid);
        float along = grrl_vec2_dot(arm, direction);
        float across = grrl_vec2_cross(arm, direction);
        all.rear_m = !any || along < all.rear_m ? along : all.rear_m;
        all.fore_m = !any || along > all.fore_m ? along : all.fore_m;
        any = true;
        if (across <= radius_m && across >= -radius_m) {
            met = !any_met || along < met ? along : met;
            any_met = true;
        }
    }
    if (any_met)
        all.rear_m = met;
    return all;
}

static bool is_blocked(const struct grrl_model *model, struct grrl_vec2 at, float distance_m)
{
    for (uint16_t i = 0; i < model->n_features; i++) {
        if (model->feature_body[i] < model->n_bodies) {
            struct grrl_vec2 arm = grrl_vec2_sub(model->feature_m[i], at);
            if (grrl_vec2_dot(arm, arm) < distance_m * distance_m)
                return true;
        }
    }
    return false;
}

enum grrl_status grrl_grounding_push(const struct grrl_model *model,
                                     const struct grrl_grounding_config *config, uint8_t body,
                                     uint8_t direction, struct grrl_push *push)
{
    struct grrl_link_frame frame;
    if (direction >= GRRL_DIRECTIONS || grrl_grounding_frame(model, body, &frame) != GRRL_OK)
        return GRRL_ERR_ARGUMENT;
    struct grrl_vec2 along = grrl_grounding_direction(&frame, direction);
    struct span span = span_along(model, body, along, config->finger_radius_m);
    float free_m = config->finger_radius_m + config->clearance_m;
    struct grrl_vec2 centroid = model->body[body].centroid_m;
    struct grrl_vec2 start = grrl_vec2_add(centroid, grrl_vec2_scale(along, span.rear_m - free_m));
    for (int i = 0; i < BACK_STEPS && is_blocked(model, start, free_m - EDGE_M); i++)
        start = grrl_vec2_sub(start, grrl_vec2_scale(along, BACK_STEP_M));
    float beyond_m = span.fore_m + config->travel_m + config->clearance_m;
    *push = (struct grrl_push){.start_m = start,
                               .end_m = grrl_vec2_add(centroid, grrl_vec2_scale(along, beyond_m)),
                               .travel_m = config->travel_m,
                               .speed_m_s = config->speed_m_s,
                               .force_n = config->force_n,
                               .timeout_s = config->timeout_s};
    return GRRL_OK;
}
