/*
 * bodies.c: features into rigid bodies, their number unknown.
 *
 * The bodies of the last update are the start (at first those of initial_segmentation.c): a body
 * whose residuals are too large is split by consensus.c, features are reassigned, and bodies that
 * never moved apart are merged. All tests are on squared residuals in units of their variance, so
 * that one noise parameter is enough; a difference counts when it is significant in single
 * keyframes, however many other keyframes agree.
 */
#include "perception/perception_internal.h"

#include <string.h>

/* Misfit above which a body is split, in standard deviations of chi squared. Noise alone lets a
 * body of ten features exceed it in one of 2,700 keyframes, in one of 57 trials of 48 keyframes. A
 * split without a cause costs time only: merge_bodies undoes it. */
#define SPLIT_SIGMAS 4.5f

/* Chi squared a feature may lose by moving to another body and still be no worse off: four standard
 * deviations of the two residuals (2) of one keyframe. */
#define ELSEWHERE_COST 8.0f

/* Of the range of a relative motion: over ten rests noise ranges over 3.1 standard deviations in
 * the mean, and over more than 5 in 15 of 1,000 cases. */
#define FAR_SIGMAS 5.0f

/* A motion apart is little below this many times what tells a joint (12 degrees, 10 mm). Features
 * 50 mm from a joint that turned more are 10 mm or 15 standard deviations off: each tells its link
 * by itself, and the bodies need neither be cut anew nor fitted as one. */
#define LITTLE 6.0f

/* Chi squared by which another cut must be better: what three parameters (MERGE_FREE) save by
 * chance in 7 of 1,000 cases. Where links had been parted wrongly the right cut gained 35 to 200.
 */
#define CUT_GAIN 12.0f

/* Chi squared a keyframe's separate pose must save. Its 3 parameters save 3 by chance, with a
 * standard deviation of 2.4; 12 is exceeded in 7 of 1000. */
#define MERGE_FREE 12.0f

/* And how much more in all keyframes together. By chance 48 of them save 0.8; the rest is a margin
 * for residuals that are not Gaussian. */
#define MERGE_EVIDENCE 40.0f

/* Of one squared residual in that sum, higher than GRRL_COST_CAP: a point 10 standard deviations
 * off tells that bodies moved apart, one at 30 tells no more. */
#define APART_CAP 100.0f

/* A feature belongs to a body up to this many standard deviations above the cost expected, and 4
 * more because the chi squared of few keyframes has a longer tail: noise exceeds the limit in one
 * case of 1,100 with one keyframe, of 3,600 with ten. */
#define LIMIT_SIGMAS 4.0f
#define LIMIT_BASE 4.0f

/* Chi squared by which another body must be better than a feature's own, as much as one keyframe is
 * expected to cost: a feature beside a joint fits both of its links and shall not change sides by
 * chance. */
#define OWN_COST 2.0f

/* Rounds of reassignment, at most: features could go to and fro. Of 4,400 calls on 200 random
 * chains 19 ended at the limit, 98% needed three rounds or fewer. */
#define REASSIGN_ROUNDS 6

#define NEVER 1e9f          /* evidence above all other */
#define LEAST_INERTIA 1e-9f /* m^2, added so that nothing is divided by zero */

void grrl_bodies_add(struct grrl_perception *p)
{
    p->number[p->n_bodies++] = ++p->n_numbers;
}

static void fit_body(struct grrl_perception *p, uint8_t body)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n = grrl_rigid_slots(p, body, slots);
    grrl_rigid_fit(p, slots, n, p->shape, &p->pose[0][body], GRRL_MAX_LINKS);
}

static void fit_all(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies; b++)
        fit_body(p, b);
}

/* Mean cost a keyframe above which a feature does not belong; few keyframes scatter more. */
static float cost_limit(const struct grrl_perception *p, uint16_t n)
{
    float limit = 2.0f * (float)n + LIMIT_SIGMAS * grrl_sqrt(4.0f * (float)n) + LIMIT_BASE;
    return limit * grrl_sqrt(p->config.slack);
}

