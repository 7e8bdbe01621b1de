/* solid_frames.h: the frames of a recording that solids are sought in. */
#ifndef GRRL_PERCEIVE_SOLID_FRAMES_H
#define GRRL_PERCEIVE_SOLID_FRAMES_H

#include <stdbool.h>
#include <stdint.h>

#include "solid_fit.h"
#include "tracks.h"

#include "grrl/perception/perception.h"

/* Places of the features of a model, by frame and index. */
struct grrl_solid_frames {
    unsigned n;
    unsigned n_features;
    struct grrl_vec2 at[GRRL_VIEWS_FRAMES][GRRL_MAX_FEATURES];
    bool seen[GRRL_VIEWS_FRAMES][GRRL_MAX_FEATURES];
    bool mostly[GRRL_MAX_FEATURES]; /* seen in most of the frames */
};

/* Of frames at equal distances takes those in a row in which the features are seen best: tracks may
 * begin late or end early. false: fewer than `least`. */
bool grrl_solid_frames_choose(struct grrl_solid_frames *frames, const struct grrl_tracks *tracks,
                              const struct grrl_model *model, unsigned least);

/* Adds n features to views. */
void grrl_solid_frames_view(const struct grrl_solid_frames *frames, const uint16_t *feature,
                            unsigned n, struct grrl_views *views);

/* The mean distance of two features in the frames that see both; HUGE_VAL: none does. */
double grrl_solid_frames_distance(const struct grrl_solid_frames *frames, uint16_t a, uint16_t b);

#endif
