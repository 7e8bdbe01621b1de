/*
 * bodies.c: features into rigid bodies, their number unknown.
 *
 * At first sight dense groups of features (blobs) are one candidate link each, the sparse rest is
 * background. Afterwards the bodies of the last update are the start: a body whose residuals are
 * too large is split by consensus (a hypothesis from a feature and its nearest neighbours, grown
 * over the features that move with it), features are reassigned, and bodies that never moved apart
 * are merged. All tests are on squared residuals in units of their variance, so that one noise
 * parameter is enough; a difference counts when it is significant in single keyframes, however many
 * other keyframes agree.
 */
#include "perception_internal.h"

#include <string.h>

#define COST_CAP 16.0f        /* of one squared residual: an outlier weighs no more */
#define DENSITY_CONTRAST 1.4f /* log of squared distances: background is twice as sparse */
#define SEED_NEIGHBOURS 3     /* with the seed: the smallest group whose pose is worth something */
#define SEEDS_MAX 48
#define SPLIT_KEYFRAMES 10  /* that tell most, used to score hypotheses */
#define SPLIT_SIGMAS 4.5f   /* misfit of a whole body, in standard deviations of chi squared */
#define ELSEWHERE_COST 8.0f /* chi squared a feature may lose by moving to another body */
#define INLIER_COST 3.5f    /* mean squared residual of a member; 2 is expected */
#define REASSIGN_ROUNDS 6
#define MERGE_FREE 12.0f     /* chi squared a keyframe's separate pose must save: 3 parameters */
#define MERGE_EVIDENCE 40.0f /* and how much more in all keyframes together */

/* Density: the first look. */

static float distance2(struct grrl_vec2 a, struct grrl_vec2 b)
{
    struct grrl_vec2 d = grrl_vec2_sub(a, b);
    return grrl_vec2_dot(d, d);
}

/* Squared distance from slot i to its second nearest neighbour in the first keyframe. */
static float neighbour_distance2(const struct grrl_perception *p, uint16_t i)
{
    const struct grrl_perception_keyframe *key = &p->keyframe[0];
    float nearest = 1e9f;
    float second = 1e9f;
    for (uint16_t j = 0; j < p->n_slots; j++) {
        if (j == i || key->weight[j] == 0) {
            continue;
        }
        float d = distance2(key->point[i], key->point[j]);
        if (d < nearest) {
            second = nearest;
            nearest = d;
        } else if (d < second) {
            second = d;
        }
    }
    return second;
}

static void sort(float *values, uint16_t n)
{
    for (uint16_t i = 1; i < n;
         i++) { /* insertion sort: once an object, GRRL_MAX_FEATURES values */
        float v = values[i];
        uint16_t j = i;
        while (j > 0 && values[j - 1] > v) {
            values[j] = values[j - 1];
            j--;
        }
        values[j] = v;
    }
}

/*
 * How far features of one object lie apart at most: three times their usual distance. Features of
 * objects lie densely, those of the background do not; Otsu's threshold (1979) on the logarithms
 * of the sorted distances parts the two, whichever are more.
 */
static float object_reach(float *distance2, uint16_t n)
{
    sort(distance2, n);
    float total = 0.0f;
    for (uint16_t i = 0; i < n; i++) {
        total += grrl_log(distance2[i] + 1e-9f);
    }
    uint16_t dense = n;
    float best = 0.0f;
    float below = 0.0f;
    for (uint16_t i = 1; i < n; i++) {
        below += grrl_log(distance2[i - 1] + 1e-9f);
        float gap = below / (float)i - (total - below) / (float)(n - i);
        float between = gap * gap * (float)i * (float)(n - i);
        if (between > best && -gap > DENSITY_CONTRAST) {
            best = between;
            dense = i;
        }
    }
    return 3.0f * grrl_sqrt(distance2[dense / 2]);
}

