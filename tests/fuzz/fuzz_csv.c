/*
 * Tracks as CSV: what is read is in order, finite and within its arrays; so is what is left when
 * tracks are chosen; and joints can be followed through it.
 */
#define _POSIX_C_SOURCE 200809L

#include <math.h>

#include "fuzz.h"
#include "motion.h"
#include "tracks.h"

enum { FEW = 3 };

static struct grrl_perception perception;
static struct grrl_model model;

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

static void choose(struct grrl_tracks *tracks)
{
    size_t n_points = tracks->n_points;
    size_t n_ids = grrl_tracks_count_ids(tracks);
    REQUIRE(grrl_tracks_choose(tracks, FEW));
    check(tracks);
    REQUIRE(tracks->n_points + tracks->left_out.n_points == n_points);
    REQUIRE(grrl_tracks_count_ids(tracks) + tracks->left_out.n == n_ids);
    REQUIRE(n_ids < FEW || grrl_tracks_count_ids(tracks) == FEW);
}

/* As if the points belonged to two bodies in turn, with a joint of each type. */
static void follow(const struct grrl_tracks *tracks)
{
    static FILE *nowhere;
    struct grrl_report report = {.model = &model,
                                 .perception = &perception,
                                 .recording = tracks,
                                 .unit = "m",
                                 .per_metre = 1.0};
    nowhere = nowhere == NULL ? fopen("/dev/null", "w") : nowhere;
    REQUIRE(nowhere != NULL);
    grrl_perception_config_default(&perception.config);
    model = (struct grrl_model){.n_bodies = 2, .n_joints = 2};
    model.joint[0] = (struct grrl_joint){.b = 1, .type = GRRL_REVOLUTE};
    model.joint[1] = (struct grrl_joint){.b = 1, .type = GRRL_PRISMATIC, .axis = {1.0f, 0.0f}};
    for (int32_t id = -8; id < 8; id++) {
        model.feature_id[model.n_features] = id;
        model.feature_body[model.n_features++] = (uint8_t)((uint32_t)id & 1u);
    }
    REQUIRE(grrl_motion_write(nowhere, &report));
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
        follow(&tracks);
        choose(&tracks);
        grrl_tracks_free(&tracks);
    } else {
        REQUIRE(error.text[0] != '\0' && tracks.id == NULL);
    }
    (void)fclose(file);
    free(copy);
    return 0;
}
