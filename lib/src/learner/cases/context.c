/* context.c: encodes a link's surroundings and earlier pushes in a few small numbers. */
#include "grrl/learner/cases/context.h"

#include <string.h>

#include "grrl/base/geometry.h"
#include "grrl/learner/grounding.h"
#include "grrl/structure/graph.h"

/* A neighbour counts as ahead or behind within about 70 degrees of the push. */
#define AHEAD_COSINE 0.35f

/* Where the aspect of a link changes its class, and how uneven its features must lie to count as
 * skewed: the mean cube of their distance, relative to the mean square to the power 1.5. */
#define STOUT 0.35f
#define ROUND 0.6f
#define SKEWED 0.15f

/* A smaller ratio of lengths may be noise. */
#define LONGER 1.15f

enum { AHEAD = 1, BEHIND = 2 };
_Static_assert(GRRL_JOINT_TYPES == 2, "GRRL_CONTEXT_ELSEWHERE has a bit for each type");
enum { MAX_TRIED = 3, MAX_JOINTS = 2, MAX_OTHERS_TRIED = 2, MAX_LONGER = 2, MAX_OCTAVE = 4 };

const uint8_t grrl_context_max[GRRL_CONTEXT_PARTS] = {
    [GRRL_CONTEXT_DIRECTION] = 2,
    [GRRL_CONTEXT_LENGTH] = MAX_OCTAVE,
    [GRRL_CONTEXT_TRIED] = MAX_TRIED,
    [GRRL_CONTEXT_NEIGHBOURS] = AHEAD | BEHIND,
    [GRRL_CONTEXT_NEIGHBOUR_LENGTH] = 1 + MAX_OCTAVE,
    [GRRL_CONTEXT_REVOLUTE] = MAX_JOINTS,
    [GRRL_CONTEXT_PRISMATIC] = MAX_JOINTS,
    [GRRL_CONTEXT_OTHERS_TRIED] = MAX_OTHERS_TRIED,
    [GRRL_CONTEXT_LONGER] = MAX_LONGER,
    [GRRL_CONTEXT_ASPECT] = 2,
    [GRRL_CONTEXT_SKEW] = 2,
    [GRRL_CONTEXT_ELSEWHERE] = 3,
};

/* Where a part begins in a key: parts of 3 bits at 18 and 22, all others in pairs of bits. */
static const uint8_t key_shift[GRRL_CONTEXT_PARTS] = {
    [GRRL_CONTEXT_DIRECTION] = 0,
    [GRRL_CONTEXT_LENGTH] = 18,
    [GRRL_CONTEXT_TRIED] = 2,
    [GRRL_CONTEXT_NEIGHBOURS] = 4,
    [GRRL_CONTEXT_NEIGHBOUR_LENGTH] = 22,
    [GRRL_CONTEXT_REVOLUTE] = 6,
    [GRRL_CONTEXT_PRISMATIC] = 8,
    [GRRL_CONTEXT_OTHERS_TRIED] = 10,
    [GRRL_CONTEXT_LONGER] = 12,
    [GRRL_CONTEXT_ASPECT] = 14,
    [GRRL_CONTEXT_SKEW] = 16,
    [GRRL_CONTEXT_ELSEWHERE] = 26,
};

static uint32_t part_mask(unsigned part)
{
    return grrl_context_max[part] > 3 ? 7u : 3u;
}

uint32_t grrl_context_key(const struct grrl_context *context)
{
    uint32_t key = 0;
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        key |= (uint32_t)context->part[i] << key_shift[i];
    return key;
}

uint8_t grrl_context_part(uint32_t key, enum grrl_context_part part)
{
    return (uint8_t)(key >> key_shift[part] & part_mask(part));
}

uint32_t grrl_context_key_bits(uint16_t parts)
{
    uint32_t bits = 0;
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        bits |= ((uint32_t)parts >> i & 1u) != 0 ? part_mask(i) << key_shift[i] : 0u;
    return bits;
}

static uint8_t at_most(unsigned x, unsigned most)
{
    return (uint8_t)(x < most ? x : most);
}

