/*
 * bodies.c: groups features into rigid bodies; their number is unknown.
 *
 * The search starts from the bodies of the last update (at first those of initial_segmentation.c):
 * a body whose residuals are too large is split by consensus.c, features are reassigned, and bodies
 * that never moved apart are merged. All tests use squared residuals in units of their variance, so
 * one noise parameter is enough; a difference counts if it is significant in single keyframes,
 * however many other keyframes agree.
 */
#include "perception/perception_internal.h"

#include <string.h>

/* Misfit above which a body is split, in standard deviations of chi squared. By noise alone a body
 * of ten features exceeds it in one of 2,700 keyframes, or one of 57 trials of 48 keyframes. A
 * needless split costs only time: the merges undo it. */
#define SPLIT_SIGMAS 4.5f

/* Chi squared that a new cut must gain: what three parameters (MERGE_FREE) save by chance in 7 of
 * 1,000 cases. Where links had been separated wrongly, the right cut gained 35 to 200. */
#define CUT_GAIN 12.0f

/* Limit on the rounds of reassignment: features could oscillate. Of 4,400 calls on 200 random
 * chains 19 reached the limit; 98% needed three rounds or fewer. */
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

/* Removes a body from the list; it must have no features left. */
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

/* Two separate blobs at rest may be one link with few visible features, or pieces of the ground.
 * They are one if another body turns relative to both about the same point: two links would have
 * two such points. In a recording also if it slides along both. */
static bool are_one_link_at_rest(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    return !grrl_assign_bodies_may_share(p, a, b) && grrl_apart_are_still(p, a, b) &&
           grrl_structure_move_as_one(p, a, b);
}

/* Merges every pair of bodies that are one: those that never moved apart or, at rest, two blobs of
 * one link. */
static void merge_bodies(struct grrl_perception *p, bool at_rest)
{
    for (uint8_t a = 0; a + 1 < p->n_bodies; a++) {
        for (uint8_t b = (uint8_t)(a + 1); b < p->n_bodies; b++) {
            if (at_rest ? !are_one_link_at_rest(p, a, b) : !grrl_apart_may_merge(p, a, b))
                continue;
            for (uint16_t i = 0; i < p->n_slots; i++)
                if (p->body_of[i] == b)
                    p->body_of[i] = a;
            remove_body(p, b);
            fit_body(p, a);
            b = a; /* the merged body may now match one checked before */
        }
    }
}

/* Bodies, one bit each. */
#define ALL_BODIES UINT32_MAX
_Static_assert(GRRL_MAX_LINKS <= 32, "a bit for each body");

static uint32_t bit_of(const struct grrl_perception *p, uint8_t body)
{
    return body < p->n_bodies ? UINT32_C(1) << body : 0u;
}

/* Refits only bodies that lost or gained features: the fit of the others would be the same.
 * *changed: those of the last round, then those of this one. */
static bool reassign_once(struct grrl_perception *p, uint32_t *changed)
{
    struct grrl_assign_origins origins;
    uint32_t before = *changed;
    bool any = false;
    *changed = 0;
    grrl_assign_find_origins(p, &origins);
    for (uint16_t i = 0; i < p->n_slots; i++) {
        uint8_t was = p->body_of[i];
        uint8_t best = grrl_assign_best(p, &origins, i, before | *changed);
        if (was == best)
            continue;
        any = true;
        p->body_of[i] = best;
        *changed |= bit_of(p, was) | bit_of(p, best);
        grrl_assign_find_origins(p, &origins);
    }
    for (uint8_t b = 0; b < p->n_bodies; b++)
        if ((*changed & bit_of(p, b)) != 0)
            fit_body(p, b);
    return any;
}

/* Alternates between assigning features to bodies and fitting poses until nothing changes. Does
 * nothing if no body has changed since. */
static void reassign(struct grrl_perception *p)
{
    uint32_t changed = ALL_BODIES;
    for (int round = 0; round < REASSIGN_ROUNDS && !p->is_assigned; round++)
        p->is_assigned = !reassign_once(p, &changed);
}

/* Features that only one body explains, of the min_features that it needs: one near a joint counts
 * for both links. In pictures a link may have no more than these. On a table, splinters near a
 * joint have so few, too; there the lower limit holds only for a body that moved far from every
 * other. */
static uint16_t least_of_its_own(const struct grrl_perception *p, uint8_t body)
{
    bool table = grrl_perception_on_table(p);
    bool lower = !table;
    for (uint8_t b = 0; b < p->n_bodies && table; b++) {
        if (b == body)
            continue;
        if (grrl_apart_is_little(p, b, body))
            return p->config.min_features;
        lower = true;
    }
    return (uint16_t)(p->config.min_features - (lower && p->config.min_features > 3 ? 1 : 0));
}

/* Whether a feature of another body moves with this one, too, in most keyframes. */
static bool has_follower(const struct grrl_perception *p, uint8_t body)
{
    uint16_t seen = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        seen = (uint16_t)(seen + (p->pose[k][body].weight > 0.0f ? 1 : 0));
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] < p->n_bodies && p->body_of[i] != body &&
            grrl_assign_follows(p, i, body, (uint16_t)(seen / 2 + 1)))
            return true;
    return false;
}

/* Whether n features of its own make a body. In pictures points may slide along edges: three that
 * move alone are no body. */
