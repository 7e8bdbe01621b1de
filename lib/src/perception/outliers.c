/*
 * outliers.c: points of a push that no motion explains.
 *
 * Three frames make a keyframe of a push, and an outlier near enough to pass for motion draws their
 * mean after it. Such a mean lies off its body while the body's other features do not, and the
 * feature itself is back in the next keyframe. A part of the body that moves apart is more than two
 * features, and at rest it stays where it went.
 */
#include "perception/perception_internal.h"

#define OFF_SIGMAS 5.0f
#define ALONE_MAX 2 /* features that may be off in one keyframe of a body; more are a motion */

static bool is_off(const struct grrl_perception *p, uint16_t slot, uint8_t k)
{
    const struct grrl_perception_pose *pose = &p->pose[k][p->body_of[slot]];
    uint8_t weight = p->keyframe[k].weight[slot];
    if (weight == 0 || !(pose->weight > 0.0f))
        return false;
    float d2 =
        grrl_vec2_distance2(p->keyframe[k].point[slot], grrl_transform(pose->pose, p->shape[slot]));
    return d2 > OFF_SIGMAS * OFF_SIGMAS * grrl_perception_variance(p, weight);
}

/* Whether a feature is off in few of the keyframes that are new: one in four. */
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
    return 4 * off <= seen + 3;
}

bool grrl_outliers_drop(struct grrl_perception *p)
{
    bool dropped = false;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        if (p->keyframe[k].examined || p->keyframe[k].at_rest)
            continue;
        for (uint8_t b = 0; b < p->n_bodies; b++) {
            uint16_t off[ALONE_MAX];
            unsigned n = 0;
            for (uint16_t i = 0; i < p->n_slots && n <= ALONE_MAX; i++) {
                if (p->body_of[i] == b && is_off(p, i, k)) {
                    if (n < ALONE_MAX)
                        off[n] = i;
                    n++;
                }
            }
            for (unsigned i = 0; i < n && n <= ALONE_MAX; i++) {
                if (is_seldom_off(p, off[i])) {
                    p->keyframe[k].weight[off[i]] = 0;
                    p->counts.outliers++;
                    dropped = true;
                }
            }
        }
    }
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        p->keyframe[k].examined = true;
    return dropped;
}
