/* Tracks as CSV: what is read is in order, finite and within its arrays. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>

#include "fuzz.h"
#include "tracks.h"

static void check(const struct grrl_tracks *tracks)
{
    size_t next = 0;
    REQUIRE(tracks->n_frames > 0);
    for (size_t f = 0; f < tracks->n_frames; f++) {
        const struct grrl_tracks_frame *frame = &tracks->frame[f];
        REQUIRE(frame->first == next);
        next += frame->n;
        REQUIRE(next <= tracks->n_points);
        for (size_t i = frame->first; i < next; i++) {
            REQUIRE(isfinite(tracks->x[i]) && isfinite(tracks->y[i]));
            REQUIRE(i == frame->first || tracks->id[i] > tracks->id[i - 1]);
        }
    }
    REQUIRE(next == tracks->n_points);
    REQUIRE(grrl_tracks_count_ids(tracks) <= tracks->n_points);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct grrl_tracks tracks;
    struct grrl_tracks_error error = {.text = ""};
    uint8_t nothing = 0;
    /* fmemopen changes nothing in mode r, but lacks const and refuses an empty buffer. */
    uint8_t *copy = malloc(size > 0 ? size : 1);
    REQUIRE(copy != NULL);
    for (size_t i = 0; i < size; i++)
        copy[i] = data[i];
    FILE *file = fmemopen(size > 0 ? copy : &nothing, size > 0 ? size : 1, "r");
    REQUIRE(file != NULL);
    if (grrl_tracks_read_csv(file, "input", &tracks, &error)) {
        check(&tracks);
        grrl_tracks_free(&tracks);
    } else {
        REQUIRE(error.text[0] != '\0' && tracks.id == NULL);
    }
    (void)fclose(file);
    free(copy);
    return 0;
}
