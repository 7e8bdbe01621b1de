/* For LD_PRELOAD: a time of day that somebody keeps setting, an hour ahead and an hour back. What
 * measures intervals by it comes to grief. */
#define _GNU_SOURCE

#include <dlfcn.h>
#include <stddef.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { HOUR_S = 3600, CALLS = 20 };

static time_t jump(void)
{
    static unsigned calls;
    static const char said[] = "the time of day jumps\n";
    if (calls == CALLS) /* for the test: it did happen */
        (void)!write(STDERR_FILENO, said, sizeof said - 1);
    return (time_t)(calls++ / CALLS % 3) * HOUR_S - HOUR_S;
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    static int (*real)(clockid_t, struct timespec *);
    if (real == NULL) {
        void *found = dlsym(RTLD_NEXT, "clock_gettime");
        real = *(int (**)(clockid_t, struct timespec *)) & found;
    }
    int status = real(clock, now);
    if (status == 0 && clock == CLOCK_REALTIME)
        now->tv_sec += jump();
    return status;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone)
{
    struct timespec precise;
    (void)zone;
    int status = clock_gettime(CLOCK_REALTIME, &precise);
    now->tv_sec = precise.tv_sec;
    now->tv_usec = (suseconds_t)(precise.tv_nsec / 1000);
    return status;
}
