/*
 * trajectory_evidence.h: what the residuals of a trajectory tell about its joint.
 *
 * Order of calls: for the residuals of the circle, and for the places along the main axis, one
 * spectrum each: begin, add in the order of time, end. Then grrl_trajectory_weigh.
 */
#ifndef GRRL_TRAJECTORY_EVIDENCE_H
#define GRRL_TRAJECTORY_EVIDENCE_H

#include <stdint.h>

#include "grrl/perception/trajectory.h"

/* Half waves over the trajectory: the slowest ones are errors of the hand and the mechanism, or of
 * the model; the same number twice more tells what noise has in each of them. */
enum { GRRL_TRAJECTORY_SLOW = 8, GRRL_TRAJECTORY_WAVES = 3 * GRRL_TRAJECTORY_SLOW };

struct grrl_trajectory_spectrum {
    uint32_t n; /* samples that will be added */
    uint32_t i;
    float squares;
    float wave[GRRL_TRAJECTORY_WAVES]; /* sums of products with one half wave, two, .. */
};

/* Mean squares, in m^2. */
struct grrl_trajectory_residuals {
    float total;
    float slow; /* what the slowest waves have beyond their share of the noise */
    float
        wave; /* noise in each wave: total over it, without slow ones, is how many samples count */
};

struct grrl_trajectory_clues {
    struct grrl_trajectory_residuals residuals; /* of the circle */
    struct grrl_trajectory_residuals places;    /* along the main axis */
    float length_m;                             /* of the path */
    float turn_rad;                             /* about the circle's centre */
};

void grrl_trajectory_spectrum_begin(struct grrl_trajectory_spectrum *spectrum, uint32_t n);
void grrl_trajectory_spectrum_add(struct grrl_trajectory_spectrum *spectrum, float residual_m);
struct grrl_trajectory_residuals
grrl_trajectory_spectrum_end(const struct grrl_trajectory_spectrum *spectrum);

/* Fills the probabilities, effective_samples, slow_m and the answer. */
void grrl_trajectory_weigh(const struct grrl_trajectory_config *config,
                           const struct grrl_trajectory_clues *clues,
                           struct grrl_trajectory_fit *fit);

#endif
