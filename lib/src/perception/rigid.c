/*
 * rigid.c: poses and residuals of a set of features taken as one rigid body.
 */
#include "perception/perception_internal.h"

/* A point of a keyframe this many standard deviations off its body is an outlier: noise reaches it
 * once in 270,000 points, see outliers.c. */
#define OFF_SIGMAS 5.0f

/* Of a body's points in a keyframe one in this many may be outliers; more are no outliers, the body
 * is wrong. */
#define OFF_SHARE 3

#define SEEN 1000u /* outweighs any number of frames averaged, 255 at most */

#define LEAST_INERTIA 1e-9f /* m^2, added so that nothing is divided by zero */

/* Least-squares pose of weighted points (Umeyama 1991, in the plane: no trigonometry needed). */
static void fit_pose(const struct grrl_perception_keyframe *key, const uint16_t *slots, uint16_t n,
                     const struct grrl_vec2 *shape, struct grrl_perception_pose *out)
{
    float weight = 0.0f;
    struct grrl_vec2 world = {0.0f, 0.0f};
    struct grrl_vec2 local = {0.0f, 0.0f};
    unsigned seen = 0;
    for (uint16_t i = 0; i < n; i++) {
        float w = (float)key->weight[slots[i]];
        if (w > 0.0f) {
            seen++;
            weight += w;
            world = grrl_vec2_add(world, grrl_vec2_scale(key->point[slots[i]], w));
            local = grrl_vec2_add(local, grrl_vec2_scale(shape[slots[i]], w));
        }
    }
    out->weight = 0.0f;
    if (seen < 2)
        return;
    world = grrl_vec2_scale(world, 1.0f / weight);
    local = grrl_vec2_scale(local, 1.0f / weight);
    float along = 0.0f;
    float across = 0.0f;
    float inertia = 0.0f;
    for (uint16_t i = 0; i < n; i++) {
        float w = (float)key->weight[slots[i]];
        if (w > 0.0f) {
            struct grrl_vec2 q = grrl_vec2_sub(shape[slots[i]], local);
            struct grrl_vec2 x = grrl_vec2_sub(key->point[slots[i]], world);
            along += w * grrl_vec2_dot(q, x);
            across += w * grrl_vec2_cross(q, x);
            inertia += w * grrl_vec2_dot(q, q);
        }
    }
    float length = grrl_sqrt(along * along + across * across);
    if (!(length > 0.0f))
        return;
    out->pose.c = along / length;
    out->pose.s = across / length;
    out->pose.p = grrl_vec2_sub(world, grrl_rotate(out->pose, local));
    out->weight = weight;
    out->inertia = inertia;
}

/* The keyframe that saw most of these features, the earliest of equals. */
static uint8_t reference_keyframe(const struct grrl_perception *p, const uint16_t *slots,
                                  uint16_t n)
{
    uint8_t best = 0;
    unsigned best_score = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        unsigned score = 0;
        for (uint16_t i = 0; i < n; i++) {
            uint8_t w = p->keyframe[k].weight[slots[i]];
            score += w > 0 ? SEEN + w : 0u;
        }
        if (score > best_score) {
            best_score = score;
            best = k;
        }
    }
    return best;
}

static void centre(const uint16_t *slots, uint16_t n, struct grrl_vec2 *shape)
{
    struct grrl_vec2 mean = {0.0f, 0.0f};
    for (uint16_t i = 0; i < n; i++)
        mean = grrl_vec2_add(mean, shape[slots[i]]);
    mean = grrl_vec2_scale(mean, 1.0f / (float)n);
    for (uint16_t i = 0; i < n; i++)
        shape[slots[i]] = grrl_vec2_sub(shape[slots[i]], mean);
}

bool grrl_rigid_place(const struct grrl_perception *p, uint16_t slot,
                      const struct grrl_perception_pose *poses, size_t stride,
                      struct grrl_vec2 *local)
{
    struct grrl_vec2 sum = {0.0f, 0.0f};
    float weight = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        float w = (float)p->keyframe[k].weight[slot];
        const struct grrl_perception_pose *pose = &poses[k * stride];
        if (w > 0.0f && pose->weight > 0.0f) {
            struct grrl_vec2 q = grrl_untransform(pose->pose, p->keyframe[k].point[slot]);
            sum = grrl_vec2_add(sum, grrl_vec2_scale(q, w));
            weight += w;
        }
    }
    if (!(weight > 0.0f))
        return false;
    *local = grrl_vec2_scale(sum, 1.0f / weight);
    return true;
}

