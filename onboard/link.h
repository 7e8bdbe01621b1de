/*
 * link.h: packets on a serial line that may damage, lose or add bytes.
 *
 * A frame is a sequence number (1), the packet's type (1), its length (2), its bytes and a CRC-32
 * (4, IEEE 802.3) over all of these, little-endian; on the line it is stuffed (Cheshire & Baker,
 * "Consistent Overhead Byte Stuffing", IEEE/ACM Trans. Networking 7, 1999), so that it contains no
 * zero, with a zero before and after it. Whatever was damaged, the next zero begins anew.
 *
 * One side asks, the other answers with the number of what was asked, one at a time. A request that
 * comes again is not done again: its answer is repeated (server.h). Number 0 is OPEN's, which
 * forgets all that was before; others count 1 to 255 and round again from 1.
 */
#ifndef ONBOARD_LINK_H
#define ONBOARD_LINK_H

#include "packet.h"

GRRL_API_BEGIN

enum { ONBOARD_LINK_HEAD = 4, ONBOARD_LINK_CRC = 4 };

/* The most bytes of a frame on the line: one more for each 254, and the zeros. */
#define ONBOARD_LINK_CONTENT (ONBOARD_LINK_HEAD + ONBOARD_MAX_BYTES + ONBOARD_LINK_CRC)
#define ONBOARD_LINK_BYTES (ONBOARD_LINK_CONTENT + ONBOARD_LINK_CONTENT / 254 + 3)

/* The number after this one. */
uint8_t onboard_link_next(uint8_t sequence);

/* Writes a frame around a packet of n bytes, up to ONBOARD_MAX_BYTES; how many bytes it has. */
size_t onboard_link_encode(uint8_t sequence, uint8_t type, const uint8_t *bytes, uint16_t n,
                           uint8_t line[ONBOARD_LINK_BYTES]);

enum onboard_link_event {
    ONBOARD_LINK_NOTHING, /* in the middle of a frame */
    ONBOARD_LINK_FRAME,   /* receiver->sequence and the packet hold it */
    ONBOARD_LINK_DAMAGED  /* something ended here that is no frame */
};

/* A frame as it comes in. */
struct onboard_receiver {
    struct onboard_packet *packet; /* where packets go */
    uint8_t sequence;              /* of the newest packet */
    /* private */
    uint8_t left; /* bytes until the next code */
    bool owed;    /* a zero stands between this block and the next */
    bool bad;     /* longer than any frame */
    uint32_t n;   /* bytes so far, unstuffed */
    uint32_t crc; /* over them */
    uint8_t head[ONBOARD_LINK_HEAD];
};

void onboard_link_init(struct onboard_receiver *receiver, struct onboard_packet *packet);

/* Takes the next byte of the line. Bytes that are no frame spoil the packet, too. */
enum onboard_link_event onboard_link_take(struct onboard_receiver *receiver, uint8_t byte);

GRRL_API_END

#endif
