/*
 * choose.c: which tracks to keep if there are more than perception holds.
 *
 * Length: tracks less than half as long as the `most`-th longest are left out first. Spread: the
 * others are ordered by mean position along a Hilbert curve, which keeps neighbours together; the
 * curve is cut into `most` pieces with equally many tracks, and the longest track of each piece is
 * kept. So every part of the image keeps its share, and a part with many points keeps more.
 */
#include <math.h>
#include <stdlib.h>

#include "tracks.h"

enum { CELLS = 1024 }; /* of the curve, on a side */

struct candidate {
    size_t first; /* sample */
    size_t length;
    uint32_t place; /* on the curve */
};

struct box {
    float low[2];
    float side;
};

/* Distance along the curve to cell (x, y). */
static uint32_t hilbert(uint32_t x, uint32_t y)
{
    uint32_t distance = 0;
    for (uint32_t s = CELLS / 2; s > 0; s /= 2) {
        uint32_t right = (x & s) > 0;
        uint32_t upper = (y & s) > 0;
        distance += s * s * ((3 * right) ^ upper);
        if (upper == 0) {
            if (right == 1) {
                x = CELLS - 1 - x;
                y = CELLS - 1 - y;
            }
            uint32_t swapped = x;
            x = y;
            y = swapped;
        }
    }
    return distance;
}

static struct box box_of(const struct grrl_tracks *tracks)
{
    float high[2] = {-INFINITY, -INFINITY};
    struct box box = {{INFINITY, INFINITY}, 0.0f};
    for (size_t i = 0; i < tracks->n_points; i++) {
        const float at[2] = {tracks->x[i], tracks->y[i]};
        for (int axis = 0; axis < 2; axis++) {
            box.low[axis] = fminf(box.low[axis], at[axis]);
            high[axis] = fmaxf(high[axis], at[axis]);
        }
    }
    box.side = fmaxf(high[0] - box.low[0], high[1] - box.low[1]);
    return box;
}

static uint32_t cell_of(float position, float low, float side)
{
    float cell = side > 0.0f ? (position - low) / side * CELLS : 0.0f;
    return cell > 0.0f ? (uint32_t)fminf(cell, CELLS - 1) : 0;
}

static uint32_t place_of(const struct grrl_tracks *tracks, const struct grrl_tracks_sample *sample,
                         size_t n, const struct box *box)
{
    double x = 0.0;
    double y = 0.0;
    for (size_t i = 0; i < n; i++) {
        x += (double)tracks->x[sample[i].at] / (double)n;
        y += (double)tracks->y[sample[i].at] / (double)n;
    }
    return hilbert(cell_of((float)x, box->low[0], box->side),
                   cell_of((float)y, box->low[1], box->side));
}

static int by_length(const void *left, const void *right)
{
    const struct candidate *a = left;
    const struct candidate *b = right;
    if (a->length != b->length)
        return a->length > b->length ? -1 : 1;
    return a->first < b->first ? -1 : a->first > b->first;
}

static int by_place(const void *left, const void *right)
{
    const struct candidate *a = left;
    const struct candidate *b = right;
    if (a->place != b->place)
        return a->place < b->place ? -1 : 1;
    return a->first < b->first ? -1 : a->first > b->first;
}

/* Moves the tracks to keep to the front. */
static void select_candidates(struct candidate *candidate, size_t n, size_t most)
{
    qsort(candidate, n, sizeof *candidate, by_length);
    size_t enough = candidate[most - 1].length;
    size_t n_long = most;
    while (n_long < n && 2 * candidate[n_long].length >= enough)
        n_long++;
    qsort(candidate, n_long, sizeof *candidate, by_place);
    for (size_t piece = 0; piece < most; piece++) {
        size_t best = piece * n_long / most;
        for (size_t i = best + 1; i < (piece + 1) * n_long / most; i++)
            if (candidate[i].length > candidate[best].length)
                best = i;
        /* piece <= best: the one swapped away has already been considered */
        struct candidate chosen = candidate[best];
        candidate[best] = candidate[piece];
        candidate[piece] = chosen;
    }
}

static int by_value(const void *left, const void *right)
{
    int32_t a = *(const int32_t *)left;
    int32_t b = *(const int32_t *)right;
    return a < b ? -1 : a > b;
}

static void leave_out(struct grrl_tracks *tracks, const struct grrl_tracks_sample *sample,
                      const struct candidate *candidate, size_t n, bool *keep)
{
    struct grrl_tracks_left_out *out = &tracks->left_out;
    for (size_t i = 0; i < tracks->n_points; i++)
        keep[i] = true;
    for (size_t c = 0; c < n; c++) {
        out->id[out->n++] = sample[candidate[c].first].id;
        out->n_points += candidate[c].length;
        for (size_t i = 0; i < candidate[c].length; i++)
            keep[sample[candidate[c].first + i].at] = false;
    }
    qsort(out->id, out->n, sizeof *out->id, by_value);
    grrl_tracks_keep(tracks, keep);
}

static size_t find_candidates(const struct grrl_tracks *tracks,
                              const struct grrl_tracks_sample *sample, struct candidate *candidate)
{
    struct box box = box_of(tracks);
    size_t n = 0;
    size_t end;
    for (size_t first = 0; first < tracks->n_points; first = end) {
        end = grrl_tracks_end(sample, tracks->n_points, first);
        candidate[n++] = (struct candidate){first, end - first,
                                            place_of(tracks, sample + first, end - first, &box)};
    }
    return n;
}

bool grrl_tracks_choose(struct grrl_tracks *tracks, size_t most)
{
    size_t n = grrl_tracks_count_ids(tracks);
    if (n <= most)
        return n > 0 || tracks->n_points == 0;
    struct grrl_tracks_sample *sample = grrl_tracks_by_id(tracks);
    struct candidate *candidate = malloc(n * sizeof *candidate);
    bool *keep = malloc(tracks->n_points * sizeof *keep);
    tracks->left_out.id = malloc((n - most) * sizeof *tracks->left_out.id);
    bool good = sample != NULL && candidate != NULL && keep != NULL && tracks->left_out.id != NULL;
    if (good) {
        (void)find_candidates(tracks, sample, candidate);
        select_candidates(candidate, n, most);
        leave_out(tracks, sample, candidate + most, n - most, keep);
    }
    free(sample);
    free(candidate);
    free(keep);
    return good;
}
