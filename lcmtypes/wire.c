/* Decodes and encodes each message, and checks every field. */
#include "wire.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

#include "grrl/base/config.h"

_Static_assert(GRRL_WIRE_MAX_POINTS >= GRRL_MAX_FEATURES, "every feature fits a points_t");
_Static_assert(GRRL_WIRE_MAX_LINKS >= GRRL_MAX_LINKS, "every link fits a model_t");
_Static_assert(GRRL_WIRE_MAX_JOINTS >= GRRL_MAX_JOINTS, "every joint fits a model_t");
_Static_assert(sizeof(float) == 4, "IEEE single precision");

enum kind { I8, I16, I32, I64, F32, BYTE };
static const uint8_t kind_bytes[] = {1, 2, 4, 8, 4, 1};

/* One field of a message: its place in the struct and its allowed values. The rows of a table
 * follow the order of the .lcm file, which is the order of the bytes. */
struct field {
    const char *name;
    double range[2]; /* smallest and largest value */
    uint16_t offset;
    uint16_t count_offset; /* of the int32_t that counts a variable array, or NO_COUNT */
    uint8_t kind;
    uint8_t n; /* values stored in the struct; 0 for a variable array, which is a pointer */
};

enum { NO_COUNT = 0xffff };

struct type {
    const char *name;
    int64_t (*fingerprint)(void);
    const struct field *fields;
    size_t n_fields;
};

/* The fingerprint precedes the fields. */
enum { HEAD_BYTES = 8 };

/* The remaining arguments are the range: low, high. */
#define ONE(type, kind, field, ...) ROW(type, kind, field, NO_COUNT, 1, __VA_ARGS__)
#define TWO(type, kind, field, ...) ROW(type, kind, field, NO_COUNT, 2, __VA_ARGS__)
#define MANY(type, kind, field, count, ...)                                                        \
    ROW(type, kind, field, (uint16_t)offsetof(type, count), 0, __VA_ARGS__)
#define ROW(type, kind, field, count, n, ...)                                                      \
    {                                                                                              \
#field, {__VA_ARGS__ }, (uint16_t)offsetof(type, field), count, kind, n                    \
    }

/* Ranges that many fields share. A double holds the 32-bit ones exactly; for 64-bit numbers only
 * the lower bound matters. */
#define ANY64 -9.3e18, 9.3e18
#define COUNT64 0.0, 9.3e18
#define POSITIVE64 1.0, 9.3e18
#define ANY32 -2147483648.0, 2147483647.0
#define COUNT32 0.0, 2147483647.0
#define ANY_FLOAT -(double)FLT_MAX, (double)FLT_MAX
#define COORDINATE -1000.0, 1000.0
#define LENGTH 0.0, 1000.0
#define PICTURE_SIDE 16, 4096
#define LINK_INDEX 0.0, GRRL_WIRE_MAX_LINKS - 1

#define P grrl_points_t
static const struct field points_fields[] = {
    ONE(P, I64, utime, ANY64),
    ONE(P, I64, session_id, POSITIVE64),
    ONE(P, I64, seq, POSITIVE64),
    ONE(P, I32, trial_id, COUNT32),
    ONE(P, I32, ack_cmd_seq, COUNT32),
    ONE(P, I64, agent_session_id, COUNT64),
    ONE(P, I8, mode, GRRL_POINTS_T_REAL_TIME, GRRL_POINTS_T_MORE),
    ONE(P, I8, phase, GRRL_POINTS_T_UNKNOWN, GRRL_POINTS_T_SETTLED),
    ONE(P, I32, n_points, 0, GRRL_WIRE_MAX_POINTS),
    MANY(P, I32, id, n_points, ANY32),
    MANY(P, F32, x, n_points, COORDINATE),
    MANY(P, F32, y, n_points, COORDINATE),
};
#undef P

