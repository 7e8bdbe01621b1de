/*
 * trajectory.h: the joint behind a single trajectory: what a handle draws while it is moved by
 * hand.
 *
 * A door's handle moves on a circle, a drawer's on a line; another may move on some other curve, or
 * not at all. Circle and line are fitted, each by the distances across it, and all four are
 * compared by how probable they make what is seen; where none is probable enough the answer is
 * open. All samples count, but neighbouring ones repeat one another's errors: what they are worth
 * together comes from the power of slow waves in the residuals, that is from their autocorrelation.
 * Errors as slow as the movement itself, of a hand that pulls askew, no number of samples averages
 * out. One call does it: grrl_trajectory_fit_of.
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
 * of furniture moved by hand: what bends such a trajectory is less the noise of single samples than
 * the play of the mechanism and of the hand.
 */
struct grrl_trajectory_config {
    float noise_m;  /* standard deviation per axis, such slow errors included; 0.01 */
    float radius_m; /* usual distance of a handle from its hinge, within a factor of three; 0.3 */
    float play_rad; /* by which a handle that slides may seem to turn; 0.09 */
    float decided;  /* probability from which on there is an answer, 0.5 to 1; 0.667 */
};

/* Positions in the order of time. */
struct grrl_trajectory {
    uint32_t n;
    uint8_t dimensions;  /* numbers a sample: 2 or 3 */
    const float *rows_m; /* n x dimensions */
};

/* What kind of handle drew a trajectory. */
enum grrl_trajectory_answer {
    GRRL_TRAJECTORY_UNDETERMINED, /* none of the others is probable enough */
    GRRL_TRAJECTORY_REVOLUTE,
    GRRL_TRAJECTORY_PRISMATIC,
    GRRL_TRAJECTORY_RIGID,  /* it did not move */
    GRRL_TRAJECTORY_NEITHER /* it moved on another curve */
};

/* What one of the two models makes of a trajectory. */
struct grrl_trajectory_model {
    float probability; /* against the other model, rigid and neither */
    float residual_m;  /* root mean square distance across it, outliers counted for less */
    float point_m[3];  /* a point on the line; the centre of the circle */
    float axis[3];     /* unit vector along the line; along the axis of rotation */
    float travel;      /* metres along the line; radians about the centre */
};

struct grrl_trajectory_fit {
    enum grrl_trajectory_answer answer;
    float p_rigid; /* these and the two models' probabilities sum to 1 */
    float p_neither;
    struct grrl_trajectory_model revolute;
    struct grrl_trajectory_model prismatic;
    float radius_m;       /* of the circle; at most 1000: a circle that is as good as a line */
    float out_of_plane_m; /* root mean square distance from the trajectory's plane */
    float slow_m; /* root mean square of the circle's residuals in waves of the path's length
                     down to a quarter of it, without noise */
    float effective_samples; /* independent ones that all are worth to the bow of the path */
    uint32_t outliers;       /* samples far from their neighbours in time, left out */
};

void grrl_trajectory_config_default(struct grrl_trajectory_config *config);

/*
 * Fits both models to the projection on the two main axes. Samples that lie more than five standard
 * deviations from the median of themselves and the two before and after are left out (at the ends
 * there are fewer to tell by); what remains counts by the loss of a Cauchy distribution. The circle
 * is fitted in Chernov and Lesort's parameters (Journal of Mathematical Imaging and Vision, 2005),
 * in which a line is a circle too, so that arcs of a few degrees do no harm.
 *
 * The answer (trajectory_evidence.c has the densities):
 * - rigid: slow movement along the main axis is as little as what a handle at rest wanders, 0.3 mm;
 *   from 10 mm on it moves;
 * - neither: slow residuals of the circle are some 3% of the path's length, of doors and drawers
 *   they are below 1%;
 * - prismatic or revolute: the turn about the circle's centre is explained by play_rad and the
 * noise of the residuals, or by a hinge at a usual distance. Samples in one place within a
 * micrometre are rigid, and the models are all zero.
 *
 * GRRL_ERR_ARGUMENT: a configuration or a number of dimensions out of range; GRRL_ERR_NUMBER: a
 * position that is not finite or beyond 1 km; GRRL_ERR_NONE: too few samples.
 * Cost: some 80 passes over the samples.
 */
GRRL_MUST_USE enum grrl_status grrl_trajectory_fit_of(const struct grrl_trajectory *trajectory,
                                                      const struct grrl_trajectory_config *config,
                                                      struct grrl_trajectory_fit *fit);

GRRL_API_END

#endif
