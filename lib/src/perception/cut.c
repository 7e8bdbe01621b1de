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

static void add(struct part_sum *to, const struct part_sum *one, float sign)
{
    to->w += sign * one->w;
    to->q = grrl_vec2_add(to->q, grrl_vec2_scale(one->q, sign));
    to->d = grrl_vec2_add(to->d, grrl_vec2_scale(one->d, sign));
    to->qq += sign * one->qq;
    to->moment += sign * one->moment;
}

/* Chi squared that a part saves with its own shift and turn. */
static float saved(const struct part_sum *s, float least_w)
{
    if (!(s->w > least_w))
        return 0.0f;
    float inertia = s->qq - grrl_vec2_dot(s->q, s->q) / s->w;
    float moment = s->moment - grrl_vec2_cross(s->q, s->d) / s->w;
    float turn = inertia > LEAST_INERTIA_SHARE * s->qq ? moment * moment / inertia : 0.0f;
    return grrl_vec2_dot(s->d, s->d) / s->w + turn;
}

static float saved_by_both(const struct part_sum *part, const struct part_sum *all)
{
    struct part_sum rest = *all;
    add(&rest, part, -1.0f);
    float rounding = LEAST_SHARE * all->w;
    return saved(part, rounding) + saved(&rest, rounding);
}

/* The terms of one feature in one keyframe; zero if it is farther off than motion can explain. */
static struct part_sum sum_of(const struct grrl_perception *p, const struct grrl_rigid_group *t,
                              uint16_t slot, uint8_t k)
{
    struct part_sum one = {0};
    uint8_t weight = p->keyframe[k].weight[slot];
    if (weight == 0 || !(t->pose[k].weight > 0.0f))
        return one;
    struct grrl_vec2 q = t->shape[slot];
    struct grrl_vec2 d = grrl_vec2_sub(grrl_to_local(&t->pose[k], p->keyframe[k].point[slot]), q);
    float reach = p->config.jump_m;
    if (grrl_vec2_dot(d, d) > reach * reach)
        return one;
    one.w = 1.0f / grrl_perception_variance(p, weight);
    one.q = grrl_vec2_scale(q, one.w);
    one.d = grrl_vec2_scale(d, one.w);
    one.qq = one.w * grrl_vec2_dot(q, q);
    one.moment = one.w * grrl_vec2_cross(q, d);
    return one;
}

static void sort_along(const struct grrl_rigid_group *t, struct grrl_vec2 direction,
                       uint16_t *slots, uint16_t n)
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

/* What the present parts save: the features of `body` and the others. */
static float saved_as_is(const struct grrl_perception *p, const struct grrl_rigid_group *t,
                         const uint8_t *body_of, uint8_t body, const struct part_sum *all)
{
    float total = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        struct part_sum part = {0};
        for (uint16_t i = 0; i < t->n; i++) {
            if (body_of[t->slot[i]] == body) {
                struct part_sum one = sum_of(p, t, t->slot[i], k);
                add(&part, &one, 1.0f);
            }
        }
        total += saved_by_both(&part, &all[k]);
    }
    return total;
}

static void sum_all(const struct grrl_perception *p, const struct grrl_rigid_group *t,
                    struct part_sum *all)
{
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        all[k] = (struct part_sum){0};
        for (uint16_t i = 0; i < t->n; i++) {
            struct part_sum one = sum_of(p, t, t->slot[i], k);
            add(&all[k], &one, 1.0f);
        }
    }
}

static struct grrl_vec2 rotate_30(struct grrl_vec2 v)
{
    return (struct grrl_vec2){v.x * 0.8660254f - v.y * 0.5f, v.x * 0.5f + v.y * 0.8660254f};
}

/* total[i]: what is saved if the first i + 1 features of an order are one part. Keyframe by
 * keyframe, whose sums then grow in registers. */
static void sweep(const struct grrl_perception *p, const struct grrl_rigid_group *t,
                  const struct part_sum *all, const uint16_t *order, float *total)
{
    uint16_t least = p->config.min_features;
    for (uint16_t i = 0; i < t->n; i++)
        total[i] = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        struct part_sum left = {0};
        for (uint16_t i = 0; i + least < t->n; i++) {
            struct part_sum one = sum_of(p, t, order[i], k);
            add(&left, &one, 1.0f);
            total[i] += i + 1 >= least ? saved_by_both(&left, &all[k]) : 0.0f;
        }
    }
}

float grrl_cut_best(const struct grrl_perception *p, const struct grrl_rigid_group *t, uint8_t body,
                    uint16_t *part, uint16_t *n_part)
{
    struct part_sum all[GRRL_MAX_KEYFRAMES];
    float total[GRRL_MAX_FEATURES];
    uint16_t order[GRRL_MAX_FEATURES];
    sum_all(p, t, all);
    for (uint16_t i = 0; i < t->n; i++)
        order[i] = t->slot[i];
    float now = saved_as_is(p, t, p->body_of, body, all);
    float best = now;
    uint16_t least = p->config.min_features;
    struct grrl_vec2 direction = {1.0f, 0.0f};
    *n_part = 0;
    for (int turn = 0; turn < DIRECTIONS; turn++) {
        sort_along(t, direction, order, t->n);
        sweep(p, t, all, order, total);
        for (uint16_t i = 0; i + least < t->n; i++) {
            if (i + 1 >= least && total[i] > best) {
                best = total[i];
                *n_part = (uint16_t)(i + 1);
                memcpy(part, order, *n_part * sizeof *part);
            }
        }
        direction = rotate_30(direction);
    }
    return best - now;
}

