/* grrl-controller: the image's controller as a process of this machine, behind a Unix socket. */
#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <getopt.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "grrl/base/random.h"
#include "server.h"

static struct onboard_controller controller;
static struct onboard_server server;

/* A line that damages bytes: each with probability 1 / every; 0: none. */
struct noise {
    uint32_t every;
    struct grrl_random random;
};

static const char help[] =
    "Usage: grrl-controller --socket PATH [--damage N] [--seed N]\n"
    "The controller of grrl-image, without emulator: waits at a new Unix socket for grrl-bridge "
    "and\n"
    "serves it until the line is closed.\n\n"
    "  --socket PATH  where to listen; needed\n"
    "  --damage N     damages one byte in N, in both directions, to test the line: changes it,\n"
    "                 leaves it out, or puts another before it\n"
    "  --seed N       seed of the damage (1)\n"
    "  --help         print this text\n"
    "  --version      print the version\n\n"
    "Exit status: 0 the line was closed; 1 trouble; 2 wrong command line.\n";

static int fail(const char *path)
{
    (void)fprintf(stderr, "grrl-controller: %s: %s\n", path, strerror(errno));
    return EXIT_FAILURE;
}

/* The one peer of a new socket, or -1. */
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

/* What comes of n bytes on the line, at most twice as many. */
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

static bool take_number(const char *name, const char *text, uint64_t most, uint64_t *value)
{
    char *end;
    errno = 0;
    *value = strtoull(text, &end, 10);
    if (text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0 && *value <= most)
        return true;
    (void)fprintf(stderr, "grrl-controller: --%s %s: must be a number from 0\n", name, text);
    return false;
}

int main(int argc, char **argv)
{
    static const struct option options[] = {
        {"socket", required_argument, NULL, 's'}, {"damage", required_argument, NULL, 'd'},
        {"seed", required_argument, NULL, 'r'},   {"help", no_argument, NULL, 'h'},
        {"version", no_argument, NULL, 'v'},      {NULL, 0, NULL, 0}};
    const char *path = NULL;
    uint64_t every = 0, seed = 1;
    int id;
    while ((id = getopt_long(argc, argv, "", options, NULL)) != -1)
        if (id == 's')
            path = optarg;
        else if (id == 'h' || id == 'v')
            return printf("%s", id == 'h' ? help : "grrl-controller " GRRL_VERSION "\n") < 0;
        else if (id == '?')
            return fputs("Try grrl-controller --help\n", stderr) < 0 ? 1 : 2;
        else if ((id == 'd' && !take_number("damage", optarg, UINT32_MAX, &every)) ||
                 (id == 'r' && !take_number("seed", optarg, UINT64_MAX, &seed)))
            return 2;
    if (path == NULL || optind < argc) {
        (void)fprintf(stderr, "grrl-controller: %s\nTry grrl-controller --help\n",
                      path == NULL ? "--socket is needed" : "there are no arguments");
        return 2;
    }
    struct noise noise = {.every = (uint32_t)every};
    grrl_random_init(&noise.random, seed, 0);
    (void)signal(SIGPIPE, SIG_IGN);
    int fd = accept_at(path);
    if (fd < 0)
        return fail(path);
    int status = serve(fd, &noise);
    (void)close(fd);
    return status;
}
