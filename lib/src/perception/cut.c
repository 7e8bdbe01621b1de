/*
 * cut.c: where to separate two bodies that moved little relative to each other.
 *
 * Moving single features to where they fit better (bodies.c) ends in a local optimum. If a joint
 * moved only a few degrees, that can be one and a half links in one body and the other half beside
 * it. Links are separated by a line, or nearly so, and all lines can be tried at once: with both
 * bodies fitted as one, the residuals of a part are linear in its turn and shift if both are small,
 * and the sums that a least-squares fit needs grow feature by feature as the line sweeps over them.
 */
#include <string.h>

#include "perception/perception_internal.h"

/* Rounds of assigning features to two crossing links. Each round moves all features at once; the
 * start, the quadrants of a cross, has most of them right. */
#define ROUNDS 4

/* Directions of the line over half a turn, 30 degrees apart: the best is within 15 degrees of the
 * true boundary, and features it leaves on the wrong side are reassigned. */
#define DIRECTIONS 6

/* Directions swept at a time, which share the terms of all features but take 6 bytes of stack a
 * feature each, and partial sums examined at a time, in a loop that becomes vectors where there are
 * some. The results are the same. */
#if defined(__SSE2__) || defined(__ARM_NEON)
#define ABREAST 6
#define LANES 8
#else
#define ABREAST 2
#define LANES 1
#endif

/* A part with a smaller share of the weights or of the inertia counts as empty: the rest is
 * rounding in differences of sums. */
#define LEAST_SHARE 1e-3f
#define LEAST_INERTIA_SHARE 1e-6f

/* Sums over one part of the features in one keyframe, weighted by 1 / variance: q is the place of a
 * feature, d its residual. */
struct part_sum {
    float w;
    struct grrl_vec2 q;
    struct grrl_vec2 d;
    float qq;
    float moment; /* q x d */
};

/* The terms of one feature: those of a sum, but q itself. */
struct term {
    float w;
    struct grrl_vec2 d;
    float qq;
    float moment;
};

static inline void add(struct part_sum *to, const struct term *one, struct grrl_vec2 q)
{
    to->w += one->w;
    to->q = grrl_vec2_add(to->q, grrl_vec2_scale(q, one->w));
    to->d = grrl_vec2_add(to->d, one->d);
    to->qq += one->qq;
    to->moment += one->moment;
}

static inline struct part_sum rest_of(const struct part_sum *all, const struct part_sum *part)
{
    return (struct part_sum){all->w - part->w, grrl_vec2_sub(all->q, part->q),
                             grrl_vec2_sub(all->d, part->d), all->qq - part->qq,
                             all->moment - part->moment};
}

/* Chi squared that a part saves with its own shift and turn. Without branches, for vectors. */
static inline float saved(const struct part_sum *s, float least_w)
{
    bool counts = s->w > least_w;
    float w = counts ? s->w : 1.0f;
    float inertia = s->qq - grrl_vec2_dot(s->q, s->q) / w;
    float moment = s->moment - grrl_vec2_cross(s->q, s->d) / w;
    bool turns = inertia > LEAST_INERTIA_SHARE * s->qq;
    float turn = moment * moment / (turns ? inertia : 1.0f);
    float both = grrl_vec2_dot(s->d, s->d) / w + (turns ? turn : 0.0f);
    return counts ? both : 0.0f;
}

static inline float saved_by_both(const struct part_sum *part, const struct part_sum *all)
{
    struct part_sum rest = rest_of(all, part);
    float rounding = LEAST_SHARE * all->w;
    return saved(part, rounding) + saved(&rest, rounding);
}

/* Features fitted as one rigid body: their slots, places and poses. */
struct whole {
    const uint16_t *slot;
    uint16_t n;
    const struct grrl_vec2 *shape;
    const struct grrl_perception_pose *pose;
    size_t stride;
};

/* The terms of one feature in one keyframe; zero if it was not seen, or is farther off than motion
 * can explain. */
static struct term term_of(const struct grrl_perception *p, const struct whole *t, uint16_t slot,
                           uint8_t k)
{
    struct term none = {0};
    uint8_t weight = p->keyframe[k].weight[slot];
    const struct grrl_perception_pose *pose = &t->pose[k * t->stride];
    if (weight == 0 || !(pose->weight > 0.0f))
        return none;
    struct grrl_vec2 q = t->shape[slot];
    struct grrl_vec2 d = grrl_vec2_sub(grrl_to_local(pose, p->keyframe[k].point[slot]), q);
    float reach = p->config.jump_m;
    if (grrl_vec2_dot(d, d) > reach * reach)
        return none;
    float w = 1.0f / grrl_perception_variance(p, weight);
    return (struct term){w, grrl_vec2_scale(d, w), w * grrl_vec2_dot(q, q),
                         w * grrl_vec2_cross(q, d)};
}

