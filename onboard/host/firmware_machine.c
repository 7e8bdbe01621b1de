/* The machine of the example firmware on this one: its serial line is a Unix socket, GRRL_LINE. */
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "machine.h"

static int line_fd = -1;

/* Waits for the other side, once. */
static void open_line(void)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    const char *path = getenv("GRRL_LINE");
    if (path == NULL || strlen(path) >= sizeof address.sun_path)
        exit(EXIT_USAGE);
    memcpy(address.sun_path, path, strlen(path) + 1);
    int listener = socket(AF_UNIX, SOCK_STREAM, 0);
    if (bind(listener, (const struct sockaddr *)&address, sizeof address) != 0 ||
        listen(listener, 1) != 0)
        exit(EXIT_DIFFERS);
    line_fd = accept(listener, NULL, NULL);
}

/* A board is switched off; this one ends when the other side is gone. */
uint8_t machine_serial_get(void)
{
    uint8_t byte;
    if (line_fd < 0)
        open_line();
    if (read(line_fd, &byte, 1) != 1)
        exit(EXIT_FINE);
    return byte;
}

void machine_serial_put(uint8_t byte)
{
    if (write(line_fd, &byte, 1) != 1)
        exit(EXIT_FINE);
}
