/* Answers frames from the line; answers repeated ones from memory. */
#include "server.h"

void onboard_server_init(struct onboard_server *server, struct onboard_controller *controller)
{
    server->controller = controller;
    server->damaged = 0;
    server->repeated = 0;
    server->done = 0;
    onboard_link_init(&server->receiver, &server->request);
}

static size_t answer(struct onboard_server *server, uint8_t sequence)
{
    const struct onboard_packet *packet = &server->controller->answer;
    return onboard_link_encode(sequence, packet->type, packet->bytes, packet->n, server->line);
}

static size_t complain(struct onboard_server *server)
{
    uint8_t count[4];
    server->damaged++;
    for (int i = 0; i < 4; i++)
        count[i] = (uint8_t)(server->damaged >> (8 * i));
    return onboard_link_encode(0, ONBOARD_BAD, count, sizeof count, server->line);
}

size_t onboard_server_take(struct onboard_server *server, uint8_t byte)
{
    switch (onboard_link_take(&server->receiver, byte)) {
    case ONBOARD_LINK_NOTHING:
        return 0;
    case ONBOARD_LINK_DAMAGED:
        return complain(server);
    case ONBOARD_LINK_FRAME:
        break;
    }
    uint8_t sequence = server->receiver.sequence;
    if (sequence == 0 || sequence != server->done) {
        server->done = sequence;
        /* After a failure the answer is REFUSED. */
        (void)!onboard_controller_take(server->controller, &server->request);
    } else {
        server->repeated++;
    }
    return answer(server, sequence);
}
