/*
 * trajectory_evidence.h: evidence about the joint from the residuals of a trajectory.
 *
 * Order of calls: one spectrum for the residuals of the circle and one for the positions along the
 * main axis, each by begin, add in time order, end. Then grrl_trajectory_weigh.
 */
#ifndef GRRL_TRAJECTORY_EVIDENCE_H
#define GRRL_TRAJECTORY_EVIDENCE_H

#include <stdint.h>

#include "grrl/perception/trajectory.h"

/* Half waves over the trajectory: the slowest are errors of the hand and the mechanism, or of the
 * model; twice as many faster ones measure the noise power per wave. The error of a wrong model is
 * in the slowest of all. */
enum {
    GRRL_TRAJECTORY_BEND = 4,
    GRRL_TRAJECTORY_SLOW = 2 * GRRL_TRAJECTORY_BEND,
    GRRL_TRAJECTORY_WAVES = 3 * GRRL_TRAJECTORY_SLOW
};

struct grrl_trajectory_spectrum {
    uint32_t n; /* samples that will be added */
    uint32_t i;
    float squares;
    float wave[GRRL_TRAJECTORY_WAVES]; /* sums of products with one half wave, two, ... */
};

/* Mean squares, in m^2. */
struct grrl_trajectory_residuals {
    float total;
    float slow; /* power of the slowest waves beyond their share of the noise */
    float bend; /* power of the slower half of these, with the noise in them */
    float sway; /* power of the other half; 0 with too few samples to tell the two apart */
    float wave; /* noise power per wave: total / wave, without the slow part, is the effective
                   number of samples */
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
