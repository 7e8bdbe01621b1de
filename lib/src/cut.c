/*
 * cut.c: where two bodies that moved little against one another part.
 *
 * Moving single features to where they fit better (bodies.c) ends in some optimum near its start.
 * Where a joint moved a few degrees, that can be a body and a half with the other half of a link
 * beside it. Links part along a line, or nearly so, and all lines can be tried at once: with both
 * bodies fitted as one, the residuals of a part that turned and shifted a little are linear in its
 * turn and shift, and the sums that a least-squares fit needs grow feature by feature as the line
 * sweeps over them.
 */
#include "perception_internal.h"

#define DIRECTIONS 6 /* of the line, over half a turn */

/* What one part of the features tells in one keyframe, weighted by 1 / variance: q is a feature's
 * place, d its residual. */
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

/* Chi squared that a shift and a turn of its own save a part. */
static float saved(const struct part_sum *s, float least_w)
{
    if (!(s->w > least_w)) {
        return 0.0f;
    }
    float inertia = s->qq - grrl_vec2_dot(s->q, s->q) / s->w;
    float moment = s->moment - grrl_vec2_cross(s->q, s->d) / s->w;
    float turn = inertia > 1e-6f * s->qq ? moment * moment / inertia : 0.0f;
    return grrl_vec2_dot(s->d, s->d) / s->w + turn;
}

static float saved_by_both(const struct part_sum *part, const struct part_sum *all)
{
    struct part_sum rest = *all;
    add(&rest, part, -1.0f);
    float rounding = 1e-3f * all->w;
    return saved(part, rounding) + saved(&rest, rounding);
}

/* One feature in one keyframe; one that is off more than motion explains counts for nothing. */
static struct part_sum sum_of(const struct grrl_perception *p, const struct grrl_together *t,
                              uint16_t slot, uint8_t k)
{
    struct part_sum one = {0};
    uint8_t weight = p->keyframe[k].weight[slot];
    if (weight == 0 || !(t->pose[k].mass > 0.0f)) {
        return one;
    }
    struct grrl_vec2 q = t->shape[slot];
    struct grrl_vec2 d =
        grrl_vec2_sub(grrl_untransform(t->pose[k].pose, p->keyframe[k].point[slot]), q);
    float reach = p->config.jump_m;
    if (grrl_vec2_dot(d, d) > reach * reach) {
        return one;
    }
    one.w = 1.0f / grrl_keyframe_variance(p, weight);
    one.q = grrl_vec2_scale(q, one.w);
    one.d = grrl_vec2_scale(d, one.w);
    one.qq = one.w * grrl_vec2_dot(q, q);
    one.moment = one.w * grrl_vec2_cross(q, d);
    return one;
}

static void sort_along(const struct grrl_together *t, struct grrl_vec2 direction, uint16_t *slots,
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

/* What the parts save as they are: the features of `body` and the others. */
static float saved_as_is(const struct grrl_perception *p, const struct grrl_together *t,
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

float grrl_best_cut(const struct grrl_perception *p, const struct grrl_together *t, uint8_t body,
                    uint16_t *part, uint16_t *n_part)
{
    struct part_sum all[GRRL_MAX_KEYFRAMES];
    struct part_sum left[GRRL_MAX_KEYFRAMES];
    uint16_t order[GRRL_MAX_FEATURES];
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        all[k] = (struct part_sum){0};
        for (uint16_t i = 0; i < t->n; i++) {
            struct part_sum one = sum_of(p, t, t->slot[i], k);
            add(&all[k], &one, 1.0f);
        }
    }
    for (uint16_t i = 0; i < t->n; i++) {
        order[i] = t->slot[i];
    }
    float now = saved_as_is(p, t, p->body_of, body, all);
    float best = now;
    uint16_t least = p->config.min_features;
    struct grrl_vec2 direction = {1.0f, 0.0f};
    *n_part = 0;
    for (int turn = 0; turn < DIRECTIONS; turn++) {
        sort_along(t, direction, order, t->n);
        for (uint8_t k = 0; k < p->n_keyframes; k++) {
            left[k] = (struct part_sum){0};
        }
        for (uint16_t i = 0; i + least < t->n; i++) {
            float total = 0.0f;
            for (uint8_t k = 0; k < p->n_keyframes; k++) {
                struct part_sum one = sum_of(p, t, order[i], k);
                add(&left[k], &one, 1.0f);
                total += i + 1 >= least ? saved_by_both(&left[k], &all[k]) : 0.0f;
            }
            if (i + 1 >= least && total > best) {
                best = total;
                *n_part = (uint16_t)(i + 1);
                for (uint16_t j = 0; j <= i; j++) {
                    part[j] = order[j];
                }
            }
        }
        direction = (struct grrl_vec2){direction.x * 0.8660254f - direction.y * 0.5f,
                                       direction.x * 0.5f + direction.y * 0.8660254f};
    }
    return best - now;
}

float grrl_hidden_joint(const struct grrl_perception *p, uint8_t body)
{
    struct grrl_together together;
    uint16_t part[GRRL_MAX_FEATURES];
    uint16_t n_part;
    together.n = grrl_body_slots(p, body, together.slot);
    for (uint16_t i = 0; i < together.n; i++) {
        together.shape[together.slot[i]] = p->shape[together.slot[i]];
    }
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        together.pose[k] = p->pose[k][body];
    }
    float chance = 3.0f * (float)p->n_keyframes; /* what a turn and a shift save by chance */
    float gain = grrl_best_cut(p, &together, body, part, &n_part) / p->config.slack;
    return gain > chance ? (gain - chance) / grrl_sqrt(2.0f * chance) : 0.0f;
}
