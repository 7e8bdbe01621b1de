/*
 * server.h: the controller's end of a serial line (link.h): takes bytes, has the bytes of an answer
 * to send.
 *
 * Each good frame is answered, once done and as often as it is asked. A damaged one is answered by
 * BAD, so that whoever asked need not wait for an answer that will not come.
 */
#ifndef ONBOARD_SERVER_H
#define ONBOARD_SERVER_H

#include "controller.h"
#include "link.h"

GRRL_API_BEGIN

struct onboard_server {
    struct onboard_controller *controller;
    uint32_t damaged;  /* frames since the start */
    uint32_t repeated; /* requests that came again */
    uint8_t line[ONBOARD_LINK_BYTES];
    struct onboard_packet request; /* being received */
    /* private */
    struct onboard_receiver receiver;
    uint8_t done; /* number of the last request, whose answer is the controller's; 0: OPEN */
};

/* The controller must have been initialised; both stay where they are. */
void onboard_server_init(struct onboard_server *server, struct onboard_controller *controller);

/* Takes the next byte of the line; how many bytes of server->line are to be sent. */
size_t onboard_server_take(struct onboard_server *server, uint8_t byte);

GRRL_API_END

#endif
