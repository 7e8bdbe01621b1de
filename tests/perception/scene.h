/*
 * scene.h: writes keyframes of bodies with known motion directly into perception, and offers the
 * double-precision helpers that the slow references of these tests share. Include after cmocka.h.
 *
 * Random tests take their seed from the environment variable GRRL_TEST_SEED, or a fixed one, and
 * print it at the start.
 */
#ifndef GRRL_TESTS_SCENE_H
#define GRRL_TESTS_SCENE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "grrl/base/random.h"
#include "perception/perception_internal.h"

struct point {
    double x;
    double y;
};

/* Rotates by the angle with cosine c and sine s, then translates by p. */
struct placed {
    struct point p;
    double c;
    double s;
};

static struct grrl_perception scene;
static struct grrl_random scene_random;

/* The truth: the pose of each body in each keyframe, and each feature's place on its body. */
static struct placed scene_body[GRRL_MAX_KEYFRAMES][GRRL_MAX_LINKS];
static struct point scene_shape[GRRL_MAX_FEATURES];

static inline void scene_seed(const char *test)
{
    const char *given = getenv("GRRL_TEST_SEED");
    uint64_t seed = given != NULL ? strtoull(given, NULL, 10) : 20080625u;
    print_message("%s: GRRL_TEST_SEED=%llu\n", test, (unsigned long long)seed);
    grrl_random_init(&scene_random, seed, 5);
}

static inline double scene_uniform(double low, double high)
{
    return low + (high - low) * (double)grrl_random_uniform(&scene_random);
}

/* A random integer from low to high, inclusive. */
static inline int scene_int(int low, int high)
{
    return low + (int)grrl_random_below(&scene_random, (uint32_t)(high - low + 1));
}

static inline bool scene_chance(double probability)
{
    return scene_uniform(0.0, 1.0) < probability;
}

static inline double scene_normal(void)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++)
        sum += scene_uniform(0.0, 1.0);
    return sum;
}

static inline struct point point_of(struct grrl_vec2 v)
{
    return (struct point){(double)v.x, (double)v.y};
}

static inline struct placed placed_of(struct grrl_pose pose)
{
    return (struct placed){point_of(pose.p), (double)pose.c, (double)pose.s};
}

static inline struct placed place(double x, double y, double angle)
{
    return (struct placed){{x, y}, cos(angle), sin(angle)};
}

static inline struct point minus(struct point a, struct point b)
{
    return (struct point){a.x - b.x, a.y - b.y};
}

static inline double square(struct point a)
{
    return a.x * a.x + a.y * a.y;
}

static inline struct point to_world(struct placed at, struct point local)
{
    return (struct point){at.p.x + at.c * local.x - at.s * local.y,
                          at.p.y + at.s * local.x + at.c * local.y};
}

static inline struct point to_local(struct placed at, struct point world)
{
    struct point d = minus(world, at.p);
    return (struct point){at.c * d.x + at.s * d.y, at.c * d.y - at.s * d.x};
}

/* The pose of b in the frame of a. */
static inline struct placed seen_from(struct placed a, struct placed b)
{
    return (struct placed){to_local(a, b.p), a.c * b.c + a.s * b.s, a.c * b.s - a.s * b.c};
}

