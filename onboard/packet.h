/*
 * packet.h: the controller's input and output as bytes, little-endian on every machine.
 *
 * A packet is a type, a length (2 bytes) and that many bytes. A recording is a sequence of packets;
 * on a serial line each is in a frame with a CRC (link.h). Requests go to the controller, which
 * answers each.
 *
 *   OPEN     links (1), features (2), keyframes (1), entries (2), seed (8), name of the policy (16,
 *            padded with zeros)
 *   TRIAL    number (4)
 *   FRAME    pushing (1), n (2), then n times id (4), x, y (4 each)
 *   PERCEIVE, CHOOSE, CLOSE    nothing
 *   LEARN    ended (1)
 *   EXPECT   the hashes so far of models, decisions and updates (8 each): in recordings only
 *   DONE, MODEL, DECISION, UPDATE, STORE    answers; a status (1) and, when it is 0, what the
 *            functions below write
 *   REFUSED  a status (1): there is no such packet, or not now
 *   BAD      damaged frames so far (4): the last one is to be sent again. On a line only
 */
#ifndef ONBOARD_PACKET_H
#define ONBOARD_PACKET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "grrl/learner/learner.h"

GRRL_API_BEGIN

/* How many cases or experiences a controller remembers. */
#ifndef ONBOARD_ENTRIES
#define ONBOARD_ENTRIES 256
#endif

enum onboard_packet_type {
    ONBOARD_OPEN = 1,
    ONBOARD_TRIAL,
    ONBOARD_FRAME,
    ONBOARD_PERCEIVE,
    ONBOARD_CHOOSE,
    ONBOARD_LEARN,
    ONBOARD_CLOSE,
    ONBOARD_EXPECT,
    ONBOARD_DONE = 64,
    ONBOARD_MODEL,
    ONBOARD_DECISION,
    ONBOARD_UPDATE,
    ONBOARD_STORE,
    ONBOARD_REFUSED,
    ONBOARD_BAD
};

/* The largest packet: a full model, or a frame. A firmware to which no model goes may say less. */
#define ONBOARD_MODEL_BYTES                                                                        \
    (5 + 28 * GRRL_MAX_LINKS + 59 * GRRL_MAX_JOINTS + 13 * GRRL_MAX_FEATURES)
#define ONBOARD_FRAME_BYTES (3 + 12 * GRRL_MAX_FEATURES)
#ifndef ONBOARD_MAX_BYTES
#define ONBOARD_MAX_BYTES                                                                          \
    (ONBOARD_MODEL_BYTES > ONBOARD_FRAME_BYTES ? ONBOARD_MODEL_BYTES : ONBOARD_FRAME_BYTES)
#endif

struct onboard_packet {
    uint8_t type;
    uint16_t n;
    bool bad; /* a write or read went beyond the end */
    uint16_t at;
    uint8_t bytes[ONBOARD_MAX_BYTES];
};

/* The points of one frame, to which the library's frame points. */
struct onboard_points {
    int32_t id[GRRL_MAX_FEATURES];
    float x_m[GRRL_MAX_FEATURES];
    float y_m[GRRL_MAX_FEATURES];
};

/* Starts a new packet. */
void onboard_packet_begin(struct onboard_packet *packet, uint8_t type);

void onboard_put(struct onboard_packet *packet, uint64_t value, unsigned bytes);
void onboard_put_float(struct onboard_packet *packet, float value);

/* Reads on from packet->at; beyond the end it returns 0 and sets bad. */
uint64_t onboard_get(struct onboard_packet *packet, unsigned bytes);
float onboard_get_float(struct onboard_packet *packet);

/* Whether everything was read, and nothing beyond the end. */
bool onboard_packet_used_up(const struct onboard_packet *packet);

/* Writes OPEN, for a controller with the caller's capacities. */
void onboard_put_open(struct onboard_packet *packet, uint64_t seed, const char *policy);

void onboard_put_frame(struct onboard_packet *packet, const struct grrl_frame *frame, bool pushing);

/* False, and an empty frame, if the packet is not a frame or holds more points than fit. */
bool onboard_get_frame(struct onboard_packet *packet, struct onboard_points *points,
                       struct grrl_frame *frame, bool *pushing);

void onboard_put_model(struct onboard_packet *packet, const struct grrl_model *model);
void onboard_put_decision(struct onboard_packet *packet, const struct grrl_decision *decision);
void onboard_put_update(struct onboard_packet *packet, const struct grrl_update *update,
                        const struct grrl_usage *usage);

/* The reverse direction, for the side that asked; reads from packet->at. False, with an unspecified
 * result, if the bytes are invalid, or a count or an index exceeds its capacity. */
bool onboard_get_model(struct onboard_packet *packet, struct grrl_model *model);
bool onboard_get_decision(struct onboard_packet *packet, struct grrl_decision *decision);
bool onboard_get_update(struct onboard_packet *packet, struct grrl_update *update,
                        struct grrl_usage *usage);

GRRL_API_END

#endif