/* Whether a feature left its place at any time. */
static bool moves(const struct grrl_perception *p, uint16_t slot)
{
    struct grrl_vec2 mean = {0.0f, 0.0f};
    float weight = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        float w = (float)p->keyframe[k].weight[slot];
        mean = grrl_vec2_add(mean, grrl_vec2_scale(p->keyframe[k].point[slot], w));
        weight += w;
    }
    uint16_t n = 0;
    float cost = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        uint8_t w = p->keyframe[k].weight[slot];
        if (w > 0) {
            float d2 = grrl_vec2_distance2(p->keyframe[k].point[slot],
                                           grrl_vec2_scale(mean, 1.0f / weight)) /
                       grrl_perception_variance(p, w);
            cost += d2 < GRRL_COST_CAP ? d2 : GRRL_COST_CAP;
            n++;
        }
    }
    return n > 0 && cost >= cost_limit(p, n);
}

/* Whether a body has moved on the table at all. */
static bool body_has_moved(const struct grrl_perception *p, uint8_t body)
{
    int balance = 0;
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == body)
            balance += p->has_moved[i] ? 1 : -1;
    return balance > 0;
}

static uint8_t blob_of_body(const struct grrl_perception *p, uint8_t body)
{
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == body && p->blob_of[i] != 0)
            return p->blob_of[i];
    return 0;
}

/* Blobs that lie apart stay apart until motion speaks: what never moved looks rigid with everything
 * that never moved. */
static bool may_share(const struct grrl_perception *p, uint8_t blob, bool moved, uint8_t body)
{
    uint8_t other = blob_of_body(p, body);
    return blob == 0 || other == 0 || blob == other || (moved && body_has_moved(p, body));
}

static float at_most(float x, float cap)
{
    return x < cap ? x : cap;
}

/* Chi squared that the poses of bodies a and b save in keyframe k over one pose of both. */
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
        struct grrl_pose own = p->pose[k][p->body_of[slot] == a ? a : b].pose;
        float scale = 1.0f / grrl_perception_variance(p, w);
        struct grrl_vec2 in_both = grrl_transform(together->pose[k].pose, together->shape[slot]);
        float as_one = scale * grrl_vec2_distance2(point, in_both);
        float alone = scale * grrl_vec2_distance2(point, grrl_transform(own, p->shape[slot]));
        saved += at_most(as_one, APART_CAP) - at_most(alone, APART_CAP);
    }
    return saved;
}

/* Evidence that bodies a and b moved apart: what separate poses save beyond their parameters. */
static float apart_evidence(const struct grrl_perception *p,
                            const struct grrl_rigid_group *together, uint8_t a, uint8_t b)
{
    float evidence = 0.0f;
    float allowance = MERGE_FREE * p->config.slack;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        if (!(p->pose[k][a].weight > 0.0f) || !(p->pose[k][b].weight > 0.0f) ||
            !(together->pose[k].weight > 0.0f))
            continue;
        float saved = saved_apart(p, together, a, b, k);
        evidence += saved > allowance ? saved - allowance : 0.0f;
    }
    return evidence;
}

/* Takes a body out of the list; its features must be elsewhere. */
static void remove_body(struct grrl_perception *p, uint8_t body)
{
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] > body && p->body_of[i] < p->n_bodies)
            p->body_of[i]--;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        memmove(&p->pose[k][body], &p->pose[k][body + 1],
                (size_t)(p->n_bodies - body - 1) * sizeof p->pose[0][0]);
    }
    memmove(&p->number[body], &p->number[body + 1],
            (size_t)(p->n_bodies - body - 1) * sizeof p->number[0]);
    p->n_bodies--;
}

/* The features of two bodies fitted as one. */
static void fit_both(const struct grrl_perception *p, uint8_t a, uint8_t b,
                     struct grrl_rigid_group *together)
{
    together->n = 0;
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == a || p->body_of[i] == b)
            together->slot[together->n++] = i;
    grrl_rigid_fit(p, together->slot, together->n, together->shape, together->pose, 1);
}

/* Whether two bodies may be one: they moved apart in no keyframe. */
static float merge_evidence(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    if (!may_share(p, blob_of_body(p, a), body_has_moved(p, a), b))
        return NEVER;
    struct grrl_rigid_group together;
    fit_both(p, a, b, &together);
    return apart_evidence(p, &together, a, b);
}