#define M grrl_model_t
static const struct field model_fields[] = {
    ONE(M, I64, utime, ANY64),
    ONE(M, I64, session_id, POSITIVE64),
    ONE(M, I32, trial_id, COUNT32),
    ONE(M, I32, cmd_seq, COUNT32),
    ONE(M, I32, n_links, 0, GRRL_WIRE_MAX_LINKS),
    ONE(M, I32, n_joints, 0, GRRL_WIRE_MAX_JOINTS),
    ONE(M, I32, n_features, 0, GRRL_WIRE_MAX_POINTS),
    MANY(M, I16, link_number, n_links, 0, 32767),
    MANY(M, F32, link_x, n_links, COORDINATE),
    MANY(M, F32, link_y, n_links, COORDINATE),
    MANY(M, F32, link_angle, n_links, ANY_FLOAT),
    MANY(M, F32, link_length, n_links, LENGTH),
    MANY(M, F32, link_width, n_links, LENGTH),
    MANY(M, I8, link_size, n_links, 0, 127),
    MANY(M, I8, joint_a, n_joints, LINK_INDEX),
    MANY(M, I8, joint_b, n_joints, LINK_INDEX),
    MANY(M, I8, joint_type, n_joints, GRRL_MODEL_T_REVOLUTE, GRRL_MODEL_T_PRISMATIC),
    MANY(M, F32, joint_probability, n_joints, 0, 1),
    MANY(M, F32, joint_x, n_joints, ANY_FLOAT),
    MANY(M, F32, joint_y, n_joints, ANY_FLOAT),
    MANY(M, F32, joint_angle, n_joints, ANY_FLOAT),
    MANY(M, F32, joint_lower, n_joints, ANY_FLOAT),
    MANY(M, F32, joint_upper, n_joints, ANY_FLOAT),
    MANY(M, I32, feature_id, n_features, ANY32),
    MANY(M, I8, feature_link, n_features, GRRL_MODEL_T_UNASSIGNED, GRRL_WIRE_MAX_LINKS - 1),
};
#undef M

#define C grrl_push_command_t
static const struct field push_command_fields[] = {
    ONE(C, I64, utime, ANY64),
    ONE(C, I64, session_id, POSITIVE64),
    ONE(C, I64, plant_session_id, COUNT64),
    ONE(C, I64, points_seq, COUNT64),
    ONE(C, I32, trial_id, COUNT32),
    ONE(C, I32, trial_revision, COUNT32),
    ONE(C, I32, cmd_seq, COUNT32),
    ONE(C, I8, kind, GRRL_PUSH_COMMAND_T_WAIT, GRRL_PUSH_COMMAND_T_PUSH),
    TWO(C, F32, start, COORDINATE),
    TWO(C, F32, end, COORDINATE),
    ONE(C, F32, travel, LENGTH),
    ONE(C, F32, speed, 0, 100),
    ONE(C, F32, force, 0, 10000),
    ONE(C, F32, timeout, 0, 3600),
};
#undef C

#define S grrl_push_status_t
static const struct field push_status_fields[] = {
    ONE(S, I64, utime, ANY64),
    ONE(S, I64, session_id, POSITIVE64),
    ONE(S, I64, agent_session_id, COUNT64),
    ONE(S, I32, trial_id, COUNT32),
    ONE(S, I32, cmd_seq, COUNT32),
    ONE(S, I8, state, GRRL_PUSH_STATUS_T_IDLE, GRRL_PUSH_STATUS_T_REFUSED),
    ONE(S, I8, reason, GRRL_PUSH_STATUS_T_NONE, GRRL_PUSH_STATUS_T_BAD_COMMAND),
    TWO(S, F32, tool, COORDINATE),
};
#undef S

#define T grrl_trial_t
static const struct field trial_fields[] = {
    ONE(T, I64, utime, ANY64),
    ONE(T, I64, session_id, POSITIVE64),
    ONE(T, I32, trial_id, 1, 2147483647),
    ONE(T, I32, revision, 1, 2147483647),
    ONE(T, I32, judged_cmd_seq, -1, 2147483647),
    ONE(T, I8, phase, GRRL_TRIAL_T_RUNNING, GRRL_TRIAL_T_FINISHED),
    ONE(T, I8, outcome, GRRL_TRIAL_T_NONE, GRRL_TRIAL_T_ABORTED),
};
#undef T