/* Grows a blob from a slot by features closer than sqrt(reach2); returns its size. */
static uint16_t grow_blob(struct grrl_perception *p, uint16_t start, float reach2, uint8_t blob)
{
    const struct grrl_perception_keyframe *key = &p->keyframe[0];
    uint16_t queue[GRRL_MAX_FEATURES];
    uint16_t n = 1;
    queue[0] = start;
    p->blob_of[start] = blob;
    for (uint16_t next = 0; next < n; next++) {
        for (uint16_t j = 0; j < p->n_slots; j++) {
            if (p->blob_of[j] == 0 && key->weight[j] > 0 &&
                distance2(key->point[queue[next]], key->point[j]) < reach2) {
                p->blob_of[j] = blob;
                queue[n++] = j;
            }
        }
    }
    return n;
}

static void add_body(struct grrl_perception *p)
{
    p->number[p->n_bodies++] = ++p->n_numbers;
}

static void first_look(struct grrl_perception *p)
{
    float values[GRRL_MAX_FEATURES];
    uint16_t n = 0;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        p->body_of[i] = GRRL_FEATURE_BACKGROUND;
        if (p->keyframe[0].weight[i] > 0) {
            values[n++] = neighbour_distance2(p, i);
        }
    }
    if (n < 3) {
        return;
    }
    float reach = object_reach(values, n);
    uint8_t blob = 0;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->blob_of[i] != 0 || p->keyframe[0].weight[i] == 0 || blob == GRRL_MAX_LINKS) {
            continue;
        }
        uint16_t size = grow_blob(p, i, reach * reach, (uint8_t)(blob + 1));
        bool is_body = size >= p->config.min_features + 1;
        for (uint16_t j = 0; j < p->n_slots; j++) {
            if (p->blob_of[j] == blob + 1) {
                p->body_of[j] = is_body ? blob : GRRL_FEATURE_BACKGROUND;
                p->blob_of[j] = is_body ? (uint8_t)(blob + 1) : 0;
            }
        }
        if (is_body) {
            blob++;
            add_body(p);
        }
    }
}

/* Fitting. */

static void fit_body(struct grrl_perception *p, uint8_t body)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n = grrl_body_slots(p, body, slots);
    grrl_rigid_fit(p, slots, n, p->shape, &p->pose[0][body], GRRL_MAX_LINKS);
}

/* Mean cost a keyframe above which a feature does not belong; few keyframes scatter more. */
static float cost_limit(uint16_t n)
{
    return 2.0f * (float)n + 4.0f * grrl_sqrt(4.0f * (float)n) + 4.0f;
}

/* Whether a feature left its place at any time. */
static bool moves(const struct grrl_perception *p, uint16_t slot)
{
    struct grrl_vec2 mean = {0.0f, 0.0f};
    float mass = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        float w = (float)p->keyframe[k].weight[slot];
        mean = grrl_vec2_add(mean, grrl_vec2_scale(p->keyframe[k].point[slot], w));
        mass += w;
    }
    uint16_t n = 0;
    float cost = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        uint8_t w = p->keyframe[k].weight[slot];
        if (w > 0) {
            float d2 = distance2(p->keyframe[k].point[slot], grrl_vec2_scale(mean, 1.0f / mass)) /
                       grrl_keyframe_variance(p, w);
            cost += d2 < COST_CAP ? d2 : COST_CAP;
            n++;
        }
    }
    return n > 0 && cost >= cost_limit(n);
}

/* Whether a body has moved on the table at all. */
static bool body_has_moved(const struct grrl_perception *p, uint8_t body)
{
    int balance = 0;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] == body) {
            balance += p->has_moved[i] ? 1 : -1;
        }
    }
    return balance > 0;
}

static uint8_t blob_of_body(const struct grrl_perception *p, uint8_t body)
{
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] == body && p->blob_of[i] != 0) {
            return p->blob_of[i];
        }
    }
    return 0;
}

/* Blobs that lie apart stay apart until motion speaks: what never moved looks rigid with everything
 * that never moved. */
