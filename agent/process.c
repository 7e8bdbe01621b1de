/* Opens LCM, reads clocks and signals, draws sessions, and notices a silent bus. */
#define _POSIX_C_SOURCE 200809L

#include "process.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "log_check.h"

enum { HINT_PERIOD_US = 5000000 };

static volatile sig_atomic_t stop;

static void on_signal(int number)
{
    (void)number;
    stop = 1;
}

void grrl_process_catch_signals(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
}

bool grrl_process_stopped(void)
{
    return stop != 0;
}

static int64_t read_clock_us(clockid_t clock)
{
    struct timespec now;
    (void)clock_gettime(clock, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

int64_t grrl_process_now_us(void *context)
{
    static int64_t offset_us;
    (void)context;
    if (offset_us == 0)
        offset_us = read_clock_us(CLOCK_REALTIME) - read_clock_us(CLOCK_MONOTONIC);
    return read_clock_us(CLOCK_MONOTONIC) + offset_us;
}

int64_t grrl_process_random_session(void)
{
    int64_t session = 0;
    int fd = open("/dev/urandom", O_RDONLY | O_CLOEXEC);
    if (fd >= 0) {
        if (read(fd, &session, sizeof session) != (ssize_t)sizeof session)
            session = 0;
        (void)close(fd);
    }
    session ^= grrl_process_now_us(NULL) ^ (int64_t)getpid() << 32;
    session &= INT64_MAX;
    return session != 0 ? session : 1;
}

/* The URL that LCM will use; NULL: its own default. */
static const char *used_url(const char *url)
{
    return url != NULL ? url : getenv("LCM_DEFAULT_URL");
}

bool grrl_process_is_log(const char *url)
{
    char path[1];
    const char *used = used_url(url);
    return used != NULL && grrl_log_path(used, sizeof path, path);
}

lcm_t *grrl_process_open_lcm(const char *program, const char *url)
{
    char path[4096];
    struct grrl_log_why why;
    const char *used = used_url(url);
    if (used != NULL && grrl_log_path(used, sizeof path, path) && !grrl_log_check(path, &why)) {
        (void)fprintf(stderr, "%s: %s\n", program, why.text);
        return NULL;
    }
    lcm_t *lcm = lcm_create(url);
    if (lcm != NULL && lcm_get_fileno(lcm) >= 0)
        return lcm;
    (void)fprintf(stderr,
                  "%s: cannot start LCM. If this machine has no network:\n"
                  "  ip link set lo up; ip route add 224.0.0.0/4 dev lo\n"
                  "or choose another provider with --lcm-url.\n",
                  program);
    if (lcm != NULL)
        lcm_destroy(lcm);
    return NULL;
}

bool grrl_process_attended(struct grrl_process_watch *watch, struct grrl_agent *agent)
{
    int64_t silence_us = grrl_agent_silence_us(agent);
    if (grrl_agent_end(agent) == GRRL_AGENT_STOPPED) {
        (void)fprintf(stderr, "%s: %s\n", watch->program, grrl_agent_stop_text(agent));
        return false;
    }
    if (grrl_agent_end(agent) == GRRL_AGENT_GAVE_WAY) {
        (void)fprintf(stderr,
                      "%s: the robot moves for another agent: stop one of the two, then start this "
                      "one again\n",
                      watch->program);
        return false;
    }
    if (watch->timeout_s > 0.0 && (double)silence_us >= watch->timeout_s * 1e6) {
        (void)fprintf(stderr, "%s: no simulator or tracker for %g s, giving up\n", watch->program,
                      watch->timeout_s);
        return false;
    }
    if (silence_us < HINT_PERIOD_US)
        watch->hinted_us = 0;
    if (silence_us - watch->hinted_us >= HINT_PERIOD_US) {
        watch->hinted_us = silence_us;
        if (!watch->quiet)
            (void)fprintf(stderr,
                          "%s: waiting for points on the same LCM provider: start grrl-sim or your "
                          "tracker\n",
                          watch->program);
    }
    return true;
}
