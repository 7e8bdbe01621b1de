/*
 * perception.c: tracks and keyframes (the observations), and the order of an update.
 */
#include "perception/perception_internal.h"

#include <math.h>
#include <string.h>

enum {
    /* Frames averaged into one rest. The noise of their mean is 0.0007 / sqrt(60) = 0.00009 m;
     * beyond that the model error (0.0001 m) is the limit. */
    REST_FRAMES_MAX = 60,
    /* Frames averaged into one keyframe of a push unless configured otherwise: enough to outvote an
     * outlier two to one, few enough that the mean of points on a curved path stays near the path.
     */
    PUSH_FRAMES = 3,
    /* A point that stays away this many frames is another feature: with 2% outliers, a feature has
     * five in a row once in 3 * 10^8 frames. */
    JUMPS_UNTIL_NEW = 5,
    /* This many moved features start a keyframe, or end a rest; fewer may be outliers. */
    MOVED_FEATURES = 3,
    /* In a push, features count if they were seen in all frames of the window, unless these are
     * fewer than one in this many. */
    COMPLETE_SHARE = 3,
    /* If one in this many features of a window is in no keyframe yet, the window becomes a
     * keyframe: their motion starts where they begin. */
    NEW_SHARE = 4,
    /* A rest ends only if one in this many visible features has left its mean. */
    SLIDING_SHARE = 10
};

/* The points of a stationary feature lie this close to their mean: one in 6 * 10^7 is farther away
 * by chance (exp(-6^2 / 2), Rayleigh distribution). Outliers start a cluster of their own. */
#define REST_SIGMAS 6.0f

/* A feature has moved if its mean at rest differs this much from its mean at the previous rest, in
 * units of the noise of one frame. Means of ten frames have less than half that noise, so this is
 * nine standard deviations of their difference. */
#define MOVED_SIGMAS 4.0f

/* A rest is worth this many times as much as a keyframe of a push that differs as much from its
 * predecessor, since it averages more frames. */
#define REST_NOVELTY 2.0f

void grrl_perception_config_default(struct grrl_perception_config *config)
{
    *config = (struct grrl_perception_config){
        .noise_m = 0.0007f,
        .model_error_m = 0.0001f,
        .keyframe_m = 0.008f,
        .jump_m = 0.015f,
        .table_m = 100.0f,
        .min_turn_rad = 0.035f,
        .min_slide_m = 0.00175f,
        .pivot_scale_m = 0.1f,
        .gap_m = 0.1f,
        .slack = 1.0f,
        .min_features = 4,
        .push_frames = PUSH_FRAMES,
        .static_background = true,
    };
}

void grrl_perception_config_camera(struct grrl_perception_config *config, float pixel_m)
{
    grrl_perception_config_default(config);
    config->noise_m = 1.0f * pixel_m;
    config->model_error_m = 1.2f * pixel_m;
    config->keyframe_m = 4.0f * pixel_m;
    config->jump_m = 50.0f * pixel_m;
    config->table_m = 1e5f * pixel_m;
    config->min_slide_m = 5.0f * pixel_m;
    config->pivot_scale_m = 100.0f * pixel_m;
    config->gap_m = 200.0f * pixel_m;
    config->slack = 5.0f;
    config->static_background = false;
}

static bool positive(float x)
{
    return grrl_is_finite(x) && x > 0.0f;
}

enum grrl_status grrl_perception_init(struct grrl_perception *perception,
                                      const struct grrl_perception_config *config)
{
    if (!positive(config->noise_m) || !positive(config->model_error_m) ||
        !positive(config->keyframe_m) || !positive(config->jump_m) || !positive(config->table_m) ||
        !positive(config->min_turn_rad) || !positive(config->min_slide_m) ||
        !positive(config->pivot_scale_m) || !positive(config->gap_m) ||
        !(grrl_is_finite(config->slack) && config->slack >= 1.0f) || config->min_features < 3 ||
        (!GRRL_PICTURES && !config->static_background))
        return GRRL_ERR_ARGUMENT;
    memset(perception, 0, sizeof *perception);
    perception->config = *config;
    grrl_perception_reset(perception);
    return GRRL_OK;
}

