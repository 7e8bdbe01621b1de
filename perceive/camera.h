/*
 * camera.h: what the camera adds to the motion, found from the tracks alone and undone.
 *
 * A camera that zooms makes all bodies grow, and one that looks at a table from the side makes them
 * change their shape as they turn: rigid bodies fall into slices.
 */
#ifndef GRRL_PERCEIVE_CAMERA_H
#define GRRL_PERCEIVE_CAMERA_H

#include <stdbool.h>

#include "tracks.h"

#include "grrl/perception/perception.h"

struct grrl_camera {
    bool zoomed;
    float zoom; /* largest scale of the picture over its smallest, - 1 */
    bool tilted;
    float tilt_rad; /* between the line of sight and the normal of the table */

    /* private: with p from the centre of the picture, upright = stretch p / (1 + horizon . p) */
    struct grrl_vec2 centre;
    float stretch[3]; /* xx, xy, yy of a symmetric matrix with determinant 1 */
    struct grrl_vec2 horizon;
};

/*
 * Scales each frame to the size of the last one and looks at the table from above, each only where
 * most pairs of points that change their distance keep it afterwards. noise: the standard deviation
 * of a point, in the unit of the positions. false: memory is short. Cost: some 300 times 240 tracks
 * x 12 neighbours x 48 frames.
 */
bool grrl_camera_undo(struct grrl_tracks *tracks, float noise, struct grrl_camera *camera);

/* A model of what was undone, as the picture shows it: where its features, bodies and joints are.
 * Lengths and ranges stay those of the centre of the picture. */
void grrl_camera_to_picture(const struct grrl_camera *camera, const struct grrl_model *upright,
                            struct grrl_model *picture);

#endif
