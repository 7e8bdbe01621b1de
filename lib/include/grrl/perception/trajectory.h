/*
 * trajectory.h: the joint behind a single trajectory, such as that of a handle moved by hand.
 *
 * The handle of a door moves on a circle, that of a drawer on a line; others move on some other
 * curve, or not at all. A circle and a line are fitted by orthogonal distance, and the four
 * hypotheses are compared by the likelihood of the data; if none is probable enough, the answer is
 * left open. All samples count, but the errors of neighbouring samples are correlated: the
 * effective number of samples follows from the power of slow waves in the residuals, that is, from
 * their autocorrelation. No number of samples averages out errors as slow as the movement itself,
 * such as those of a hand that pulls sideways. One call does it: grrl_trajectory_fit_of.
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
 * Fill with grrl_trajectory_config_default, then change what differs. The defaults are for
 * furniture handles moved by hand: such a trajectory is bent by the play of the mechanism and of
 * the hand more than by the noise of single samples.
 */
struct grrl_trajectory_config {
    float noise_m;  /* standard deviation per axis, including such slow errors; 0.01 */
    float radius_m; /* typical distance of a handle from its hinge, within a factor of three; 0.3 */
    float play_rad; /* how far a sliding handle may seem to turn; 0.09 */
    float decided;  /* least probability for an answer, 0.5 to 1; 0.667 */
};

/* Positions in time order. */
struct grrl_trajectory {
    uint32_t n;
    uint8_t dimensions;  /* coordinates per sample: 2 or 3 */
    const float *rows_m; /* n x dimensions */
};

/* What kind of joint produced a trajectory. */
enum grrl_trajectory_answer {
    GRRL_TRAJECTORY_UNDETERMINED, /* none of the others is probable enough */
    GRRL_TRAJECTORY_REVOLUTE,
    GRRL_TRAJECTORY_PRISMATIC,
    GRRL_TRAJECTORY_RIGID,  /* it did not move */
    GRRL_TRAJECTORY_NEITHER /* it moved along another curve */
};

/* The fit of one of the two models. */
struct grrl_trajectory_model {
    float probability; /* compared with the other model, rigid and neither */
    float residual_m;  /* root mean square distance from the curve, outliers weighted down */
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
    float radius_m; /* of the circle; at most 1000, where a circle cannot be told from a line */
    float out_of_plane_m; /* root mean square distance from the trajectory's plane */
    float slow_m; /* root mean square of the circle's residuals, without noise, at wavelengths from
                     twice the path's length down to a quarter of it */
    float effective_samples; /* number of independent samples, as far as the bow of the path is
                                concerned */
    uint32_t outliers;       /* samples far from their neighbours in time; they are ignored */
};

void grrl_trajectory_config_default(struct grrl_trajectory_config *config);

/*
 * Fits both models to the projection onto the two main axes. Samples more than five standard
 * deviations from the running median of five samples (fewer at the ends) are ignored; the others
 * are weighted by the loss of a Cauchy distribution. The circle is fitted in Chernov and Lesort's
 * parameters (Journal of Mathematical Imaging and Vision, 2005), in which a line is a circle too,
 * so arcs of a few degrees are well conditioned.
 *
 * The answer (see trajectory_evidence.c for the densities):
 * - rigid: the slow movement along the main axis is as small as the drift of a handle at rest,
 *   0.3 mm; from 10 mm on the handle counts as moving;
 * - neither: the slow residuals of the circle are around 2% of the path's length and smooth, with
 *   most of their power in at most four half waves over the path; those of doors and drawers are
 *   below 1% and spread over eight;
 * - prismatic or revolute: the turn about the circle's centre is explained by play_rad and the
 * noise of the residuals (prismatic), or by a hinge at a typical distance (revolute). If all
 * samples lie within a micrometre, the answer is rigid and both models are zero.
 *
 * GRRL_ERR_ARGUMENT: a configuration or a number of dimensions out of range; GRRL_ERR_NUMBER: a
 * position that is not finite or beyond 1 km; GRRL_ERR_NONE: too few samples. Cost: about 80 passes
 * over the samples.
 */
GRRL_MUST_USE enum grrl_status grrl_trajectory_fit_of(const struct grrl_trajectory *trajectory,
                                                      const struct grrl_trajectory_config *config,
                                                      struct grrl_trajectory_fit *fit);

GRRL_API_END

#endif
