/*
 * trajectory.h: the joint behind a single trajectory: what a handle draws while it is moved by
 * hand.
 *
 * A door's handle moves on a circle, a drawer's on a line. Both are fitted, each by the distances
 * across it, and compared by their marginal likelihoods: an arc so flat that its radius would be
 * unusual is rather a line. Neighbouring samples repeat one another's errors, so that a trajectory
 * counts as a number of independent samples that does not grow with the camera's rate. One call
 * does it: grrl_trajectory_fit.
 */
#ifndef GRRL_TRAJECTORY_H
#define GRRL_TRAJECTORY_H

#include <stdint.h>

#include "grrl/base/api.h"
#include "grrl/base/joint_type.h"
#include "grrl/base/status.h"

GRRL_API_BEGIN

/* The fewest samples a trajectory may have. */
enum { GRRL_TRAJECTORY_MIN_SAMPLES = 5 };

/*
 * Fill with grrl_trajectory_config_default, then change what differs. The defaults are for handles
 * of furniture moved by hand: what bends such a trajectory is not the noise of single samples but
 * the play of the mechanism and of the hand, centimetres long.
 */
struct grrl_trajectory_config {
    float noise_m;           /* standard deviation per axis, such slow errors included; 0.01 */
    float effective_samples; /* independent samples a trajectory is worth, at least 1; 5 */
    float radius_m; /* usual distance of a handle from its hinge, within a factor of two; 0.5 */
};

/* Positions in the order of time. */
struct grrl_trajectory {
    uint32_t n;
    uint8_t dimensions;  /* numbers a sample: 2 or 3 */
    const float *rows_m; /* n x dimensions */
};

/* What one of the two models makes of a trajectory. */
struct grrl_trajectory_model {
    float probability; /* of this model against the other */
    float residual_m;  /* root mean square distance across it, outliers counted for less */
    float point_m[3];  /* a point on the line; the centre of the circle */
    float axis[3];     /* unit vector along the line; along the axis of rotation */
    float travel;      /* metres along the line; radians about the centre */
};

struct grrl_trajectory_fit {
    enum grrl_joint_type type; /* the more probable one */
    struct grrl_trajectory_model revolute;
    struct grrl_trajectory_model prismatic;
    float radius_m;       /* of the circle; at most 1000: a circle that is as good as a line */
    float out_of_plane_m; /* root mean square distance from the trajectory's plane */
    uint32_t outliers;    /* samples far from their neighbours in time, left out */
};

void grrl_trajectory_config_default(struct grrl_trajectory_config *config);

/*
 * Fits both models to the projection on the two main axes. Samples that lie more than five standard
 * deviations from the median of themselves and the two before and after are left out (at the ends
 * there are fewer to tell by); what remains counts by the loss of a Cauchy distribution. The circle
 * is fitted in Chernov and Lesort's parameters (Journal of Mathematical Imaging and Vision, 2005),
 * in which a line is a circle too, so that arcs of a few degrees do no harm.
 * GRRL_ERR_ARGUMENT: a configuration or a number of dimensions out of range; GRRL_ERR_NUMBER: a
 * position that is not finite or beyond 1 km; GRRL_ERR_NONE: too few samples, or all in one place.
 * Cost: some 80 passes over the samples.
 */
GRRL_MUST_USE enum grrl_status grrl_trajectory_fit_of(const struct grrl_trajectory *trajectory,
                                                      const struct grrl_trajectory_config *config,
                                                      struct grrl_trajectory_fit *fit);

GRRL_API_END

#endif