/* How far two bodies moved apart from rest to rest, and the variances of that. */
struct range {
    float turn;
    float shift2;
    float turn_var; /* the largest: noise alone must not look far enough */
    float shift_var;
};

/* Widens an interval so that x is in it. */
static void include(float interval[2], float x)
{
    interval[0] = x < interval[0] ? x : interval[0];
    interval[1] = x > interval[1] ? x : interval[1];
}

/* Pose of b in the frame of a. */
static struct grrl_pose relative_pose(struct grrl_pose a, struct grrl_pose b)
{
    return (struct grrl_pose){grrl_unrotate(a, grrl_vec2_sub(b.p, a.p)), a.c * b.c + a.s * b.s,
                              a.c * b.s - a.s * b.c};
}

/* The larger variances of a relative pose so far and in one keyframe. */
static void include_noise(const struct grrl_perception *p, const struct grrl_perception_pose *a,
                          const struct grrl_perception_pose *b, struct grrl_vec2 between,
                          struct range *range)
{
    float noise2 = p->config.noise_m * p->config.noise_m;
    float turn =
        noise2 * (1.0f / (a->inertia + LEAST_INERTIA) + 1.0f / (b->inertia + LEAST_INERTIA));
    float shift = noise2 * (1.0f / a->weight + 1.0f / b->weight) +
                  0.25f * turn * grrl_vec2_dot(between, between);
    range->turn_var = turn > range->turn_var ? turn : range->turn_var;
    range->shift_var = shift > range->shift_var ? shift : range->shift_var;
}

static struct range range_between(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    float turn[2] = {0.0f, 0.0f};
    float x[2] = {0.0f, 0.0f};
    float y[2] = {0.0f, 0.0f};
    struct grrl_pose reference = {{0.0f, 0.0f}, 1.0f, 0.0f}; /* of b in a, at the first rest */
    struct grrl_vec2 middle = {0.0f, 0.0f};
    struct range range = {0};
    bool begun = false;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        const struct grrl_perception_pose *pa = &p->pose[k][a];
        const struct grrl_perception_pose *pb = &p->pose[k][b];
        if (!p->keyframe[k].at_rest || !(pa->weight > 0.0f) || !(pb->weight > 0.0f))
            continue;
        struct grrl_pose r = relative_pose(pa->pose, pb->pose);
        if (!begun) {
            begun = true;
            reference = r;
            middle = grrl_vec2_scale(r.p, 0.5f);
        }
        include_noise(p, pa, pb, r.p, &range);
        /* where b takes the point half way between them */
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
 * Whether two bodies moved apart far enough, from rest to rest, that a joint could be told. Less is
 * not worth a body: features beside the joint could not be shared out, and what the pair is tied to
 * would be tied to either.
 */
static bool is_far(const struct grrl_perception *p, const struct range *range)
{
    float least_turn = p->config.min_turn_rad;
    float least_shift = p->config.min_slide_m;
    float sigmas2 = FAR_SIGMAS * FAR_SIGMAS;
    return (range->turn > least_turn && range->turn * range->turn > sigmas2 * range->turn_var) ||
           (range->shift2 > least_shift * least_shift &&
            range->shift2 > sigmas2 * range->shift_var);
}

/* In units of what tells a joint. */
static bool is_less(const struct grrl_perception *p, const struct range *range, float units)
{
    float little_turn = units * p->config.min_turn_rad;
    float little_shift = units * p->config.min_slide_m;
    return range->turn < little_turn && range->shift2 < little_shift * little_shift;
}

static bool may_merge(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    struct range range = range_between(p, a, b);
    bool far = is_far(p, &range);
    if (far && !is_less(p, &range, LITTLE * p->config.slack))
        return false; /* beyond doubt; a fit of both together costs much more than this */
    float evidence = merge_evidence(p, a, b);
    return evidence < MERGE_EVIDENCE * p->config.slack || (evidence < NEVER && !far);
}

static void merge_bodies(struct grrl_perception *p)
{
    for (uint8_t a = 0; a + 1 < p->n_bodies; a++) {
        for (uint8_t b = (uint8_t)(a + 1); b < p->n_bodies; b++) {
            if (!may_merge(p, a, b))
                continue;
            for (uint16_t i = 0; i < p->n_slots; i++)
                if (p->body_of[i] == b)
                    p->body_of[i] = a;
            remove_body(p, b);
            fit_body(p, a);
            b = a; /* the merged body may now fit one that was passed over */
        }
    }
}

/*
 * Whether a feature strays from its body less than what tells a joint, in the mean. A body bent by
 * a joint that moved less keeps its features, though their residuals are beyond noise.
 */
static bool stays_close(const struct grrl_perception *p, uint16_t slot)
{
    uint8_t body = p->body_of[slot];
    float limit2 = p->config.min_slide_m * p->config.min_slide_m;
    float sum = 0.0f;
    float n = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        if (p->keyframe[k].weight[slot] > 0 && p->pose[k][body].weight > 0.0f) {
            struct grrl_vec2 at = grrl_transform(p->pose[k][body].pose, p->shape[slot]);
            sum += grrl_vec2_distance2(p->keyframe[k].point[slot], at);
            n += 1.0f;
        }
    }
    return sum < limit2 * n;
}

