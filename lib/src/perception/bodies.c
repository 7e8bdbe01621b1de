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
 * split without a cause costs time only: the merges undo it. */
#define SPLIT_SIGMAS 4.5f

/* Chi squared by which another cut must be better: what three parameters (MERGE_FREE) save by
 * chance in 7 of 1,000 cases. Where links had been parted wrongly the right cut gained 35 to 200.
 */
#define CUT_GAIN 12.0f

/* Rounds of reassignment, at most: features could go to and fro. Of 4,400 calls on 200 random
 * chains 19 ended at the limit, 98% needed three rounds or fewer. */
#define REASSIGN_ROUNDS 6

void grrl_bodies_add(struct grrl_perception *p)
{
    p->number[p->n_bodies++] = ++p->n_numbers;
}

static void fit_body(struct grrl_perception *p, uint8_t body)
{
    p->is_assigned = false;
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n = grrl_rigid_slots(p, body, slots);
    grrl_rigid_fit(p, slots, n, p->shape, &p->pose[0][body], GRRL_MAX_LINKS);
}

static void fit_all(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies; b++)
        fit_body(p, b);
}

/* Takes a body out of the list; its features must be elsewhere. */
static void remove_body(struct grrl_perception *p, uint8_t body)
{
    p->is_assigned = false;
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

/* Makes one of all pairs of bodies of which `are_one` says so. */
static void merge_where(struct grrl_perception *p,
                        bool (*are_one)(const struct grrl_perception *, uint8_t, uint8_t))
{
    for (uint8_t a = 0; a + 1 < p->n_bodies; a++) {
        for (uint8_t b = (uint8_t)(a + 1); b < p->n_bodies; b++) {
            if (!are_one(p, a, b))
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

/* Two blobs at rest that lie apart may be one link on which few features show. They are if another
 * turns against both about the same point: links on two joints have two. */
static bool are_one_link_at_rest(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    return !grrl_assign_bodies_may_share(p, a, b) && grrl_apart_are_still(p, a, b) &&
           grrl_structure_turn_as_one(p, a, b);
}

/* Fits again the bodies that lost or gained features: of the others nothing else would come. */
static bool reassign_once(struct grrl_perception *p)
{
    bool changed[GRRL_MAX_LINKS] = {false};
    bool any = false;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        uint8_t was = p->body_of[i];
        uint8_t best = grrl_assign_best(p, i);
        if (was == best)
            continue;
        any = true;
        p->body_of[i] = best;
        if (was < p->n_bodies)
            changed[was] = true;
        if (best < p->n_bodies)
            changed[best] = true;
    }
    for (uint8_t b = 0; b < p->n_bodies; b++)
        if (changed[b])
            fit_body(p, b);
    return any;
}

/* Features to the body they move with, poses to the features, until nothing changes; nor does it if
 * no body has since. */
static void reassign(struct grrl_perception *p)
{
    for (int round = 0; round < REASSIGN_ROUNDS && !p->is_assigned; round++)
        p->is_assigned = !reassign_once(p);
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
        if (grrl_assign_body_has_moved(p, b) || grrl_initial_is_compact(p, b))
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

/* Features beside a joint move with either link and can pose as a body of their own: a body is
 * real only if enough of its features fit nowhere else. */
static void dissolve_redundant(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies && p->n_bodies > 1; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = grrl_rigid_slots(p, b, slots);
        uint16_t unique = 0;
        for (uint16_t i = 0; i < n && unique < p->config.min_features; i++)
            unique = (uint16_t)(unique + (grrl_assign_fits_elsewhere(p, slots[i], n) ? 0 : 1));
        if (unique < p->config.min_features) {
            for (uint16_t i = 0; i < n; i++)
                p->body_of[slots[i]] = GRRL_FEATURE_NONE;
            remove_body(p, b--);
            reassign(p);
        }
    }
}

/* A body whose features have all gone to others is none. They moved there when another body
 * dissolved, so that nothing tells where it is any more, and no joint of it is left. */
static void drop_empty(struct grrl_perception *p)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    for (uint8_t b = 0; b < p->n_bodies; b++)
        if (grrl_rigid_slots(p, b, slots) == 0)
            remove_body(p, b--);
}

/* Two bodies that moved apart only a little are cut anew, where they part best (cut.c). */
static void cut_anew(struct grrl_perception *p, uint8_t a, uint8_t b)
{
    if (!grrl_apart_is_little(p, a, b) || !grrl_assign_bodies_may_share(p, a, b))
        return;
    struct grrl_rigid_group together;
    uint16_t part[GRRL_MAX_FEATURES];
    uint16_t n_part;
    grrl_apart_fit_both(p, a, b, &together);
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

/*
 * A body outlives its features. Where tracks are short, those that the reference keyframe of a
 * consensus did not see took no part in it; they join while they move with the body as far as it is
 * known, which tells where it is in further keyframes.
 */
static void extend_body(struct grrl_perception *p, uint8_t body, const uint16_t *slots, uint16_t n,
                        const float *score)
{
    uint8_t reference;
    bool gained = grrl_consensus_reference(p, slots, n, score, &reference);
    while (gained) {
        gained = false;
        for (uint16_t i = 0; i < n; i++) {
            if (p->body_of[slots[i]] == GRRL_FEATURE_NONE &&
                p->keyframe[reference].weight[slots[i]] == 0 &&
                grrl_assign_follows(p, slots[i], body)) {
                p->body_of[slots[i]] = body;
                gained = true;
            }
        }
        if (gained)
            fit_body(p, body);
    }
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
    extend_body(p, body, slots, n, score);
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
    extend_body(p, body, slots, n, score);
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
                                               grrl_to_world(&p->pose[k][body], p->shape[i]));
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
    p->is_assigned = false;
    p->rest_error_m = grrl_rest_error(p);
    for (uint16_t i = 0; i < p->n_slots; i++)
        p->has_moved[i] = grrl_assign_moves(p, i);
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
    merge_where(p, grrl_apart_may_merge);
    cut_all_anew(p);
    reassign(p);
    dissolve_small(p);
    merge_where(p, are_one_link_at_rest);
    give_back_the_table(p);
    dissolve_redundant(p);
    drop_empty(p);
    for (uint8_t b = 0; b < p->n_bodies; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = grrl_rigid_slots(p, b, slots);
        grrl_rigid_refit(p, slots, n, p->shape, &p->pose[0][b], GRRL_MAX_LINKS);
        p->bend_m2[b] = bend_of(p, b);
    }
}
