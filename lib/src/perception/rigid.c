/*
 * rigid.c: poses and residuals of a set of features taken as one rigid body.
 */
#include "perception/perception_internal.h"

/* A point this many standard deviations off its body in a keyframe is an outlier: noise reaches
 * that once in 270,000 points, see outliers.c. */
#define OFF_SIGMAS 5.0f

/* One in this many points of a body in a keyframe may be outliers; if there are more, the body is
 * wrong instead. */
#define OFF_SHARE 3

/* Beyond GRRL_COST_CAP by more than rounding. */
#define OFF_COST (1.1f * GRRL_COST_CAP)

/* A feature more in a keyframe counts as much as this many frames averaged, of all its features. */
#define SEEN 1000u

/* Standard deviation of growth: a camera may approach or zoom by a third. A body never appears less
 * than half as large as before. */
#define GROWTH_SD 0.3f
#define LEAST_GROWTH (-0.5f)

/* Standard deviations of a size in a keyframe within which a change may be noise. */
#define SIZE_SIGMAS 3.0f

float grrl_rigid_growth(const struct grrl_perception *p, float length, float inertia)
{
    float prior = grrl_perception_variance(p, 1) / (GROWTH_SD * GROWTH_SD);
    float growth = (length - inertia) / (inertia + prior);
    return growth > LEAST_GROWTH ? growth : LEAST_GROWTH;
}

/* The points of a body that one keyframe saw, in arrays that compilers turn into vectors. */
struct sightings {
    uint16_t n;
    float w[GRRL_MAX_FEATURES];
    float local_x[GRRL_MAX_FEATURES];
    float local_y[GRRL_MAX_FEATURES];
    float world_x[GRRL_MAX_FEATURES];
    float world_y[GRRL_MAX_FEATURES];
    float weight;           /* sum of w */
    struct grrl_vec2 local; /* weighted sums */
    struct grrl_vec2 world;
};

static void gather(const struct grrl_perception_keyframe *key, const uint16_t *slots, uint16_t n,
                   const struct grrl_vec2 *shape, struct sightings *seen)
{
    struct grrl_vec2 local = {0.0f, 0.0f};
    struct grrl_vec2 world = {0.0f, 0.0f};
    float weight = 0.0f;
    uint16_t count = 0;
    for (uint16_t i = 0; i < n; i++) {
        float w = (float)key->weight[slots[i]];
        if (w > 0.0f) {
            struct grrl_vec2 q = shape[slots[i]];
            struct grrl_vec2 x = key->point[slots[i]];
            seen->w[count] = w;
            seen->local_x[count] = q.x;
            seen->local_y[count] = q.y;
            seen->world_x[count] = x.x;
            seen->world_y[count] = x.y;
            count++;
            weight += w;
            local = grrl_vec2_add(local, grrl_vec2_scale(q, w));
            world = grrl_vec2_add(world, grrl_vec2_scale(x, w));
        }
    }
    seen->n = count;
    seen->weight = weight;
    seen->local = local;
    seen->world = world;
}

/* Least-squares pose of weighted points (Umeyama 1991, in the plane: no trigonometry needed). */
static void fit_sized_pose(const struct grrl_perception *p, uint8_t k, const uint16_t *slots,
                           uint16_t n, const struct grrl_vec2 *shape, bool grows,
                           struct grrl_perception_pose *out)
{
    struct sightings seen;
    gather(&p->keyframe[k], slots, n, shape, &seen);
    out->weight = 0.0f;
    if (seen.n < 2)
        return;
    const struct grrl_vec2 local = grrl_vec2_scale(seen.local, 1.0f / seen.weight);
    const struct grrl_vec2 world = grrl_vec2_scale(seen.world, 1.0f / seen.weight);
    float along = 0.0f;
    float across = 0.0f;
    float inertia = 0.0f;
    for (uint16_t i = 0; i < seen.n; i++) {
        struct grrl_vec2 q = {seen.local_x[i] - local.x, seen.local_y[i] - local.y};
        struct grrl_vec2 x = {seen.world_x[i] - world.x, seen.world_y[i] - world.y};
        along += seen.w[i] * grrl_vec2_dot(q, x);
        across += seen.w[i] * grrl_vec2_cross(q, x);
        inertia += seen.w[i] * grrl_vec2_dot(q, q);
    }
    float length = grrl_sqrt(along * along + across * across);
    if (!(length > 0.0f))
        return;
    out->pose.c = along / length;
    out->pose.s = across / length;
    out->growth = grows ? grrl_rigid_growth(p, length, inertia) : 0.0f;
    out->pose.p =
        grrl_vec2_sub(world, grrl_rotate(out->pose, grrl_vec2_scale(local, 1.0f + out->growth)));
    out->weight = seen.weight;
    out->inertia = inertia;
}

