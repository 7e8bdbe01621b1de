/*
 * grounding.h: relational actions and pushes in metres and newtons (paper, sections III and VI).
 *
 * A link's principal axis has no sign and a plane can be mirrored; so that a stored action does the
 * same thing on another object, both are grounded in the structure: the axis points away from the
 * neighbours the link hangs on, the left-hand side is the side where the rest of the object lies.
 */
#ifndef GRRL_GROUNDING_H
#define GRRL_GROUNDING_H

#include "grrl/base/api.h"
#include "grrl/perception/perception.h"

GRRL_API_BEGIN

/* Fill with grrl_grounding_config_default, then change what differs. */
struct grrl_grounding_config {
    float finger_radius_m; /* of the pushing tool; 0.01 */
    float clearance_m;     /* from the tool's edge to the nearest feature at the start; 0.015 */
    float travel_m;        /* how far to push after the first contact; 0.03 */
    float speed_m_s;       /* 0.08 */
    float force_n;         /* limit; 10 */
    float timeout_s;       /* 2.5 */
};

/* The frame of directions of a link: right-handed or mirrored, both unit vectors. */
struct grrl_link_frame {
    struct grrl_vec2 forward; /* 0 degrees */
    struct grrl_vec2 side;    /* 90 degrees */
};

/* A push as a robot takes it: come down at start, move towards end, stop `travel_m` after the first
 * contact, at the end of the line, or after the timeout. World frame, metres. */
struct grrl_push {
    struct grrl_vec2 start_m;
    struct grrl_vec2 end_m;
    float travel_m;
    float speed_m_s;
    float force_n;
    float timeout_s;
};

void grrl_grounding_config_default(struct grrl_grounding_config *config);

/* GRRL_ERR_ARGUMENT for a configuration that is not finite or not positive. */
GRRL_MUST_USE enum grrl_status
grrl_grounding_config_check(const struct grrl_grounding_config *config);

/*
 * The frame of directions of body `body`. Forward lies along its principal axis and points away
 * from its joined neighbours; with neighbours at both ends away from the heavier end (more links,
 * then longer links, then the joint discovered first); without neighbours along the axis as it is.
 * Side points towards the centroid of the rest of its object, or makes the frame right-handed. A
 * mirrored or turned model gives the mirrored or turned frame. GRRL_ERR_ARGUMENT: no such body.
 */
GRRL_MUST_USE enum grrl_status grrl_grounding_frame(const struct grrl_model *model, uint8_t body,
                                                    struct grrl_link_frame *frame);

/* The unit vector of a direction (an index into grrl_direction_deg) in the world frame. */
struct grrl_vec2 grrl_grounding_direction(const struct grrl_link_frame *frame, uint8_t direction);

/*
 * The push that an action (a body's index, an index into grrl_direction_deg) means: through the
 * centroid, from behind the rearmost feature in the tool's way to beyond the foremost one. The
 * start is backed off, by up to 0.4 m, until the clearance holds against every body's features.
 * GRRL_ERR_ARGUMENT: no such body or direction. Cost: linear in features x steps backed off.
 */
GRRL_MUST_USE enum grrl_status grrl_grounding_push(const struct grrl_model *model,
                                                   const struct grrl_grounding_config *config,
                                                   uint8_t body, uint8_t direction,
                                                   struct grrl_push *push);

GRRL_API_END

#endif
