/*
 * consensus.c: the largest set of features that moved as one.
 *
 * Each hypothesis starts from a feature and its nearest neighbours: where has this group moved, and
 * which features moved with it? It grows to include those that did. The residual of a follower is
 * divided by a variance that includes the uncertainty of the group's own pose, so a group of four
 * features can grow along a link without losing its far end.
 */
#include "perception/perception_internal.h"

#include <string.h>

/* With the seed they form a group of four, as many as make a body (min_features): the pose of a
 * smaller group is so uncertain that everything follows it. */
#define SEED_NEIGHBOURS 3

/* Number of hypotheses, spread evenly over the features: the cost of a split is linear in it. A
 * part with one in ten of the features gets four or five seeds. */
#define SEEDS_MAX 48

/* Keyframes used to score hypotheses. Half are spread over the trial: with only the worst ones, two
 * links in one body stayed together for many pushes. */
#define SPLIT_KEYFRAMES 12

/* Cap on one squared residual, 20 standard deviations: high because keyframes are ranked by misfit,
 * and those with large relative motions must not all score the same. */
#define MISFIT_CAP 400.0f

/* Limit on a follower's mean squared residual, which is 2 on average: over 12 keyframes noise
 * exceeds it once in 77 features, over 6 once in 20. Features lost this way are reassigned
 * afterwards. */
#define INLIER_COST 3.5f

/* A group that is lost early saw nothing move apart, so everything follows it: it must be seen in
 * one of so many keyframes. */
#define TOLD_SHARE 2

#define GROW_ROUNDS 3 /* a group grows along a link, then settles */

/* Largest misfit of a body over its keyframes, in standard deviations; score[k] for each. */
float grrl_consensus_misfit(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                            uint8_t body, float *score)
{
    float worst = 0.0f;
    float total = 0.0f;
    float total_n = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        const struct grrl_perception_pose *pose = &p->pose[k][body];
        float sum = 0.0f;
        float count = 0.0f;
        for (uint16_t i = 0; i < n; i++) {
            uint8_t w = p->keyframe[k].weight[slots[i]];
            if (w > 0 && pose->weight > 0.0f) {
                float d2 = grrl_vec2_distance2(p->keyframe[k].point[slots[i]],
                                               grrl_to_world(pose, p->shape[slots[i]])) /
                           grrl_perception_variance(p, w);
                sum += d2 < MISFIT_CAP ? d2 : MISFIT_CAP;
                count += 1.0f;
            }
        }
        score[k] = count > 0.0f ? (sum - 2.0f * count) / grrl_sqrt(4.0f * count) : 0.0f;
        worst = score[k] > worst ? score[k] : worst;
        total += sum;
        total_n += count;
    }
    float all = total_n > 0.0f ? (total - 2.0f * total_n) / grrl_sqrt(4.0f * total_n) : 0.0f;
    return worst > all ? worst : all;
}

/* The keyframes on which hypotheses are scored. */
struct choice_of_keyframes {
    uint8_t n;
    uint8_t k[SPLIT_KEYFRAMES];
    float variance[GRRL_MAX_FEATURES]; /* of the features, by place, in the reference keyframe */
};

/* Number of features seen in both keyframes. */
static unsigned seen_in_both(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                             uint8_t k0, uint8_t k1)
{
    unsigned seen = 0;
    for (uint16_t i = 0; i < n; i++)
        if (p->keyframe[k0].weight[slots[i]] > 0 && p->keyframe[k1].weight[slots[i]] > 0)
            seen++;
    return seen;
}

/* If tracks are shorter than the motion: the keyframe that shares the most misfit with others. */
static uint8_t telling_reference(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                                 const float *score)
{
    uint8_t best = 0;
    float best_told = -1.0f;
    for (uint8_t k0 = 0; k0 < p->n_keyframes; k0++) {
        float told = 0.0f;
        for (uint8_t k = 0; k < p->n_keyframes; k++) {
            unsigned seen = k == k0 ? 0 : seen_in_both(p, slots, n, k0, k);
            if (seen > SEED_NEIGHBOURS && score[k] > 0.0f)
                told += (float)seen * score[k];
        }
        if (told > best_told) {
            best_told = told;
            best = k0;
        }
    }
    return best;
}

/* Whether tracks are shorter than the motion: most keyframes have too few features in common with
 * the fullest for a group. */
