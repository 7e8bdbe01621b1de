/*
 * noise.h: estimates the tracker's noise from its points.
 *
 * Perception needs one number of a tracker: the standard deviation of a point in one frame. Where
 * nobody has measured it, frames at rest show it: the second difference of three frames in a row
 * has six times the variance of a point. A steady motion has no second difference, so a slow drift
 * does no harm and even frames of motion do little. The estimate is the median over all points and
 * frames, so points that vanish, jump or change their ids do not count. A tracker that smooths over
 * time scatters less from frame to frame than its error: give its noise by hand.
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
#define GRRL_NOISE_MIN_SAMPLES 100 /* differences along an axis; two a point in three frames */

/* private: the last two points of a feature */
struct grrl_noise_track {
    int32_t id;
    uint32_t seen;  /* frames in a row, 0: the track is free */
    uint32_t frame; /* when it was last seen, from 1 */
    struct grrl_vec2 last;
    struct grrl_vec2 before;
};

struct grrl_noise {
    /* private */
    uint32_t n_frames;
    uint32_t n_samples;
    struct grrl_noise_track track[GRRL_MAX_FEATURES];
    uint32_t bin[GRRL_NOISE_BINS]; /* second differences by size, sixteen bins an octave */
};

void grrl_noise_init(struct grrl_noise *noise);

/* Takes one frame; they follow one another without gaps. A point that is not finite, or an id for
 * which there is no room, is left out. Cost: linear in the points. */
void grrl_noise_observe(struct grrl_noise *noise, const struct grrl_frame *frame);

/*
 * The standard deviation of a point in a frame, per axis, to some 5% from ten frames of forty
 * points. GRRL_ERR_NONE: fewer than GRRL_NOISE_MIN_SAMPLES differences so far. GRRL_ERR_NUMBER: the
 * points scatter less than can be told, as when they are rounded or stand still. Cost: a few passes
 * over the bins.
 */
GRRL_MUST_USE enum grrl_status grrl_noise_estimate(const struct grrl_noise *noise, float *sigma_m);

GRRL_API_END

#endif