static bool may_share(const struct grrl_perception *p, uint8_t blob, bool moved, uint8_t body)
{
    uint8_t other = blob_of_body(p, body);
    return blob == 0 || other == 0 || blob == other || (moved && body_has_moved(p, body));
}

/* Splitting. */

/* Largest misfit of a body over its keyframes in standard deviations; score[k] for each. */
static float misfit(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
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
            if (w > 0 && pose->mass > 0.0f) {
                float d2 = distance2(p->keyframe[k].point[slots[i]],
                                     grrl_transform(pose->pose, p->shape[slots[i]])) /
                           grrl_keyframe_variance(p, w);
                sum += d2 < COST_CAP ? d2 : COST_CAP;
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

/* A few keyframes as a perception of their own would see them: which to score hypotheses on. */
struct choice_of_keyframes {
    uint8_t n;
    uint8_t k[SPLIT_KEYFRAMES];
};

static struct choice_of_keyframes telling_keyframes(const struct grrl_perception *p,
                                                    const float *score)
{
    struct choice_of_keyframes chosen = {0};
    bool taken[GRRL_MAX_KEYFRAMES] = {false};
    while (chosen.n < SPLIT_KEYFRAMES && chosen.n < p->n_keyframes) {
        uint8_t best = 0;
        float best_score = -1e9f;
        for (uint8_t k = 0; k < p->n_keyframes; k++) {
            if (!taken[k] && score[k] > best_score) {
                best = k;
                best_score = score[k];
            }
        }
        taken[best] = true;
        chosen.k[chosen.n++] = best;
    }
    return chosen;
}

/* A rigid displacement from one keyframe to another, with what its uncertainty needs. */
struct displacement {
    struct grrl_vec2 from;
    struct grrl_vec2 to;
    float c;
    float s;
    float mass;
    float inertia;
};

static bool displacement_of(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                            uint8_t k0, uint8_t k1, struct displacement *d)
{
    const struct grrl_perception_keyframe *a = &p->keyframe[k0];
    const struct grrl_perception_keyframe *b = &p->keyframe[k1];
    *d = (struct displacement){.c = 1.0f};
    unsigned seen = 0;
    for (uint16_t i = 0; i < n; i++) {
        if (a->weight[slots[i]] > 0 && b->weight[slots[i]] > 0) {
            d->from = grrl_vec2_add(d->from, a->point[slots[i]]);
            d->to = grrl_vec2_add(d->to, b->point[slots[i]]);
            seen++;
        }
    }
    if (seen < 2) {
        return false;
    }
    d->mass = (float)seen;
    d->from = grrl_vec2_scale(d->from, 1.0f / d->mass);
    d->to = grrl_vec2_scale(d->to, 1.0f / d->mass);
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
    }
    return d->inertia > 0.0f;
}

/*
 * The features among `slots` that move as the group does, in the chosen keyframes relative to the
 * reference k0; returns how many, members[] holds them.
 */
static uint16_t followers(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                          const uint16_t *group, uint16_t n_group, uint8_t k0,
                          const struct choice_of_keyframes *chosen, uint16_t *members)
{
    float cost[GRRL_MAX_FEATURES] = {0.0f};
    float count[GRRL_MAX_FEATURES] = {0.0f};
    for (uint8_t c = 0; c < chosen->n; c++) {
        uint8_t k = chosen->k[c];
        struct displacement d;
        if (k == k0 || !displacement_of(p, group, n_group, k0, k, &d)) {
            continue;
        }
        for (uint16_t i = 0; i < n; i++) {
            uint8_t w0 = p->keyframe[k0].weight[slots[i]];
            uint8_t w1 = p->keyframe[k].weight[slots[i]];
            if (w0 == 0 || w1 == 0) {
                continue;
            }
            struct grrl_vec2 x = grrl_vec2_sub(p->keyframe[k0].point[slots[i]], d.from);
            struct grrl_vec2 y = grrl_vec2_sub(p->keyframe[k].point[slots[i]], d.to);
            struct grrl_vec2 r = {y.x - (d.c * x.x - d.s * x.y), y.y - (d.s * x.x + d.c * x.y)};
            float variance = (grrl_keyframe_variance(p, w0) + grrl_keyframe_variance(p, w1)) *
                             (1.0f + 1.0f / d.mass + grrl_vec2_dot(x, x) / (2.0f * d.inertia));
            float d2 = grrl_vec2_dot(r, r) / variance;
            cost[i] += d2 < COST_CAP ? d2 : COST_CAP;
            count[i] += 1.0f;
        }
    }
    uint16_t n_members = 0;
    for (uint16_t i = 0; i < n; i++) {
        if (count[i] > 0.0f && cost[i] <= INLIER_COST * count[i]) {
            members[n_members++] = slots[i];
        }
    }
    return n_members;
}

/* The seed and its nearest neighbours in the reference keyframe. */
static uint16_t seed_group(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                           uint16_t seed, uint8_t k0, uint16_t *group)
{
    float d2[SEED_NEIGHBOURS];
    uint16_t n_group = 1;
    group[0] = seed;
    for (uint16_t i = 0; i < n; i++) {
        if (slots[i] == seed || p->keyframe[k0].weight[slots[i]] == 0) {
            continue;
        }
        float d = distance2(p->keyframe[k0].point[seed], p->keyframe[k0].point[slots[i]]);
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

/* The largest set of features in `slots` that moved as one; returns its size, members[]. */
static uint16_t best_consensus(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                               const float *score, uint16_t *members)
{
    struct choice_of_keyframes chosen = telling_keyframes(p, score);
    uint8_t k0 = 0;
    unsigned best_seen = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++) { /* the reference: most seen, best averaged */
        unsigned seen = 0;
        for (uint16_t i = 0; i < n; i++) {
            uint8_t w = p->keyframe[k].weight[slots[i]];
            seen += w > 0 ? 100u + w : 0u;
        }
        if (seen > best_seen) {
            best_seen = seen;
            k0 = k;
        }
    }
    uint16_t best = 0;
    uint16_t step = (uint16_t)(1 + n / (SEEDS_MAX + 1));
    for (uint16_t i = 0; i < n; i = (uint16_t)(i + step)) {
        uint16_t group[GRRL_MAX_FEATURES];
        uint16_t grown[GRRL_MAX_FEATURES];
        if (p->keyframe[k0].weight[slots[i]] == 0) {
            continue;
        }
        uint16_t n_group = seed_group(p, slots, n, slots[i], k0, group);
        for (int round = 0; round < 3 && n_group >= 3; round++) {
            uint16_t n_grown = followers(p, slots, n, group, n_group, k0, &chosen, grown);
            memcpy(group, grown, n_grown * sizeof group[0]);
            n_group = n_grown;
        }
        if (n_group > best) {
            best = n_group;
            memcpy(members, group, n_group * sizeof group[0]);
        }
    }
    return best;
}

/* Merging. */

/* Evidence that two feature sets moved apart: what separate poses save beyond their parameters. */
static float apart_evidence(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                            const uint8_t *body_of, uint8_t a, uint8_t b)
{
    struct grrl_vec2 shape[GRRL_MAX_FEATURES];
    struct grrl_perception_pose poses[GRRL_MAX_KEYFRAMES];
    grrl_rigid_fit(p, slots, n, shape, poses, 1);
    float evidence = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        float saved = 0.0f;
        const struct grrl_perception_pose *pa = &p->pose[k][a];
        const struct grrl_perception_pose *pb = &p->pose[k][b];
        if (!(pa->mass > 0.0f) || !(pb->mass > 0.0f) || !(poses[k].mass > 0.0f)) {
            continue;
        }
        for (uint16_t i = 0; i < n; i++) {
            uint16_t slot = slots[i];
            uint8_t w = p->keyframe[k].weight[slot];
            if (w == 0) {
                continue;
            }
            const struct grrl_perception_pose *own = body_of[slot] == a ? pa : pb;
            float scale = 1.0f / grrl_keyframe_variance(p, w);
            float together = scale * distance2(p->keyframe[k].point[slot],
                                               grrl_transform(poses[k].pose, shape[slot]));
            float alone = scale * distance2(p->keyframe[k].point[slot],
                                            grrl_transform(own->pose, p->shape[slot]));
            saved += (together < 100.0f ? together : 100.0f) - (alone < 100.0f ? alone : 100.0f);
        }
        evidence += saved > MERGE_FREE ? saved - MERGE_FREE : 0.0f;
    }
    return evidence;
}

/* Takes a body out of the list; its features must be elsewhere. */
static void remove_body(struct grrl_perception *p, uint8_t body)
{
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] > body && p->body_of[i] < p->n_bodies) {
            p->body_of[i]--;
        }
    }
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        memmove(&p->pose[k][body], &p->pose[k][body + 1],
                (size_t)(p->n_bodies - body - 1) * sizeof p->pose[0][0]);
    }
    memmove(&p->number[body], &p->number[body + 1],
            (size_t)(p->n_bodies - body - 1) * sizeof p->number[0]);
    p->n_bodies--;
}

