/*
 * solids.h: pieces that are one solid, which turns out of the plane of the image or is near the
 * camera.
 *
 * Perception knows flat rigid bodies. A solid that turns falls into pieces, each nearly flat. Two
 * pieces are one solid if the images of both together fit one as well as they fit two.
 */
#ifndef GRRL_PERCEIVE_SOLIDS_H
#define GRRL_PERCEIVE_SOLIDS_H

#include <stdbool.h>

#include "tracks.h"

#include "grrl/perception/perception.h"

/* The bodies of a model after its pieces have been joined, by their index. */
struct grrl_solids {
    uint8_t origin[GRRL_MAX_LINKS]; /* the index of its first piece in the model before */
    bool solid[GRRL_MAX_LINKS];     /* of several pieces, or of points that were in no body */
};

/*
 * Joins the pieces of solids, and makes bodies of points in none that are one. Joints of a solid
 * are dropped: pivots and slides in the plane of the image do not describe how it moves. tracks:
 * the recording that the model is of, in metres; config: that of its perception. false: memory is
 * short. Cost: some 10 ms for each pair of pieces.
 */
bool grrl_solids_join(const struct grrl_tracks *tracks, const struct grrl_perception_config *config,
                      struct grrl_model *model, struct grrl_solids *solids);

#endif
