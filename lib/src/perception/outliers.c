/*
 * outliers.c: points of a push that no motion explains.
 *
 * A keyframe of a push averages three frames, and an outlier close enough to pass for motion shifts
 * their mean. Such a mean lies off its body while the other features of the body do not, and the
 * feature is back in the next keyframe. A part of the body that moves relative to the rest has more
 * than two features, and stays where it went once at rest.
 */
#include "perception/perception_internal.h"

/* A point this far off its body is an outlier: noise reaches it once in 270,000 points (the
 * Rayleigh distribution: exp(-5^2 / 2)). */
#define OFF_SIGMAS 5.0f

/* The most features that may be off in one keyframe of a body; more indicate motion. With 2%
 * outliers and three frames per keyframe, three or more of ten features are off by chance once in
 * fifty keyframes. */
#define ALONE_MAX 2

/* A feature is rarely off if it is off in at most one of this many keyframes. */
#define SELDOM 4

static bool is_off(const struct grrl_perception *p, uint16_t slot, uint8_t k)
{
    const struct grrl_perception_pose *pose = &p->pose[k][p->body_of[slot]];
    uint8_t weight = p->keyframe[k].weight[slot];
    if (weight == 0 || !(pose->weight > 0.0f))
        return false;
    float d2 = grrl_vec2_distance2(p->keyframe[k].point[slot], grrl_to_world(pose, p->shape[slot]));
    return d2 > OFF_SIGMAS * OFF_SIGMAS * grrl_perception_variance(p, weight);
}

/* Whether a feature is off in at most one in four of the new keyframes. */
static bool is_seldom_off(const struct grrl_perception *p, uint16_t slot)
{
    unsigned off = 0;
    unsigned seen = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        if (!p->keyframe[k].examined) {
            seen++;
            off += is_off(p, slot, k) ? 1u : 0u;
        }
    }
    return SELDOM * off <= seen + SELDOM - 1;
}

/* Removes features that are off their body in keyframe k from that keyframe, if they are few and
 * rarely off; returns how many. */
static uint32_t drop_from(struct grrl_perception *p, uint8_t body, uint8_t k)
{
    uint16_t off[ALONE_MAX];
    unsigned n = 0;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] == body && is_off(p, i, k)) {
            if (n == ALONE_MAX)
                return 0;
            off[n++] = i;
        }
    }
    uint32_t dropped = 0;
    for (unsigned i = 0; i < n; i++) {
        if (is_seldom_off(p, off[i])) {
            p->keyframe[k].weight[off[i]] = 0;
            dropped++;
        }
    }
    return dropped;
}

bool grrl_outliers_drop(struct grrl_perception *p)
{
    uint32_t dropped = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        for (uint8_t b = 0; b < p->n_bodies && !p->keyframe[k].examined && !p->keyframe[k].at_rest;
             b++)
            dropped += drop_from(p, b, k);
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        p->keyframe[k].examined = true;
    p->counts.outliers += dropped;
    return dropped > 0;
}