void grrl_perception_reset(struct grrl_perception *perception)
{
    struct grrl_perception_config config = perception->config;
    struct grrl_perception_counts counts = perception->counts;
    memset(perception, 0, sizeof *perception);
    perception->config = config;
    perception->counts = counts;
}

/* Tracks. */

static uint32_t hash_of(int32_t id)
{
    return ((uint32_t)id * 2654435761u) >> 7;
}

static void forget_history(struct grrl_perception *p, uint16_t slot)
{
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        p->keyframe[k].weight[slot] = 0;
    p->window.heap[0][slot].n = 0;
    p->window.heap[1][slot].n = 0;
    p->body_of[slot] = GRRL_FEATURE_NONE;
    p->blob_of[slot] = 0;
    p->jumps[slot] = 0;
}

/* A slot can be reused for another feature if no stored keyframe has seen it. */
static bool slot_is_stale(const struct grrl_perception *p, uint16_t slot)
{
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        if (p->keyframe[k].weight[slot] > 0)
            return false;
    return p->window.heap[0][slot].n == 0 && p->last_frame[slot] + 1 < p->counts.frames;
}

static void rebuild_hash(struct grrl_perception *p)
{
    uint32_t size = (uint32_t)(sizeof p->slot_of_hash / sizeof p->slot_of_hash[0]);
    memset(p->slot_of_hash, 0, sizeof p->slot_of_hash);
    for (uint16_t i = 0; i < p->n_slots; i++) {
        uint32_t h = hash_of(p->id[i]) % size;
        while (p->slot_of_hash[h] != 0)
            h = (h + 1) % size;
        p->slot_of_hash[h] = (uint16_t)(i + 1);
    }
}

/* The slot of a feature, a new one for a new id; false: all slots are in use. */
static bool find_slot(struct grrl_perception *p, int32_t id, uint16_t *slot, bool *is_new)
{
    uint32_t size = (uint32_t)(sizeof p->slot_of_hash / sizeof p->slot_of_hash[0]);
    uint32_t h = hash_of(id) % size;
    *is_new = false;
    while (p->slot_of_hash[h] != 0) {
        if (p->id[p->slot_of_hash[h] - 1] == id) {
            *slot = (uint16_t)(p->slot_of_hash[h] - 1);
            return true;
        }
        h = (h + 1) % size;
    }
    *is_new = true;
    if (p->n_slots < GRRL_MAX_FEATURES) {
        *slot = p->n_slots++;
        p->id[*slot] = id;
        p->slot_of_hash[h] = (uint16_t)(*slot + 1);
    } else {
        uint16_t i = 0;
        while (i < p->n_slots && !slot_is_stale(p, i))
            i++;
        if (i == p->n_slots)
            return false;
        *slot = i;
        p->id[i] = id;
        rebuild_hash(p);
    }
    forget_history(p, *slot);
    return true;
}

/*
 * Whether a point continues its track; counts and drops outliers, restarts a track that stays away.
 * An outlier that passed must not turn the next point into one, so a point may also continue the
 * point before the last.
 */
static bool accept_point(struct grrl_perception *p, uint16_t slot, bool is_new,
                         struct grrl_vec2 point)
{
    if (!is_new) {
        float gap = (float)(p->counts.frames - p->last_frame[slot]);
        float reach = p->config.jump_m * (gap < 2.0f ? gap : 2.0f);
        if (grrl_vec2_distance2(point, p->last[slot]) > reach * reach &&
            grrl_vec2_distance2(point, p->before[slot]) > reach * reach) {
            p->counts.outliers++;
            if (++p->jumps[slot] < JUMPS_UNTIL_NEW)
                return false;
            forget_history(p, slot);
            is_new = true;
        }
    }
    p->jumps[slot] = 0;
    p->before[slot] = is_new ? point : p->last[slot];
    p->last[slot] = point;
    p->last_frame[slot] = p->counts.frames;
    return true;
}