#define D grrl_decision_t
static const struct field decision_fields[] = {
    ONE(D, I64, utime, ANY64),
    ONE(D, I64, session_id, POSITIVE64),
    ONE(D, I32, trial_id, COUNT32),
    ONE(D, I32, cmd_seq, 1, 2147483647),
    ONE(D, I16, link_number, 0, 32767),
    ONE(D, I16, direction_deg, 0, 359),
    ONE(D, I8, reason, GRRL_DECISION_T_RANDOM, GRRL_DECISION_T_RULE),
    ONE(D, I8, source, GRRL_DECISION_T_NONE, GRRL_DECISION_T_CASES),
    ONE(D, I16, distance, 0, 32767),
    ONE(D, I32, source_index, -1, 2147483647),
    ONE(D, F32, value, ANY_FLOAT),
    ONE(D, F32, lower, ANY_FLOAT),
    ONE(D, F32, upper, ANY_FLOAT),
    ONE(D, F32, phi, 0, 1),
    ONE(D, F32, last_reward, ANY_FLOAT),
    ONE(D, F32, last_target, ANY_FLOAT),
};
#undef D

#define A grrl_agent_status_t
static const struct field agent_status_fields[] = {
    ONE(A, I64, utime, ANY64),
    ONE(A, I64, session_id, POSITIVE64),
    ONE(A, I64, plant_session_id, COUNT64),
    ONE(A, I32, trial_id, COUNT32),
    ONE(A, I32, pushes, COUNT32),
    ONE(A, I32, entries, COUNT32),
    ONE(A, I32, capacity, COUNT32),
    ONE(A, I32, evictions, COUNT32),
    ONE(A, I64, received, COUNT64),
    ONE(A, I64, lost, COUNT64),
    ONE(A, I64, repeated, COUNT64),
    ONE(A, I64, rejected, COUNT64),
    ONE(A, I64, foreign, COUNT64),
};
#undef A

#define I grrl_image_t
static const struct field image_fields[] = {
    ONE(I, I64, utime, ANY64),
    ONE(I, I64, session_id, POSITIVE64),
    ONE(I, I64, seq, POSITIVE64),
    ONE(I, I32, trial_id, COUNT32),
    ONE(I, I32, ack_cmd_seq, COUNT32),
    ONE(I, I64, agent_session_id, COUNT64),
    ONE(I, I8, mode, GRRL_POINTS_T_REAL_TIME, GRRL_POINTS_T_LOCK_STEP),
    ONE(I, I8, phase, GRRL_POINTS_T_UNKNOWN, GRRL_POINTS_T_SETTLED),
    ONE(I, I32, width, PICTURE_SIDE),
    ONE(I, I32, height, PICTURE_SIDE),
    ONE(I, I8, encoding, GRRL_IMAGE_T_RAW_GREY, GRRL_IMAGE_T_PNG),
    ONE(I, I32, n_bytes, 1, GRRL_WIRE_MAX_PICTURE),
    MANY(I, BYTE, data, n_bytes, 0, 255),
};
#undef I

#define S grrl_stop_t
static const struct field stop_fields[] = {
    ONE(S, I64, utime, ANY64),
    ONE(S, I64, session_id, POSITIVE64),
    ONE(S, I64, agent_session_id, COUNT64),
    ONE(S, I8, reason, GRRL_STOP_T_OPERATOR, GRRL_STOP_T_FAULT),
};
#undef S

/* The address of a field's first value. A variable array is a pointer in the struct; memcpy reads
 * it regardless of the pointer's type. */
static unsigned char *place(const struct field *field, void *message)
{
    unsigned char *base = (unsigned char *)message + field->offset;
    if (field->n == 0) {
        void *array;
        memcpy(&array, base, sizeof array);
        base = array;
    }
    return base;
}

static const unsigned char *place_const(const struct field *field, const void *message)
{
    const unsigned char *base = (const unsigned char *)message + field->offset;
    if (field->n == 0) {
        const void *array;
        memcpy(&array, base, sizeof array);
        base = array;
    }
    return base;
}

