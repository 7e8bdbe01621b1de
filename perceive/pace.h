/* pace.h: how fast the points of a recording move from frame to frame. */
#ifndef GRRL_PERCEIVE_PACE_H
#define GRRL_PERCEIVE_PACE_H

#include "tracks.h"

#include "grrl/perception/perception.h"

/*
 * Fits a configuration to the pace of a recording in metres. Where points move farther from frame
 * to frame than the configuration expects (few frames a second, a large picture, two pictures), or
 * where ids live only for a few frames, jump_m grows and push_frames is 1; otherwise all stays as
 * it is. false: memory is short. Cost: a sort of all points.
 */
bool grrl_pace_configure(const struct grrl_tracks *tracks, struct grrl_perception_config *config);

#endif