static bool tracks_are_short(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                             uint8_t fullest)
{
    unsigned shared = 0;
    unsigned filled = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        filled += seen_in_both(p, slots, n, k, k) > SEED_NEIGHBOURS ? 1u : 0u;
        shared += seen_in_both(p, slots, n, fullest, k) > SEED_NEIGHBOURS ? 1u : 0u;
    }
    return 2 * shared < filled;
}

bool grrl_consensus_reference(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                              const float *score, uint8_t *reference)
{
    *reference = grrl_rigid_reference(p, slots, n);
    if (!tracks_are_short(p, slots, n, *reference))
        return false;
    *reference = telling_reference(p, slots, n, score);
    return true;
}

/*
 * Half are spread over all keyframes, including the last, so that no lasting change is missed; the
 * other half are those in which the features fit worst as one body. With short tracks, only
 * keyframes that share enough features with k0 for a group are used.
 */
static struct choice_of_keyframes telling_keyframes(const struct grrl_perception *p,
                                                    const uint16_t *slots, uint16_t n, uint8_t k0,
                                                    bool is_short, const float *score)
{
    struct choice_of_keyframes chosen = {0};
    uint8_t useful[GRRL_MAX_KEYFRAMES];
    uint8_t n_useful = 0;
    bool taken[GRRL_MAX_KEYFRAMES] = {false};
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        if (!is_short || seen_in_both(p, slots, n, k0, k) > SEED_NEIGHBOURS)
            useful[n_useful++] = k;
    for (uint8_t i = 0; i < SPLIT_KEYFRAMES / 2 && n_useful > 0; i++) {
        uint8_t k = useful[(n_useful - 1) * (i + 1) / (SPLIT_KEYFRAMES / 2)];
        if (!taken[k]) {
            taken[k] = true;
            chosen.k[chosen.n++] = k;
        }
    }
    while (chosen.n < SPLIT_KEYFRAMES && chosen.n < n_useful) {
        uint8_t best = GRRL_MAX_KEYFRAMES;
        for (uint8_t i = 0; i < n_useful; i++) {
            uint8_t k = useful[i];
            if (!taken[k] && (best == GRRL_MAX_KEYFRAMES || score[k] > score[best]))
                best = k;
        }
        taken[best] = true;
        chosen.k[chosen.n++] = best;
    }
    return chosen;
}

/* A rigid displacement from one keyframe to another, with the terms of its uncertainty. */
struct displacement {
    struct grrl_vec2 from;
    struct grrl_vec2 to;
    float c;
    float s;
    float size; /* apparent size in the second keyframe; 1 in the first */
    float weight;
    float inertia;
};

static bool displacement_of(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                            uint8_t k0, uint8_t k1, struct displacement *d)
{
    const struct grrl_perception_keyframe *a = &p->keyframe[k0];
    const struct grrl_perception_keyframe *b = &p->keyframe[k1];
    *d = (struct displacement){.c = 1.0f, .size = 1.0f};
    unsigned seen = 0;
    for (uint16_t i = 0; i < n; i++) {
        if (a->weight[slots[i]] > 0 && b->weight[slots[i]] > 0) {
            d->from = grrl_vec2_add(d->from, a->point[slots[i]]);
            d->to = grrl_vec2_add(d->to, b->point[slots[i]]);
            seen++;
        }
    }
    if (seen < 2)
        return false;
    d->weight = (float)seen;
    d->from = grrl_vec2_scale(d->from, 1.0f / d->weight);
    d->to = grrl_vec2_scale(d->to, 1.0f / d->weight);
    float along = 0.0f;
    float across = 0.0f;
    for (uint16_t i = 0; i < n; i++) {
        if (a->weight[slots[i]] > 0 && b->weight[slots[i]] > 0) {
            struct grrl_vec2 x = grrl_vec2_sub(a->point[slots[i]], d->from);
            struct grrl_vec2 y = grrl_vec2_sub(b->point[slots[i]], d->to);
            along += grrl_vec2_dot(x, y);
            across += grrl_vec2_cross(x, y);
            d->inertia += grrl_vec2_dot(x, x);
        }
    }
    float length = grrl_sqrt(along * along + across * across);
    if (length > 0.0f) {
        d->c = along / length;
        d->s = across / length;
        d->size += p->config.sizes_change ? grrl_rigid_growth(p, length, d->inertia) : 0.0f;
    }
    return d->inertia > 0.0f;
}