static uint8_t octave(float length_m, float large_m)
{
    uint8_t octave = 0;
    for (float limit = 0.6f * large_m; octave < MAX_OCTAVE && length_m >= limit; limit *= 2.0f)
        octave++;
    return octave;
}

static bool joins(const struct grrl_joint *joint, uint8_t body)
{
    return joint->a == body || joint->b == body;
}

static void count_joints(const struct grrl_model *model, uint8_t body,
                         uint8_t count[GRRL_JOINT_TYPES])
{
    memset(count, 0, GRRL_JOINT_TYPES);
    for (uint8_t j = 0; j < model->n_joints; j++)
        count[model->joint[j].type] += joins(&model->joint[j], body);
}

static struct grrl_attempts *find(struct grrl_trial_attempts *attempts, uint16_t number)
{
    for (unsigned i = 0; i < GRRL_MAX_LINKS; i++)
        if (attempts->link[i].number == number)
            return &attempts->link[i];
    return NULL;
}

static bool is_present(const struct grrl_model *model, uint16_t number)
{
    for (uint8_t i = 0; i < model->n_bodies; i++)
        if (model->body[i].number == number)
            return true;
    return false;
}

void grrl_attempts_update(struct grrl_trial_attempts *attempts, const struct grrl_model *model,
                          float large_m)
{
    for (unsigned i = 0; i < GRRL_MAX_LINKS; i++)
        if (!is_present(model, attempts->link[i].number))
            memset(&attempts->link[i], 0, sizeof attempts->link[i]);
    for (uint8_t i = 0; i < model->n_bodies; i++) {
        struct grrl_attempts now = {.number = model->body[i].number,
                                    .length = octave(model->body[i].length_m, large_m)};
        count_joints(model, i, now.joints);
        struct grrl_attempts *link = find(attempts, now.number);
        if (link == NULL)
            link = find(attempts, 0); /* one is free: at most GRRL_MAX_LINKS bodies exist */
        if (link->number != now.number || link->length != now.length ||
            memcmp(link->joints, now.joints, sizeof now.joints) != 0)
            *link = now;
    }
}

void grrl_attempts_add(struct grrl_trial_attempts *attempts, uint16_t body_number,
                       uint8_t direction)
{
    struct grrl_attempts *link = find(attempts, body_number);
    if (link != NULL && link->tried[direction] < UINT8_MAX)
        link->tried[direction]++;
}

/* The parts that all directions of one body share. */
static void describe_link(const struct grrl_model *model, float large_m, uint8_t body,
                          struct grrl_context *context)
{
    const struct grrl_body *self = &model->body[body];
    uint8_t joints[GRRL_JOINT_TYPES];
    unsigned longer = 0;
    unsigned elsewhere = 0;
    uint8_t longest = 0;
    count_joints(model, body, joints);
    for (uint8_t i = 0; i < model->n_bodies; i++)
        longer += model->body[i].length_m > LONGER * self->length_m;
    for (uint8_t j = 0; j < model->n_joints; j++) {
        const struct grrl_joint *joint = &model->joint[j];
        if (joins(joint, body)) {
            uint8_t other = joint->a == body ? joint->b : joint->a;
            uint8_t length = (uint8_t)(1 + octave(model->body[other].length_m, large_m));
            longest = length > longest ? length : longest;
        } else {
            elsewhere |= 1u << joint->type;
        }
    }
    memset(context, 0, sizeof *context);
    context->part[GRRL_CONTEXT_LENGTH] = octave(self->length_m, large_m);
    context->part[GRRL_CONTEXT_NEIGHBOUR_LENGTH] = longest;
    context->part[GRRL_CONTEXT_REVOLUTE] = at_most(joints[GRRL_REVOLUTE], MAX_JOINTS);
    context->part[GRRL_CONTEXT_PRISMATIC] = at_most(joints[GRRL_PRISMATIC], MAX_JOINTS);
    context->part[GRRL_CONTEXT_LONGER] = at_most(longer, MAX_LONGER);
    context->part[GRRL_CONTEXT_ELSEWHERE] = (uint8_t)elsewhere;
    context->part[GRRL_CONTEXT_ASPECT] = (uint8_t)((self->width_m > STOUT * self->length_m) +
                                                   (self->width_m > ROUND * self->length_m));
}

