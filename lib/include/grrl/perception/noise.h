/*
 * noise.h: estimates the tracker's noise from its points.
 *
 * Perception needs one number about a tracker: the standard deviation of a point in one frame. If
 * it has not been measured, it can be estimated from frames at rest: the second difference of three
 * consecutive frames has six times the variance of a point. A steady motion has no second
 * difference, so slow drift does no harm and frames in motion do little. The estimate is the median
 * over all points and frames, so points that vanish, jump or change their ids do not affect it. A
 * tracker that smooths over time scatters less from frame to frame than its true error: set its
 * noise by hand.
 *
 * Order of calls: grrl_noise_init, grrl_noise_observe for each frame, grrl_noise_estimate at any
 * time.
 */
#ifndef GRRL_NOISE_H
#define GRRL_NOISE_H

#include "grrl/base/api.h"
#include "grrl/perception/perception.h"

GRRL_API_BEGIN

#define grrl_noise_init GRRL_SIZED(grrl_noise_init)

#define GRRL_NOISE_BINS 512
#define GRRL_NOISE_MIN_SAMPLES 100 /* differences along an axis: two per point and three frames */

/* private: the last two points of a feature */
struct grrl_noise_track {
    int32_t id;
    uint32_t seen;  /* consecutive frames; 0: the track is free */
    uint32_t frame; /* when it was last seen, from 1 */
    struct grrl_vec2 last;
    struct grrl_vec2 before;
};

struct grrl_noise {
    /* private */
    uint32_t n_frames;
    uint32_t n_samples;
    struct grrl_noise_track track[GRRL_MAX_FEATURES];
    uint32_t bin[GRRL_NOISE_BINS]; /* second differences by size, sixteen bins per octave */
};

void grrl_noise_init(struct grrl_noise *noise);

/* Takes the next frame; leave out none. A point that is not finite, or whose id does not fit in the
 * table, is ignored. Cost: linear in the points. */
void grrl_noise_observe(struct grrl_noise *noise, const struct grrl_frame *frame);

/*
 * The standard deviation of a point in a frame, per axis, accurate to about 5% from ten frames of
 * forty points. GRRL_ERR_NONE: fewer than GRRL_NOISE_MIN_SAMPLES differences so far.
 * GRRL_ERR_NUMBER: the scatter is too small to measure, for example because the points are rounded
 * or stand still. Cost: a few passes over the bins.
 */
GRRL_MUST_USE enum grrl_status grrl_noise_estimate(const struct grrl_noise *noise, float *sigma_m);

GRRL_API_END

#endif