/* What a feature costs in a body beyond what it may; false: it cannot be in it. */
static bool excess_in(const struct grrl_perception *p, uint16_t slot, uint8_t body, float *excess)
{
    bool is_own = body == p->body_of[slot];
    struct grrl_vec2 local = p->shape[slot];
    uint16_t n;
    if (!is_own && (!may_share(p, p->blob_of[slot], p->has_moved[slot], body) ||
                    !grrl_rigid_place(p, slot, &p->pose[0][body], GRRL_MAX_LINKS, &local)))
        return false;
    float cost =
        grrl_rigid_cost(p, slot, local, &p->pose[0][body], GRRL_MAX_LINKS, GRRL_COST_CAP, &n);
    *excess = cost - cost_limit(p, n) - (is_own ? OWN_COST : 0.0f);
    return n > 0;
}

/* The body a feature moves with, or GRRL_FEATURE_.. */
static uint8_t best_body(const struct grrl_perception *p, uint16_t slot)
{
    uint8_t own = p->body_of[slot];
    uint8_t best = GRRL_FEATURE_NONE;
    float best_excess = 0.0f; /* over the limit: unassigned */
    bool is_table = own == GRRL_FEATURE_BACKGROUND && p->blob_of[slot] == 0;
    for (uint8_t b = 0; b < p->n_bodies && !is_table; b++) { /* the table moves with nothing */
        float excess;
        if (excess_in(p, slot, b, &excess) && excess < best_excess) {
            best = b;
            best_excess = excess;
        }
    }
    if (best == GRRL_FEATURE_NONE && own < p->n_bodies && stays_close(p, slot))
        best = own;
    if (!p->has_moved[slot] && (p->blob_of[slot] == 0 || best == GRRL_FEATURE_NONE))
        best = GRRL_FEATURE_BACKGROUND;
    return best;
}

static bool reassign_once(struct grrl_perception *p)
{
    bool changed = false;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        uint8_t best = best_body(p, i);
        changed = changed || p->body_of[i] != best;
        p->body_of[i] = best;
    }
    if (changed)
        fit_all(p);
    return changed;
}

/* Features to the body they move with, poses to the features, until nothing changes. */
static void reassign(struct grrl_perception *p)
{
    for (int round = 0; round < REASSIGN_ROUNDS && reassign_once(p); round++) {
    }
}

/* Bodies with too few features are none. */
static void dissolve_small(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = grrl_rigid_slots(p, b, slots);
        if (n < p->config.min_features) {
            for (uint16_t i = 0; i < n; i++)
                p->body_of[slots[i]] = GRRL_FEATURE_NONE;
            remove_body(p, b--);
        }
    }
}

/* What never moved and hangs together only by what has moved away is the table beside the object.
 */
