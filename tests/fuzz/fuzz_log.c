/*
 * LCM logs: read as tracks by log_reader.c, and learned from by an observer. For it the log goes
 * through log_check.c and LCM's own reader, every message then through wire.c. Where a log is not
 * damaged, both readers see the same events.
 */
#define _GNU_SOURCE /* memfd_create */

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "agent.h"
#include "fuzz.h"
#include "log_check.h"
#include "log_reader.h"
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

/* What is in a log: bytes of channels and data. */
struct content {
    size_t events;
    size_t bytes;
};

/* Reads every event; false: the log is damaged. */
static bool read_log(const char *path, struct content *content)
{
    struct grrl_log_reader reader;
    struct grrl_log_event event;
    struct grrl_log_damage damage;
    struct grrl_tracks_error error;
    enum grrl_log_step step;
    int64_t at = 0;
    bool whole = true;
    REQUIRE(grrl_log_open(&reader, path, &error));
    while ((step = grrl_log_next(&reader, &event, &damage, &error)) < GRRL_LOG_END) {
        REQUIRE((step == GRRL_LOG_EVENT ? event.at : damage.from) == at);
        at = step == GRRL_LOG_EVENT ? reader.at : damage.to;
        whole = whole && (step == GRRL_LOG_EVENT || damage.from == damage.to);
        if (step == GRRL_LOG_EVENT) {
            content->events++;
            content->bytes += event.channel_length + event.data_length;
        }
    }
    REQUIRE(step == GRRL_LOG_END && at == reader.size);
    grrl_log_close(&reader);
    return whole;
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

static struct content observe(const char *path)
{
    struct content content = {0, 0};
    lcm_eventlog_t *log = lcm_eventlog_create(path, "r");
    lcm_eventlog_event_t *event;
    REQUIRE(log != NULL);
    start_observer();
    while ((event = lcm_eventlog_read_next_event(log)) != NULL) {
        if (lcm_publish(lcm, event->channel, event->data, (unsigned)event->datalen) == 0)
            while (lcm_handle_timeout(lcm, 0) > 0)
                continue;
        content.events++;
        content.bytes += (size_t)event->channellen + (size_t)event->datalen;
        lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(log);
    REQUIRE(agent.counts.rejected <= agent.counts.received);
    grrl_agent_close(&agent);
    return content;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[PATH_BYTES];
    int fd = memfd_create("log", MFD_CLOEXEC);
    REQUIRE(fd >= 0 && write(fd, data, size) == (ssize_t)size);
    (void)snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    struct grrl_log_why why;
    read_tracks(path);
    struct content ours = {0, 0};
    bool whole = read_log(path, &ours);
    if (grrl_log_check(path, &why)) {
        struct content theirs = observe(path);
        REQUIRE(!whole || (ours.events == theirs.events && ours.bytes == theirs.bytes));
    }
    (void)close(fd);
    return 0;
}