/* Whether two bodies may be one: they moved apart in no keyframe. */
static float merge_evidence(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    if (!may_share(p, blob_of_body(p, a), body_has_moved(p, a), b)) {
        return 1e9f;
    }
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n = 0;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] == a || p->body_of[i] == b) {
            slots[n++] = i;
        }
    }
    return apart_evidence(p, slots, n, p->body_of, a, b);
}

static void merge_bodies(struct grrl_perception *p)
{
    for (uint8_t a = 0; a + 1 < p->n_bodies; a++) {
        for (uint8_t b = (uint8_t)(a + 1); b < p->n_bodies; b++) {
            if (merge_evidence(p, a, b) >= MERGE_EVIDENCE) {
                continue;
            }
            for (uint16_t i = 0; i < p->n_slots; i++) {
                if (p->body_of[i] == b) {
                    p->body_of[i] = a;
                }
            }
            remove_body(p, b);
            fit_body(p, a);
            b = a; /* the merged body may now fit one that was passed over */
        }
    }
}

/* Reassigning. */

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
                             !grrl_rigid_place(p, i, &p->pose[0][b], GRRL_MAX_LINKS, &local))) {
                continue;
            }
            if (own == GRRL_FEATURE_BACKGROUND && p->blob_of[i] == 0) {
                break; /* decided below: the background moves with nothing */
            }
            float cost = grrl_rigid_cost(p, i, local, &p->pose[0][b], GRRL_MAX_LINKS, COST_CAP, &n);
            float excess = cost - cost_limit(n) - (b == own ? 2.0f : 0.0f);
            if (n > 0 && excess < best_excess) {
                best = b;
                best_excess = excess;
            }
        }
        if (!p->has_moved[i] && (p->blob_of[i] == 0 || best == GRRL_FEATURE_NONE)) {
            best = GRRL_FEATURE_BACKGROUND;
        }
        changed = changed || p->body_of[i] != best;
        p->body_of[i] = best;
    }
    for (uint8_t b = 0; b < p->n_bodies && changed; b++) {
        fit_body(p, b);
    }
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
        uint16_t n = grrl_body_slots(p, b, slots);
        if (n < p->config.min_features) {
            for (uint16_t i = 0; i < n; i++) {
                p->body_of[slots[i]] = GRRL_FEATURE_NONE;
            }
            remove_body(p, b--);
        }
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
    float own_cost =
        grrl_rigid_cost(p, slot, p->shape[slot], &p->pose[0][own], GRRL_MAX_LINKS, COST_CAP, &n);
    float leverage = 1.5f / (float)n_own;
    float allowed = own_cost + ELSEWHERE_COST +
                    2.0f * (float)n * (1.0f - (1.0f - leverage) / (1.0f + leverage));
    for (uint8_t b = 0; b < p->n_bodies; b++) {
        struct grrl_vec2 local;
        if (b != own && may_share(p, p->blob_of[slot], p->has_moved[slot], b) &&
            grrl_rigid_place(p, slot, &p->pose[0][b], GRRL_MAX_LINKS, &local) &&
            grrl_rigid_cost(p, slot, local, &p->pose[0][b], GRRL_MAX_LINKS, COST_CAP, &n) <=
                allowed) {
            return true;
        }
    }
    return false;
}

