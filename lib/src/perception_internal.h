/*
 * perception_internal.h: the rooms behind perception.h.
 *
 *   perception.c  tracks and keyframes: what was seen
 *   rigid.c       poses and residuals of a set of features taken as one rigid body
 *   bodies.c      which features belong together: segment, split, reassign, merge
 *   joints.c      what ties two bodies together, and the structure of all
 */
#ifndef GRRL_PERCEPTION_INTERNAL_H
#define GRRL_PERCEPTION_INTERNAL_H

#include "grrl/perception.h"

/* Variance of a keyframe's point per axis, m^2: noise of `weight` averaged frames + model error. */
float grrl_keyframe_variance(const struct grrl_perception *p, uint8_t weight);

/*
 * rigid.c. A set of features is a list of slots. `shape` holds one point a slot in the body's frame,
 * whose origin is the features' centroid.
 */

/* Poses in all keyframes and the shape that fit best. poses[k] for k < n_keyframes. */
void grrl_rigid_fit(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                    struct grrl_vec2 *shape, struct grrl_perception_pose *poses, size_t stride);

/* Where slot's point lies in the frame of these poses: the mean over all keyframes. */
bool grrl_rigid_place(const struct grrl_perception *p, uint16_t slot,
                      const struct grrl_perception_pose *poses, size_t stride,
                      struct grrl_vec2 *local);

/*
 * Squared residuals of a slot over their variance, each cut at `cap`, summed over the keyframes;
 * 2 is expected of each. *n counts the keyframes where both were seen.
 */
float grrl_rigid_cost(const struct grrl_perception *p, uint16_t slot, struct grrl_vec2 local,
                      const struct grrl_perception_pose *poses, size_t stride, float cap,
                      uint16_t *n);

/* The members of body `body` (or GRRL_FEATURE_..), as slots. */
uint16_t grrl_body_slots(const struct grrl_perception *p, uint8_t body, uint16_t *slots);

/* bodies.c: brings body_of, shape and pose up to date. */
void grrl_bodies_update(struct grrl_perception *p);

/* joints.c: fills the model's joints from the bodies. */
void grrl_joints_update(struct grrl_perception *p);

#endif
