/* Feeds a recording to a controller and compares the hashes. */
#include "replay.h"

static enum grrl_status next_packet(const struct onboard_source *source,
                                    struct onboard_packet *packet)
{
    uint8_t head[3];
    if (source->read(source->context, head, sizeof head) != 0)
        return GRRL_ERR_IO;
    unsigned n = head[1] | (unsigned)head[2] << 8;
    if (n > ONBOARD_MAX_BYTES)
        return GRRL_ERR_FORMAT;
    packet->type = head[0];
    packet->n = (uint16_t)n;
    return source->read(source->context, packet->bytes, n) == 0 ? GRRL_OK : GRRL_ERR_IO;
}

enum grrl_status onboard_replay(struct onboard_controller *controller,
                                const struct onboard_source *source, struct onboard_packet *packet,
                                struct onboard_progress *progress)
{
    *progress = (struct onboard_progress){0};
    enum grrl_status status;
    do {
        status = next_packet(source, packet);
        if (status == GRRL_OK) {
            progress->packets++;
            progress->trials += packet->type == ONBOARD_TRIAL;
            progress->pushes += packet->type == ONBOARD_CHOOSE;
            status = onboard_controller_take(controller, packet);
        }
    } while (status == GRRL_OK && packet->type != ONBOARD_CLOSE);
    return status;
}
