/*
 * lost.c: points that a tracker has lost but still writes a position for.
 *
 * Two habits are known, and each is assumed only if the whole recording shows it.
 *
 * Marks: exactly (0, 0) or (-1, -1). Evidence: tracks that jump to or from a mark by more than LEAP
 * times the longest of their other steps (per frame). If there are two such tracks, or one that is
 * on the mark in at least FEW frames, every point on the mark is lost.
 *
 * Frozen: the last position again and again. Evidence: outside runs of at least RUN equal
 * positions, most tracks never repeat a position exactly (one step in RARE may), so noise or motion
 * makes visible positions distinct. Then such a run is lost from its second position on, in a track
 * that otherwise repeats just as rarely. Not if at least TOGETHER tracks repeat over exactly the
 * same frames: then a body without noise has come to rest.
 */
#include <math.h>
#include <stdlib.h>

#include "tracks.h"

#define LEAP 4.0f

enum { FEW = 3, RARE = 50, RUN = 6, LONG_TRACK = 10, LEAST_STEPS = 5, TOGETHER = 4 };

struct search {
    struct grrl_tracks *tracks;
    const struct grrl_tracks_sample *sample; /* by id and frame */
    bool *keep;                              /* by index in the recording */
};

static bool same(const struct grrl_tracks *tracks, size_t a, size_t b)
{
    return tracks->x[a] == tracks->x[b] && tracks->y[a] == tracks->y[b];
}

static bool is_at(const struct grrl_tracks *tracks, size_t at, float mark)
{
    return tracks->x[at] == mark && tracks->y[at] == mark;
}

/* How far a track moves between two samples, per frame. */
static float step_of(const struct search *search, const struct grrl_tracks_sample *a,
                     const struct grrl_tracks_sample *b)
{
    const struct grrl_tracks *tracks = search->tracks;
    return hypotf(tracks->x[b->at] - tracks->x[a->at], tracks->y[b->at] - tracks->y[a->at]) /
           (float)(b->frame - a->frame);
}

/* The longest step of a track off the mark; negative: fewer than two steps. */
static float longest_step(const struct search *search, size_t first, size_t end, float mark)
{
    const struct grrl_tracks_sample *before = NULL;
    float longest = -1.0f;
    unsigned steps = 0;
    for (size_t i = first; i < end; i++) {
        if (is_at(search->tracks, search->sample[i].at, mark))
            continue;
        if (before != NULL) {
            longest = fmaxf(longest, step_of(search, before, &search->sample[i]));
            steps++;
        }
        before = &search->sample[i];
    }
    return steps < 2 ? -1.0f : longest;
}

/* Number of frames in which a track is on the mark, if it jumped to or from it; else 0. */
static size_t frames_on_mark(const struct search *search, size_t first, size_t end, float mark)
{
    const struct grrl_tracks *tracks = search->tracks;
    float longest = longest_step(search, first, end, mark);
    size_t on_mark = 0;
    bool leaps = false;
    for (size_t i = first; longest >= 0.0f && i < end; i++) {
        bool marked = is_at(tracks, search->sample[i].at, mark);
        on_mark += marked;
        if (i > first && marked != is_at(tracks, search->sample[i - 1].at, mark))
            leaps = leaps ||
                    step_of(search, &search->sample[i - 1], &search->sample[i]) > LEAP * longest;
    }
    return leaps ? on_mark : 0;
}

static void drop_marked(struct search *search, float mark)
{
    struct grrl_tracks *tracks = search->tracks;
    size_t n_tracks = 0;
    size_t most = 0;
    size_t end;
    for (size_t first = 0; first < tracks->n_points; first = end) {
        end = grrl_tracks_end(search->sample, tracks->n_points, first);
        size_t on_mark = frames_on_mark(search, first, end, mark);
        n_tracks += on_mark > 0;
        most = on_mark > most ? on_mark : most;
    }
    if (n_tracks < 2 && most < FEW)
        return;
    for (size_t i = 0; i < tracks->n_points; i++) {
        if (is_at(tracks, i, mark)) {
            search->keep[i] = false;
            tracks->lost.marked++;
        }
    }
}

/* A run of equal positions: samples of one track. */
struct run {
    size_t begin;
    size_t end;
    uint32_t from; /* frames */
    uint32_t to;
};

struct track_steps {
    size_t n;       /* outside of long runs */
    size_t repeats; /* of these, without any motion */
    size_t n_runs;  /* long ones */
};