static uint32_t count(const struct field *field, const void *message)
{
    int32_t n = field->n;
    if (field->count_offset != NO_COUNT)
        memcpy(&n, (const unsigned char *)message + field->count_offset, sizeof n);
    return (uint32_t)n;
}

static uint64_t big_endian(const uint8_t *data, unsigned n)
{
    uint64_t bits = 0;
    for (unsigned i = 0; i < n; i++)
        bits = bits << 8 | data[i];
    return bits;
}

static void put_big_endian(uint64_t bits, unsigned n, uint8_t *data)
{
    for (unsigned i = n; i-- > 0; bits >>= 8)
        data[i] = (uint8_t)bits;
}

/* Stores a value whose bits are right-aligned. */
static void store(enum kind kind, uint64_t bits, unsigned char *to)
{
    uint8_t b1 = (uint8_t)bits;
    uint16_t b2 = (uint16_t)bits;
    uint32_t b4 = (uint32_t)bits;
    const void *from[] = {&b1, &b2, &b4, &bits, &b4};
    memcpy(to, from[kind], kind_bytes[kind]);
}

static double load(enum kind kind, const unsigned char *from)
{
    int8_t i1;
    int16_t i2;
    int32_t i4;
    int64_t i8;
    float f;
    switch (kind) {
    case I8:
        memcpy(&i1, from, sizeof i1);
        return i1;
    case I16:
        memcpy(&i2, from, sizeof i2);
        return i2;
    case I32:
        memcpy(&i4, from, sizeof i4);
        return i4;
    case I64:
        memcpy(&i8, from, sizeof i8);
        return (double)i8;
    default:
        memcpy(&f, from, sizeof f);
        return (double)f;
    }
}

static bool in_range(const struct field *field, double value)
{
    return value >= field->range[0] && value <= field->range[1]; /* written so that NaN fails */
}

/* Whether n values are in range. A frame has three arrays of up to 256 values: those in loops that
 * the compiler turns into vectors, with limits that a float or an int32_t holds exactly. */
static bool all_in_range(const struct field *field, const unsigned char *values, uint32_t n)
{
    unsigned good = 1;
    if (field->kind == F32) {
        const float low = (float)field->range[0];
        const float high = (float)field->range[1];
        for (uint32_t i = 0; i < n; i++) {
            float value;
            memcpy(&value, values + (size_t)i * sizeof value, sizeof value);
            good &= (unsigned)(value >= low) & (unsigned)(value <= high);
        }
    } else if (field->kind == I32) {
        const int32_t low = (int32_t)field->range[0];
        const int32_t high = (int32_t)field->range[1];
        for (uint32_t i = 0; i < n && (low > INT32_MIN || high < INT32_MAX); i++) {
            int32_t value;
            memcpy(&value, values + (size_t)i * sizeof value, sizeof value);
            good &= (unsigned)(value >= low) & (unsigned)(value <= high);
        }
    } else {
        for (uint32_t i = 0; i < n; i++)
            good &= in_range(
                field, load((enum kind)field->kind, values + (size_t)i * kind_bytes[field->kind]));
    }
    return good != 0;
}

/* Names the first value that is out of range. */
static bool refuse(const struct type *type, const struct field *field, const unsigned char *values,
                   struct grrl_wire_why *why)
{
    double value;
    do {
        value = load((enum kind)field->kind, values);
        values += kind_bytes[field->kind];
    } while (in_range(field, value));
    (void)snprintf(why->text, sizeof why->text, "%s: %s is %.9g, must be %.9g to %.9g", type->name,
                   field->name, value, field->range[0], field->range[1]);
    return false;
}

