/* Reads the tracks of a trial from an LCM log. */
#include "tracks.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include <lcm/lcm.h>

#include "log_check.h"
#include "wire.h"

/* Where a log's messages go: a recording that grows. */
struct collector {
    struct grrl_tracks *tracks;
    size_t points_capacity;
    size_t frames_capacity;
    int32_t wanted; /* trial, 0: the last */
    int64_t session;
    int64_t seq; /* of the last frame taken; a lock-step sender repeats frames */
    struct grrl_wire_why why;
};

/* Makes room for `capacity` items; false: the array is as it was. */
static bool widen(void **array, size_t item, size_t capacity)
{
    void *grown = realloc(*array, item * capacity);
    if (grown != NULL)
        *array = grown;
    return grown != NULL;
}

static bool make_room(struct collector *to, size_t points)
{
    struct grrl_tracks *tracks = to->tracks;
    if (tracks->n_frames == to->frames_capacity) {
        size_t capacity = to->frames_capacity == 0 ? 1024 : 2 * to->frames_capacity;
        void *frame = tracks->frame;
        if (!widen(&frame, sizeof *tracks->frame, capacity))
            return false;
        tracks->frame = frame;
        to->frames_capacity = capacity;
    }
    if (tracks->n_points + points > to->points_capacity) {
        size_t capacity = 2 * (tracks->n_points + points) + 1024;
        void *id = tracks->id;
        void *x = tracks->x;
        void *y = tracks->y;
        bool good = widen(&id, sizeof *tracks->id, capacity) &&
                    widen(&x, sizeof *tracks->x, capacity) &&
                    widen(&y, sizeof *tracks->y, capacity);
        tracks->id = id;
        tracks->x = x;
        tracks->y = y;
        to->points_capacity = good ? capacity : to->points_capacity;
        return good;
    }
    return true;
}

/* A new session or trial begins a new recording; what was kept before goes. */
static void follow_trial(struct collector *to, const grrl_points_t *message)
{
    if (message->session_id != to->session || message->trial_id != to->tracks->trial) {
        to->tracks->n_points = 0;
        to->tracks->n_frames = 0;
        to->tracks->trial = message->trial_id;
        to->session = message->session_id;
        to->seq = 0;
    }
}

static bool take(struct collector *to, const struct grrl_wire_points *points)
{
    const grrl_points_t *message = &points->message;
    if (to->wanted != 0 && message->trial_id != to->wanted)
        return true;
    follow_trial(to, message);
    if (message->seq <= to->seq)
        return true;
    to->seq = message->seq;
    size_t n = (size_t)message->n_points;
    if (!make_room(to, n))
        return false;
    struct grrl_tracks *tracks = to->tracks;
    bool first = tracks->n_frames == 0;
    bool rest = message->phase == GRRL_POINTS_T_REST || message->phase == GRRL_POINTS_T_SETTLED;
    tracks->frame[tracks->n_frames++] =
        (struct grrl_tracks_frame){.first = tracks->n_points,
                                   .n = (uint32_t)n,
                                   .pushing = !rest && !first,
                                   .settled = message->phase == GRRL_POINTS_T_SETTLED};
    memcpy(tracks->id + tracks->n_points, points->id, n * sizeof *points->id);
    memcpy(tracks->x + tracks->n_points, points->x, n * sizeof *points->x);
    memcpy(tracks->y + tracks->n_points, points->y, n * sizeof *points->y);
    tracks->n_points += n;
    return true;
}

static bool take_event(struct collector *to, const lcm_eventlog_event_t *event)
{
    static struct grrl_wire_points points;
    size_t length = strlen(GRRL_CHANNEL_POINTS);
    if (event->channellen != (int32_t)length ||
        memcmp(event->channel, GRRL_CHANNEL_POINTS, length) != 0)
        return true;
    if (event->datalen < 0 ||
        !grrl_wire_decode_points(event->data, (uint32_t)event->datalen, &points, &to->why)) {
        to->tracks->refused++;
        return true;
    }
    return take(to, &points);
}

static void describe_failure(const struct collector *from, const char *path,
                             struct grrl_tracks_error *error)
{
    if (from->wanted != 0)
        (void)snprintf(error->text, sizeof error->text,
                       "%.200s: no points of trial %d; leave --trial away for the last one", path,
                       (int)from->wanted);
    else if (from->tracks->refused > 0)
        (void)snprintf(error->text, sizeof error->text,
                       "%.200s: not one of %u messages on %s is whole: %.120s", path,
                       (unsigned)from->tracks->refused, GRRL_CHANNEL_POINTS, from->why.text);
    else
        (void)snprintf(error->text, sizeof error->text,
                       "%.200s: an LCM log with messages on %s is needed, this has none", path,
                       GRRL_CHANNEL_POINTS);
}

bool grrl_tracks_read_log(const char *path, int32_t trial, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error)
{
    struct collector to = {.tracks = tracks, .wanted = trial};
    struct grrl_log_why log_why;
    *tracks = (struct grrl_tracks){0};
    if (!grrl_log_check(path, &log_why)) {
        (void)snprintf(error->text, sizeof error->text, "%s", log_why.text);
        return false;
    }
    lcm_eventlog_t *log = lcm_eventlog_create(path, "r");
    if (log == NULL) {
        (void)snprintf(error->text, sizeof error->text, "%.200s: %s", path, strerror(errno));
        return false;
    }
    bool good = true;
    lcm_eventlog_event_t *event;
    while (good && (event = lcm_eventlog_read_next_event(log)) != NULL) {
        good = take_event(&to, event);
        lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(log);
    if (!good)
        (void)snprintf(error->text, sizeof error->text, "%.200s: out of memory", path);
    else if (tracks->n_frames == 0)
        describe_failure(&to, path, error);
    good = good && tracks->n_frames > 0;
    if (!good)
        grrl_tracks_free(tracks);
    return good;
}