/* Features beside a joint move with either link and can pose as a body of their own: a body is
 * real only if enough of its features fit nowhere else. */
static void dissolve_redundant(struct grrl_perception *p)
{
    for (uint8_t b = 0; b < p->n_bodies && p->n_bodies > 1; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = grrl_body_slots(p, b, slots);
        uint16_t unique = 0;
        for (uint16_t i = 0; i < n && unique < p->config.min_features; i++) {
            unique = (uint16_t)(unique + (fits_elsewhere(p, slots[i], n) ? 0 : 1));
        }
        if (unique < p->config.min_features) {
            for (uint16_t i = 0; i < n; i++) {
                p->body_of[slots[i]] = GRRL_FEATURE_NONE;
            }
            remove_body(p, b--);
            reassign(p);
        }
    }
}

/* Splits body `body` if a part of it moved apart from the rest. */
static void split_body(struct grrl_perception *p, uint8_t body)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t members[GRRL_MAX_FEATURES];
    float score[GRRL_MAX_KEYFRAMES];
    uint16_t n = grrl_body_slots(p, body, slots);
    if (n < p->config.min_features || misfit(p, slots, n, body, score) < SPLIT_SIGMAS) {
        return;
    }
    uint16_t n_members = best_consensus(p, slots, n, score, members);
    if (n_members < p->config.min_features || n_members == n) {
        return;
    }
    for (uint16_t i = 0; i < n; i++) {
        p->body_of[slots[i]] = GRRL_FEATURE_NONE;
    }
    for (uint16_t i = 0; i < n_members; i++) {
        p->body_of[members[i]] = body;
    }
    fit_body(p, body);
}

