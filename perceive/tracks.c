/* tracks.c: functions for all recordings, whatever their source. */
#include "tracks.h"

#include <stdlib.h>
#include <string.h>

static int by_id_and_frame(const void *left, const void *right)
{
    const struct grrl_tracks_sample *a = left;
    const struct grrl_tracks_sample *b = right;
    if (a->id != b->id)
        return a->id < b->id ? -1 : 1;
    return a->frame < b->frame ? -1 : a->frame > b->frame;
}

struct grrl_tracks_sample *grrl_tracks_by_id(const struct grrl_tracks *tracks)
{
    struct grrl_tracks_sample *sample =
        tracks->n_points > 0 ? malloc(tracks->n_points * sizeof *sample) : NULL;
    if (sample == NULL)
        return NULL;
    for (size_t f = 0; f < tracks->n_frames; f++) {
        const struct grrl_tracks_frame *frame = &tracks->frame[f];
        for (size_t i = frame->first; i < frame->first + frame->n; i++)
            sample[i] = (struct grrl_tracks_sample){tracks->id[i], (uint32_t)f, i};
    }
    qsort(sample, tracks->n_points, sizeof *sample, by_id_and_frame);
    return sample;
}

size_t grrl_tracks_end(const struct grrl_tracks_sample *sample, size_t n, size_t first)
{
    size_t end = first + 1;
    while (end < n && sample[end].id == sample[first].id)
        end++;
    return end;
}

void grrl_tracks_keep(struct grrl_tracks *tracks, const bool *keep)
{
    size_t n = 0;
    for (size_t f = 0; f < tracks->n_frames; f++) {
        struct grrl_tracks_frame *frame = &tracks->frame[f];
        size_t begin = frame->first;
        size_t end = begin + frame->n;
        frame->first = n;
        for (size_t i = begin; i < end; i++) {
            if (!keep[i])
                continue;
            tracks->id[n] = tracks->id[i];
            tracks->x[n] = tracks->x[i];
            tracks->y[n] = tracks->y[i];
            n++;
        }
        frame->n = (uint32_t)(n - frame->first);
    }
    tracks->n_points = n;
}

size_t grrl_tracks_count_ids(const struct grrl_tracks *tracks)
{
    struct grrl_tracks_sample *sample = grrl_tracks_by_id(tracks);
    size_t different = 0;
    if (sample == NULL)
        return 0;
    for (size_t i = 0; i < tracks->n_points; i = grrl_tracks_end(sample, tracks->n_points, i))
        different++;
    free(sample);
    return different;
}

void grrl_tracks_free(struct grrl_tracks *tracks)
{
    free(tracks->id);
    free(tracks->x);
    free(tracks->y);
    free(tracks->frame);
    free(tracks->left_out.id);
    *tracks = (struct grrl_tracks){0};
}
