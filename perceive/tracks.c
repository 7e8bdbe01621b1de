/* Counts the points of a recording, and frees it. */
#include "tracks.h"

#include <stdlib.h>
#include <string.h>

static int by_value(const void *left, const void *right)
{
    int32_t a = *(const int32_t *)left;
    int32_t b = *(const int32_t *)right;
    return a < b ? -1 : a > b;
}

size_t grrl_tracks_count_ids(const struct grrl_tracks *tracks)
{
    int32_t *sorted = tracks->n_points > 0 ? malloc(tracks->n_points * sizeof *sorted) : NULL;
    size_t different = 0;
    if (sorted == NULL)
        return 0;
    memcpy(sorted, tracks->id, tracks->n_points * sizeof *sorted);
    qsort(sorted, tracks->n_points, sizeof *sorted, by_value);
    for (size_t i = 0; i < tracks->n_points; i++)
        different += i == 0 || sorted[i] != sorted[i - 1];
    free(sorted);
    return different;
}

void grrl_tracks_free(struct grrl_tracks *tracks)
{
    free(tracks->id);
    free(tracks->x);
    free(tracks->y);
    free(tracks->frame);
    *tracks = (struct grrl_tracks){0};
}
