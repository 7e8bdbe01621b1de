/*
 * initial_segmentation.c: candidate bodies before anything has moved. Features of objects are
 * dense, those of the background sparse: each dense group (blob) is one candidate link.
 */
#include "perception/perception_internal.h"

/* Minimum difference between the mean logarithms of squared distances on the two sides of Otsu's
 * threshold: ln 4 = 1.39 means a background twice as sparse as the object. Distances at a uniform
 * density differ less. */
#define DENSITY_CONTRAST 1.4f

/* Neighbouring features of one object lie at most this many times their usual distance apart. Among
 * points scattered at random over a plane, the second nearest is that far away once in 200,000
 * (Gamma distribution of its squared distance). */
#define REACH 3.0f

#define LEAST_M2 1e-9f /* (0.03 mm)^2, added to squared distances before the logarithm */

#define APART_M2 1e9f /* squared distance of features that no keyframe saw together */

/* Squared distance of two features in the first keyframe that saw both. */
static float first_distance2(const struct grrl_perception *p, uint16_t i, uint16_t j)
{
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        const struct grrl_perception_keyframe *key = &p->keyframe[k];
        if (key->weight[i] > 0 && key->weight[j] > 0)
            return grrl_vec2_distance2(key->point[i], key->point[j]);
    }
    return APART_M2;
}

/* The first keyframe that saw a feature, or n_keyframes. */
static uint8_t first_keyframe(const struct grrl_perception *p, uint16_t slot)
{
    uint8_t k = 0;
    while (k < p->n_keyframes && p->keyframe[k].weight[slot] == 0)
        k++;
    return k;
}

/* Squared distance from slot i, first seen in keyframe k, to its second nearest neighbour there. */
static float neighbour_distance2(const struct grrl_perception *p, uint16_t i, uint8_t k)
{
    const struct grrl_perception_keyframe *key = &p->keyframe[k];
    float nearest = APART_M2;
    float second = APART_M2;
    for (uint16_t j = 0; j < p->n_slots; j++) {
        if (j == i || key->weight[j] == 0)
            continue;
        float d = grrl_vec2_distance2(key->point[i], key->point[j]);
        if (d < nearest) {
            second = nearest;
            nearest = d;
        } else if (d < second) {
            second = d;
        }
    }
    return second;
}

void grrl_perception_sort(float *values, uint16_t n)
{
    for (uint16_t i = 1; i < n; i++) {
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
 * The largest distance between neighbouring features of one object: three times their usual
 * distance. Features of objects are dense, those of the background sparse; Otsu's threshold (1979)
 * on the logarithms of the sorted distances separates the two, whichever are more numerous.
 */
static float object_reach(float *distance2, uint16_t n)
{
    grrl_perception_sort(distance2, n);
    float total = 0.0f;
    for (uint16_t i = 0; i < n; i++)
        total += grrl_log(distance2[i] + LEAST_M2);
    uint16_t dense = n;
    float best = 0.0f;
    float below = 0.0f;
    for (uint16_t i = 1; i < n; i++) {
        below += grrl_log(distance2[i - 1] + LEAST_M2);
        float gap = below / (float)i - (total - below) / (float)(n - i);
        float between = gap * gap * (float)i * (float)(n - i);
        if (between > best && -gap > DENSITY_CONTRAST) {
            best = between;
            dense = i;
        }
    }
    return REACH * grrl_sqrt(distance2[dense / 2]);
}

/* Grows a blob from a slot by adding features closer than sqrt(reach2); returns its size. */
static uint16_t grow_blob(struct grrl_perception *p, uint16_t start, float reach2, uint8_t blob)
{
    uint16_t queue[GRRL_MAX_FEATURES];
    uint16_t n = 1;
    queue[0] = start;
    p->blob_of[start] = blob;
    for (uint16_t next = 0; next < n; next++) {
        for (uint16_t j = 0; j < p->n_slots; j++) {
            if (p->blob_of[j] == 0 && first_distance2(p, queue[next], j) < reach2) {
                p->blob_of[j] = blob;
                queue[n++] = j;
            }
        }
    }
    return n;
}

/* How many features of a body are connected to `start`; reached[] marks them. */
static uint16_t grow_in_body(const struct grrl_perception *p, uint8_t body, uint16_t start,
                             bool *reached)
{
    uint16_t queue[GRRL_MAX_FEATURES];
    uint16_t n = 1;
    queue[0] = start;
    reached[start] = true;
    for (uint16_t next = 0; next < n; next++) {
        for (uint16_t j = 0; j < p->n_slots; j++) {
            if (p->body_of[j] == body && !reached[j] &&
                first_distance2(p, queue[next], j) < p->reach2_m2) {
                reached[j] = true;
                queue[n++] = j;
            }
        }
    }
    return n;
}

bool grrl_initial_is_compact(const struct grrl_perception *p, uint8_t body)
{
    bool reached[GRRL_MAX_FEATURES] = {false};
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == body && !reached[i] &&
            grow_in_body(p, body, i, reached) >= p->config.min_features)
            return true;
    return false;
}

/* Assigns the features of a blob to a body, or to the background. */
static void settle_blob(struct grrl_perception *p, uint8_t blob, bool is_body)
{
    for (uint16_t j = 0; j < p->n_slots; j++) {
        if (p->blob_of[j] == blob) {
            p->body_of[j] = is_body ? (uint8_t)(blob - 1) : GRRL_FEATURE_BACKGROUND;
            p->blob_of[j] = is_body ? blob : 0;
        }
    }
}

/* Grows blobs from all features and makes bodies of the large ones, GRRL_MAX_LINKS at most. */
static void find_blobs(struct grrl_perception *p)
{
    uint8_t n = 0;
    for (uint16_t i = 0; i < p->n_slots && n < GRRL_MAX_LINKS; i++) {
        if (p->blob_of[i] != 0)
            continue;
        uint16_t size = grow_blob(p, i, p->reach2_m2, (uint8_t)(n + 1));
        bool is_body = size >= p->config.min_features + 1;
        settle_blob(p, (uint8_t)(n + 1), is_body);
        if (is_body) {
            n++;
            grrl_bodies_add(p);
        }
    }
}

void grrl_initial_segmentation(struct grrl_perception *p)
{
    float values[GRRL_MAX_FEATURES];
    uint16_t n = 0;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        p->body_of[i] = grrl_perception_on_table(p) ? GRRL_FEATURE_BACKGROUND : 0;
        p->blob_of[i] = grrl_perception_on_table(p) ? 0 : 1;
        uint8_t k = first_keyframe(p, i);
        if (k < p->n_keyframes)
            values[n++] = neighbour_distance2(p, i, k);
    }
    if (!grrl_perception_on_table(p)) {
        grrl_bodies_add(p);
        return;
    }
    if (n < 3)
        return;
    float reach = object_reach(values, n);
    p->reach2_m2 = reach * reach;
    find_blobs(p);
}
