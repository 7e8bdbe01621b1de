/* replay.h: feeds a recorded run to a controller, packet by packet. */
#ifndef ONBOARD_REPLAY_H
#define ONBOARD_REPLAY_H

#include "controller.h"

GRRL_API_BEGIN

/* Returns 0 when all `size` bytes were read. */
struct onboard_source {
    void *context;
    int (*read)(void *context, void *bytes, size_t size);
};

/* How far a replay got; after a failure, where it stopped. */
struct onboard_progress {
    uint32_t packets;
    uint32_t trials;
    uint32_t pushes;
};

/*
 * Runs from OPEN to CLOSE. GRRL_ERR_IO: the recording ends early; GRRL_ERR_CORRUPT: the results
 * differ from the recorded ones; other statuses as for onboard_controller_take.
 */
GRRL_MUST_USE enum grrl_status onboard_replay(struct onboard_controller *controller,
                                              const struct onboard_source *source,
                                              struct onboard_packet *packet,
                                              struct onboard_progress *progress);

GRRL_API_END

#endif
