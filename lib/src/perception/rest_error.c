/*
 * rest_error.c: position error at rest that averaging does not remove.
 *
 * A tracker in pictures drifts, and holds on to corners that are none: at rest a point is in one
 * place for sixty frames, and after the next push in another though nothing moved it. The table
 * tells: what is sparse at first sight hardly ever moves. The model error grows to what its points
 * are found to be off, so that drift is not taken for motion, however many pushes follow.
 */
#include "perception/perception_internal.h"

/* The median of the squared displacements between two rests in units of their variance per axis:
 * 2 ln 2. */
#define MEDIAN 1.386f

/* The median of n squared displacements scatters by 1.7 / sqrt(n) of itself, and what it exceeds
 * noise by must be this many times as much. */
#define CHANCE 1.7f
#define CHANCE_SIGMAS 5.0f

/* Pairs of rests, and points of the table in either, needed. */
enum { LEAST_PAIRS = 3, LEAST_FEATURES = 12 };

/* What is found counts from so many times the configured error on: less is chance. */
#define SIGNIFICANT 1.5f

static void sort(float *values, uint16_t n)
{
    for (uint16_t i = 1; i < n; i++) { /* insertion sort: the table, or rests */
        float v = values[i];
        uint16_t j = i;
        while (j > 0 && values[j - 1] > v) {
            values[j] = values[j - 1];
            j--;
        }
        values[j] = v;
    }
}

/* What the table's points tell of two rests, variances per axis. */
struct rest_pair {
    uint16_t n;    /* points seen in both */
    float noise;   /* of a point, the mean of both rests */
    float surplus; /* beyond that, by chance below 0 */
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
    sort(d2, pair.n);
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
    if (n < LEAST_PAIRS || !p->config.static_background)
        return 0.0f;
    sort(surplus, n);
    float found = surplus[n / 2];
    float chance = CHANCE_SIGMAS * CHANCE * (noise / points) / grrl_sqrt(points);
    float least = SIGNIFICANT * p->config.model_error_m;
    float most = p->config.min_slide_m; /* beyond it nothing could be told */
    if (!(found > chance && found > least * least))
        return 0.0f;
    return found < most * most ? grrl_sqrt(found) : most;
}
