/*
 * renewed.c: new ids for old points.
 *
 * A tracker that redetects a corner it has lost gives it a new id. A track that begins where
 * another one ended, within noise, continues it. This is assumed only if the whole recording shows
 * it: at least half of the tracks that end before the last frame have a follower. If two tracks
 * could follow, neither does.
 */
#include <math.h>
#include <stdlib.h>

#include "tracks.h"

/* The most frames until the new id appears. */
enum { GAP = 3 };

/* Largest distance of a follower's start from the extrapolated track, in standard deviations of a
 * point: its own noise and that of two earlier points, over GAP frames. */
#define NEAR_SIGMAS 6.0f

/* One in this many tracks that end must have a follower. */
enum { HABIT = 2 };

struct track {
    int32_t id;
    uint32_t first_frame;
    uint32_t last_frame;
    float first[2];
    float last[2];
    float speed[2]; /* per frame, at the end */
    size_t follower;
    size_t leader; /* SIZE_MAX: none */
};

static struct track track_of(const struct grrl_tracks *tracks,
                             const struct grrl_tracks_sample *sample, size_t n)
{
    size_t first = sample[0].at;
    size_t last = sample[n - 1].at;
    struct track track = {.id = sample[0].id,
                          .first_frame = sample[0].frame,
                          .last_frame = sample[n - 1].frame,
                          .first = {tracks->x[first], tracks->y[first]},
                          .last = {tracks->x[last], tracks->y[last]},
                          .follower = SIZE_MAX,
                          .leader = SIZE_MAX};
    size_t back = n > GAP ? n - 1 - GAP : 0;
    float frames = (float)(sample[n - 1].frame - sample[back].frame);
    if (frames > 0.0f) {
        track.speed[0] = (track.last[0] - tracks->x[sample[back].at]) / frames;
        track.speed[1] = (track.last[1] - tracks->y[sample[back].at]) / frames;
    }
    return track;
}

/* Whether b begins where a was heading. */
static bool may_follow(const struct track *a, const struct track *b, float limit)
{
    if (b->first_frame <= a->last_frame || b->first_frame > a->last_frame + GAP)
        return false;
    float frames = (float)(b->first_frame - a->last_frame);
    return hypotf(b->first[0] - a->last[0] - frames * a->speed[0],
                  b->first[1] - a->last[1] - frames * a->speed[1]) < limit;
}

static int by_first_frame(const void *left, const void *right)
{
    const struct track *a = left;
    const struct track *b = right;
    if (a->first_frame != b->first_frame)
        return a->first_frame < b->first_frame ? -1 : 1;
    return a->id < b->id ? -1 : a->id > b->id;
}

/* The first track that begins after a frame. */
static size_t first_after(const struct track *track, size_t n, uint32_t frame)
{
    size_t low = 0;
    while (low < n) {
        size_t middle = low + (n - low) / 2;
        if (track[middle].first_frame <= frame)
            low = middle + 1;
        else
            n = middle;
    }
    return low;
}

/* Pairs tracks, sorted by first frame, if the choice is unique; returns how many. */
static size_t find_followers(struct track *track, size_t n, uint32_t last_frame, float limit,
                             size_t *n_ended)
{
    size_t n_pairs = 0;
    *n_ended = 0;
    for (size_t i = 0; i < n; i++) {
        size_t found = 0;
        *n_ended += track[i].last_frame < last_frame;
        for (size_t j = first_after(track, n, track[i].last_frame);
             j < n && track[j].first_frame <= track[i].last_frame + GAP; j++) {
            if (!may_follow(&track[i], &track[j], limit))
                continue;
            found++;
            track[i].follower = j;
        }
        track[i].follower = found == 1 ? track[i].follower : SIZE_MAX;
    }
    for (size_t i = 0; i < n; i++) {
        size_t j = track[i].follower;
        if (j == SIZE_MAX)
            continue;
        if (track[j].leader == SIZE_MAX) {
            track[j].leader = i;
            n_pairs++;
        } else { /* two tracks could continue as this one */
            track[i].follower = SIZE_MAX;
        }
    }
    return n_pairs;
}

/* The points of each frame by ascending id. */
static void sort_frames(struct grrl_tracks *tracks)
{
    for (size_t f = 0; f < tracks->n_frames; f++) {
        size_t first = tracks->frame[f].first;
        for (size_t i = first + 1; i < first + tracks->frame[f].n; i++) { /* nearly in order */
            int32_t id = tracks->id[i];
            float x = tracks->x[i];
            float y = tracks->y[i];
            size_t j = i;
            for (; j > first && tracks->id[j - 1] > id; j--) {
                tracks->id[j] = tracks->id[j - 1];
                tracks->x[j] = tracks->x[j - 1];
                tracks->y[j] = tracks->y[j - 1];
            }
            tracks->id[j] = id;
            tracks->x[j] = x;
            tracks->y[j] = y;
        }
    }
}

struct renamed {
    int32_t from;
    int32_t to;
};

static int by_old_id(const void *left, const void *right)
{
    int32_t a = ((const struct renamed *)left)->from;
    int32_t b = ((const struct renamed *)right)->from;
    return a < b ? -1 : a > b;
}

/* Every track takes the id of its first predecessor. */
static bool rename_tracks(struct grrl_tracks *tracks, struct track *track, size_t n)
{
    struct renamed *renamed = malloc(n * sizeof *renamed);
    if (renamed == NULL)
        return false;
    for (size_t i = 0; i < n; i++) { /* by first frame: leaders come before */
        renamed[i].from = track[i].id;
        if (track[i].leader != SIZE_MAX)
            track[i].id = track[track[i].leader].id;
        renamed[i].to = track[i].id;
    }
    qsort(renamed, n, sizeof *renamed, by_old_id);
    for (size_t i = 0; i < tracks->n_points; i++) {
        const struct renamed key = {.from = tracks->id[i]};
        const struct renamed *found = bsearch(&key, renamed, n, sizeof *renamed, by_old_id);
        tracks->id[i] = found->to;
    }
    free(renamed);
    sort_frames(tracks);
    return true;
}

bool grrl_tracks_join_renewed(struct grrl_tracks *tracks, float noise)
{
    if (tracks->n_points == 0)
        return true;
    struct grrl_tracks_sample *sample = grrl_tracks_by_id(tracks);
    struct track *track = malloc(tracks->n_points * sizeof *track);
    bool good = sample != NULL && track != NULL;
    if (good) {
        size_t n = 0;
        size_t end;
        for (size_t first = 0; first < tracks->n_points; first = end) {
            end = grrl_tracks_end(sample, tracks->n_points, first);
            track[n++] = track_of(tracks, sample + first, end - first);
        }
        qsort(track, n, sizeof *track, by_first_frame);
        size_t n_ended;
        size_t n_pairs = find_followers(track, n, (uint32_t)(tracks->n_frames - 1),
                                        NEAR_SIGMAS * noise, &n_ended);
        if (n_pairs > 0 && HABIT * n_pairs >= n_ended) {
            good = rename_tracks(tracks, track, n);
            tracks->n_renewed = good ? n_pairs : 0;
        }
    }
    free(sample);
    free(track);
    return good;
}
