/*
 * Packets to the controller, as on its serial line behind the frames, and as in a recording: type,
 * length, bytes. The first byte of the input tells whether a valid OPEN and TRIAL come first.
 */
#include <string.h>

#include "controller.h"
#include "fuzz.h"
#include "replay.h"

static struct onboard_controller controller;
static struct onboard_packet packet;

static int read_bytes(void *context, void *bytes, size_t size)
{
    struct fuzz_input *input = context;
    if (size > input->left)
        return -1;
    memcpy(bytes, input->data, size);
    input->data += size;
    input->left -= size;
    return 0;
}

static void open_trial(void)
{
    onboard_put_open(&packet, 1, "learn");
    REQUIRE(onboard_controller_take(&controller, &packet) == GRRL_OK);
    onboard_packet_begin(&packet, ONBOARD_TRIAL);
    onboard_put(&packet, 1, 4);
    REQUIRE(onboard_controller_take(&controller, &packet) == GRRL_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_input input = {data, size};
    const struct onboard_source source = {.context = &input, .read = read_bytes};
    struct onboard_progress progress;
    onboard_controller_init(&controller, NULL);
    if ((fuzz_byte(&input) & 1) != 0)
        open_trial();
    /* A packet that is refused does no harm to those after it. */
    enum grrl_status status = GRRL_OK;
    while (status != GRRL_ERR_IO && input.left > 0) {
        status = onboard_replay(&controller, &source, &packet, &progress);
        REQUIRE(controller.answer.n <= ONBOARD_MAX_BYTES);
        REQUIRE(!controller.answer.bad || controller.answer.type == 0);
    }
    return 0;
}
