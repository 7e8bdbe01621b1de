/*
 * LCM logs: read as tracks, and learned from by an observer. The log goes through log_check.c and
 * LCM's own reader, every message then through wire.c.
 */
#define _GNU_SOURCE /* memfd_create */

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "agent.h"
#include "fuzz.h"
#include "log_check.h"
#include "policy_memory.h"
#include "tracks.h"

enum { CAPACITY = 16, PATH_BYTES = 64 };

static struct grrl_agent agent;
static POLICY_MEMORY(CAPACITY) memory;
static lcm_t *lcm;

static int64_t now_us(void *context)
{
    (void)context;
    return 0;
}

static void read_tracks(const char *path)
{
    struct grrl_tracks tracks;
    struct grrl_tracks_error error = {.text = ""};
    if (!grrl_tracks_read_log(path, 0, &tracks, &error)) {
        REQUIRE(error.text[0] != '\0' && tracks.id == NULL);
        return;
    }
    size_t next = 0;
    for (size_t f = 0; f < tracks.n_frames; f++) {
        REQUIRE(tracks.frame[f].first == next);
        next += tracks.frame[f].n;
    }
    REQUIRE(next == tracks.n_points);
    grrl_tracks_free(&tracks);
}

static void start_observer(void)
{
    struct grrl_agent_config config = {.session_id = 1, .observe = true, .now_us = now_us};
    grrl_learner_config_default(&config.learner);
    REQUIRE(grrl_policy_make(&grrl_policy_learn, memory.bytes, sizeof memory.bytes, CAPACITY, NULL,
                             &config.policy) == GRRL_OK);
    if (lcm == NULL)
        lcm = lcm_create("memq://");
    REQUIRE(lcm != NULL && grrl_agent_init(&agent, &config, lcm) == GRRL_OK);
}

static void observe(const char *path)
{
    lcm_eventlog_t *log = lcm_eventlog_create(path, "r");
    lcm_eventlog_event_t *event;
    REQUIRE(log != NULL);
    start_observer();
    while ((event = lcm_eventlog_read_next_event(log)) != NULL) {
        if (lcm_publish(lcm, event->channel, event->data, (unsigned)event->datalen) == 0)
            while (lcm_handle_timeout(lcm, 0) > 0)
                continue;
        lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(log);
    REQUIRE(agent.counts.rejected <= agent.counts.received);
    grrl_agent_close(&agent);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[PATH_BYTES];
    int fd = memfd_create("log", MFD_CLOEXEC);
    REQUIRE(fd >= 0 && write(fd, data, size) == (ssize_t)size);
    (void)snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    struct grrl_log_why why;
    read_tracks(path);
    if (grrl_log_check(path, &why))
        observe(path);
    (void)close(fd);
    return 0;
}