static void give_back_the_table(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies && p->config.static_background; b++) {
        if (body_has_moved(p, b) || grrl_initial_is_compact(p, b))
            continue;
        for (uint16_t i = 0; i < p->n_slots; i++) {
            if (p->body_of[i] == b) {
                p->body_of[i] = GRRL_FEATURE_BACKGROUND;
                p->blob_of[i] = 0;
            }
        }
        remove_body(p, b--);
    }
}

/*
 * Whether a feature would be no worse off in some other body. A body of n features follows their
 * noise with its own pose, which saves it a share of about 3 / (2 n) of each residual.
 */
static bool fits_elsewhere(const struct grrl_perception *p, uint16_t slot, uint16_t n_own)
{
    uint16_t n;
    uint8_t own = p->body_of[slot];
    float own_cost = grrl_rigid_cost(p, slot, p->shape[slot], &p->pose[0][own], GRRL_MAX_LINKS,
                                     GRRL_COST_CAP, &n);
    float leverage = 1.5f / (float)n_own;
    float allowed = own_cost + ELSEWHERE_COST +
                    2.0f * (float)n * (1.0f - (1.0f - leverage) / (1.0f + leverage));
    for (uint8_t b = 0; b < p->n_bodies; b++) {
        struct grrl_vec2 local;
        if (b != own && may_share(p, p->blob_of[slot], p->has_moved[slot], b) &&
            grrl_rigid_place(p, slot, &p->pose[0][b], GRRL_MAX_LINKS, &local) &&
            grrl_rigid_cost(p, slot, local, &p->pose[0][b], GRRL_MAX_LINKS, GRRL_COST_CAP, &n) <=
                allowed)
            return true;
    }
    return false;
}

/* Features beside a joint move with either link and can pose as a body of their own: a body is
 * real only if enough of its features fit nowhere else. */
static void dissolve_redundant(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies && p->n_bodies > 1; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = grrl_rigid_slots(p, b, slots);
        uint16_t unique = 0;
        for (uint16_t i = 0; i < n && unique < p->config.min_features; i++)
            unique = (uint16_t)(unique + (fits_elsewhere(p, slots[i], n) ? 0 : 1));
        if (unique < p->config.min_features) {
            for (uint16_t i = 0; i < n; i++)
                p->body_of[slots[i]] = GRRL_FEATURE_NONE;
            remove_body(p, b--);
            reassign(p);
        }
    }
}

/* Two bodies that moved apart only a little are cut anew, where they part best (cut.c). */
static void cut_anew(struct grrl_perception *p, uint8_t a, uint8_t b)
{
    struct range range = range_between(p, a, b);
    if (!is_less(p, &range, LITTLE) || !may_share(p, blob_of_body(p, a), body_has_moved(p, a), b))
        return;
    struct grrl_rigid_group together;
    uint16_t part[GRRL_MAX_FEATURES];
    uint16_t n_part;
    fit_both(p, a, b, &together);
    float gain = grrl_cut_best(p, &together, a, part, &n_part);
    uint16_t crossed[GRRL_MAX_FEATURES];
    uint16_t n_crossed;
    float crossed_gain = grrl_cut_best_cross(p, &together, a, crossed, &n_crossed);
    if (crossed_gain > gain) {
        gain = crossed_gain;
        n_part = n_crossed;
        memcpy(part, crossed, n_part * sizeof *part);
    }
    if (gain < CUT_GAIN * p->config.slack)
        return;
    int of_a = 0; /* the part goes on as the body most of it was, so that numbers stay */
    for (uint16_t i = 0; i < n_part; i++)
        of_a += p->body_of[part[i]] == a ? 1 : -1;
    for (uint16_t i = 0; i < together.n; i++)
        p->body_of[together.slot[i]] = of_a > 0 ? b : a;
    for (uint16_t i = 0; i < n_part; i++)
        p->body_of[part[i]] = of_a > 0 ? a : b;
    fit_body(p, a);
    fit_body(p, b);
}

static void cut_all_anew(struct grrl_perception *p)
{
    for (uint8_t a = 0; a + 1 < p->n_bodies; a++)
        for (uint8_t b = (uint8_t)(a + 1); b < p->n_bodies; b++)
            cut_anew(p, a, b);
}

