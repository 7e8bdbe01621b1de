/*
 * The controller's end of its serial line. The input is a series of steps: a raw byte for the line,
 * or a frame with a good CRC around whatever comes next, so that the fuzzer gets behind the CRC;
 * with another step, one of its bytes is damaged. Every frame is answered, and what is sent are
 * frames of the server's own.
 */
#include <string.h>

#include "fuzz.h"
#include "server.h"

static struct onboard_controller controller;
static struct onboard_server server;
static struct onboard_packet answer;
static struct onboard_receiver receiver;

enum step { RAW, FRAME, DAMAGED_FRAME, STEPS };

static void give(uint8_t byte)
{
    size_t n = onboard_server_take(&server, byte);
    REQUIRE(n <= sizeof server.line);
    unsigned frames = 0;
    for (size_t i = 0; i < n; i++) {
        enum onboard_link_event event = onboard_link_take(&receiver, server.line[i]);
        REQUIRE(event != ONBOARD_LINK_DAMAGED);
        frames += event == ONBOARD_LINK_FRAME;
    }
    REQUIRE(frames == (n > 0));
}

static void give_frame(struct fuzz_input *input, bool damaged)
{
    uint8_t bytes[ONBOARD_MAX_BYTES];
    uint8_t line[ONBOARD_LINK_BYTES];
    uint8_t sequence = fuzz_byte(input);
    uint8_t type = fuzz_byte(input);
    uint16_t n = (uint16_t)(fuzz_byte(input) | fuzz_byte(input) << 8);
    n = n < ONBOARD_MAX_BYTES ? n : ONBOARD_MAX_BYTES;
    for (uint16_t i = 0; i < n; i++)
        bytes[i] = fuzz_byte(input);
    size_t length = onboard_link_encode(sequence, type, bytes, n, line);
    REQUIRE(length <= sizeof line);
    if (damaged)
        line[(fuzz_byte(input) | (size_t)fuzz_byte(input) << 8) % length] ^= fuzz_byte(input);
    for (size_t i = 0; i < length; i++)
        give(line[i]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_input input = {data, size};
    onboard_controller_init(&controller, NULL);
    onboard_server_init(&server, &controller);
    onboard_link_init(&receiver, &answer);
    if ((fuzz_byte(&input) & 1) != 0) {
        static struct onboard_packet open;
        uint8_t line[ONBOARD_LINK_BYTES];
        onboard_put_open(&open, 1, "learn");
        size_t length = onboard_link_encode(0, open.type, open.bytes, open.n, line);
        for (size_t i = 0; i < length; i++)
            give(line[i]);
        REQUIRE(controller.open);
    }
    while (input.left > 0) {
        switch (fuzz_byte(&input) % STEPS) {
        case RAW:
            give(fuzz_byte(&input));
            break;
        case FRAME:
            give_frame(&input, false);
            break;
        default:
            give_frame(&input, true);
            break;
        }
    }
    return 0;
}