/* Applies a, then b in the frame of a. */
static inline struct placed then(struct placed a, struct placed b)
{
    return (struct placed){to_world(a, b.p), a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
}

/* An empty table with keyframes that see nothing; the first and every third are at rest. Returns
 * how many there are: as many as asked for, where they fit. */
static inline int scene_start(int n_keyframes)
{
    n_keyframes = n_keyframes < GRRL_MAX_KEYFRAMES ? n_keyframes : GRRL_MAX_KEYFRAMES;
    memset(&scene, 0, sizeof scene);
    scene.config = (struct grrl_perception_config){.noise_m = 0.0007f,
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
                                                   .static_background = true};
    scene.n_keyframes = (uint8_t)n_keyframes;
    for (int k = 0; k < n_keyframes; k++) {
        scene.keyframe[k].at_rest = k % 3 == 0;
        for (int b = 0; b < GRRL_MAX_LINKS; b++)
            scene_body[k][b] = place(0.0, 0.0, 0.0);
    }
    return n_keyframes;
}

static inline uint16_t scene_add_feature(uint8_t body, double x, double y)
{
    uint16_t slot = scene.n_slots++;
    scene.id[slot] = 1000 - 3 * slot;
    scene.body_of[slot] = body;
    scene_shape[slot] = (struct point){x, y};
    return slot;
}

/* Adds a link of 130 mm with n features; returns the index of the body, the last one. */
static inline uint8_t scene_add_body(int n)
{
    uint8_t body = scene.n_bodies++;
    scene.number[body] = ++scene.n_numbers;
    for (int i = 0; i < n; i++)
        (void)scene_add_feature(body, scene_uniform(-0.065, 0.065), scene_uniform(-0.02, 0.02));
    return body;
}

/* Moves a body in a random walk: steps of at most this many metres and radians. */
static inline void scene_wander(int body, double shift, double turn)
{
    double x = scene_uniform(-0.3, 0.3);
    double y = scene_uniform(-0.3, 0.3);
    double angle = scene_uniform(-3.0, 3.0);
    for (int k = 0; k < scene.n_keyframes; k++) {
        scene_body[k][body] = place(x, y, angle);
        x += scene_uniform(-shift, shift);
        y += scene_uniform(-shift, shift);
        angle += scene_uniform(-turn, turn);
    }
}

/* Fills the keyframes. Features are missing at random; the others are averages of 1 to 60 frames
 * with `noise` times the configured noise. Features of no body stay in place. */
static inline void scene_see(double noise, double missing)
{
    for (int k = 0; k < scene.n_keyframes; k++) {
        for (int i = 0; i < scene.n_slots; i++) {
            uint8_t body = scene.body_of[i];
            bool in_body = body < scene.n_bodies;
            struct point at =
                in_body ? to_world(scene_body[k][body], scene_shape[i]) : scene_shape[i];
            uint8_t w = (uint8_t)(scene.keyframe[k].at_rest ? scene_int(5, 60) : scene_int(1, 3));
            double sd = noise * (double)scene.config.noise_m / sqrt((double)w);
            scene.keyframe[k].weight[i] = scene_chance(missing) ? 0 : w;
            scene.keyframe[k].point[i] = (struct grrl_vec2){(float)(at.x + sd * scene_normal()),
                                                            (float)(at.y + sd * scene_normal())};
            scene.last[i] = scene.keyframe[k].point[i];
        }
    }
}

static inline void scene_fit(void)
{
    for (uint8_t b = 0; b < scene.n_bodies; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = grrl_rigid_slots(&scene, b, slots);
        grrl_rigid_fit(&scene, slots, n, scene.shape, &scene.pose[0][b], GRRL_MAX_LINKS);
    }
}

/* The two variances used as the unit of all errors. */
static inline double noise_square(void)
{
    return (double)scene.config.noise_m * (double)scene.config.noise_m;
}

static inline double variance_of(int weight)
{
    double model = (double)scene.config.model_error_m;
    return noise_square() / weight + model * model;
}

static inline struct point seen_at(int k, int slot)
{
    return point_of(scene.keyframe[k].point[slot]);
}

/* The keyframe that saw most of these features; a feature counts as much as 1,000 frames averaged.
 */
static inline int scene_reference(const uint16_t *slots, int n)
{
    int best = 0;
    int best_seen = 0;
    for (int k = 0; k < scene.n_keyframes; k++) {
        int seen = 0;
        for (int i = 0; i < n; i++)
            if (scene.keyframe[k].weight[slots[i]] > 0)
                seen += 1000 + scene.keyframe[k].weight[slots[i]];
        if (seen > best_seen) {
            best = k;
            best_seen = seen;
        }
    }
    return best;
}

static inline bool is_near(double a, double b, double tolerance)
{
    return fabs(a - b) <= tolerance * fmax(1.0, fmax(fabs(a), fabs(b)));
}

#define assert_near(a, b, tolerance)                                                               \
    do {                                                                                           \
        double near_a = (double)(a);                                                               \
        double near_b = (double)(b);                                                               \
        if (!is_near(near_a, near_b, (tolerance)))                                                 \
            fail_msg("%s:%d: " #a " is %.9g instead of %.9g", __FILE__, __LINE__, near_a, near_b); \
    } while (0)

/* Compares positions, in metres. */
#define assert_at(a, b, tolerance_m)                                                               \
    do {                                                                                           \
        struct point at_a = point_of(a);                                                           \
        struct point at_b = (b);                                                                   \
        if (!(square(minus(at_a, at_b)) <= (tolerance_m) * (tolerance_m)))                         \
            fail_msg("%s:%d: " #a " is (%.9g, %.9g) instead of (%.9g, %.9g)", __FILE__, __LINE__,  \
                     at_a.x, at_a.y, at_b.x, at_b.y);                                              \
    } while (0)

#endif
