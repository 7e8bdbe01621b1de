/*
 * wire.h: converts between the bytes of a message and its struct, with all range checks.
 *
 * The decoders that lcm-gen writes trust the wire: a count sizes an allocation. This module accepts
 * a message only if its fingerprint is right, every count is within its limit, every number is
 * finite and within its documented range, every index points into its array, and the size is exact
 * to the byte. Nothing is allocated. This is the only file of the project that checks ranges of
 * messages.
 *
 * grrl_wire_decode_<type>  returns true, or false with a reason; *out is then unspecified
 * grrl_wire_encode_<type>  the bytes written, or -1 with a reason: what would be refused on the
 *                          other side is not sent
 */
#ifndef GRRL_WIRE_H
#define GRRL_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "channels.h"
#include "grrl_agent_status_t.h"
#include "grrl_decision_t.h"
#include "grrl_image_t.h"
#include "grrl_model_t.h"
#include "grrl_points_t.h"
#include "grrl_push_command_t.h"
#include "grrl_push_status_t.h"
#include "grrl_stop_t.h"
#include "grrl_trial_t.h"

#include "grrl/base/api.h"

GRRL_API_BEGIN

/* The capacities of the messages, at least those of the library (asserted in wire.c). */
enum {
    GRRL_WIRE_MAX_POINTS = 256,
    GRRL_WIRE_MAX_LINKS = 32,
    GRRL_WIRE_MAX_JOINTS = 64,
    GRRL_WIRE_MAX_BYTES = 4096,              /* fits every encoded message but image_t */
    GRRL_WIRE_MAX_PICTURE = 4 * 1024 * 1024, /* bytes of an image_t's picture */
    GRRL_WIRE_MAX_IMAGE_BYTES = GRRL_WIRE_MAX_PICTURE + 128 /* fits an image_t */
};

/* Why a message was refused: type, field and value, in English. */
struct grrl_wire_why {
    char text[128];
};

/* A message with storage for its arrays. After a copy, the copy's pointers still point to the
 * original: call grrl_wire_bind_<type> on the copy. */
struct grrl_wire_points {
    grrl_points_t message;
    int32_t id[GRRL_WIRE_MAX_POINTS];
    float x[GRRL_WIRE_MAX_POINTS];
    float y[GRRL_WIRE_MAX_POINTS];
};

struct grrl_wire_model {
    grrl_model_t message;
    int16_t link_number[GRRL_WIRE_MAX_LINKS];
    float link_x[GRRL_WIRE_MAX_LINKS];
    float link_y[GRRL_WIRE_MAX_LINKS];
    float link_angle[GRRL_WIRE_MAX_LINKS];
    float link_length[GRRL_WIRE_MAX_LINKS];
    float link_width[GRRL_WIRE_MAX_LINKS];
    int8_t link_size[GRRL_WIRE_MAX_LINKS];
    int8_t joint_a[GRRL_WIRE_MAX_JOINTS];
    int8_t joint_b[GRRL_WIRE_MAX_JOINTS];
    int8_t joint_type[GRRL_WIRE_MAX_JOINTS];
    float joint_probability[GRRL_WIRE_MAX_JOINTS];
    float joint_x[GRRL_WIRE_MAX_JOINTS];
    float joint_y[GRRL_WIRE_MAX_JOINTS];
    float joint_angle[GRRL_WIRE_MAX_JOINTS];
    float joint_lower[GRRL_WIRE_MAX_JOINTS];
    float joint_upper[GRRL_WIRE_MAX_JOINTS];
    int32_t feature_id[GRRL_WIRE_MAX_POINTS];
    int8_t feature_link[GRRL_WIRE_MAX_POINTS];
};

/* For processes that deal in pictures; of static storage or on the heap, never on the stack. */
struct grrl_wire_image {
    grrl_image_t message;
    uint8_t data[GRRL_WIRE_MAX_PICTURE];
};

/* Points the message's arrays at its own storage. Call it before filling a message by hand. */
void grrl_wire_bind_points(struct grrl_wire_points *points);
void grrl_wire_bind_model(struct grrl_wire_model *model);
void grrl_wire_bind_image(struct grrl_wire_image *image);

bool grrl_wire_decode_points(const void *data, uint32_t size, struct grrl_wire_points *out,
                             struct grrl_wire_why *why);
bool grrl_wire_decode_model(const void *data, uint32_t size, struct grrl_wire_model *out,
                            struct grrl_wire_why *why);
bool grrl_wire_decode_push_command(const void *data, uint32_t size, grrl_push_command_t *out,
                                   struct grrl_wire_why *why);
bool grrl_wire_decode_push_status(const void *data, uint32_t size, grrl_push_status_t *out,
                                  struct grrl_wire_why *why);
bool grrl_wire_decode_trial(const void *data, uint32_t size, grrl_trial_t *out,
                            struct grrl_wire_why *why);
bool grrl_wire_decode_decision(const void *data, uint32_t size, grrl_decision_t *out,
                               struct grrl_wire_why *why);
bool grrl_wire_decode_agent_status(const void *data, uint32_t size, grrl_agent_status_t *out,
                                   struct grrl_wire_why *why);
bool grrl_wire_decode_stop(const void *data, uint32_t size, grrl_stop_t *out,
                           struct grrl_wire_why *why);

bool grrl_wire_decode_image(const void *data, uint32_t size, struct grrl_wire_image *out,
                            struct grrl_wire_why *why);

/* capacity: size of data in bytes. GRRL_WIRE_MAX_BYTES is enough for every message but image_t,
 * which needs GRRL_WIRE_MAX_IMAGE_BYTES. */
int grrl_wire_encode_points(const grrl_points_t *message, int capacity, uint8_t *data,
                            struct grrl_wire_why *why);
int grrl_wire_encode_model(const grrl_model_t *message, int capacity, uint8_t *data,
                           struct grrl_wire_why *why);
int grrl_wire_encode_push_command(const grrl_push_command_t *message, int capacity, uint8_t *data,
                                  struct grrl_wire_why *why);
int grrl_wire_encode_push_status(const grrl_push_status_t *message, int capacity, uint8_t *data,
                                 struct grrl_wire_why *why);
int grrl_wire_encode_trial(const grrl_trial_t *message, int capacity, uint8_t *data,
                           struct grrl_wire_why *why);
int grrl_wire_encode_decision(const grrl_decision_t *message, int capacity, uint8_t *data,
                              struct grrl_wire_why *why);
int grrl_wire_encode_agent_status(const grrl_agent_status_t *message, int capacity, uint8_t *data,
                                  struct grrl_wire_why *why);
int grrl_wire_encode_image(const grrl_image_t *message, int capacity, uint8_t *data,
                           struct grrl_wire_why *why);
int grrl_wire_encode_stop(const grrl_stop_t *message, int capacity, uint8_t *data,
                          struct grrl_wire_why *why);

GRRL_API_END

#endif