/* Windows and keyframes. */

static void window_clear(struct grrl_perception *p)
{
    memset(&p->window, 0, sizeof p->window);
}

static struct grrl_vec2 mean_of(const struct grrl_perception_sum *sum)
{
    float scale = 1.0f / (float)sum->n;
    return (struct grrl_vec2){sum->x * scale, sum->y * scale};
}

/* The larger cluster: number of points and their mean. */
static uint8_t window_mean(const struct grrl_perception *p, uint16_t slot, struct grrl_vec2 *mean)
{
    const struct grrl_perception_sum *a = &p->window.heap[0][slot];
    const struct grrl_perception_sum *b = &p->window.heap[1][slot];
    const struct grrl_perception_sum *larger = b->n > a->n ? b : a;
    if (larger->n > 0)
        *mean = mean_of(larger);
    return larger->n;
}

/*
 * Adds a point to the cluster it is close to, so that a single point far away does not shift the
 * mean. A point close to neither replaces the second cluster while that is a single point.
 */
static void window_take(struct grrl_perception *p, uint16_t slot, struct grrl_vec2 point)
{
    float reach = p->moving ? p->config.jump_m : REST_SIGMAS * p->config.noise_m;
    for (int h = 0; h < 2; h++) {
        struct grrl_perception_sum *sum = &p->window.heap[h][slot];
        bool near = sum->n > 0 && grrl_vec2_distance2(point, mean_of(sum)) < reach * reach;
        if (near) {
            sum->x += point.x;
            sum->y += point.y;
            sum->n++;
            return;
        }
        if (sum->n == 0 || (h == 1 && sum->n == 1)) {
            *sum = (struct grrl_perception_sum){point.x, point.y, 1};
            return;
        }
    }
}

/* How many features of the window are farther than `distance` from their place in the latest
 * keyframe, from `first` on, that saw them. */
static unsigned moved_since(const struct grrl_perception *p, uint8_t first, float distance)
{
    unsigned moved = 0;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        struct grrl_vec2 mean;
        uint8_t k = p->n_keyframes;
        while (k > first && p->keyframe[k - 1].weight[i] == 0)
            k--;
        if (k > first && window_mean(p, i, &mean) > 0 &&
            grrl_vec2_length(grrl_vec2_sub(mean, p->keyframe[k - 1].point[i])) > distance)
            moved++;
    }
    return moved;
}

/* Whether enough features have moved to start a keyframe. In pictures, where a link may have hardly
 * more than that, those that the last keyframe missed count, too. */
static bool many_have_moved(const struct grrl_perception *p)
{
    uint8_t first = grrl_perception_on_table(p) ? (uint8_t)(p->n_keyframes - 1) : 0;
    return moved_since(p, first, p->config.keyframe_m) >= MOVED_FEATURES;
}

static bool is_in_a_keyframe(const struct grrl_perception *p, uint16_t slot)
{
    for (uint8_t k = p->n_keyframes; k-- > 0;)
        if (p->keyframe[k].weight[slot] > 0)
            return true;
    return false;
}

/* Whether many features of the window are in no keyframe yet: their tracks began during the push.
 */
static bool many_are_new(const struct grrl_perception *p)
{
    unsigned seen = 0;
    unsigned fresh = 0;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        struct grrl_vec2 mean;
        if (window_mean(p, i, &mean) > 0) {
            seen++;
            fresh += is_in_a_keyframe(p, i) ? 0u : 1u;
        }
    }
    return fresh >= MOVED_FEATURES && NEW_SHARE * fresh >= seen;
}