/* From the wire's order of bytes to the machine's, or back: it is the same change. */
static void turn(enum kind kind, const uint8_t *bytes, uint32_t n, uint8_t *to)
{
    const unsigned width = kind_bytes[kind];
    if (width == 1) /* there may be a million */
        memcpy(to, bytes, n);
    for (uint32_t i = 0; width == 4 && i < n; i++) {
        const uint8_t *from = bytes + 4 * (size_t)i;
        uint32_t bits =
            (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
        memcpy(to + 4 * (size_t)i, &bits, 4);
    }
    for (uint32_t i = 0; (width == 2 || width == 8) && i < n; i++)
        store(kind, big_endian(bytes + (size_t)i * width, width), to + (size_t)i * width);
}

static bool decode(const struct type *type, const void *data, uint32_t size, void *message,
                   struct grrl_wire_why *why)
{
    const uint8_t *bytes = data;
    if (size < HEAD_BYTES || big_endian(bytes, HEAD_BYTES) != (uint64_t)type->fingerprint()) {
        (void)snprintf(why->text, sizeof why->text, "%s: not a message of this type", type->name);
        return false;
    }
    uint32_t at = HEAD_BYTES;
    for (size_t f = 0; f < type->n_fields; f++) {
        const struct field *field = &type->fields[f];
        unsigned width = kind_bytes[field->kind];
        /* Counts were checked as fields of their own, so n * width cannot overflow. */
        uint32_t n = count(field, message);
        if (n * width > size - at) {
            (void)snprintf(why->text, sizeof why->text, "%s: ends within %s, after %u bytes",
                           type->name, field->name, (unsigned)size);
            return false;
        }
        unsigned char *to = place(field, message);
        turn((enum kind)field->kind, bytes + at, n, to);
        at += n * width;
        if (field->kind != BYTE && !all_in_range(field, to, n)) /* every byte is right */
            return refuse(type, field, to, why);
    }
    if (at == size)
        return true;
    (void)snprintf(why->text, sizeof why->text, "%s: %u bytes too many", type->name,
                   (unsigned)(size - at));
    return false;
}

/* The same checks, on the sender's side. Returns the bytes written, or -1. */
static int encode(const struct type *type, const void *message, int capacity, uint8_t *data,
                  struct grrl_wire_why *why)
{
    const uint32_t room = capacity < 0 ? 0 : (uint32_t)capacity;
    uint32_t at = HEAD_BYTES;
    for (size_t f = 0; f < type->n_fields; f++) {
        const struct field *field = &type->fields[f];
        const unsigned char *values = place_const(field, message);
        uint32_t n = count(field, message);
        if (field->kind != BYTE && !all_in_range(field, values, n)) {
            (void)refuse(type, field, values, why);
            return -1;
        }
        if (room < at || n * kind_bytes[field->kind] > room - at) {
            (void)snprintf(why->text, sizeof why->text, "%s: the buffer is too small", type->name);
            return -1;
        }
        turn((enum kind)field->kind, values, n, data + at);
        at += n * kind_bytes[field->kind];
    }
    put_big_endian((uint64_t)type->fingerprint(), HEAD_BYTES, data);
    return (int)at;
}

/* Checks what the table cannot express: indices of links must be below the number of links. */
static bool check_indices(const grrl_model_t *model, struct grrl_wire_why *why)
{
    for (int32_t j = 0; j < model->n_joints; j++) {
        int a = model->joint_a[j];
        int b = model->joint_b[j];
        if (a < model->n_links && b < model->n_links && a != b)
            continue;
        (void)snprintf(why->text, sizeof why->text,
                       "model_t: joint %d between links %d and %d of %d", (int)j, a, b,
                       (int)model->n_links);
        return false;
    }
    for (int32_t i = 0; i < model->n_features; i++) {
        if (model->feature_link[i] < model->n_links)
            continue;
        (void)snprintf(why->text, sizeof why->text, "model_t: feature_link is %d of %d links",
                       model->feature_link[i], (int)model->n_links);
        return false;
    }
    return true;
}

/* A picture without coding has a byte a pixel, or three. */
static bool check_picture(const grrl_image_t *image, struct grrl_wire_why *why)
{
    int32_t pixels = image->width * image->height;
    int32_t bytes = image->encoding == GRRL_IMAGE_T_RAW_GREY  ? pixels
                    : image->encoding == GRRL_IMAGE_T_RAW_BGR ? 3 * pixels
                                                              : image->n_bytes;
    if (image->n_bytes == bytes)
        return true;
    (void)snprintf(why->text, sizeof why->text, "image_t: n_bytes is %d, %d x %d pixels are %d",
                   (int)image->n_bytes, (int)image->width, (int)image->height, (int)bytes);
    return false;
}

#define TYPE(x)                                                                                    \
    static const struct type x##_type = {#x "_t", __grrl_##x##_t_get_hash, x##_fields,             \
                                         sizeof x##_fields / sizeof x##_fields[0]};

#define ENCODE(x)                                                                                  \
    int grrl_wire_encode_##x(const grrl_##x##_t *message, int capacity, uint8_t *data,             \
                             struct grrl_wire_why *why)                                            \
    {                                                                                              \
        return encode(&x##_type, message, capacity, data, why);                                    \
    }

#define DECODE(x)                                                                                  \
    bool grrl_wire_decode_##x(const void *data, uint32_t size, grrl_##x##_t *out,                  \
                              struct grrl_wire_why *why)                                           \
    {                                                                                              \
        return decode(&x##_type, data, size, out, why);                                            \
    }

TYPE(points)
TYPE(model)
TYPE(push_command)
TYPE(push_status)
TYPE(trial)
TYPE(decision)
TYPE(agent_status)
TYPE(image)
TYPE(stop)

ENCODE(points)
ENCODE(push_command)
ENCODE(push_status)
ENCODE(trial)
ENCODE(decision)
ENCODE(agent_status)
ENCODE(stop)

DECODE(push_command)
DECODE(push_status)
DECODE(trial)
DECODE(decision)
DECODE(agent_status)
DECODE(stop)

bool grrl_wire_decode_points(const void *data, uint32_t size, struct grrl_wire_points *out,
                             struct grrl_wire_why *why)
{
    grrl_wire_bind_points(out);
    return decode(&points_type, data, size, &out->message, why);
}

bool grrl_wire_decode_model(const void *data, uint32_t size, struct grrl_wire_model *out,
                            struct grrl_wire_why *why)
{
    grrl_wire_bind_model(out);
    return decode(&model_type, data, size, &out->message, why) && check_indices(&out->message, why);
}

int grrl_wire_encode_model(const grrl_model_t *message, int capacity, uint8_t *data,
                           struct grrl_wire_why *why)
{
    int size = encode(&model_type, message, capacity, data, why);
    return size >= 0 && check_indices(message, why) ? size : -1;
}

bool grrl_wire_decode_image(const void *data, uint32_t size, struct grrl_wire_image *out,
                            struct grrl_wire_why *why)
{
    grrl_wire_bind_image(out);
    return decode(&image_type, data, size, &out->message, why) && check_picture(&out->message, why);
}

int grrl_wire_encode_image(const grrl_image_t *message, int capacity, uint8_t *data,
                           struct grrl_wire_why *why)
{
    int size = encode(&image_type, message, capacity, data, why);
    return size >= 0 && check_picture(message, why) ? size : -1;
}

void grrl_wire_bind_image(struct grrl_wire_image *image)
{
    image->message.data = image->data;
}

void grrl_wire_bind_points(struct grrl_wire_points *points)
{
    points->message.id = points->id;
    points->message.x = points->x;
    points->message.y = points->y;
}

void grrl_wire_bind_model(struct grrl_wire_model *model)
{
    grrl_model_t *message = &model->message;
    message->link_number = model->link_number;
    message->link_x = model->link_x;
    message->link_y = model->link_y;
    message->link_angle = model->link_angle;
    message->link_length = model->link_length;
    message->link_width = model->link_width;
    message->link_size = model->link_size;
    message->joint_a = model->joint_a;
    message->joint_b = model->joint_b;
    message->joint_type = model->joint_type;
    message->joint_probability = model->joint_probability;
    message->joint_x = model->joint_x;
    message->joint_y = model->joint_y;
    message->joint_angle = model->joint_angle;
    message->joint_lower = model->joint_lower;
    message->joint_upper = model->joint_upper;
    message->feature_id = model->feature_id;
    message->feature_link = model->feature_link;
}