/* Bodies among the features that belong to none: what splitting left over, and what the background
 * gave up because it moved. */
static bool adopt_strays(struct grrl_perception *p)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t members[GRRL_MAX_FEATURES];
    float score[GRRL_MAX_KEYFRAMES];
    uint16_t n = grrl_body_slots(p, GRRL_FEATURE_NONE, slots);
    if (n < p->config.min_features || p->n_bodies == GRRL_MAX_LINKS) {
        return false;
    }
    uint8_t body = p->n_bodies;
    for (uint16_t i = 0; i < n; i++) {
        p->body_of[slots[i]] = body;
    }
    fit_body(p, body);
    (void)misfit(p, slots, n, body, score);
    uint16_t n_members = best_consensus(p, slots, n, score, members);
    for (uint16_t i = 0; i < n; i++) {
        p->body_of[slots[i]] = GRRL_FEATURE_NONE;
    }
    if (n_members < p->config.min_features) {
        return false;
    }
    for (uint16_t i = 0; i < n_members; i++) {
        p->body_of[members[i]] = body;
    }
    add_body(p);
    fit_body(p, body);
    return true;
}

void grrl_bodies_update(struct grrl_perception *p)
{
    if (p->n_bodies == 0) {
        first_look(p);
    }
    for (uint16_t i = 0; i < p->n_slots; i++) {
        p->has_moved[i] = moves(p, i);
    }
    for (uint8_t b = 0; b < p->n_bodies; b++) {
        fit_body(p, b);
    }
    for (uint8_t b = 0; b < p->n_bodies; b++) {
        split_body(p, b);
    }
    while (adopt_strays(p)) {
    }
    reassign(p);
    while (adopt_strays(p)) { /* what the background gave up */
    }
    dissolve_small(p);
    merge_bodies(p);
    reassign(p);
    dissolve_small(p);
    dissolve_redundant(p);
}