/* Splits body `body` if a part of it moved apart from the rest. */
static void split_body(struct grrl_perception *p, uint8_t body)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t members[GRRL_MAX_FEATURES];
    float score[GRRL_MAX_KEYFRAMES];
    uint16_t n = grrl_rigid_slots(p, body, slots);
    if (n < p->config.min_features ||
        grrl_consensus_misfit(p, slots, n, body, score) < SPLIT_SIGMAS)
        return;
    uint16_t n_members = grrl_consensus_find(p, slots, n, score, members);
    if (n_members < p->config.min_features || n_members == n)
        return;
    for (uint16_t i = 0; i < n; i++)
        p->body_of[slots[i]] = GRRL_FEATURE_NONE;
    for (uint16_t i = 0; i < n_members; i++)
        p->body_of[members[i]] = body;
    fit_body(p, body);
}

/* Bodies among the features that belong to none: what splitting left over, and what the background
 * gave up because it moved. */
static bool adopt_strays(struct grrl_perception *p)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t members[GRRL_MAX_FEATURES];
    float score[GRRL_MAX_KEYFRAMES];
    uint16_t n = grrl_rigid_slots(p, GRRL_FEATURE_NONE, slots);
    if (n < p->config.min_features || p->n_bodies == GRRL_MAX_LINKS)
        return false;
    uint8_t body = p->n_bodies;
    for (uint16_t i = 0; i < n; i++)
        p->body_of[slots[i]] = body;
    fit_body(p, body);
    (void)grrl_consensus_misfit(p, slots, n, body, score);
    uint16_t n_members = grrl_consensus_find(p, slots, n, score, members);
    for (uint16_t i = 0; i < n; i++)
        p->body_of[slots[i]] = GRRL_FEATURE_NONE;
    if (n_members < p->config.min_features)
        return false;
    for (uint16_t i = 0; i < n_members; i++)
        p->body_of[members[i]] = body;
    grrl_bodies_add(p);
    fit_body(p, body);
    return true;
}

/*
 * A joint within a body that moved too little to be told bends the body: what its residuals vary
 * beyond noise, per axis. It bends it less than what tells a joint; outliers do more, and must not
 * pass for it: where they do, no joint misses anything any more.
 */
static float bend_of(const struct grrl_perception *p, uint8_t body)
{
    float most = p->config.min_slide_m * p->config.min_slide_m;
    float sum = 0.0f;
    float n = 0.0f;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        for (uint8_t k = 0; k < p->n_keyframes && p->body_of[i] == body; k++) {
            uint8_t w = p->keyframe[k].weight[i];
            if (w > 0 && p->pose[k][body].weight > 0.0f) {
                float d2 = grrl_vec2_distance2(p->keyframe[k].point[i],
                                               grrl_transform(p->pose[k][body].pose, p->shape[i]));
                sum += 0.5f * (d2 < most ? d2 : most) - grrl_perception_variance(p, w);
                n += 1.0f;
            }
        }
    }
    return sum > 0.0f ? sum / n : 0.0f;
}

void grrl_bodies_update(struct grrl_perception *p)
{
    if (p->n_bodies == 0)
        grrl_initial_segmentation(p);
    for (uint16_t i = 0; i < p->n_slots; i++)
        p->has_moved[i] = moves(p, i);
    fit_all(p);
    if (grrl_outliers_drop(p))
        fit_all(p);
    for (uint8_t b = 0; b < p->n_bodies; b++)
        split_body(p, b);
    while (adopt_strays(p)) {
    }
    reassign(p);
    while (adopt_strays(p)) { /* what the background gave up */
    }
    dissolve_small(p);
    merge_bodies(p);
    cut_all_anew(p);
    reassign(p);
    dissolve_small(p);
    give_back_the_table(p);
    dissolve_redundant(p);
    for (uint8_t b = 0; b < p->n_bodies; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = grrl_rigid_slots(p, b, slots);
        grrl_rigid_refit(p, slots, n, p->shape, &p->pose[0][b], GRRL_MAX_LINKS);
        p->bend_m2[b] = bend_of(p, b);
    }
}
