/*
 * grounding.h: turns relational actions into pushes in metres and newtons (paper, sections III and
 * VI).
 *
 * A link's principal axis has no sign, and the plane can be mirrored. The structure therefore fixes
 * both signs, so that a stored action has the same effect on another object: the axis points away
 * from the neighbours the link hangs on, and its left-hand side faces the rest of the object.
 */
#ifndef GRRL_GROUNDING_H
#define GRRL_GROUNDING_H

#include "grrl/base/api.h"
#include "grrl/perception/perception.h"

GRRL_API_BEGIN

/* Fill with grrl_grounding_config_default, then change what should differ. */
struct grrl_grounding_config {
    float finger_radius_m; /* of the pushing tool; 0.01 */
    float clearance_m;     /* between the tool's edge and the nearest feature at the start; 0.015 */
    float travel_m;        /* travel after first contact; 0.03 */
    float speed_m_s;       /* 0.08 */
    float force_n;         /* limit; 10 */
    float timeout_s;       /* 2.5 */
};

/* The coordinate frame for a link's directions: right-handed or mirrored, both vectors of unit
 * length. */
struct grrl_link_frame {
    struct grrl_vec2 forward; /* 0 degrees */
    struct grrl_vec2 side;    /* 90 degrees */
};

/* A push as a robot executes it: lower the tool at start, move towards end, stop `travel_m` after
 * first contact, at the end of the line, or at the timeout. World frame, metres. */
struct grrl_push {
    struct grrl_vec2 start_m;
    struct grrl_vec2 end_m;
    float travel_m;
    float speed_m_s;
    float force_n;
    float timeout_s;
};

void grrl_grounding_config_default(struct grrl_grounding_config *config);

/* GRRL_ERR_ARGUMENT if a value is not finite or not positive. */
GRRL_MUST_USE enum grrl_status
grrl_grounding_config_check(const struct grrl_grounding_config *config);

/*
 * Computes the direction frame of body `body`. Forward lies along the principal axis and points
 * away from the joined neighbours. With neighbours at both ends it points away from the heavier end
 * (more links, then longer links, then the joint discovered first). Without neighbours it keeps the
 * axis as given. Side points towards the centroid of the rest of the object; if there is no rest,
 * it makes the frame right-handed. A mirrored or rotated model gives a mirrored or rotated frame.
 * GRRL_ERR_ARGUMENT: no such body.
 */
GRRL_MUST_USE enum grrl_status grrl_grounding_frame(const struct grrl_model *model, uint8_t body,
                                                    struct grrl_link_frame *frame);

/* The unit vector of a direction (an index into grrl_direction_deg) in the world frame. */
struct grrl_vec2 grrl_grounding_direction(const struct grrl_link_frame *frame, uint8_t direction);

/*
 * Computes the push for an action (a body's index and an index into grrl_direction_deg). Its line
 * passes through the centroid, from behind the rearmost feature in the tool's path to beyond the
 * foremost one. The start is moved back, by up to 0.4 m, until it clears the features of every
 * body. GRRL_ERR_ARGUMENT: no such body or direction. Cost: linear in features x steps moved back.
 */
GRRL_MUST_USE enum grrl_status grrl_grounding_push(const struct grrl_model *model,
                                                   const struct grrl_grounding_config *config,
                                                   uint8_t body, uint8_t direction,
                                                   struct grrl_push *push);

GRRL_API_END

#endif