/*
 * Links that cross are separated not by one line but by two: the quadrants of a cross belong to one
 * link and the other in turn. Starting from crosses in several directions, each feature moves to
 * the side whose turn and shift leaves the smaller residual.
 */
static void cross(const struct grrl_rigid_group *t, struct grrl_vec2 direction, bool *is_left)
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
static float left_over(const struct part_sum *part, const struct part_sum *one)
{
    struct grrl_vec2 mean = grrl_vec2_scale(part->q, 1.0f / part->w);
    struct grrl_vec2 shift = grrl_vec2_scale(part->d, 1.0f / part->w);
    float inertia = part->qq - grrl_vec2_dot(part->q, mean);
    float turn = inertia > LEAST_INERTIA_SHARE * part->qq
                     ? (part->moment - grrl_vec2_cross(part->q, shift)) / inertia
                     : 0.0f;
    struct grrl_vec2 q = grrl_vec2_sub(grrl_vec2_scale(one->q, 1.0f / one->w), mean);
    struct grrl_vec2 d = grrl_vec2_sub(grrl_vec2_scale(one->d, 1.0f / one->w), shift);
    struct grrl_vec2 rest = {d.x + turn * q.y, d.y - turn * q.x};
    return one->w * grrl_vec2_dot(rest, rest);
}

/* Moves each feature to the side that leaves the smaller residual; returns what both sides saved
 * before. */
static float share_out(const struct grrl_perception *p, const struct grrl_rigid_group *t,
                       const struct part_sum *all, bool *is_left)
{
    float excess[GRRL_MAX_FEATURES] = {
        0.0f}; /* what remains on the left minus what remains on the right */
    float total = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        struct part_sum left = {0};
        for (uint16_t i = 0; i < t->n; i++) {
            if (is_left[i]) {
                struct part_sum one = sum_of(p, t, t->slot[i], k);
                add(&left, &one, 1.0f);
            }
        }
        struct part_sum right = all[k];
        add(&right, &left, -1.0f);
        total += saved_by_both(&left, &all[k]);
        float rounding = LEAST_SHARE * all[k].w;
        for (uint16_t i = 0; i < t->n && left.w > rounding && right.w > rounding; i++) {
            struct part_sum one = sum_of(p, t, t->slot[i], k);
            excess[i] += one.w > 0.0f ? left_over(&left, &one) - left_over(&right, &one) : 0.0f;
        }
    }
    for (uint16_t i = 0; i < t->n; i++)
        is_left[i] = excess[i] < 0.0f;
    return total;
}

static uint16_t take_left(const struct grrl_rigid_group *t, const bool *is_left, uint16_t *part)
{
    uint16_t n = 0;
    for (uint16_t i = 0; i < t->n; i++)
        if (is_left[i])
            part[n++] = t->slot[i];
    return n;
}

/* Whether the features of `body` and the others overlap rather than lie side by side. */
static bool lie_across(const struct grrl_perception *p, const struct grrl_rigid_group *t,
                       uint8_t body)
{
    struct part_sum side[2] = {{0}};
    for (uint16_t i = 0; i < t->n; i++) {
        struct grrl_vec2 q = t->shape[t->slot[i]];
        struct part_sum one = {.w = 1.0f, .q = q, .qq = grrl_vec2_dot(q, q)};
        add(&side[p->body_of[t->slot[i]] == body ? 0 : 1], &one, 1.0f);
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

float grrl_cut_best_cross(const struct grrl_perception *p, const struct grrl_rigid_group *t,
                          uint8_t body, uint16_t *part, uint16_t *n_part)
{
    struct part_sum all[GRRL_MAX_KEYFRAMES];
    uint16_t least = p->config.min_features;
    bool is_left[GRRL_MAX_FEATURES];
    uint16_t trial[GRRL_MAX_FEATURES];
    *n_part = 0;
    if (!lie_across(p, t, body))
        return 0.0f;
    sum_all(p, t, all);
    float now = saved_as_is(p, t, p->body_of, body, all);
    float best = now;
    struct grrl_vec2 direction = {1.0f, 0.0f};
    for (int turn = 0; turn < DIRECTIONS / 2; turn++) {
        cross(t, direction, is_left);
        for (int round = 0; round < ROUNDS; round++) {
            uint16_t n = take_left(t, is_left, trial);
            float total = share_out(p, t, all, is_left);
            if (n >= least && n + least <= t->n && total > best) {
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
    struct grrl_rigid_group together;
    uint16_t part[GRRL_MAX_FEATURES];
    uint16_t n_part;
    together.n = grrl_rigid_slots(p, body, together.slot);
    for (uint16_t i = 0; i < together.n; i++)
        together.shape[together.slot[i]] = p->shape[together.slot[i]];
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        together.pose[k] = p->pose[k][body];
    float chance = 3.0f * (float)p->n_keyframes; /* what a turn and a shift save by chance */
    float gain = grrl_cut_best(p, &together, body, part, &n_part) / p->config.slack;
    return gain > chance ? (gain - chance) / grrl_sqrt(2.0f * chance) : 0.0f;
}
