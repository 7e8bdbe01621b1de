/*
 * tracks_log.c: turns one trial of an LCM log into a recording.
 *
 * The log is read twice: first to find which sessions are in it, then to read the messages of one.
 */
#include "tracks.h"

#include <stdlib.h>
#include <string.h>

#include "log_reader.h"
#include "wire.h"

struct session {
    int64_t id;
    size_t n_messages;
    size_t n_turns; /* how often it started, or resumed after another session */
    bool has_wanted;
};

/* The sessions in a log. */
struct survey {
    int32_t wanted; /* trial; 0: any */
    struct session *session;
    size_t n;
    size_t capacity;
    size_t current;
    uint32_t refused;
    struct grrl_wire_why why;
};

/* Collects the messages of a log into a growing recording. */
struct collector {
    struct grrl_tracks *tracks;
    size_t points_capacity;
    size_t frames_capacity;
    int32_t wanted; /* trial; 0: the last */
    int64_t session;
    int64_t seq;  /* of the last frame taken; a sender in lock step repeats frames */
    bool in_it;   /* the last message of the session belongs to the recording */
    bool damaged; /* since the last message of the session */
    int32_t ended_trial;
    bool tells_of_trials;
};

/* --- the sessions ----------------------------------------------------------------------------- */

static struct session *find_session(struct survey *survey, int64_t id)
{
    for (size_t i = 0; i < survey->n; i++)
        if (survey->session[i].id == id)
            return &survey->session[i];
    if (survey->n == survey->capacity) {
        size_t capacity = survey->capacity == 0 ? 8 : 2 * survey->capacity;
        struct session *grown = realloc(survey->session, capacity * sizeof *grown);
        if (grown == NULL)
            return NULL;
        survey->session = grown;
        survey->capacity = capacity;
    }
    survey->session[survey->n] = (struct session){.id = id};
    return &survey->session[survey->n++];
}

static bool survey_points(struct survey *survey, const grrl_points_t *message)
{
    struct session *session = find_session(survey, message->session_id);
    if (session == NULL)
        return false;
    size_t index = (size_t)(session - survey->session);
    session->n_turns += session->n_messages == 0 || index != survey->current;
    session->n_messages++;
    session->has_wanted =
        session->has_wanted || survey->wanted == 0 || message->trial_id == survey->wanted;
    survey->current = index;
    return true;
}

/* The session to read; NULL: no session has the trial. */
static const struct session *choose_session(const struct survey *survey, bool *interleaved)
{
    const struct session *last = NULL;
    const struct session *largest = NULL;
    *interleaved = false;
    for (size_t i = 0; i < survey->n; i++) {
        const struct session *session = &survey->session[i];
        *interleaved = *interleaved || session->n_turns > 1;
        if (!session->has_wanted)
            continue;
        last = session;
        if (largest == NULL || session->n_messages > largest->n_messages)
            largest = session;
    }
    return *interleaved ? largest : last;
}

/* --- the recording ---------------------------------------------------------------------------- */

/* Grows the array to `capacity` items; false: it is unchanged. */
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

/* A new trial starts a new recording; the earlier one is discarded. */
static void follow_trial(struct collector *to, const grrl_points_t *message)
{
    struct grrl_tracks *tracks = to->tracks;
    if (tracks->n_frames == 0 || message->trial_id != tracks->log.trial) {
        tracks->n_points = 0;
        tracks->n_frames = 0;
        tracks->log.trial = message->trial_id;
        tracks->log.holed = false;
        to->seq = 0;
    }
    tracks->log.holed = tracks->log.holed || to->damaged;
    to->in_it = true;
}

static bool take(struct collector *to, const struct grrl_wire_points *points)
{
    const grrl_points_t *message = &points->message;
    struct grrl_tracks *tracks = to->tracks;
    if (message->session_id != to->session)
        return true;
    if (to->wanted != 0 && message->trial_id != to->wanted)
        to->in_it = false;
    else
        follow_trial(to, message);
    to->damaged = false;
    if (!to->in_it || message->seq <= to->seq)
        return true;
    to->seq = message->seq;
    size_t n = (size_t)message->n_points;
    if (!make_room(to, n))
        return false;
    bool first = tracks->n_frames == 0;
    bool rest = message->phase == GRRL_POINTS_T_REST || message->phase == GRRL_POINTS_T_SETTLED;
    tracks->frame[tracks->n_frames++] =
        (struct grrl_tracks_frame){.first = tracks->n_points,
                                   .number = message->seq,
                                   .n = (uint32_t)n,
                                   .pushing = !rest && !first,
                                   .settled = message->phase == GRRL_POINTS_T_SETTLED};
    memcpy(tracks->id + tracks->n_points, points->id, n * sizeof *points->id);
    memcpy(tracks->x + tracks->n_points, points->x, n * sizeof *points->x);
    memcpy(tracks->y + tracks->n_points, points->y, n * sizeof *points->y);
    tracks->n_points += n;
    return true;
}