/* The novelty of a keyframe: the sum of squared displacements since its predecessor. */
static float novelty(const struct grrl_perception *p, uint8_t k)
{
    float sum = 0.0f;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        const struct grrl_perception_keyframe *a = &p->keyframe[k - 1];
        const struct grrl_perception_keyframe *b = &p->keyframe[k];
        if (a->weight[i] > 0 && b->weight[i] > 0) {
            struct grrl_vec2 d = grrl_vec2_sub(b->point[i], a->point[i]);
            sum += grrl_vec2_dot(d, d);
        }
    }
    return p->keyframe[k].at_rest ? REST_NOVELTY * sum : sum;
}

/* Makes room by dropping the keyframe with the least novelty, never the first. */
static void thin_keyframes(struct grrl_perception *p)
{
    uint8_t least = 1;
    float least_novelty = novelty(p, 1);
    for (uint8_t k = 2; k < p->n_keyframes; k++) {
        float n = novelty(p, k);
        if (n < least_novelty) {
            least_novelty = n;
            least = k;
        }
    }
    memmove(&p->keyframe[least], &p->keyframe[least + 1],
            (size_t)(p->n_keyframes - least - 1) * sizeof p->keyframe[0]);
    p->n_keyframes--;
    p->counts.thinned++;
}

/*
 * How many points a feature needs in a window of a push. Means over different frames differ by the
 * motion between these, so only features seen in all frames count; if there are hardly any, all
 * count.
 */
static uint8_t points_needed(const struct grrl_perception *p)
{
    unsigned seen = 0;
    unsigned complete = 0;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        struct grrl_vec2 mean;
        uint8_t weight = window_mean(p, i, &mean);
        seen += weight > 0 ? 1u : 0u;
        complete += weight >= p->window.frames ? 1u : 0u;
    }
    return COMPLETE_SHARE * complete >= seen ? p->window.frames : 1;
}

static void store_window(struct grrl_perception *p, struct grrl_perception_keyframe *key,
                         bool at_rest)
{
    memset(key, 0, sizeof *key);
    key->at_rest = at_rest;
    uint8_t least = at_rest ? 1 : points_needed(p);
    for (uint16_t i = 0; i < p->n_slots; i++) {
        uint8_t weight = window_mean(p, i, &key->point[i]);
        key->weight[i] = weight < least ? 0 : weight;
    }
}

static struct grrl_perception_keyframe *new_keyframe(struct grrl_perception *p)
{
    if (p->n_keyframes == GRRL_MAX_KEYFRAMES)
        thin_keyframes(p);
    p->n_keyframes++;
    if (p->n_keyframes > p->counts.keyframes_high)
        p->counts.keyframes_high = p->n_keyframes;
    return &p->keyframe[p->n_keyframes - 1];
}

/* Two rests with no motion between them are one: their averages are combined. */
static bool join_rest(struct grrl_perception *p)
{
    struct grrl_perception_keyframe *key = &p->keyframe[p->n_keyframes - 1];
    float distance = MOVED_SIGMAS * p->config.noise_m;
    if (!key->at_rest || moved_since(p, (uint8_t)(p->n_keyframes - 1), distance) > 0)
        return false;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        struct grrl_vec2 mean;
        float a = (float)key->weight[i];
        float b = (float)window_mean(p, i, &mean);
        if (!(b > 0.0f))
            continue;
        key->point[i] = grrl_vec2_scale(
            grrl_vec2_add(grrl_vec2_scale(key->point[i], a), grrl_vec2_scale(mean, b)),
            1.0f / (a + b));
        key->weight[i] = (uint8_t)(a + b < (float)REST_FRAMES_MAX ? a + b : (float)REST_FRAMES_MAX);
    }
    return true;
}