/* Of all features, by slot. */
static void find_terms(const struct grrl_perception *p, const struct whole *t, uint8_t k,
                       struct term *terms)
{
    for (uint16_t i = 0; i < t->n; i++)
        terms[t->slot[i]] = term_of(p, t, t->slot[i], k);
}

static void sort_along(const struct whole *t, struct grrl_vec2 direction, uint16_t *slots,
                       uint16_t n)
{
    for (uint16_t i = 1; i < n; i++) { /* insertion sort: the features of two links */
        uint16_t slot = slots[i];
        float at = grrl_vec2_dot(direction, t->shape[slot]);
        uint16_t j = i;
        while (j > 0 && grrl_vec2_dot(direction, t->shape[slots[j - 1]]) > at) {
            slots[j] = slots[j - 1];
            j--;
        }
        slots[j] = slot;
    }
}

/* What the present parts save in one keyframe, the features of `body` and the others; *all: the sum
 * over both. */
static float saved_as_is(const struct whole *t, const struct term *terms, const uint8_t *body_of,
                         uint8_t body, struct part_sum *all)
{
    struct part_sum part = {0};
    *all = (struct part_sum){0};
    for (uint16_t i = 0; i < t->n; i++) {
        uint16_t slot = t->slot[i];
        add(all, &terms[slot], t->shape[slot]);
        if (body_of[slot] == body)
            add(&part, &terms[slot], t->shape[slot]);
    }
    return saved_by_both(&part, all);
}

static struct grrl_vec2 rotate_30(struct grrl_vec2 v)
{
    return (struct grrl_vec2){v.x * 0.8660254f - v.y * 0.5f, v.x * 0.5f + v.y * 0.8660254f};
}

/* The features in their order along a line; total[i]: what is saved if the first i + 1 are one
 * part. */
struct sweep {
    uint16_t order[GRRL_MAX_FEATURES];
    float total[GRRL_MAX_FEATURES + LANES];
};

/* Partial sums, by component. */
struct lanes {
    float w[LANES];
    float qx[LANES];
    float qy[LANES];
    float dx[LANES];
    float dy[LANES];
    float qq[LANES];
    float moment[LANES];
};

static void put_lane(struct lanes *lanes, uint16_t j, const struct part_sum *s)
{
    lanes->w[j] = s->w;
    lanes->qx[j] = s->q.x;
    lanes->qy[j] = s->q.y;
    lanes->dx[j] = s->d.x;
    lanes->dy[j] = s->d.y;
    lanes->qq[j] = s->qq;
    lanes->moment[j] = s->moment;
}

static inline struct part_sum lane(const struct lanes *lanes, uint16_t j)
{
    return (struct part_sum){lanes->w[j],
                             {lanes->qx[j], lanes->qy[j]},
                             {lanes->dx[j], lanes->dy[j]},
                             lanes->qq[j],
                             lanes->moment[j]};
}

/* Adds what one keyframe saves. Totals of parts that are too small mean nothing. */
static void sweep_keyframe(const struct whole *t, const struct term *terms,
                           const struct part_sum *all, uint16_t end, struct sweep *sweep)
{
    struct part_sum left = {0};
    const struct part_sum whole = *all;
    for (uint16_t first = 0; first < end; first = (uint16_t)(first + LANES)) {
        struct lanes lanes;
        for (uint16_t j = 0; j < LANES; j++) {
            if (first + j < end) {
                uint16_t slot = sweep->order[first + j];
                add(&left, &terms[slot], t->shape[slot]);
            }
            put_lane(&lanes, j, &left);
        }
        for (uint16_t j = 0; j < LANES; j++) {
            struct part_sum part = lane(&lanes, j);
            sweep->total[first + j] += saved_by_both(&part, &whole);
        }
    }
}

/* The orders of the features along ABREAST lines, each 30 degrees from the one before. */
static void begin_sweeps(const struct whole *t, struct grrl_vec2 *direction, struct sweep *sweeps)
{
    for (int s = 0; s < ABREAST; s++) {
        const uint16_t *before = s > 0 ? sweeps[s - 1].order : sweeps[ABREAST - 1].order;
        memmove(sweeps[s].order, before, t->n * sizeof before[0]);
        memset(sweeps[s].total, 0, sizeof sweeps[s].total);
        sort_along(t, *direction, sweeps[s].order, t->n);
        *direction = rotate_30(*direction);
    }
}