static void fit_pose(const struct grrl_perception *p, uint8_t k, const uint16_t *slots, uint16_t n,
                     const struct grrl_vec2 *shape, struct grrl_perception_pose *out)
{
    fit_sized_pose(p, k, slots, n, shape, p->config.sizes_change, out);
}

float grrl_perception_size_change(const struct grrl_perception *perception, uint8_t body)
{
    const struct grrl_perception *p = perception;
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n = body < p->n_bodies ? grrl_rigid_slots(p, body, slots) : 0;
    float least = 1e9f;
    float most = -1e9f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        struct grrl_perception_pose pose;
        fit_sized_pose(p, k, slots, n, p->shape, true, &pose);
        if (!(pose.weight > 0.0f))
            continue;
        float sd = grrl_sqrt(grrl_perception_variance(p, 1) / (pose.inertia + GRRL_LEAST_INERTIA));
        least = pose.growth + SIZE_SIGMAS * sd < least ? pose.growth + SIZE_SIGMAS * sd : least;
        most = pose.growth - SIZE_SIGMAS * sd > most ? pose.growth - SIZE_SIGMAS * sd : most;
    }
    return most > least ? most - least : 0.0f;
}

uint8_t grrl_rigid_reference(const struct grrl_perception *p, const uint16_t *slots, uint16_t n)
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

static bool sees(const struct grrl_perception *p, uint8_t k, uint16_t slot,
                 const struct grrl_perception_pose *poses, size_t stride)
{
    return p->keyframe[k].weight[slot] > 0 && poses[k * stride].weight > 0.0f;
}

bool grrl_rigid_place(const struct grrl_perception *p, uint16_t slot,
                      const struct grrl_perception_pose *poses, size_t stride,
                      struct grrl_vec2 *local)
{
    const bool grows = p->config.sizes_change; /* otherwise it is quicker */
    struct grrl_vec2 sum = {0.0f, 0.0f};
    float weight = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        float w = (float)p->keyframe[k].weight[slot];
        const struct grrl_perception_pose *pose = &poses[k * stride];
        if (w > 0.0f && pose->weight > 0.0f) {
            struct grrl_vec2 q = grows ? grrl_to_local(pose, p->keyframe[k].point[slot])
                                       : grrl_untransform(pose->pose, p->keyframe[k].point[slot]);
            sum = grrl_vec2_add(sum, grrl_vec2_scale(q, w));
            weight += w;
        }
    }
    if (!(weight > 0.0f))
        return false;
    *local = grrl_vec2_scale(sum, 1.0f / weight);
    return true;
}

/* Features whose place on the body is known come first, then the others. */
struct known {
    uint16_t n; /* number of known ones */
    uint16_t slot[GRRL_MAX_FEATURES];
};

/* The initial shape is what one keyframe saw, relative to its centroid; features it did not see
 * come later. */