static bool is_on(const struct grrl_log_event *event, const char *channel)
{
    size_t length = strlen(channel);
    return event->channel_length == length && memcmp(event->channel, channel, length) == 0;
}

static void take_trial(struct collector *to, const struct grrl_log_event *event)
{
    grrl_trial_t message;
    struct grrl_wire_why why;
    if (!grrl_wire_decode_trial(event->data, (uint32_t)event->data_length, &message, &why) ||
        message.session_id != to->session)
        return;
    to->tells_of_trials = true;
    if (message.phase != GRRL_TRIAL_T_RUNNING && message.trial_id > to->ended_trial)
        to->ended_trial = message.trial_id;
}

static void note_damage(struct collector *to, const struct grrl_log_damage *damage)
{
    struct grrl_tracks_log *log = &to->tracks->log;
    if (log->n_damages++ == 0) {
        log->damaged_at = damage->from;
        log->whole_at = damage->to;
    }
    log->damaged_bytes += damage->to - damage->from;
    log->holed = log->holed || to->in_it;
    to->damaged = true;
}

/* --- both passes ------------------------------------------------------------------------------ */

/* Reads the log into the collector, or into the survey if there is no collector. */
static bool read_events(const char *path, struct survey *survey, struct collector *to,
                        struct grrl_tracks_error *error)
{
    static struct grrl_wire_points points;
    struct grrl_log_reader reader;
    struct grrl_log_event event;
    struct grrl_log_damage damage;
    if (!grrl_log_open(&reader, path, error))
        return false;
    if (to != NULL)
        to->tracks->log.size = reader.size;
    enum grrl_log_step step;
    bool good = true;
    while (good && (step = grrl_log_next(&reader, &event, &damage, error)) < GRRL_LOG_END) {
        if (step == GRRL_LOG_DAMAGE) {
            if (to != NULL)
                note_damage(to, &damage);
        } else if (!is_on(&event, GRRL_CHANNEL_POINTS)) {
            if (to != NULL && is_on(&event, GRRL_CHANNEL_TRIAL))
                take_trial(to, &event);
        } else if (grrl_wire_decode_points(event.data, (uint32_t)event.data_length, &points,
                                           &survey->why)) {
            good = to != NULL ? take(to, &points) : survey_points(survey, &points.message);
        } else if (to == NULL) {
            survey->refused++;
        }
        if (!good)
            (void)snprintf(error->text, sizeof error->text, "%.200s: out of memory", path);
    }
    grrl_log_close(&reader);
    return good && step == GRRL_LOG_END;
}

static void describe_failure(const struct survey *survey, const char *path,
                             struct grrl_tracks_error *error)
{
    if (survey->n > 0)
        (void)snprintf(error->text, sizeof error->text,
                       "%.200s: no points of trial %d; omit --trial to read the last one", path,
                       (int)survey->wanted);
    else if (survey->refused > 0)
        (void)snprintf(error->text, sizeof error->text,
                       "%.200s: none of the %u messages on %s is intact: %.120s", path,
                       (unsigned)survey->refused, GRRL_CHANNEL_POINTS, survey->why.text);
    else
        (void)snprintf(error->text, sizeof error->text,
                       "%.200s: no messages on %s; an LCM log with such messages is needed", path,
                       GRRL_CHANNEL_POINTS);
}

bool grrl_tracks_read_log(const char *path, int32_t trial, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error)
{
    struct survey survey = {.wanted = trial};
    struct collector to = {.tracks = tracks, .wanted = trial};
    *tracks = (struct grrl_tracks){0};
    const struct session *session = NULL;
    bool good = read_events(path, &survey, NULL, error);
    if (good) {
        session = choose_session(&survey, &tracks->log.interleaved);
        if (session == NULL)
            describe_failure(&survey, path, error);
    }
    good = session != NULL;
    if (good) {
        to.session = session->id;
        tracks->log.session = session->id;
        tracks->log.n_sessions = (uint32_t)survey.n;
        tracks->log.refused = survey.refused;
        good = read_events(path, &survey, &to, error);
        if (good && tracks->n_frames == 0)
            describe_failure(&survey, path, error);
        good = good && tracks->n_frames > 0;
        tracks->log.unended = to.tells_of_trials && to.ended_trial < tracks->log.trial;
    }
    free(survey.session);
    if (!good)
        grrl_tracks_free(tracks);
    return good;
}