/*
 * The features among `slots` that move with the group in the chosen keyframes, relative to the
 * reference k0; returns how many, members[] holds them.
 */
static uint16_t followers(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                          const uint16_t *group, uint16_t n_group, uint8_t k0,
                          const struct choice_of_keyframes *chosen, uint16_t *members)
{
    float cost[GRRL_MAX_FEATURES] = {0.0f};
    float count[GRRL_MAX_FEATURES] = {0.0f};
    const float lost = INLIER_COST * (float)chosen->n; /* above it no keyframe to come helps */
    const float noise2 = p->config.noise_m * p->config.noise_m;
    const float model = grrl_perception_model_error(p);
    const float model2 = model * model;
    unsigned told = 0; /* keyframes */
    for (uint8_t c = 0; c < chosen->n; c++) {
        uint8_t k = chosen->k[c];
        struct displacement d;
        if (k == k0 || !displacement_of(p, group, n_group, k0, k, &d))
            continue;
        told++;
        for (uint16_t i = 0; i < n; i++) {
            uint8_t w0 = p->keyframe[k0].weight[slots[i]];
            uint8_t w1 = p->keyframe[k].weight[slots[i]];
            if (w0 == 0 || w1 == 0 || cost[i] > lost)
                continue;
            struct grrl_vec2 x =
                grrl_vec2_scale(grrl_vec2_sub(p->keyframe[k0].point[slots[i]], d.from), d.size);
            struct grrl_vec2 y = grrl_vec2_sub(p->keyframe[k].point[slots[i]], d.to);
            struct grrl_vec2 r = {y.x - (d.c * x.x - d.s * x.y), y.y - (d.s * x.x + d.c * x.y)};
            float variance = (chosen->variance[i] + (noise2 / (float)w1 + model2)) *
                             (1.0f + 1.0f / d.weight + grrl_vec2_dot(x, x) / (2.0f * d.inertia));
            float d2 = grrl_vec2_dot(r, r) / variance;
            cost[i] += d2 < GRRL_COST_CAP ? d2 : GRRL_COST_CAP;
            count[i] += 1.0f;
        }
    }
    uint16_t n_members = 0;
    for (uint16_t i = 0; i < n && TOLD_SHARE * told >= chosen->n; i++)
        if (count[i] > 0.0f && cost[i] <= INLIER_COST * count[i])
            members[n_members++] = slots[i];
    return n_members;
}

/* Whether two features may move as one: in pictures, where links may have hardly more features than
 * a group, only those that keep their distance. */
static bool may_move_as_one(const struct grrl_perception *p, uint16_t i, uint16_t j, uint8_t k0,
                            const struct choice_of_keyframes *chosen)
{
    float cost = 0.0f;
    float count = 0.0f;
    float at_k0 =
        grrl_sqrt(grrl_vec2_distance2(p->keyframe[k0].point[i], p->keyframe[k0].point[j]));
    if (chosen == NULL)
        return true;
    for (uint8_t c = 0; c < chosen->n; c++) {
        const struct grrl_perception_keyframe *key = &p->keyframe[chosen->k[c]];
        uint8_t least = key->weight[i] < key->weight[j] ? key->weight[i] : key->weight[j];
        if (least == 0)
            continue;
        float change = grrl_sqrt(grrl_vec2_distance2(key->point[i], key->point[j])) - at_k0;
        float d2 = change * change / (4.0f * grrl_perception_variance(p, least));
        cost += d2 < GRRL_COST_CAP ? d2 : GRRL_COST_CAP;
        count += 1.0f;
    }
    return cost <= INLIER_COST * count;
}