/* Stores the rest being averaged as the last keyframe, or updates that. */
static void commit_rest(struct grrl_perception *p)
{
    if (p->window.frames == 0)
        return;
    if (p->rest_open) {
        store_window(p, &p->keyframe[p->n_keyframes - 1], true);
    } else if (p->n_keyframes > 0 && join_rest(p)) {
        window_clear(p);
    } else {
        store_window(p, new_keyframe(p), true);
        p->rest_open = true;
    }
}

static void window_add(struct grrl_perception *p, const struct grrl_frame *frame)
{
    for (uint32_t i = 0; i < frame->n; i++) {
        struct grrl_vec2 point = {frame->x_m[i], frame->y_m[i]};
        float limit = p->config.table_m;
        if (!(fabsf(point.x) < limit && fabsf(point.y) < limit)) {
            p->counts.refused++; /* also NaN */
            continue;
        }
        uint16_t slot;
        bool is_new;
        if (!find_slot(p, frame->id[i], &slot, &is_new)) {
            p->counts.overflow++;
            continue;
        }
        if (accept_point(p, slot, is_new, point))
            window_take(p, slot, point);
    }
    p->window.frames++;
    if (p->n_slots > p->counts.features_high)
        p->counts.features_high = p->n_slots;
}

/* At rest no feature leaves its mean. If some do, things are still sliding and averaging starts
 * again. */
static bool still_sliding(const struct grrl_perception *p, const struct grrl_frame *frame)
{
    unsigned away = 0;
    unsigned seen = 0;
    for (uint32_t i = 0; i < frame->n; i++) {
        uint32_t size = (uint32_t)(sizeof p->slot_of_hash / sizeof p->slot_of_hash[0]);
        uint32_t h = hash_of(frame->id[i]) % size;
        while (p->slot_of_hash[h] != 0 && p->id[p->slot_of_hash[h] - 1] != frame->id[i])
            h = (h + 1) % size;
        struct grrl_vec2 mean;
        if (p->slot_of_hash[h] != 0 &&
            window_mean(p, (uint16_t)(p->slot_of_hash[h] - 1), &mean) > 0) {
            struct grrl_vec2 d = {frame->x_m[i] - mean.x, frame->y_m[i] - mean.y};
            seen++;
            away += grrl_vec2_length(d) > REST_SIGMAS * p->config.noise_m ? 1u : 0u;
        }
    }
    return away >= MOVED_FEATURES && away * SLIDING_SHARE > seen;
}

static void observe_rest(struct grrl_perception *p, const struct grrl_frame *frame)
{
    if (p->moving || (!p->rest_open && p->window.frames > 0 && still_sliding(p, frame))) {
        window_clear(p);
        p->moving = false;
        p->rest_open = false;
    }
    if (p->window.frames < REST_FRAMES_MAX)
        window_add(p, frame);
}

static void observe_push(struct grrl_perception *p, const struct grrl_frame *frame)
{
    if (!p->moving) {
        commit_rest(p);
        window_clear(p);
        p->moving = true;
        p->rest_open = false;
    }
    window_add(p, frame);
    if (p->window.frames >= (p->config.push_frames > 0 ? p->config.push_frames : PUSH_FRAMES)) {
        if (p->n_keyframes == 0 || many_have_moved(p) || many_are_new(p))
            store_window(p, new_keyframe(p), false);
        window_clear(p);
    }
}

void grrl_perception_observe(struct grrl_perception *perception, const struct grrl_frame *frame,
                             bool pushing)
{
    perception->counts.frames++;
    if (pushing)
        observe_push(perception, frame);
    else
        observe_rest(perception, frame);
}

enum grrl_status grrl_perception_update(struct grrl_perception *perception)
{
    commit_rest(perception);
    if (perception->n_keyframes == 0 || perception->n_slots == 0)
        return GRRL_ERR_NONE;
    grrl_bodies_update(perception);
    grrl_structure_update(perception);
    return GRRL_OK;
}

const struct grrl_model *grrl_perception_model(const struct grrl_perception *perception)
{
    return &perception->model;
}
