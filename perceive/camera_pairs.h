/*
 * camera_pairs.h: distances between points that move together, from which camera.c tells the
 * camera.
 */
#ifndef GRRL_PERCEIVE_CAMERA_PAIRS_H
#define GRRL_PERCEIVE_CAMERA_PAIRS_H

#include <stdbool.h>
#include <stdint.h>

#include "tracks.h"

#include "grrl/base/geometry.h"

enum {
    GRRL_CAMERA_FRAMES = 32,  /* of the recording, evenly */
    GRRL_CAMERA_TRACKS = 240, /* likewise */
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

/* The positions of tracks in frames; no pairs yet. false: memory is short. */
bool grrl_camera_pairs_find(const struct grrl_tracks *tracks, struct grrl_vec2 centre,
                            struct grrl_camera_pairs *pairs);

/*
 * Of each track the neighbours, by positions `at` instead of its own. Those to which its distance
 * changes least for its length rather move with it than others; but while the size of the picture
 * is not known, that would choose pairs which two bodies share, and the nearest are taken.
 */
void grrl_camera_pairs_choose(struct grrl_camera_pairs *pairs,
                              struct grrl_vec2 (*at)[GRRL_CAMERA_TRACKS], float noise,
                              bool size_known);

#endif