static bool are_enough(const struct grrl_perception *p, uint8_t body, uint16_t n)
{
    return n >= p->config.min_features || (n >= least_of_its_own(p, body) &&
                                           (grrl_perception_on_table(p) || has_follower(p, body)));
}

/* Removes bodies with too few features. */
static void dissolve_small(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = grrl_rigid_slots(p, b, slots);
        if (!are_enough(p, b, n)) {
            for (uint16_t i = 0; i < n; i++)
                p->body_of[slots[i]] = GRRL_FEATURE_NONE;
            remove_body(p, b--);
        }
    }
}

/* A body that never moved, and whose features were connected only through features that have since
 * moved away, is the table beside the object. */
static void give_back_the_table(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies && grrl_perception_on_table(p); b++) {
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

/* Features near a joint move with either link and can look like a body of their own: a body is real
 * only if enough of its features fit nowhere else. */
static void dissolve_redundant(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies && p->n_bodies > 1; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        struct grrl_assign_origins origins;
        uint16_t n = grrl_rigid_slots(p, b, slots);
        uint16_t unique = 0;
        grrl_assign_find_origins(p, &origins);
        for (uint16_t i = 0; i < n && unique < p->config.min_features; i++)
            unique =
                (uint16_t)(unique + (grrl_assign_fits_elsewhere(p, &origins, slots[i], n) ? 0 : 1));
        if (unique < p->config.min_features && unique < least_of_its_own(p, b)) {
            for (uint16_t i = 0; i < n; i++)
                p->body_of[slots[i]] = GRRL_FEATURE_NONE;
            remove_body(p, b--);
            reassign(p);
        }
    }
}

/* Removes bodies that have lost all their features to others, which happens when another body
 * dissolves: their place is no longer known, and they have no joints. */
static void drop_empty(struct grrl_perception *p)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    for (uint8_t b = 0; b < p->n_bodies; b++)
        if (grrl_rigid_slots(p, b, slots) == 0)
            remove_body(p, b--);
}

/* Cuts two bodies with little relative motion again, where the cut separates them best (cut.c). */
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
    int of_a = 0; /* the part keeps the body most of it belonged to, so numbers stay */
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
 * A body outlives its features. If tracks are short, features that the reference keyframe of a
 * consensus did not see took no part in it. They join as long as they move with the body where its
 * pose is known; that gives its pose in further keyframes.
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
                grrl_assign_follows(p, slots[i], body, 2)) {
                p->body_of[slots[i]] = body;
                gained = true;
            }
        }
        if (gained)
            fit_body(p, body);
    }
}

/* Splits `body` if part of it moved relative to the rest. If no part moved as one, it may be a few
 * features of two links whose others are unassigned: then the part is sought among these, too. */
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
    if (n_members < p->config.min_features) {
        n = (uint16_t)(n + grrl_rigid_slots(p, GRRL_FEATURE_NONE, slots + n));
        n_members = grrl_consensus_find(p, slots, n, score, members);
    }
    if (n_members < p->config.min_features || n_members == n)
        return;
    for (uint16_t i = 0; i < n; i++)
        p->body_of[slots[i]] = GRRL_FEATURE_NONE;
    for (uint16_t i = 0; i < n_members; i++)
        p->body_of[members[i]] = body;
    fit_body(p, body);
    extend_body(p, body, slots, n, score);
}

/* Forms a body from unassigned features: those left over by splits, and those that left the
 * background because they moved. */
static bool adopt_strays(struct grrl_perception *p)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t members[GRRL_MAX_FEATURES];
    float score[GRRL_MAX_KEYFRAMES];
    uint16_t n = grrl_rigid_slots(p, GRRL_FEATURE_NONE, slots);
    if (n + 1 < p->config.min_features || p->n_bodies == GRRL_MAX_LINKS)
        return false;
    uint8_t body = p->n_bodies;
    for (uint16_t i = 0; i < n; i++)
        p->body_of[slots[i]] = body;
    fit_body(p, body);
    (void)grrl_consensus_misfit(p, slots, n, body, score);
    uint16_t n_members = grrl_consensus_find(p, slots, n, score, members);
    for (uint16_t i = 0; i < n; i++)
        p->body_of[slots[i]] = GRRL_FEATURE_NONE;
    if (n_members + 1 < p->config.min_features)
        return false;
    for (uint16_t i = 0; i < n_members; i++)
        p->body_of[members[i]] = body;
    fit_body(p, body);
    if (!are_enough(p, body, n_members)) {
        for (uint16_t i = 0; i < n_members; i++)
            p->body_of[members[i]] = GRRL_FEATURE_NONE;
        return false;
    }
    grrl_bodies_add(p);
    extend_body(p, body, slots, n, score);
    return true;
}

/*
 * The variance of a body's residuals beyond noise, per axis: a joint inside a body that moved too
 * little to be detected bends the body. Its effect is below the joint detection threshold, so
 * larger residuals are capped: outliers must not count as bending, since that would make every
 * joint fit.
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
    while (adopt_strays(p)) { /* features that left the background */
    }
    dissolve_small(p);
    merge_bodies(p, false);
    cut_all_anew(p);
    reassign(p);
    dissolve_small(p);
    merge_bodies(p, true);
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
