/*
 * pace.c: how far points move from frame to frame, and for how long they are visible.
 *
 * The step of a frame is the one that one in SHARE of its points reaches, and at least MOVERS
 * points: a single outlier is faster than anything that moves. The pace is the median over the
 * frames in which something moved.
 */
#include "pace.h"

#include <math.h>
#include <stdlib.h>

/* One point in this many, and at least MOVERS, moves at least as fast: enough for a small link, too
 * many for outliers. */
enum { SHARE = 10, MOVERS = 3 };

/* A step is motion rather than noise if it exceeds this many standard deviations of a point. */
#define MOVING_SIGMAS 6.0f

/* A jump is longer than this many times the pace: a swing is fastest in the middle, and a point at
 * the end of a link is faster than others. */
#define JUMP_PACES 4.0f

/* If half of the ids live for at most this many frames, that is too short for two keyframes of
 * three frames each. */
enum { SHORT_LIFE = 12 };

/* A link of two points is looked for if there are at most so many keyframes. */
enum { MOVERS_OF_A_LINK = 2, FEW_KEYFRAMES = 4 };

static int by_size(const void *left, const void *right)
{
    float a = *(const float *)left;
    float b = *(const float *)right;
    return a < b ? -1 : a > b;
}

/* A step and the frame it ends in. */
struct step {
    uint32_t frame;
    float length;
};

static int by_frame_fastest_first(const void *left, const void *right)
{
    const struct step *a = left;
    const struct step *b = right;
    if (a->frame != b->frame)
        return a->frame < b->frame ? -1 : 1;
    return a->length > b->length ? -1 : a->length < b->length;
}

/* Collects the steps between consecutive frames; life[] gets the number of samples of each track.
 */
static size_t find_steps(const struct grrl_tracks *tracks, const struct grrl_tracks_sample *sample,
                         struct step *step, float *life, size_t *n_lives)
{
    size_t n = 0;
    size_t end;
    *n_lives = 0;
    for (size_t first = 0; first < tracks->n_points; first = end) {
        end = grrl_tracks_end(sample, tracks->n_points, first);
        life[(*n_lives)++] = (float)(end - first);
        for (size_t i = first + 1; i < end; i++) {
            if (sample[i].frame != sample[i - 1].frame + 1)
                continue;
            size_t a = sample[i - 1].at;
            size_t b = sample[i].at;
            step[n++] = (struct step){
                sample[i].frame, hypotf(tracks->x[b] - tracks->x[a], tracks->y[b] - tracks->y[a])};
        }
    }
    return n;
}

/* The pace of whatever moves; 0: nothing does. pace[] has room for one number per frame. */
static float median_pace(struct step *step, size_t n, float least, float *pace)
{
    size_t n_moving = 0;
    size_t end;
    qsort(step, n, sizeof *step, by_frame_fastest_first);
    for (size_t first = 0; first < n; first = end) {
        for (end = first; end < n && step[end].frame == step[first].frame; end++) {
        }
        size_t rank = (end - first) / SHARE;
        rank = rank < MOVERS - 1 ? MOVERS - 1 : rank;
        if (first + rank < end && step[first + rank].length > least)
            pace[n_moving++] = step[first + rank].length;
    }
    if (n_moving == 0)
        return 0.0f;
    qsort(pace, n_moving, sizeof *pace, by_size);
    return pace[n_moving / 2];
}

static float median_life(float *life, size_t n)
{
    qsort(life, n, sizeof *life, by_size);
    return n > 0 ? life[n / 2] : 0.0f;
}

bool grrl_pace_configure(const struct grrl_tracks *tracks, struct grrl_perception_config *config)
{
    if (tracks->n_points == 0)
        return true;
    struct grrl_tracks_sample *sample = grrl_tracks_by_id(tracks);
    struct step *step = malloc(tracks->n_points * sizeof *step);
    float *size = malloc((tracks->n_points + tracks->n_frames) * sizeof *size);
    bool good = sample != NULL && step != NULL && size != NULL;
    if (good) {
        size_t n_lives;
        size_t n = find_steps(tracks, sample, step, size, &n_lives);
        float life = median_life(size, n_lives);
        float pace = median_pace(step, n, MOVING_SIGMAS * config->noise_m, size);
        if (JUMP_PACES * pace > config->jump_m)
            config->jump_m = JUMP_PACES * pace;
        if (pace > 2.0f * config->keyframe_m || life <= (float)SHORT_LIFE)
            config->push_frames = 1;
    }
    free(sample);
    free(step);
    free(size);
    return good;
}

/* How many points, by ascending id in both frames, moved farther than `distance` from one to the
 * other. */
static unsigned moved_between(const struct grrl_tracks *tracks, size_t from, size_t to,
                              float distance)
{
    size_t a = tracks->frame[from].first;
    size_t b = tracks->frame[to].first;
    size_t end_a = a + tracks->frame[from].n;
    size_t end_b = b + tracks->frame[to].n;
    unsigned moved = 0;
    while (a < end_a && b < end_b) {
        if (tracks->id[a] < tracks->id[b]) {
            a++;
        } else if (tracks->id[a] > tracks->id[b]) {
            b++;
        } else {
            float step = hypotf(tracks->x[b] - tracks->x[a], tracks->y[b] - tracks->y[a]);
            moved += step > distance ? 1u : 0u;
            a++;
            b++;
        }
    }
    return moved;
}

/* The first frame in which two points have moved since frame `from`; n_frames: there is none. */
static size_t next_stop(const struct grrl_tracks *tracks, size_t from, float distance)
{
    size_t f = from + 1;
    while (f < tracks->n_frames && moved_between(tracks, from, f, distance) < MOVERS_OF_A_LINK)
        f++;
    return f;
}

bool grrl_pace_stop_for_two(struct grrl_tracks *tracks, float keyframe_m, unsigned keyframes)
{
    size_t stops = 0;
    if (keyframes > FEW_KEYFRAMES)
        return false;
    for (size_t f = next_stop(tracks, 0, keyframe_m); f < tracks->n_frames;
         f = next_stop(tracks, f, keyframe_m))
        stops++;
    if (stops == 0 || stops < 2 * (size_t)keyframes)
        return false;
    for (size_t f = next_stop(tracks, 0, keyframe_m); f < tracks->n_frames;
         f = next_stop(tracks, f, keyframe_m))
        tracks->frame[f].pushing = false;
    return true;
}
