/*
 * apart.c: whether two bodies moved relative to each other: by how far, and what it costs to fit
 * them as one.
 */
#include "perception/perception_internal.h"

/* Standard deviations for the range of a relative motion: over ten rests noise has a mean range of
 * 3.1, and exceeds 5 in 15 of 1,000 cases. */
#define FAR_SIGMAS 5.0f

/* Relative motion below this many times the joint detection threshold is small (12 degrees, 10 mm).
 * Beyond it, features 50 mm from the joint are off by 10 mm or 15 standard deviations: each one
 * identifies its link by itself, and the bodies need neither be cut again nor fitted as one. */
#define LITTLE 6.0f

/* Chi squared that a separate pose must save in a keyframe. Its 3 parameters save 3 by chance, with
 * a standard deviation of 2.4; 12 is exceeded in 7 of 1000. */
#define MERGE_FREE 12.0f

/* What must remain beyond that over all keyframes. By chance 48 of them leave 0.8; the rest is a
 * margin for residuals that are not Gaussian. */
#define MERGE_EVIDENCE 40.0f

/* Cap on one squared residual in that sum, higher than GRRL_COST_CAP: a point 10 standard
 * deviations off shows that the bodies moved apart; one at 30 shows no more. */
#define APART_CAP 100.0f

#define FEW_FRAMES 3 /* as many as in a keyframe of a push */

static float at_most(float x, float cap)
{
    return x < cap ? x : cap;
}

/* Chi squared that separate poses of bodies a and b save in keyframe k compared with one common
 * pose. */
static float saved_apart(const struct grrl_perception *p, const struct grrl_rigid_group *together,
                         uint8_t a, uint8_t b, uint8_t k)
{
    float saved = 0.0f;
    for (uint16_t i = 0; i < together->n; i++) {
        uint16_t slot = together->slot[i];
        uint8_t w = p->keyframe[k].weight[slot];
        if (w == 0)
            continue;
        struct grrl_vec2 point = p->keyframe[k].point[slot];
        const struct grrl_perception_pose *own = &p->pose[k][p->body_of[slot] == a ? a : b];
        float scale = 1.0f / grrl_perception_variance(p, w);
        struct grrl_vec2 in_both = grrl_to_world(&together->pose[k], together->shape[slot]);
        float as_one = scale * grrl_vec2_distance2(point, in_both);
        float alone = scale * grrl_vec2_distance2(point, grrl_to_world(own, p->shape[slot]));
        saved += at_most(as_one, APART_CAP) - at_most(alone, APART_CAP);
    }
    return saved;
}

/* A sum that has reached `enough` is not finished. */
static float evidence_of(const struct grrl_perception *p, const struct grrl_rigid_group *together,
                         uint8_t a, uint8_t b, float enough)
{
    float evidence = 0.0f;
    float allowance = MERGE_FREE * p->config.slack;
    for (uint8_t k = 0; k < p->n_keyframes && evidence < enough; k++) {
        if (!(p->pose[k][a].weight > 0.0f) || !(p->pose[k][b].weight > 0.0f) ||
            !(together->pose[k].weight > 0.0f))
            continue;
        float saved = saved_apart(p, together, a, b, k);
        evidence += saved > allowance ? saved - allowance : 0.0f;
    }
    return evidence;
}

void grrl_apart_fit_both(const struct grrl_perception *p, uint8_t a, uint8_t b,
                         struct grrl_rigid_group *together)
{
    together->n = 0;
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == a || p->body_of[i] == b)
            together->slot[together->n++] = i;
    grrl_rigid_fit(p, together->slot, together->n, together->shape, together->pose, 1);
}

float grrl_apart_evidence(const struct grrl_perception *p, uint8_t a, uint8_t b, float enough)
{
    struct grrl_rigid_group together;
    grrl_apart_fit_both(p, a, b, &together);
    return evidence_of(p, &together, a, b, enough);
}

/* Widens an interval so that x is in it. */
static void include(float interval[2], float x)
{
    interval[0] = x < interval[0] ? x : interval[0];
    interval[1] = x > interval[1] ? x : interval[1];
}

/* Pose of b in the frame of a. */
static struct grrl_pose relative_pose(const struct grrl_perception_pose *a,
                                      const struct grrl_perception_pose *b)
{
    return (struct grrl_pose){grrl_origin_in(a, b), a->pose.c * b->pose.c + a->pose.s * b->pose.s,
                              a->pose.c * b->pose.s - a->pose.s * b->pose.c};
}

/* Raises the variances in `range` to those of the relative pose in one keyframe. */
static void include_noise(const struct grrl_perception *p, const struct grrl_perception_pose *a,
                          const struct grrl_perception_pose *b, struct grrl_vec2 between,
                          struct grrl_apart_range *range)
{
    float noise2 = p->config.noise_m * p->config.noise_m;
    float turn = noise2 * (1.0f / (a->inertia + GRRL_LEAST_INERTIA) +
                           1.0f / (b->inertia + GRRL_LEAST_INERTIA));
    float shift = noise2 * (1.0f / a->weight + 1.0f / b->weight) +
                  0.25f * turn * grrl_vec2_dot(between, between);
    range->turn_var = turn > range->turn_var ? turn : range->turn_var;
    range->shift_var = shift > range->shift_var ? shift : range->shift_var;
}

