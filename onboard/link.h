/*
 * link.h: packets on a serial line that may damage, lose or insert bytes.
 *
 * A frame is a sequence number (1), the packet's type (1), its length (2), its bytes and a CRC-32
 * (4, IEEE 802.3) over all of these, little-endian. On the line it is byte-stuffed (Cheshire &
 * Baker, "Consistent Overhead Byte Stuffing", IEEE/ACM Trans. Networking 7, 1999), so that it
 * contains no zero, with a zero before and after it. After any damage, reception resumes at the
 * next zero.
 *
 * One side asks, and the other answers with the request's number, one at a time. A repeated request
 * is not executed again: its answer is repeated (server.h). Number 0 belongs to OPEN, which
 * discards all earlier state; other requests count from 1 to 255 and then from 1 again.
 */
#ifndef ONBOARD_LINK_H
#define ONBOARD_LINK_H

#include "packet.h"

GRRL_API_BEGIN

enum { ONBOARD_LINK_HEAD = 4, ONBOARD_LINK_CRC = 4 };

/* The largest frame on the line: stuffing adds one byte per 254, and the zeros come on top. */
#define ONBOARD_LINK_CONTENT (ONBOARD_LINK_HEAD + ONBOARD_MAX_BYTES + ONBOARD_LINK_CRC)
#define ONBOARD_LINK_BYTES (ONBOARD_LINK_CONTENT + ONBOARD_LINK_CONTENT / 254 + 3)

/* The number that follows this one. */
uint8_t onboard_link_next(uint8_t sequence);

/* Writes a frame around a packet of n bytes, up to ONBOARD_MAX_BYTES; returns its length. */
size_t onboard_link_encode(uint8_t sequence, uint8_t type, const uint8_t *bytes, uint16_t n,
                           uint8_t line[ONBOARD_LINK_BYTES]);

enum onboard_link_event {
    ONBOARD_LINK_NOTHING, /* in the middle of a frame */
    ONBOARD_LINK_FRAME,   /* complete, in receiver->sequence and the packet */
    ONBOARD_LINK_DAMAGED  /* something that is not a frame ended here */
};

/* A frame being received. */
struct onboard_receiver {
    struct onboard_packet *packet; /* destination of packets */
    uint8_t sequence;              /* of the latest packet */
    /* private */
    uint8_t left; /* bytes until the next code */
    bool owed;    /* a zero belongs between this block and the next */
    bool bad;     /* longer than any frame */
    uint32_t n;   /* bytes so far, unstuffed */
    uint32_t crc; /* over these bytes */
    uint8_t head[ONBOARD_LINK_HEAD];
};

void onboard_link_init(struct onboard_receiver *receiver, struct onboard_packet *packet);

/* Processes the next byte of the line. Bytes that are not a frame overwrite the packet too. */
enum onboard_link_event onboard_link_take(struct onboard_receiver *receiver, uint8_t byte);

GRRL_API_END

#endif