/* Whether neighbours lie ahead of and behind a push in this direction. */
static uint8_t neighbours_along(const struct grrl_model *model, uint8_t body,
                                struct grrl_vec2 direction)
{
    unsigned sides = 0;
    for (uint8_t j = 0; j < model->n_joints; j++) {
        const struct grrl_joint *joint = &model->joint[j];
        if (!joins(joint, body))
            continue;
        uint8_t other = joint->a == body ? joint->b : joint->a;
        struct grrl_vec2 arm =
            grrl_vec2_sub(model->body[other].centroid_m, model->body[body].centroid_m);
        float along = grrl_vec2_dot(arm, direction);
        float threshold = AHEAD_COSINE * grrl_vec2_length(arm);
        sides |= along > threshold ? (unsigned)AHEAD : 0u;
        sides |= along < -threshold ? (unsigned)BEHIND : 0u;
    }
    return (uint8_t)sides;
}

/* Whether a body's features thin out against a direction (1), along it (2), or neither (0). */
static uint8_t skew_along(const struct grrl_model *model, uint8_t body, struct grrl_vec2 direction)
{
    float square = 0.0f;
    float cube = 0.0f;
    float n = 0.0f;
    for (uint16_t i = 0; i < model->n_features; i++) {
        if (model->feature_body[i] != body)
            continue;
        struct grrl_vec2 arm = grrl_vec2_sub(model->feature_m[i], model->body[body].centroid_m);
        float along = grrl_vec2_dot(arm, direction);
        square += along * along;
        cube += along * along * along;
        n += 1.0f;
    }
    float limit = n > 0.0f ? SKEWED * square * grrl_sqrt(square / n) : 0.0f;
    return (uint8_t)(cube > limit ? 2 : cube < -limit);
}

/* 0 along the axis, 1 at 45 degrees, 2 perpendicular. */
static uint8_t direction_class(int degrees)
{
    return (uint8_t)(degrees % 180 / 45);
}

enum grrl_status grrl_context_of(const struct grrl_trial_attempts *attempts,
                                 const struct grrl_model *model, float large_m, uint8_t body,
                                 struct grrl_context contexts[GRRL_DIRECTIONS])
{
    struct grrl_link_frame frame;
    if (grrl_grounding_frame(model, body, &frame) != GRRL_OK)
        return GRRL_ERR_ARGUMENT;
    const struct grrl_attempts *link = NULL;
    unsigned all_tried = 0;
    for (unsigned i = 0; i < GRRL_MAX_LINKS; i++)
        if (attempts->link[i].number == model->body[body].number)
            link = &attempts->link[i];
    for (uint8_t d = 0; d < GRRL_DIRECTIONS && link != NULL; d++)
        all_tried += link->tried[d];
    struct grrl_context common;
    describe_link(model, large_m, body, &common);
    for (uint8_t d = 0; d < GRRL_DIRECTIONS; d++) {
        unsigned tried = link != NULL ? link->tried[d] : 0;
        contexts[d] = common;
        contexts[d].part[GRRL_CONTEXT_DIRECTION] = direction_class(grrl_direction_deg[d]);
        contexts[d].part[GRRL_CONTEXT_TRIED] = at_most(tried, MAX_TRIED);
        contexts[d].part[GRRL_CONTEXT_OTHERS_TRIED] = at_most(all_tried - tried, MAX_OTHERS_TRIED);
        struct grrl_vec2 direction = grrl_grounding_direction(&frame, d);
        contexts[d].part[GRRL_CONTEXT_NEIGHBOURS] = neighbours_along(model, body, direction);
        if (model->n_joints == 0)
            contexts[d].part[GRRL_CONTEXT_SKEW] = skew_along(model, body, direction);
    }
    return GRRL_OK;
}
