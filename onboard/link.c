/* Frames: byte stuffing, CRC and sequence numbers. */
#include "link.h"

/* The CRC over bytes followed by their own CRC has this value. */
#define CRC_RESIDUE UINT32_C(0xdebb20e3)
#define CRC_START UINT32_C(0xffffffff)

/* CRC-32 by half bytes, without the final inversion. */
static uint32_t crc_on(uint32_t crc, uint8_t byte)
{
    static const uint32_t table[16] = {0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac,
                                       0x76dc4190, 0x6b6b51f4, 0x4db26158, 0x5005713c,
                                       0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
                                       0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
    crc ^= byte;
    crc = crc >> 4 ^ table[crc & 15];
    return crc >> 4 ^ table[crc & 15];
}

uint8_t onboard_link_next(uint8_t sequence)
{
    return sequence == UINT8_MAX ? 1 : (uint8_t)(sequence + 1);
}

/* A frame being sent: code is the position of the current block's code. */
struct sender {
    uint8_t *line;
    size_t n;
    size_t code;
    uint32_t crc;
};

static void begin_block(struct sender *sender)
{
    sender->code = sender->n++;
}

static void end_block(struct sender *sender)
{
    sender->line[sender->code] = (uint8_t)(sender->n - sender->code);
}

/* A block of 254 bytes without a zero represents only itself; any other implies a zero after it. */
static void send(struct sender *sender, uint8_t byte)
{
    sender->crc = crc_on(sender->crc, byte);
    if (sender->n - sender->code == UINT8_MAX) {
        end_block(sender);
        begin_block(sender);
    }
    if (byte == 0) {
        end_block(sender);
        begin_block(sender);
    } else {
        sender->line[sender->n++] = byte;
    }
}

size_t onboard_link_encode(uint8_t sequence, uint8_t type, const uint8_t *bytes, uint16_t n,
                           uint8_t line[ONBOARD_LINK_BYTES])
{
    struct sender sender = {.line = line, .n = 1, .crc = CRC_START};
    line[0] = 0;
    begin_block(&sender);
    send(&sender, sequence);
    send(&sender, type);
    send(&sender, (uint8_t)n);
    send(&sender, (uint8_t)(n >> 8));
    for (uint16_t i = 0; i < n; i++)
        send(&sender, bytes[i]);
    uint32_t crc = ~sender.crc;
    for (int i = 0; i < ONBOARD_LINK_CRC; i++)
        send(&sender, (uint8_t)(crc >> (8 * i)));
    end_block(&sender);
    line[sender.n++] = 0;
    return sender.n;
}

/* Adds one byte of the content. The CRC's own bytes are stored if there is room, and
 * do not count. */
static void take_content(struct onboard_receiver *receiver, uint8_t byte)
{
    uint32_t at = receiver->n++;
    receiver->crc = crc_on(receiver->crc, byte);
    if (at < ONBOARD_LINK_HEAD)
        receiver->head[at] = byte;
    else if (at - ONBOARD_LINK_HEAD < ONBOARD_MAX_BYTES)
        receiver->packet->bytes[at - ONBOARD_LINK_HEAD] = byte;
    else if (at >= ONBOARD_LINK_CONTENT)
        receiver->bad = true;
}

static void begin_frame(struct onboard_receiver *receiver)
{
    receiver->left = 0;
    receiver->owed = false;
    receiver->bad = false;
    receiver->n = 0;
    receiver->crc = CRC_START;
}

void onboard_link_init(struct onboard_receiver *receiver, struct onboard_packet *packet)
{
    *receiver = (struct onboard_receiver){.packet = packet};
    begin_frame(receiver);
}

/* Ends a frame at a zero. An empty one is no damage: there are zeros on both sides of a frame. */
static enum onboard_link_event end_frame(struct onboard_receiver *receiver)
{
    bool empty = receiver->n == 0 && !receiver->owed && !receiver->bad;
    unsigned length = receiver->head[2] | (unsigned)receiver->head[3] << 8;
    bool good = !receiver->bad && receiver->left == 0 && receiver->crc == CRC_RESIDUE &&
                receiver->n == ONBOARD_LINK_HEAD + length + ONBOARD_LINK_CRC;
    begin_frame(receiver);
    if (!good)
        return empty ? ONBOARD_LINK_NOTHING : ONBOARD_LINK_DAMAGED;
    receiver->sequence = receiver->head[0];
    onboard_packet_begin(receiver->packet, receiver->head[1]);
    receiver->packet->n = (uint16_t)length;
    return ONBOARD_LINK_FRAME;
}

enum onboard_link_event onboard_link_take(struct onboard_receiver *receiver, uint8_t byte)
{
    if (byte == 0)
        return end_frame(receiver);
    if (receiver->bad)
        return ONBOARD_LINK_NOTHING;
    if (receiver->left > 0) {
        receiver->left--;
        take_content(receiver, byte);
        return ONBOARD_LINK_NOTHING;
    }
    if (receiver->owed)
        take_content(receiver, 0);
    receiver->left = (uint8_t)(byte - 1);
    receiver->owed = byte != UINT8_MAX;
    return ONBOARD_LINK_NOTHING;
}