static void begin_shape(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                        struct grrl_vec2 *shape, struct known *known)
{
    const struct grrl_perception_keyframe *key = &p->keyframe[grrl_rigid_reference(p, slots, n)];
    struct grrl_vec2 mean = {0.0f, 0.0f};
    unsigned seen = 0;
    for (uint16_t i = 0; i < n; i++) {
        if (key->weight[slots[i]] > 0) {
            mean = grrl_vec2_add(mean, key->point[slots[i]]);
            seen++;
        }
    }
    mean = grrl_vec2_scale(mean, seen > 0 ? 1.0f / (float)seen : 0.0f);
    uint16_t unknown = n;
    known->n = 0;
    for (uint16_t i = 0; i < n; i++) {
        if (key->weight[slots[i]] > 0) {
            shape[slots[i]] = grrl_vec2_sub(key->point[slots[i]], mean);
            known->slot[known->n++] = slots[i];
        } else {
            shape[slots[i]] = (struct grrl_vec2){0.0f, 0.0f};
            known->slot[--unknown] = slots[i];
        }
    }
}

/* Places the features that were seen with a known pose; returns whether there were any. */
static bool place_unknown(const struct grrl_perception *p, uint16_t n, struct grrl_vec2 *shape,
                          const struct grrl_perception_pose *poses, size_t stride,
                          struct known *known)
{
    uint16_t before = known->n;
    for (uint16_t i = known->n; i < n; i++) {
        uint16_t slot = known->slot[i];
        if (grrl_rigid_place(p, slot, poses, stride, &shape[slot])) {
            known->slot[i] = known->slot[known->n];
            known->slot[known->n++] = slot;
        }
    }
    return known->n > before;
}

/*
 * A body outlives its features: the known features give poses, these place other features seen at
 * the same time, and those give poses in keyframes that saw none of the first.
 */
static void spread_shape(const struct grrl_perception *p, uint16_t n, struct grrl_vec2 *shape,
                         struct grrl_perception_pose *poses, size_t stride, struct known *known)
{
    while (place_unknown(p, n, shape, poses, stride, known))
        for (uint8_t k = 0; k < p->n_keyframes; k++)
            if (!(poses[k * stride].weight > 0.0f))
                fit_pose(p, k, known->slot, known->n, shape, &poses[k * stride]);
}

/* Generalised Procrustes analysis (Gower 1975): poses for a shape, the shape for these, and the
 * poses for that. The errors of the first shape, from one keyframe, turn all poses alike, so a
 * further round gains nothing. */
void grrl_rigid_fit(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                    struct grrl_vec2 *shape, struct grrl_perception_pose *poses, size_t stride)
{
    struct known known;
    begin_shape(p, slots, n, shape, &known);
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        fit_pose(p, k, known.slot, known.n, shape, &poses[k * stride]);
    spread_shape(p, n, shape, poses, stride, &known);
    for (uint16_t i = 0; i < known.n; i++)
        (void)grrl_rigid_place(p, known.slot[i], poses, stride, &shape[known.slot[i]]);
    centre(known.slot, known.n, shape);
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        fit_pose(p, k, known.slot, known.n, shape, &poses[k * stride]);
}

/* Whether a point is farther off its body than noise, or a joint too small to detect, can explain.
 */
static bool is_off(const struct grrl_perception *p, uint8_t weight, float d2)
{
    float least = p->config.min_slide_m * p->config.min_slide_m;
    return d2 > least && d2 > OFF_SIGMAS * OFF_SIGMAS * grrl_perception_variance(p, weight);
}

/* The index in `slots` of the point farthest off its body in keyframe k; n: none is off. */
static uint16_t farthest_off(const struct grrl_perception *p, uint8_t k, const uint16_t *slots,
                             uint16_t n, const struct grrl_vec2 *shape,
                             const struct grrl_perception_pose *pose)
{
    uint16_t worst = n;
    float worst2 = 0.0f;
    for (uint16_t i = 0; i < n; i++) {
        float d2 = grrl_vec2_distance2(p->keyframe[k].point[slots[i]],
                                       grrl_to_world(pose, shape[slots[i]]));
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
            fit_pose(p, k, kept, n_kept, shape, &pose);
        }
        if (n_kept >= least)
            poses[k * stride] = pose;
    }
}

