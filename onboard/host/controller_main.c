/* grrl-controller: the image's controller as a process on this machine, behind a Unix socket. */
#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "cli/options.h"
#include "grrl/base/random.h"
#include "server.h"

static struct onboard_controller controller;
static struct onboard_server server;

/* Simulates a damaging line: each byte is hit with probability 1 / every; 0: none. */
struct noise {
    uint32_t every;
    struct grrl_random random;
};

static const struct grrl_program program = {
    .name = "grrl-controller",
    .usage = "grrl-controller --socket PATH [--damage N] [--seed N]",
    .intro =
        "Runs the controller of grrl-image without an emulator: waits at a new Unix socket for "
        "grrl-bridge and\nserves it until the line is closed.\n",
    .outro = "Exit status: 0 the line was closed; 1 failure; 2 wrong command line.\n",
};

static int fail(const char *path)
{
    (void)fprintf(stderr, "grrl-controller: %s: %s\n", path, strerror(errno));
    return EXIT_FAILURE;
}

/* Accepts one peer at a new socket, or returns -1. */
static int accept_at(const char *path)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    if (strlen(path) >= sizeof address.sun_path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    memcpy(address.sun_path, path, strlen(path) + 1);
    int listening = socket(AF_UNIX, SOCK_STREAM, 0);
    if (listening < 0)
        return -1;
    int peer = -1;
    if (bind(listening, (const struct sockaddr *)&address, sizeof address) == 0) {
        if (listen(listening, 1) == 0)
            peer = accept(listening, NULL, NULL);
        (void)unlink(path);
    }
    int reason = errno;
    (void)close(listening);
    errno = reason;
    return peer;
}

/* Damages n bytes on the line; the result has at most twice as many. */
static size_t damage(struct noise *noise, const uint8_t *bytes, size_t n, uint8_t *damaged)
{
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
        bool hit = noise->every > 0 && grrl_random_below(&noise->random, noise->every) == 0;
        uint32_t kind = hit ? grrl_random_below(&noise->random, 3) : 3;
        uint8_t other = hit ? (uint8_t)grrl_random_below(&noise->random, 256) : 0;
        if (kind == 0 || kind == 1)
            damaged[m++] = other;
        if (kind == 1 || kind == 3)
            damaged[m++] = bytes[i];
    }
    return m;
}

static bool send_all(int fd, const uint8_t *bytes, size_t n)
{
    while (n > 0) {
        ssize_t written = write(fd, bytes, n);
        if (written < 0 && errno != EINTR)
            return false;
        bytes += written > 0 ? written : 0;
        n -= written > 0 ? (size_t)written : 0;
    }
    return true;
}

static int serve(int fd, struct noise *noise)
{
    static uint8_t in[512], damaged[2 * ONBOARD_LINK_BYTES];
    onboard_controller_init(&controller, NULL);
    onboard_server_init(&server, &controller);
    for (;;) {
        ssize_t n = read(fd, in, sizeof in);
        if (n <= 0)
            return n == 0 || errno == ECONNRESET ? EXIT_SUCCESS : fail("the line");
        size_t got = damage(noise, in, (size_t)n, damaged);
        uint8_t line[2 * sizeof in];
        memcpy(line, damaged, got);
        for (size_t i = 0; i < got; i++) {
            size_t answer = onboard_server_take(&server, line[i]);
            size_t sent = damage(noise, server.line, answer, damaged);
            if (!send_all(fd, damaged, sent))
                return errno == EPIPE ? EXIT_SUCCESS : fail("the line");
        }
    }
}

int main(int argc, char **argv)
{
    const char *path = NULL;
    struct noise noise = {0};
    uint64_t seed = 1;
    const struct grrl_option rows[] = {
        grrl_option_text("socket", "PATH", "Unix socket to create; required", &path),
        grrl_option_u32("damage", "N",
                        "damage one byte in N, in both directions, to test the line: change it,\n"
                        "drop it, or insert another before it",
                        0, UINT32_MAX, &noise.every),
        grrl_option_u64("seed", "N", "seed of the damage (1)", 0, UINT64_MAX, &seed),
    };
    enum grrl_options_result parsed =
        grrl_options_parse(&program, rows, sizeof rows / sizeof rows[0], argc, argv, NULL);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    if (path == NULL)
        return grrl_options_wrong(&program, "--socket is required");
    grrl_random_init(&noise.random, seed, 0);
    (void)signal(SIGPIPE, SIG_IGN);
    int fd = accept_at(path);
    if (fd < 0)
        return fail(path);
    int status = serve(fd, &noise);
    (void)close(fd);
    return status;
}