static size_t end_of_run(const struct search *search, size_t begin, size_t end)
{
    size_t i = begin + 1;
    while (i < end && same(search->tracks, search->sample[i].at, search->sample[begin].at))
        i++;
    return i;
}

/* Counts a track's steps and appends its long runs to `runs`, unless that is NULL. */
static struct track_steps count_steps(const struct search *search, size_t first, size_t end,
                                      struct run *runs)
{
    struct track_steps steps = {0, 0, 0};
    size_t next;
    for (size_t i = first; i < end; i = next) {
        next = end_of_run(search, i, end);
        steps.n += next < end;
        if (next - i < RUN) {
            steps.n += next - i - 1;
            steps.repeats += next - i - 1;
            continue;
        }
        if (runs != NULL)
            runs[steps.n_runs] =
                (struct run){i, next, search->sample[i].frame, search->sample[next - 1].frame};
        steps.n_runs++;
    }
    return steps;
}

static bool hardly_repeats(const struct track_steps *steps)
{
    return steps->n >= LEAST_STEPS && RARE * steps->repeats <= steps->n;
}

/* Whether the tracks show that a visible point never stands exactly still; *n_runs: number of long
 * runs in tracks that otherwise do not. */
static bool all_else_scatters(const struct search *search, size_t *n_runs)
{
    size_t n = search->tracks->n_points;
    size_t n_long = 0;
    size_t n_scatter = 0;
    size_t end;
    *n_runs = 0;
    for (size_t first = 0; first < n; first = end) {
        end = grrl_tracks_end(search->sample, n, first);
        struct track_steps steps = count_steps(search, first, end, NULL);
        bool scatters = hardly_repeats(&steps);
        *n_runs += scatters ? steps.n_runs : 0;
        if (end - first >= LONG_TRACK) {
            n_long++;
            n_scatter += scatters;
        }
    }
    return *n_runs > 0 && 2 * n_scatter > n_long;
}

static int by_frames(const void *left, const void *right)
{
    const struct run *a = left;
    const struct run *b = right;
    if (a->from != b->from)
        return a->from < b->from ? -1 : 1;
    return a->to < b->to ? -1 : a->to > b->to;
}

static void drop_runs(struct search *search, struct run *runs, size_t n)
{
    qsort(runs, n, sizeof *runs, by_frames);
    size_t next;
    for (size_t i = 0; i < n; i = next) {
        next = i + 1;
        while (next < n && by_frames(&runs[next], &runs[i]) == 0)
            next++;
        for (size_t k = i; next - i < TOGETHER && k < next; k++) {
            for (size_t s = runs[k].begin + 1; s < runs[k].end; s++) {
                bool *keep = &search->keep[search->sample[s].at];
                search->tracks->lost.frozen += *keep;
                *keep = false;
            }
        }
    }
}

static bool drop_frozen(struct search *search)
{
    size_t n_points = search->tracks->n_points;
    size_t n_runs;
    if (!all_else_scatters(search, &n_runs))
        return true;
    struct run *runs = malloc(n_runs * sizeof *runs);
    if (runs == NULL)
        return false;
    size_t n = 0;
    size_t end;
    for (size_t first = 0; first < n_points; first = end) {
        end = grrl_tracks_end(search->sample, n_points, first);
        struct track_steps steps = count_steps(search, first, end, NULL);
        if (hardly_repeats(&steps))
            n += count_steps(search, first, end, runs + n).n_runs;
    }
    drop_runs(search, runs, n);
    free(runs);
    return true;
}

/* One pass over all points by id, for frozen points (`freezes`) or for marks. */
static bool look(struct grrl_tracks *tracks, bool freezes)
{
    if (tracks->n_points == 0)
        return true;
    bool good = false;
    struct grrl_tracks_sample *sample = grrl_tracks_by_id(tracks);
    bool *keep = malloc(tracks->n_points * sizeof *keep);
    if (sample != NULL && keep != NULL) {
        struct search search = {tracks, sample, keep};
        for (size_t i = 0; i < tracks->n_points; i++)
            keep[i] = true;
        good = !freezes || drop_frozen(&search);
        if (!freezes) {
            drop_marked(&search, 0.0f);
            drop_marked(&search, -1.0f);
        }
        grrl_tracks_keep(tracks, keep);
    }
    free(sample);
    free(keep);
    return good;
}

bool grrl_tracks_drop_lost(struct grrl_tracks *tracks)
{
    return look(tracks, false) && look(tracks, true);
}
