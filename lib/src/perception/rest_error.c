/*
 * rest_error.c: position error at rest that averaging does not remove.
 *
 * An image tracker drifts, and latches on to corners that are not real: a point at rest keeps one
 * place for sixty frames, and after the next push is in another though nothing moved it. The table
 * reveals this: features that are sparse initially hardly ever move. The model error is raised to
 * the error measured on them, so that drift is not mistaken for motion, however many pushes follow.
 */
#include "perception/perception_internal.h"

/* The median of the squared displacements between two rests in units of their variance per axis:
 * 2 ln 2. */
#define MEDIAN 1.386f

/* The median of n squared displacements has a relative standard deviation of 1.7 / sqrt(n); its
 * excess over noise must be this many times as much. */
#define CHANCE 1.7f
#define CHANCE_SIGMAS 5.0f

/* Minimum number of pairs of rests, and of table points in each pair. */
enum { LEAST_PAIRS = 3, LEAST_FEATURES = 12 };

/* The measured error counts if it is at least this many times the configured error. */
#define SIGNIFICANT 1.5f

/* Comparison of the table's points between two rests; variances per axis. */
struct rest_pair {
    uint16_t n;    /* points seen in both */
    float noise;   /* of a point, averaged over both rests */
    float surplus; /* beyond that; may be below 0 by chance */
};

static struct rest_pair compare(const struct grrl_perception *p, uint8_t k0, uint8_t k1)
{
    float d2[GRRL_MAX_FEATURES];
    struct rest_pair pair = {0};
    for (uint16_t i = 0; i < p->n_slots; i++) {
        uint8_t w0 = p->keyframe[k0].weight[i];
        uint8_t w1 = p->keyframe[k1].weight[i];
        if (w0 == 0 || w1 == 0 || p->blob_of[i] != 0)
            continue;
        d2[pair.n++] = grrl_vec2_distance2(p->keyframe[k0].point[i], p->keyframe[k1].point[i]);
        pair.noise +=
            0.5f * p->config.noise_m * p->config.noise_m * (1.0f / (float)w0 + 1.0f / (float)w1);
    }
    if (pair.n == 0)
        return pair;
    grrl_perception_sort(d2, pair.n);
    pair.noise /= (float)pair.n;
    pair.surplus = 0.5f * d2[pair.n / 2] / MEDIAN - pair.noise;
    return pair;
}

float grrl_rest_error(const struct grrl_perception *p)
{
    float surplus[GRRL_MAX_KEYFRAMES];
    uint16_t n = 0;
    float points = 0.0f;
    float noise = 0.0f;
    uint8_t last = GRRL_MAX_KEYFRAMES;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        if (!p->keyframe[k].at_rest)
            continue;
        struct rest_pair pair = {0};
        if (last < GRRL_MAX_KEYFRAMES)
            pair = compare(p, last, k);
        if (pair.n >= LEAST_FEATURES) {
            surplus[n++] = pair.surplus;
            points += (float)pair.n;
            noise += pair.noise * (float)pair.n;
        }
        last = k;
    }
    if (n < LEAST_PAIRS || !grrl_perception_on_table(p))
        return 0.0f;
    grrl_perception_sort(surplus, n);
    float found = surplus[n / 2];
    float chance = CHANCE_SIGMAS * CHANCE * (noise / points) / grrl_sqrt(points);
    float least = SIGNIFICANT * p->config.model_error_m;
    float most = p->config.min_slide_m; /* beyond it no slide could be detected */
    if (!(found > chance && found > least * least))
        return 0.0f;
    return found < most * most ? grrl_sqrt(found) : most;
}
