/*
 * bodies.c: features into rigid bodies, their number unknown.
 *
 * The bodies of the last update are the start (at first those of first_look.c): a body whose
 * residuals are too large is split by consensus.c, features are reassigned, and bodies that never
 * moved apart are merged. All tests are on squared residuals in units of their variance, so that
 * one noise parameter is enough; a difference counts when it is significant in single keyframes,
 * however many other keyframes agree.
 */
#include "perception/perception_internal.h"

#include <string.h>

#define SPLIT_SIGMAS 4.5f   /* misfit of a whole body, in standard deviations of chi squared */
#define ELSEWHERE_COST 8.0f /* chi squared a feature may lose by moving to another body */
#define FAR_SIGMAS 5.0f     /* a range, of some ten rests, that noise does not reach */
#define LITTLE 6.0f         /* a motion apart, in units of what tells a joint */
#define CUT_GAIN 12.0f      /* chi squared by which another cut must be better */
#define NEVER 1e9f
#define REASSIGN_ROUNDS 6
#define MERGE_FREE 12.0f     /* chi squared a keyframe's separate pose must save: 3 parameters */
#define MERGE_EVIDENCE 40.0f /* and how much more in all keyframes together */

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
    float limit = 2.0f * (float)n + 4.0f * grrl_sqrt(4.0f * (float)n) + 4.0f;
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

/* Evidence that two feature sets moved apart: what separate poses save beyond their parameters. */
static float apart_evidence(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                            const uint8_t *body_of, uint8_t a, uint8_t b)
{
    struct grrl_vec2 shape[GRRL_MAX_FEATURES];
    struct grrl_perception_pose poses[GRRL_MAX_KEYFRAMES];
    grrl_rigid_fit(p, slots, n, shape, poses, 1);
    float evidence = 0.0f;
    float allowance = MERGE_FREE * p->config.slack;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        float saved = 0.0f;
        const struct grrl_perception_pose *pa = &p->pose[k][a];
        const struct grrl_perception_pose *pb = &p->pose[k][b];
        if (!(pa->weight > 0.0f) || !(pb->weight > 0.0f) || !(poses[k].weight > 0.0f))
            continue;
        for (uint16_t i = 0; i < n; i++) {
            uint16_t slot = slots[i];
            uint8_t w = p->keyframe[k].weight[slot];
            if (w == 0)
                continue;
            const struct grrl_perception_pose *own = body_of[slot] == a ? pa : pb;
            float scale = 1.0f / grrl_perception_variance(p, w);
            float together =
                scale * grrl_vec2_distance2(p->keyframe[k].point[slot],
                                            grrl_transform(poses[k].pose, shape[slot]));
            float alone = scale * grrl_vec2_distance2(p->keyframe[k].point[slot],
                                                      grrl_transform(own->pose, p->shape[slot]));
            saved += (together < 100.0f ? together : 100.0f) - (alone < 100.0f ? alone : 100.0f);
        }
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

static uint16_t slots_of_both(const struct grrl_perception *p, uint8_t a, uint8_t b,
                              uint16_t *slots)
{
    uint16_t n = 0;
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == a || p->body_of[i] == b)
            slots[n++] = i;
    return n;
}

/* Whether two bodies may be one: they moved apart in no keyframe. */
static float merge_evidence(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    if (!may_share(p, blob_of_body(p, a), body_has_moved(p, a), b))
        return NEVER;
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n = slots_of_both(p, a, b, slots);
    return apart_evidence(p, slots, n, p->body_of, a, b);
}

/* How far two bodies moved apart from rest to rest, and the variances of that. */
struct range {
    float turn;
    float shift2;
    float turn_var; /* the largest: noise alone must not look far enough */
    float shift_var;
};

