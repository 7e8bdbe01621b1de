/* Reads and writes the packets, and checks what it reads. */
#include "packet.h"

#include <string.h>

_Static_assert(ONBOARD_MAX_BYTES <= UINT16_MAX, "a length has 2 bytes");

void onboard_packet_begin(struct onboard_packet *packet, uint8_t type)
{
    packet->type = type;
    packet->n = 0;
    packet->at = 0;
    packet->bad = false;
}

void onboard_put(struct onboard_packet *packet, uint64_t value, unsigned bytes)
{
    if (packet->n + bytes > ONBOARD_MAX_BYTES) {
        packet->bad = true;
        return;
    }
    for (unsigned i = 0; i < bytes; i++)
        packet->bytes[packet->n++] = (uint8_t)(value >> (8 * i));
}

void onboard_put_float(struct onboard_packet *packet, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    onboard_put(packet, bits, 4);
}

uint64_t onboard_get(struct onboard_packet *packet, unsigned bytes)
{
    if (packet->at + bytes > packet->n) {
        packet->bad = true;
        return 0;
    }
    uint64_t value = 0;
    for (unsigned i = 0; i < bytes; i++)
        value |= (uint64_t)packet->bytes[packet->at++] << (8 * i);
    return value;
}

float onboard_get_float(struct onboard_packet *packet)
{
    uint32_t bits = (uint32_t)onboard_get(packet, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

bool onboard_packet_used_up(const struct onboard_packet *packet)
{
    return !packet->bad && packet->at == packet->n;
}

void onboard_put_open(struct onboard_packet *packet, uint64_t seed, const char *policy)
{
    onboard_packet_begin(packet, ONBOARD_OPEN);
    onboard_put(packet, GRRL_MAX_LINKS, 1);
    onboard_put(packet, GRRL_MAX_FEATURES, 2);
    onboard_put(packet, GRRL_MAX_KEYFRAMES, 1);
    onboard_put(packet, ONBOARD_ENTRIES, 2);
    onboard_put(packet, seed, 8);
    size_t length = strlen(policy);
    for (size_t i = 0; i < GRRL_POLICY_NAME_BYTES; i++)
        onboard_put(packet, i < length ? (uint8_t)policy[i] : 0u, 1);
}

void onboard_put_frame(struct onboard_packet *packet, const struct grrl_frame *frame, bool pushing)
{
    onboard_packet_begin(packet, ONBOARD_FRAME);
    onboard_put(packet, pushing, 1);
    onboard_put(packet, frame->n, 2);
    for (uint32_t i = 0; i < frame->n; i++) {
        onboard_put(packet, (uint32_t)frame->id[i], 4);
        onboard_put_float(packet, frame->x_m[i]);
        onboard_put_float(packet, frame->y_m[i]);
    }
}

bool onboard_get_frame(struct onboard_packet *packet, struct onboard_points *points,
                       struct grrl_frame *frame, bool *pushing)
{
    *frame = (struct grrl_frame){.id = points->id, .x_m = points->x_m, .y_m = points->y_m};
    *pushing = onboard_get(packet, 1) != 0;
    uint32_t n = (uint32_t)onboard_get(packet, 2);
    if (n > GRRL_MAX_FEATURES || packet->n != 3 + 12 * n)
        return false;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t id = (uint32_t)onboard_get(packet, 4);
        memcpy(&points->id[i], &id, sizeof id);
        points->x_m[i] = onboard_get_float(packet);
        points->y_m[i] = onboard_get_float(packet);
    }
    frame->n = n;
    return true;
}

static void put_vec2(struct onboard_packet *packet, struct grrl_vec2 v)
{
    onboard_put_float(packet, v.x);
    onboard_put_float(packet, v.y);
}

static void put_joint(struct onboard_packet *packet, const struct grrl_joint *joint)
{
    onboard_put(packet, joint->a, 1);
    onboard_put(packet, joint->b, 1);
    onboard_put(packet, joint->type, 1);
    onboard_put_float(packet, joint->probability);
    onboard_put_float(packet, joint->p_revolute);
    onboard_put_float(packet, joint->p_prismatic);
    onboard_put_float(packet, joint->p_disconnected);
    put_vec2(packet, joint->point_m);
    for (int i = 0; i < 3; i++)
        onboard_put_float(packet, joint->point_cov_m2[i]);
    put_vec2(packet, joint->axis);
    onboard_put_float(packet, joint->axis_sd_rad);
    onboard_put_float(packet, joint->lower);
    onboard_put_float(packet, joint->upper);
}

void onboard_put_model(struct onboard_packet *packet, const struct grrl_model *model)
{
    onboard_put(packet, model->n_bodies, 1);
    onboard_put(packet, model->n_joints, 1);
    onboard_put(packet, model->n_features, 2);
    for (int i = 0; i < model->n_bodies; i++) {
        const struct grrl_body *body = &model->body[i];
        onboard_put(packet, body->number, 2);
        onboard_put(packet, body->n_features, 2);
        put_vec2(packet, body->centroid_m);
        put_vec2(packet, body->axis);
        onboard_put_float(packet, body->length_m);
        onboard_put_float(packet, body->width_m);
    }
    for (int i = 0; i < model->n_joints; i++)
        put_joint(packet, &model->joint[i]);
    for (int i = 0; i < model->n_features; i++) {
        onboard_put(packet, (uint32_t)model->feature_id[i], 4);
        put_vec2(packet, model->feature_m[i]);
        onboard_put(packet, model->feature_body[i], 1);
    }
}

void onboard_put_decision(struct onboard_packet *packet, const struct grrl_decision *decision)
{
    const struct grrl_choice *choice = &decision->choice;
    put_vec2(packet, decision->push.start_m);
    put_vec2(packet, decision->push.end_m);
    onboard_put_float(packet, decision->push.travel_m);
    onboard_put_float(packet, decision->push.speed_m_s);
    onboard_put_float(packet, decision->push.force_n);
    onboard_put_float(packet, decision->push.timeout_s);
    onboard_put(packet, decision->body_number, 2);
    onboard_put(packet, choice->link, 1);
    onboard_put(packet, choice->direction, 1);
    onboard_put(packet, choice->reason, 1);
    onboard_put(packet, choice->source.kind, 1);
    onboard_put(packet, choice->source.distance, 1);
    onboard_put(packet, choice->source.index, 4);
    onboard_put_float(packet, choice->value);
    onboard_put_float(packet, choice->lower);
    onboard_put_float(packet, choice->upper);
    onboard_put_float(packet, choice->phi);
}

void onboard_put_update(struct onboard_packet *packet, const struct grrl_update *update,
                        const struct grrl_usage *usage)
{
    onboard_put_float(packet, update->reward);
    onboard_put_float(packet, update->target);
    onboard_put(packet, update->index, 4);
    onboard_put(packet, usage->n, 4);
    onboard_put(packet, usage->capacity, 4);
    onboard_put(packet, usage->evictions, 4);
}

static struct grrl_vec2 get_vec2(struct onboard_packet *packet)
{
    float x = onboard_get_float(packet);
    return (struct grrl_vec2){x, onboard_get_float(packet)};
}

static uint8_t get_byte(struct onboard_packet *packet)
{
    return (uint8_t)onboard_get(packet, 1);
}

static void get_body(struct onboard_packet *packet, struct grrl_body *body)
{
    body->number = (uint16_t)onboard_get(packet, 2);
    body->n_features = (uint16_t)onboard_get(packet, 2);
    body->centroid_m = get_vec2(packet);
    body->axis = get_vec2(packet);
    body->length_m = onboard_get_float(packet);
    body->width_m = onboard_get_float(packet);
}

static void get_joint(struct onboard_packet *packet, struct grrl_joint *joint)
{
    joint->a = get_byte(packet);
    joint->b = get_byte(packet);
    joint->type = get_byte(packet);
    joint->probability = onboard_get_float(packet);
    joint->p_revolute = onboard_get_float(packet);
    joint->p_prismatic = onboard_get_float(packet);
    joint->p_disconnected = onboard_get_float(packet);
    joint->point_m = get_vec2(packet);
    for (int i = 0; i < 3; i++)
        joint->point_cov_m2[i] = onboard_get_float(packet);
    joint->axis = get_vec2(packet);
    joint->axis_sd_rad = onboard_get_float(packet);
    joint->lower = onboard_get_float(packet);
    joint->upper = onboard_get_float(packet);
}

bool onboard_get_model(struct onboard_packet *packet, struct grrl_model *model)
{
    model->n_bodies = get_byte(packet);
    model->n_joints = get_byte(packet);
    model->n_features = (uint16_t)onboard_get(packet, 2);
    if (model->n_bodies > GRRL_MAX_LINKS || model->n_joints > GRRL_MAX_JOINTS ||
        model->n_features > GRRL_MAX_FEATURES)
        return false;
    bool fine = true;
    for (int i = 0; i < model->n_bodies; i++)
        get_body(packet, &model->body[i]);
    for (int i = 0; i < model->n_joints; i++) {
        struct grrl_joint *joint = &model->joint[i];
        get_joint(packet, joint);
        fine = fine && joint->a < model->n_bodies && joint->b < model->n_bodies &&
               joint->type < GRRL_JOINT_TYPES;
    }
    for (int i = 0; i < model->n_features; i++) {
        uint32_t id = (uint32_t)onboard_get(packet, 4);
        memcpy(&model->feature_id[i], &id, sizeof id);
        model->feature_m[i] = get_vec2(packet);
        uint8_t body = get_byte(packet);
        model->feature_body[i] = body;
        fine = fine && (body < model->n_bodies || body == GRRL_FEATURE_BACKGROUND ||
                        body == GRRL_FEATURE_NONE);
    }
    return fine && onboard_packet_used_up(packet);
}

bool onboard_get_decision(struct onboard_packet *packet, struct grrl_decision *decision)
{
    struct grrl_choice *choice = &decision->choice;
    decision->push.start_m = get_vec2(packet);
    decision->push.end_m = get_vec2(packet);
    decision->push.travel_m = onboard_get_float(packet);
    decision->push.speed_m_s = onboard_get_float(packet);
    decision->push.force_n = onboard_get_float(packet);
    decision->push.timeout_s = onboard_get_float(packet);
    decision->body_number = (uint16_t)onboard_get(packet, 2);
    choice->link = get_byte(packet);
    choice->direction = get_byte(packet);
    choice->reason = get_byte(packet);
    choice->source.kind = get_byte(packet);
    choice->source.distance = get_byte(packet);
    choice->source.index = (uint32_t)onboard_get(packet, 4);
    choice->value = onboard_get_float(packet);
    choice->lower = onboard_get_float(packet);
    choice->upper = onboard_get_float(packet);
    choice->phi = onboard_get_float(packet);
    return onboard_packet_used_up(packet) && choice->link < GRRL_MAX_LINKS &&
           choice->direction < GRRL_DIRECTIONS && choice->reason <= GRRL_CHOICE_RULE &&
           choice->source.kind <= GRRL_SOURCE_CASES;
}

bool onboard_get_update(struct onboard_packet *packet, struct grrl_update *update,
                        struct grrl_usage *usage)
{
    update->reward = onboard_get_float(packet);
    update->target = onboard_get_float(packet);
    update->index = (uint32_t)onboard_get(packet, 4);
    usage->n = (uint32_t)onboard_get(packet, 4);
    usage->capacity = (uint32_t)onboard_get(packet, 4);
    usage->evictions = (uint32_t)onboard_get(packet, 4);
    return onboard_packet_used_up(packet);
}