/* Generalised Procrustes analysis (Gower 1975): poses for a shape, the shape for poses, twice. */
void grrl_rigid_fit(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                    struct grrl_vec2 *shape, struct grrl_perception_pose *poses, size_t stride)
{
    uint8_t reference = reference_keyframe(p, slots, n);
    struct grrl_vec2 mean = {0.0f, 0.0f};
    unsigned seen = 0;
    for (uint16_t i = 0; i < n; i++) {
        if (p->keyframe[reference].weight[slots[i]] > 0) {
            mean = grrl_vec2_add(mean, p->keyframe[reference].point[slots[i]]);
            seen++;
        }
    }
    mean = grrl_vec2_scale(mean, seen > 0 ? 1.0f / (float)seen : 0.0f);
    uint16_t known[GRRL_MAX_FEATURES]; /* in the reference; the rest is placed afterwards */
    uint16_t n_known = 0;
    for (uint16_t i = 0; i < n; i++) {
        if (p->keyframe[reference].weight[slots[i]] > 0) {
            shape[slots[i]] = grrl_vec2_sub(p->keyframe[reference].point[slots[i]], mean);
            known[n_known++] = slots[i];
        } else {
            shape[slots[i]] = (struct grrl_vec2){0.0f, 0.0f};
        }
    }
    for (int round = 0; round < 2; round++) {
        for (uint8_t k = 0; k < p->n_keyframes; k++) {
            fit_pose(&p->keyframe[k], round == 0 ? known : slots, round == 0 ? n_known : n, shape,
                     &poses[k * stride]);
        }
        for (uint16_t i = 0; i < n; i++)
            (void)grrl_rigid_place(p, slots[i], poses, stride, &shape[slots[i]]);
        if (round == 0)
            centre(slots, n, shape);
    }
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        fit_pose(&p->keyframe[k], slots, n, shape, &poses[k * stride]);
}

/* Farther off its body than noise, and a joint too small to be told, explain. */
static bool is_off(const struct grrl_perception *p, uint8_t weight, float d2)
{
    float least = p->config.min_slide_m * p->config.min_slide_m;
    return d2 > least && d2 > OFF_SIGMAS * OFF_SIGMAS * grrl_perception_variance(p, weight);
}

/* The place in slots of the point farthest off its body in keyframe k, n: none is off. */
static uint16_t farthest_off(const struct grrl_perception *p, uint8_t k, const uint16_t *slots,
                             uint16_t n, const struct grrl_vec2 *shape,
                             const struct grrl_perception_pose *pose)
{
    uint16_t worst = n;
    float worst2 = 0.0f;
    for (uint16_t i = 0; i < n; i++) {
        float d2 = grrl_vec2_distance2(p->keyframe[k].point[slots[i]],
                                       grrl_transform(pose->pose, shape[slots[i]]));
        if (d2 > worst2 && is_off(p, p->keyframe[k].weight[slots[i]], d2)) {
            worst = i;
            worst2 = d2;
        }
    }
    return worst;
}

void grrl_rigid_refit(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                      const struct grrl_vec2 *shape, struct grrl_perception_pose *poses,
                      size_t stride)
{
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        uint16_t kept[GRRL_MAX_FEATURES];
        uint16_t n_kept = 0;
        for (uint16_t i = 0; i < n; i++)
            if (p->keyframe[k].weight[slots[i]] > 0)
                kept[n_kept++] = slots[i];
        struct grrl_perception_pose pose = poses[k * stride];
        uint16_t least = (uint16_t)(n_kept - n_kept / OFF_SHARE);
        uint16_t worst = 0;
        while (pose.weight > 0.0f && n_kept >= least &&
               (worst = farthest_off(p, k, kept, n_kept, shape, &pose)) < n_kept) {
            kept[worst] = kept[--n_kept];
            fit_pose(&p->keyframe[k], kept, n_kept, shape, &pose);
        }
        if (n_kept >= least)
            poses[k * stride] = pose;
    }
}

float grrl_rigid_cost(const struct grrl_perception *p, uint16_t slot, struct grrl_vec2 local,
                      const struct grrl_perception_pose *poses, size_t stride, float cap,
                      uint16_t *n)
{
    float cost = 0.0f;
    float noise2 = p->config.noise_m * p->config.noise_m;
    uint16_t count = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        uint8_t w = p->keyframe[k].weight[slot];
        const struct grrl_perception_pose *pose = &poses[k * stride];
        if (w == 0 || !(pose->weight > 0.0f))
            continue;
        struct grrl_vec2 r =
            grrl_vec2_sub(p->keyframe[k].point[slot], grrl_transform(pose->pose, local));
        float lever2 = grrl_vec2_dot(local, local);
        float variance = grrl_perception_variance(p, w) + noise2 / pose->weight +
                         0.5f * noise2 * lever2 / (pose->inertia + LEAST_INERTIA);
        float d2 = grrl_vec2_dot(r, r) / variance;
        cost += d2 < cap ? d2 : cap;
        count++;
    }
    *n = count;
    return cost;
}

uint16_t grrl_rigid_slots(const struct grrl_perception *p, uint8_t body, uint16_t *slots)
{
    uint16_t n = 0;
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == body)
            slots[n++] = i;
    return n;
}