/* The seed and its nearest neighbours in the reference keyframe. */
static uint16_t seed_group(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                           uint16_t seed, uint8_t k0, const struct choice_of_keyframes *chosen,
                           uint16_t *group)
{
    float d2[SEED_NEIGHBOURS];
    uint16_t n_group = 1;
    group[0] = seed;
    for (uint16_t i = 0; i < n; i++) {
        if (slots[i] == seed || p->keyframe[k0].weight[slots[i]] == 0 ||
            !may_move_as_one(p, seed, slots[i], k0, chosen))
            continue;
        float d = grrl_vec2_distance2(p->keyframe[k0].point[seed], p->keyframe[k0].point[slots[i]]);
        uint16_t at = n_group;
        while (at > 1 && d2[at - 2] > d) {
            if (at <= SEED_NEIGHBOURS) {
                d2[at - 1] = d2[at - 2];
                group[at] = group[at - 1];
            }
            at--;
        }
        if (at <= SEED_NEIGHBOURS) {
            d2[at - 1] = d;
            group[at] = slots[i];
            n_group = n_group <= SEED_NEIGHBOURS ? (uint16_t)(n_group + 1) : n_group;
        }
    }
    return n_group;
}

/* Features of groups that grow no more: seeds among them would lead to the same groups. */
struct explained {
    uint32_t bits[(GRRL_MAX_FEATURES + 31) / 32];
};

static bool is_explained(const struct explained *explained, uint16_t slot)
{
    return (explained->bits[slot / 32] >> slot % 32 & 1u) != 0;
}

static void explain(struct explained *explained, const uint16_t *group, uint16_t n)
{
    for (uint16_t i = 0; i < n; i++)
        explained->bits[group[i] / 32] |= UINT32_C(1) << group[i] % 32;
}

/*
 * Lets a group take in what follows it and lose what does not; returns its size. *stable: at first
 * the size of the group, then how much of it follows itself for sure. A group that swells in the
 * last round saw little, and has not yet met what it gained.
 */
static uint16_t grow(const struct grrl_perception *p, const uint16_t *slots, uint16_t n, uint8_t k0,
                     const struct choice_of_keyframes *chosen, struct explained *explained,
                     uint16_t *group, uint16_t *stable)
{
    uint16_t grown[GRRL_MAX_FEATURES];
    uint16_t n_group = *stable;
    for (int round = 0; round < GROW_ROUNDS && n_group >= 3; round++) {
        uint16_t n_grown = followers(p, slots, n, group, n_group, k0, chosen, grown);
        bool same = n_grown == n_group && memcmp(group, grown, n_grown * sizeof group[0]) == 0;
        memcpy(group, grown, n_grown * sizeof group[0]);
        *stable = n_grown < n_group ? n_grown : n_group;
        n_group = n_grown;
        if (same) {
            explain(explained, group, n_group);
            break;
        }
    }
    return n_group;
}

/* The largest group that grows from seeds and their nearest neighbours, or those of them that
 * `keep` their distance; returns its size. */
static uint16_t largest_group(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                              uint8_t k0, const struct choice_of_keyframes *chosen, bool keep,
                              uint16_t *members)
{
    uint16_t best = 0;
    uint16_t n_members = 0;
    uint16_t step = (uint16_t)(1 + n / (SEEDS_MAX + 1));
    struct explained explained = {{0}};
    for (uint16_t i = 0; i < n; i = (uint16_t)(i + step)) {
        uint16_t group[GRRL_MAX_FEATURES];
        if (p->keyframe[k0].weight[slots[i]] == 0 || is_explained(&explained, slots[i]))
            continue;
        uint16_t n_group = seed_group(p, slots, n, slots[i], k0, keep ? chosen : NULL, group);
        uint16_t stable = n_group;
        n_group = grow(p, slots, n, k0, chosen, &explained, group, &stable);
        if (stable > best) {
            best = stable;
            n_members = n_group;
            memcpy(members, group, n_group * sizeof group[0]);
        }
    }
    return n_members;
}

/* The largest set of features in `slots` that moved as one; returns its size, members[]. */
uint16_t grrl_consensus_find(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                             const float *score, uint16_t *members)
{
    uint8_t k0;
    bool is_short = grrl_consensus_reference(p, slots, n, score, &k0);
    struct choice_of_keyframes chosen = telling_keyframes(p, slots, n, k0, is_short, score);
    for (uint16_t i = 0; i < n; i++)
        if (p->keyframe[k0].weight[slots[i]] > 0)
            chosen.variance[i] = grrl_perception_variance(p, p->keyframe[k0].weight[slots[i]]);
    uint16_t n_members = largest_group(p, slots, n, k0, &chosen, false, members);
    if (n_members < p->config.min_features && !grrl_perception_on_table(p) &&
        !p->config.sizes_change)
        n_members = largest_group(p, slots, n, k0, &chosen, true, members);
    return n_members;
}
