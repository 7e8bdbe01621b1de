/*
 * server.h: the controller's end of a serial line (link.h): receives bytes, and returns the bytes
 * of an answer to send.
 *
 * Each good frame is executed once and answered as often as it arrives. A damaged frame is answered
 * with BAD, so that the other side need not wait for an answer that will never come.
 */
#ifndef ONBOARD_SERVER_H
#define ONBOARD_SERVER_H

#include "controller.h"
#include "link.h"

GRRL_API_BEGIN

struct onboard_server {
    struct onboard_controller *controller;
    uint32_t damaged;  /* frames since the start */
    uint32_t repeated; /* repeated requests */
    uint8_t line[ONBOARD_LINK_BYTES];
    struct onboard_packet request; /* being received */
    /* private */
    struct onboard_receiver receiver;
    uint8_t done; /* number of the last request, whose answer the controller holds; 0: OPEN */
};

/* The controller must be initialised; both must stay in place. */
void onboard_server_init(struct onboard_server *server, struct onboard_controller *controller);

/* Processes the next byte of the line; returns how many bytes of server->line to send. */
size_t onboard_server_take(struct onboard_server *server, uint8_t byte);

GRRL_API_END

#endif
