#define _POSIX_C_SOURCE 200809L

#include "process.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

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

int64_t grrl_process_now_us(void *context)
{
    struct timespec now;
    (void)context;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
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

lcm_t *grrl_process_open_lcm(const char *program, const char *url)
{
    lcm_t *lcm = lcm_create(url);
    if (lcm != NULL && lcm_get_fileno(lcm) >= 0)
        return lcm;
    (void)fprintf(stderr,
                  "%s: LCM does not start. If this machine has no network:\n"
                  "  ip link set lo up; ip route add 224.0.0.0/4 dev lo\n"
                  "or name another provider with --lcm-url.\n",
                  program);
    if (lcm != NULL)
        lcm_destroy(lcm);
    return NULL;
}