/* The largest number of frames averaged for any point of a keyframe. */
static uint8_t frames_of(const struct grrl_perception_keyframe *key, uint16_t n_slots)
{
    uint8_t most = 0;
    for (uint16_t i = 0; i < n_slots; i++)
        most = key->weight[i] > most ? key->weight[i] : most;
    return most;
}

/*
 * Whether to compare keyframes at rest only: at least two of them saw both bodies, averaged over
 * more frames than a keyframe of a push. Otherwise all keyframes count: the recording may not say
 * when things were at rest, a link may be missing in the first or the last image, or a motion may
 * be reversed.
 */
static bool rests_tell_alone(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    unsigned rests = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        if (p->keyframe[k].at_rest && p->pose[k][a].weight > 0.0f && p->pose[k][b].weight > 0.0f &&
            frames_of(&p->keyframe[k], p->n_slots) > FEW_FRAMES)
            rests++;
    return rests >= 2;
}

struct grrl_apart_range grrl_apart_range_between(const struct grrl_perception *p, uint8_t a,
                                                 uint8_t b)
{
    float turn[2] = {0.0f, 0.0f};
    float x[2] = {0.0f, 0.0f};
    float y[2] = {0.0f, 0.0f};
    struct grrl_pose reference = {0}; /* of b in a, at the first rest */
    struct grrl_vec2 middle = {0};
    struct grrl_apart_range range = {0};
    bool begun = false;
    bool rests_alone = rests_tell_alone(p, a, b);
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        const struct grrl_perception_pose *pa = &p->pose[k][a];
        const struct grrl_perception_pose *pb = &p->pose[k][b];
        if ((rests_alone && !p->keyframe[k].at_rest) || !(pa->weight > 0.0f) ||
            !(pb->weight > 0.0f))
            continue;
        struct grrl_pose r = relative_pose(pa, pb);
        if (!begun) {
            begun = true;
            reference = r;
            middle = grrl_vec2_scale(r.p, 0.5f);
        }
        include_noise(p, pa, pb, r.p, &range);
        /* where b carries the point halfway between them */
        struct grrl_vec2 at = grrl_transform(r, grrl_untransform(reference, middle));
        struct grrl_vec2 d = grrl_vec2_sub(at, middle);
        include(turn, r.s * reference.c - r.c * reference.s);
        include(x, d.x);
        include(y, d.y);
    }
    struct grrl_vec2 shifted = {x[1] - x[0], y[1] - y[0]};
    range.turn = turn[1] - turn[0];
    range.shift2 = grrl_vec2_dot(shifted, shifted);
    return range;
}

/*
 * Whether the relative motion of two bodies, from rest to rest, is large enough to detect a joint.
 * Below that a second body is not worthwhile: features near the joint could not be assigned, and
 * whatever is joined to the pair would seem to be joined to either.
 */
static bool is_far(const struct grrl_perception *p, const struct grrl_apart_range *range)
{
    float least_turn = p->config.min_turn_rad;
    float least_shift = p->config.min_slide_m;
    float sigmas2 = FAR_SIGMAS * FAR_SIGMAS;
    return (range->turn > least_turn && range->turn * range->turn > sigmas2 * range->turn_var) ||
           (range->shift2 > least_shift * least_shift &&
            range->shift2 > sigmas2 * range->shift_var);
}

/* Whether the motion is below `units` times the joint detection threshold. */
static bool is_less(const struct grrl_perception *p, const struct grrl_apart_range *range,
                    float units)
{
    float little_turn = units * p->config.min_turn_rad;
    float little_shift = units * p->config.min_slide_m;
    return range->turn < little_turn && range->shift2 < little_shift * little_shift;
}

bool grrl_apart_may_merge(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    struct grrl_apart_range range = grrl_apart_range_between(p, a, b);
    bool far = is_far(p, &range);
    if (far && !is_less(p, &range, LITTLE * p->config.slack))
        return false; /* clearly two bodies; saves the much more expensive fit of both together */
    if (!grrl_assign_bodies_may_share(p, a, b))
        return false;
    float enough = MERGE_EVIDENCE * p->config.slack;
    return !far || grrl_apart_evidence(p, a, b, enough) < enough;
}

bool grrl_apart_are_still(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    struct grrl_apart_range range = grrl_apart_range_between(p, a, b);
    return !is_far(p, &range);
}

bool grrl_apart_never_moved(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    return grrl_perception_on_table(p) && !rests_tell_alone(p, a, b) &&
           !grrl_assign_body_has_moved(p, a) && !grrl_assign_body_has_moved(p, b);
}

bool grrl_apart_is_little(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    struct grrl_apart_range range = grrl_apart_range_between(p, a, b);
    return is_less(p, &range, LITTLE);
}
