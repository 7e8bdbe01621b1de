/*
 * camera_pairs.h: pairs of points on one body, whose distances tell camera.c what the camera does.
 */
#ifndef GRRL_PERCEIVE_CAMERA_PAIRS_H
#define GRRL_PERCEIVE_CAMERA_PAIRS_H

#include <stdbool.h>
#include <stdint.h>

#include "tracks.h"

#include "grrl/base/geometry.h"

enum {
    GRRL_CAMERA_FRAMES = 32,  /* at most; evenly spaced */
    GRRL_CAMERA_TRACKS = 240, /* at most; evenly chosen */
    GRRL_CAMERA_NEIGHBOURS = 12,
    GRRL_CAMERA_PAIRS = GRRL_CAMERA_TRACKS * GRRL_CAMERA_NEIGHBOURS
};

struct grrl_camera_pairs {
    uint32_t n_frames;
    size_t frame[GRRL_CAMERA_FRAMES]; /* index in the recording */
    uint32_t n_tracks;
    struct grrl_vec2 at[GRRL_CAMERA_FRAMES][GRRL_CAMERA_TRACKS]; /* from the centre */
    bool seen[GRRL_CAMERA_FRAMES][GRRL_CAMERA_TRACKS];
    uint32_t n_pairs;
    uint16_t a[GRRL_CAMERA_PAIRS];
    uint16_t b[GRRL_CAMERA_PAIRS];
};

/* Samples frames and tracks; there are no pairs yet. false: out of memory. */
bool grrl_camera_pairs_find(const struct grrl_tracks *tracks, struct grrl_vec2 centre,
                            struct grrl_camera_pairs *pairs);

/*
 * Pairs each track with its neighbours, by the positions `at` instead of pairs->at: at most
 * GRRL_CAMERA_NEIGHBOURS, and at most a quarter of the tracks, so that few points are not paired
 * across bodies. Tracks whose distance changes least, relative to its length, probably move
 * together. While the size of the image is unknown, that would prefer pairs of two bodies; then the
 * nearest tracks are taken.
 */
void grrl_camera_pairs_choose(struct grrl_camera_pairs *pairs,
                              struct grrl_vec2 (*at)[GRRL_CAMERA_TRACKS], float noise,
                              bool size_known);

#endif