/* Keyframe by keyframe, whose residuals serve all lines. Returns what the present parts save. */
static float sweep_all(const struct grrl_perception *p, const struct whole *t, uint8_t body,
                       struct sweep *sweeps)
{
    struct term terms[GRRL_MAX_FEATURES];
    uint16_t least = p->config.min_features;
    uint16_t end = t->n > least ? (uint16_t)(t->n - least) : 0;
    float now = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        struct part_sum all;
        find_terms(p, t, k, terms);
        now += saved_as_is(t, terms, p->body_of, body, &all);
        for (int s = 0; s < ABREAST; s++)
            sweep_keyframe(t, terms, &all, end, &sweeps[s]);
    }
    return now;
}

/* part: NULL if only the gain matters. */
static float best_cut(const struct grrl_perception *p, const struct whole *t, uint8_t body,
                      uint16_t *part, uint16_t *n_part)
{
    struct sweep sweeps[ABREAST];
    uint16_t least = p->config.min_features;
    struct grrl_vec2 direction = {1.0f, 0.0f};
    float now = 0.0f;
    float best = 0.0f;
    *n_part = 0;
    memcpy(sweeps[ABREAST - 1].order, t->slot, t->n * sizeof t->slot[0]);
    for (int turn = 0; turn < DIRECTIONS; turn += ABREAST) {
        begin_sweeps(t, &direction, sweeps);
        now = sweep_all(p, t, body, sweeps);
        best = turn == 0 ? now : best;
        for (int s = 0; s < ABREAST; s++) {
            for (uint16_t i = 0; i + least < t->n; i++) {
                if (i + 1 >= least && sweeps[s].total[i] > best) {
                    best = sweeps[s].total[i];
                    *n_part = (uint16_t)(i + 1);
                    if (part != NULL)
                        memcpy(part, sweeps[s].order, *n_part * sizeof *part);
                }
            }
        }
    }
    return best - now;
}

static struct whole whole_of(const struct grrl_rigid_group *t)
{
    return (struct whole){t->slot, t->n, t->shape, t->pose, 1};
}

float grrl_cut_best(const struct grrl_perception *p, const struct grrl_rigid_group *together,
                    uint8_t body, uint16_t *part, uint16_t *n_part)
{
    struct whole whole = whole_of(together);
    return best_cut(p, &whole, body, part, n_part);
}

/*
 * Links that cross are separated not by one line but by two: the quadrants of a cross belong to one
 * link and the other in turn. Starting from crosses in several directions, each feature moves to
 * the side whose turn and shift leaves the smaller residual.
 */
static void cross(const struct whole *t, struct grrl_vec2 direction, bool *is_left)
{
    struct grrl_vec2 middle = {0.0f, 0.0f};
    for (uint16_t i = 0; i < t->n; i++)
        middle = grrl_vec2_add(middle, grrl_vec2_scale(t->shape[t->slot[i]], 1.0f / (float)t->n));
    for (uint16_t i = 0; i < t->n; i++) {
        struct grrl_vec2 q = grrl_vec2_sub(t->shape[t->slot[i]], middle);
        is_left[i] = grrl_vec2_dot(direction, q) * grrl_vec2_cross(direction, q) > 0.0f;
    }
}

/* Chi squared of one feature that remains after a part's turn and shift. */
static float left_over(const struct part_sum *part, const struct term *one, struct grrl_vec2 place)
{
    struct grrl_vec2 mean = grrl_vec2_scale(part->q, 1.0f / part->w);
    struct grrl_vec2 shift = grrl_vec2_scale(part->d, 1.0f / part->w);
    float inertia = part->qq - grrl_vec2_dot(part->q, mean);
    float turn = inertia > LEAST_INERTIA_SHARE * part->qq
                     ? (part->moment - grrl_vec2_cross(part->q, shift)) / inertia
                     : 0.0f;
    struct grrl_vec2 q =
        grrl_vec2_sub(grrl_vec2_scale(grrl_vec2_scale(place, one->w), 1.0f / one->w), mean);
    struct grrl_vec2 d = grrl_vec2_sub(grrl_vec2_scale(one->d, 1.0f / one->w), shift);
    struct grrl_vec2 rest = {d.x + turn * q.y, d.y - turn * q.x};
    return one->w * grrl_vec2_dot(rest, rest);
}

