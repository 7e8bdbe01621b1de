/* pace.h: how fast the points of a recording move from frame to frame. */
#ifndef GRRL_PERCEIVE_PACE_H
#define GRRL_PERCEIVE_PACE_H

#include "tracks.h"

#include "grrl/perception/perception.h"

/*
 * Adapts a configuration to the pace of a recording in metres. If points move farther from frame to
 * frame than the configuration expects (few frames per second, a large image, only two images), or
 * if ids live for only a few frames, jump_m grows and push_frames is 1; otherwise nothing changes.
 * false: out of memory. Cost: a sort of all points.
 */
bool grrl_pace_configure(const struct grrl_tracks *tracks, struct grrl_perception_config *config);

/*
 * The library takes a keyframe of a push when three points have moved, so a link of two points
 * would be seen in the first and last frame only, and pass for a part of another. If a recording
 * gave hardly any keyframes, and two points moved by `keyframe_m` at least twice as often, each
 * frame in which they did counts as rest from now on: the library always keeps these. Whether any
 * does.
 */
bool grrl_pace_stop_for_two(struct grrl_tracks *tracks, float keyframe_m, unsigned keyframes);

#endif