/* Variance of a residual per axis: of the point, the place and the turn of the body. */
static inline float residual_variance(const struct grrl_perception *p, uint8_t weight,
                                      const struct grrl_perception_pose *pose, float lever2)
{
    float noise2 = p->config.noise_m * p->config.noise_m;
    return grrl_perception_variance(p, weight) + noise2 / pose->weight +
           0.5f * noise2 * lever2 / (pose->inertia + GRRL_LEAST_INERTIA);
}

float grrl_rigid_cost(const struct grrl_perception *p, uint16_t slot, struct grrl_vec2 local,
                      const struct grrl_perception_pose *poses, size_t stride, float enough,
                      uint16_t *n)
{
    float cost = 0.0f;
    float lever2 = grrl_vec2_dot(local, local);
    uint16_t count = 0;
    for (uint8_t k = 0; k < p->n_keyframes && cost <= enough; k++) {
        uint8_t w = p->keyframe[k].weight[slot];
        const struct grrl_perception_pose *pose = &poses[k * stride];
        if (w == 0 || !(pose->weight > 0.0f))
            continue;
        struct grrl_vec2 r = grrl_vec2_sub(p->keyframe[k].point[slot], grrl_to_world(pose, local));
        float d2 = grrl_vec2_dot(r, r) / residual_variance(p, w, pose, lever2);
        cost += d2 < GRRL_COST_CAP ? d2 : GRRL_COST_CAP;
        count++;
    }
    if (cost <= enough)
        *n = count;
    return cost;
}

/* The squared distance beyond which a keyframe costs the cap, for a lever of twice half_lever2. */
static float capped2(const struct grrl_perception *p, uint16_t slot, uint8_t k,
                     const struct grrl_perception_pose *poses, size_t stride, float half_lever2)
{
    return OFF_COST * residual_variance(p, p->keyframe[k].weight[slot], &poses[k * stride],
                                        2.0f * half_lever2);
}

static struct grrl_vec2 local_in(const struct grrl_perception *p, uint16_t slot, uint8_t k,
                                 const struct grrl_perception_pose *poses, size_t stride)
{
    return grrl_untransform(poses[k * stride].pose, p->keyframe[k].point[slot]);
}

/*
 * Let two keyframes place a feature at q and r on a body, and let m be any place for both. One of q
 * and r, say q, is off m by at least h, half their distance. The lever |m| is at most |q| + |q -
 * m|, and chi squared grows with |q - m|, so it is at least that of h with a lever of |q| + h,
 * which is bounded by (a + b)^2 <= 2 a^2 + 2 b^2. If that exceeds the cap for q and for r, one of
 * the two keyframes costs the cap. The pairs are the first and the last keyframe, then those
 * between them.
 */
bool grrl_rigid_is_off(const struct grrl_perception *p, uint16_t slot,
                       const struct grrl_perception_pose *poses, size_t stride, float enough)
{
    uint8_t first = 0;
    uint8_t end = p->n_keyframes;
    float least = 0.0f;
    for (; least <= enough && !p->config.sizes_change; least += GRRL_COST_CAP) {
        while (first < end && !sees(p, first, slot, poses, stride))
            first++;
        while (first < end && !sees(p, (uint8_t)(end - 1), slot, poses, stride))
            end--;
        if (first + 1 >= end)
            return false;
        uint8_t last = --end;
        struct grrl_vec2 q = local_in(p, slot, first, poses, stride);
        struct grrl_vec2 r = local_in(p, slot, last, poses, stride);
        float half2 = 0.25f * grrl_vec2_distance2(q, r);
        if (half2 < capped2(p, slot, first, poses, stride, grrl_vec2_dot(q, q) + half2) ||
            half2 < capped2(p, slot, last, poses, stride, grrl_vec2_dot(r, r) + half2))
            return false;
        first++;
    }
    return least > enough;
}

uint16_t grrl_rigid_slots(const struct grrl_perception *p, uint8_t body, uint16_t *slots)
{
    uint16_t n = 0;
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == body)
            slots[n++] = i;
    return n;
}