/* Moves each feature to the side that leaves the smaller residual; returns what both sides saved
 * before. */
static float share_out(const struct grrl_perception *p, const struct whole *t, bool *is_left)
{
    struct term terms[GRRL_MAX_FEATURES];
    float excess[GRRL_MAX_FEATURES] = {0.0f}; /* what remains on the left minus on the right */
    float total = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        struct part_sum left = {0};
        struct part_sum all = {0};
        find_terms(p, t, k, terms);
        for (uint16_t i = 0; i < t->n; i++) {
            struct grrl_vec2 q = t->shape[t->slot[i]];
            add(&all, &terms[t->slot[i]], q);
            if (is_left[i])
                add(&left, &terms[t->slot[i]], q);
        }
        total += saved_by_both(&left, &all);
        struct part_sum right = rest_of(&all, &left);
        float rounding = LEAST_SHARE * all.w;
        for (uint16_t i = 0; i < t->n && left.w > rounding && right.w > rounding; i++) {
            const struct term *one = &terms[t->slot[i]];
            struct grrl_vec2 q = t->shape[t->slot[i]];
            excess[i] +=
                one->w > 0.0f ? left_over(&left, one, q) - left_over(&right, one, q) : 0.0f;
        }
    }
    for (uint16_t i = 0; i < t->n; i++)
        is_left[i] = excess[i] < 0.0f;
    return total;
}

static uint16_t take_left(const struct whole *t, const bool *is_left, uint16_t *part)
{
    uint16_t n = 0;
    for (uint16_t i = 0; i < t->n; i++)
        if (is_left[i])
            part[n++] = t->slot[i];
    return n;
}

/* Whether the features of `body` and the others overlap rather than lie side by side. */
static bool lie_across(const struct grrl_perception *p, const struct whole *t, uint8_t body)
{
    struct part_sum side[2] = {{0}};
    for (uint16_t i = 0; i < t->n; i++) {
        struct grrl_vec2 q = t->shape[t->slot[i]];
        struct term one = {.w = 1.0f, .qq = grrl_vec2_dot(q, q)};
        add(&side[p->body_of[t->slot[i]] == body ? 0 : 1], &one, q);
    }
    float radius2 = 0.0f; /* the sum of mean squared radii */
    struct grrl_vec2 apart = {0.0f, 0.0f};
    for (int i = 0; i < 2; i++) {
        if (!(side[i].w > 0.0f))
            return false;
        struct grrl_vec2 mean = grrl_vec2_scale(side[i].q, 1.0f / side[i].w);
        radius2 += side[i].qq / side[i].w - grrl_vec2_dot(mean, mean);
        apart = grrl_vec2_sub(mean, apart);
    }
    return grrl_vec2_dot(apart, apart) < radius2;
}

float grrl_cut_best_cross(const struct grrl_perception *p, const struct grrl_rigid_group *together,
                          uint8_t body, uint16_t *part, uint16_t *n_part)
{
    uint16_t least = p->config.min_features;
    bool is_left[GRRL_MAX_FEATURES];
    uint16_t trial[GRRL_MAX_FEATURES];
    const struct whole t = whole_of(together);
    *n_part = 0;
    if (!lie_across(p, &t, body))
        return 0.0f;
    for (uint16_t i = 0; i < t.n; i++)
        is_left[i] = p->body_of[t.slot[i]] == body;
    const float now = share_out(p, &t, is_left);
    float best = now;
    struct grrl_vec2 direction = {1.0f, 0.0f};
    for (int turn = 0; turn < DIRECTIONS / 2; turn++) {
        cross(&t, direction, is_left);
        for (int round = 0; round < ROUNDS; round++) {
            uint16_t n = take_left(&t, is_left, trial);
            float total = share_out(p, &t, is_left);
            if (n >= least && n + least <= t.n && total > best) {
                best = total;
                *n_part = n;
                memcpy(part, trial, n * sizeof *part);
            }
        }
        direction = rotate_30(direction);
    }
    return best - now;
}

float grrl_cut_hidden_joint(const struct grrl_perception *p, uint8_t body)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n_part;
    uint16_t n = grrl_rigid_slots(p, body, slots);
    const struct whole whole = {slots, n, p->shape, &p->pose[0][body], GRRL_MAX_LINKS};
    float chance = 3.0f * (float)p->n_keyframes; /* what a turn and a shift save by chance */
    float gain = best_cut(p, &whole, body, NULL, &n_part) / p->config.slack;
    return gain > chance ? (gain - chance) / grrl_sqrt(2.0f * chance) : 0.0f;
}