static struct range range_between(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    float turn[2] = {0.0f, 0.0f};
    struct grrl_vec2 shift[2] = {{0.0f, 0.0f}, {0.0f, 0.0f}};
    struct grrl_pose reference = {{0.0f, 0.0f}, 1.0f, 0.0f}; /* of b in a, at the first rest */
    struct grrl_vec2 middle = {0.0f, 0.0f};
    struct range range = {0};
    bool begun = false;
    float noise2 = p->config.noise_m * p->config.noise_m;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        const struct grrl_perception_pose *pa = &p->pose[k][a];
        const struct grrl_perception_pose *pb = &p->pose[k][b];
        if (!p->keyframe[k].at_rest || !(pa->weight > 0.0f) || !(pb->weight > 0.0f))
            continue;
        struct grrl_pose r = {grrl_unrotate(pa->pose, grrl_vec2_sub(pb->pose.p, pa->pose.p)),
                              pa->pose.c * pb->pose.c + pa->pose.s * pb->pose.s,
                              pa->pose.c * pb->pose.s - pa->pose.s * pb->pose.c};
        if (!begun) {
            begun = true;
            reference = r;
            middle = grrl_vec2_scale(r.p, 0.5f);
        }
        float tv = noise2 * (1.0f / (pa->inertia + 1e-9f) + 1.0f / (pb->inertia + 1e-9f));
        float sv =
            noise2 * (1.0f / pa->weight + 1.0f / pb->weight) + 0.25f * tv * grrl_vec2_dot(r.p, r.p);
        range.turn_var = tv > range.turn_var ? tv : range.turn_var;
        range.shift_var = sv > range.shift_var ? sv : range.shift_var;
        /* where b takes the point half way between them */
        struct grrl_vec2 at = grrl_transform(r, grrl_untransform(reference, middle));
        struct grrl_vec2 d = grrl_vec2_sub(at, middle);
        float t = r.s * reference.c - r.c * reference.s;
        turn[0] = t < turn[0] ? t : turn[0];
        turn[1] = t > turn[1] ? t : turn[1];
        shift[0].x = d.x < shift[0].x ? d.x : shift[0].x;
        shift[0].y = d.y < shift[0].y ? d.y : shift[0].y;
        shift[1].x = d.x > shift[1].x ? d.x : shift[1].x;
        shift[1].y = d.y > shift[1].y ? d.y : shift[1].y;
    }
    struct grrl_vec2 shifted = grrl_vec2_sub(shift[1], shift[0]);
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

static bool reassign_once(struct grrl_perception *p)
{
    bool changed = false;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        uint8_t own = p->body_of[i];
        uint8_t best = GRRL_FEATURE_NONE;
        float best_excess = 0.0f; /* over the limit: unassigned */
        for (uint8_t b = 0; b < p->n_bodies; b++) {
            struct grrl_vec2 local = p->shape[i];
            uint16_t n;
            if (b != own && (!may_share(p, p->blob_of[i], p->has_moved[i], b) ||
                             !grrl_rigid_place(p, i, &p->pose[0][b], GRRL_MAX_LINKS, &local)))
                continue;
            if (own == GRRL_FEATURE_BACKGROUND && p->blob_of[i] == 0)
                break; /* decided below: the background moves with nothing */
            float cost =
                grrl_rigid_cost(p, i, local, &p->pose[0][b], GRRL_MAX_LINKS, GRRL_COST_CAP, &n);
            float excess = cost - cost_limit(p, n) - (b == own ? 2.0f : 0.0f);
            if (n > 0 && excess < best_excess) {
                best = b;
                best_excess = excess;
            }
        }
        if (best == GRRL_FEATURE_NONE && own < p->n_bodies && stays_close(p, i))
            best = own;
        if (!p->has_moved[i] && (p->blob_of[i] == 0 || best == GRRL_FEATURE_NONE))
            best = GRRL_FEATURE_BACKGROUND;
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
    together.n = slots_of_both(p, a, b, together.slot);
    grrl_rigid_fit(p, together.slot, together.n, together.shape, together.pose, 1);
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
