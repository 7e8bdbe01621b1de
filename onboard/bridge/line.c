/* Sends a request, and resends it until the answer arrives. */
#define _DEFAULT_SOURCE /* cfmakeraw */

#include "line.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

/* A request is resent after this time, and then after twice as long each time. Perceiving takes an
 * emulated controller a second or more. */
enum { RESEND_MS = 300, LONGEST_RESEND_MS = 5000, SILENCE_MS = 30000, RETRY_MS = 50 };

static bool fail(struct bridge_line *line, const char *what)
{
    line->failed = true;
    (void)snprintf(line->why, sizeof line->why, "%.200s: %s", line->path, what);
    return false;
}

static int64_t now_ms(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

static int connect_to(const char *path)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    if (strlen(path) >= sizeof address.sun_path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    memcpy(address.sun_path, path, strlen(path) + 1);
    int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd >= 0 && connect(fd, (const struct sockaddr *)&address, sizeof address) != 0) {
        int reason = errno;
        (void)close(fd);
        errno = reason;
        return -1;
    }
    return fd;
}

static int open_device(const char *path)
{
    struct termios settings;
    int fd = open(path, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (fd >= 0 && tcgetattr(fd, &settings) == 0) {
        cfmakeraw(&settings);
        (void)cfsetspeed(&settings, B115200);
        (void)tcsetattr(fd, TCSANOW, &settings);
        (void)tcflush(fd, TCIOFLUSH);
    }
    return fd;
}

static void begin(struct bridge_line *line, const char *path, int fd)
{
    memset(line, 0, sizeof *line);
    line->path = path;
    line->fd = fd;
    onboard_link_init(&line->receiver, &line->answer);
}

bool bridge_line_open(struct bridge_line *line, const char *path, int wait_ms)
{
    int64_t until = now_ms() + wait_ms;
    for (;;) {
        struct stat about;
        bool there = stat(path, &about) == 0;
        int fd = there && S_ISCHR(about.st_mode) ? open_device(path) : connect_to(path);
        int reason = errno;
        begin(line, path, fd);
        if (fd >= 0)
            return true;
        if ((reason != ENOENT && reason != ECONNREFUSED) || now_ms() >= until)
            return fail(line, reason == ENOENT
                                  ? "there is no such socket or device; start the controller first"
                                  : strerror(reason));
        (void)poll(NULL, 0, RETRY_MS);
    }
}

void bridge_line_close(struct bridge_line *line)
{
    if (line->fd >= 0)
        (void)close(line->fd);
    line->fd = -1;
}

/* A closed connection must be an error here, not a signal: the caller ignores SIGPIPE. */
static bool send_request(struct bridge_line *line)
{
    const struct onboard_packet *request = &line->request;
    size_t n =
        onboard_link_encode(line->sequence, request->type, request->bytes, request->n, line->out);
    line->counts.bytes_out += n;
    for (size_t at = 0; at < n;) {
        ssize_t written = write(line->fd, line->out + at, n - at);
        if (written < 0 && errno != EINTR)
            return fail(line, strerror(errno));
        at += written > 0 ? (size_t)written : 0;
    }
    return true;
}

/* Processes one good frame; returns whether it is the answer. BAD: the request did not arrive. */
static bool is_answer(struct bridge_line *line, bool *again)
{
    struct onboard_packet *answer = &line->answer;
    if (answer->type == ONBOARD_BAD) {
        line->counts.damaged_out = (uint32_t)onboard_get(answer, 4);
        *again = true;
        return false;
    }
    if (line->receiver.sequence != line->sequence || answer->type < ONBOARD_DONE) {
        line->counts.late++;
        return false;
    }
    return true;
}

/* Processes bytes up to the answer; frames after it may belong to another request. */
static bool take_bytes(struct bridge_line *line, bool *again)
{
    while (line->taken < line->n_in) {
        enum onboard_link_event event = onboard_link_take(&line->receiver, line->in[line->taken++]);
        if (event == ONBOARD_LINK_DAMAGED) {
            line->counts.damaged_in++;
            *again = true;
        } else if (event == ONBOARD_LINK_FRAME && is_answer(line, again)) {
            return true;
        }
    }
    return false;
}

/* Processes the available bytes, or waits up to `timeout` ms for some. */
static bool receive(struct bridge_line *line, int timeout, bool *again)
{
    if (line->taken < line->n_in)
        return take_bytes(line, again);
    struct pollfd wanted = {.fd = line->fd, .events = POLLIN};
    int ready = poll(&wanted, 1, timeout);
    if (ready == 0 || (ready < 0 && errno == EINTR))
        return false;
    ssize_t n = ready < 0 ? -1 : read(line->fd, line->in, sizeof line->in);
    if (n < 0 && errno == EINTR)
        return false;
    if (n <= 0)
        return fail(line, n == 0 ? "the controller has closed the line" : strerror(errno));
    line->counts.bytes_in += (uint64_t)n;
    line->n_in = (size_t)n;
    line->taken = 0;
    return take_bytes(line, again);
}

bool bridge_line_ask(struct bridge_line *line)
{
    if (line->failed)
        return false;
    line->sequence = line->request.type == ONBOARD_OPEN ? 0 : onboard_link_next(line->sequence);
    line->counts.requests++;
    int64_t start = now_ms();
    int64_t sent = start;
    int wait = RESEND_MS;
    if (!send_request(line))
        return false;
    while (!line->failed) {
        bool again = false;
        int64_t left = sent + wait - now_ms();
        if (receive(line, left > 0 ? (int)left : 0, &again))
            return true;
        if (!line->failed && now_ms() - start > SILENCE_MS)
            return fail(line, "the controller does not answer; is the image running?");
        if (!line->failed && (again || now_ms() - sent >= wait)) {
            wait = again || wait >= LONGEST_RESEND_MS ? wait : 2 * wait;
            sent = now_ms();
            line->counts.resent++;
            (void)send_request(line);
        }
    }
    return false;
}
