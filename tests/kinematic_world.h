/*
 * kinematic_world.h: a world without physics, for the tests of perception. Links lie in a plane,
 * the test moves their joints, and perception sees noisy points.
 */
#ifndef GRRL_TEST_KINEMATIC_WORLD_H
#define GRRL_TEST_KINEMATIC_WORLD_H

#include <math.h>
#include <string.h>

#include "grrl/grrl.h"

enum { WORLD_LINKS = GRRL_MAX_LINKS, WORLD_POINTS = GRRL_MAX_FEATURES };

struct kinematic_world {
    struct grrl_random random;
    float noise_m;
    float length_m;
    int n_links;
    int parent[WORLD_LINKS]; /* -1: a root */
    char joint[WORLD_LINKS]; /* joint with the parent, 'R' or 'P'; 0 for a root */
    float q[WORLD_LINKS];
    float anchor_m[WORLD_LINKS]; /* where on the parent's axis the link is joined */
    struct grrl_pose root[WORLD_LINKS];
    float root_angle[WORLD_LINKS];
    struct grrl_pose pose[WORLD_LINKS];
    int n_points;
    int body[WORLD_POINTS]; /* -1: background */
    struct grrl_vec2 local[WORLD_POINTS];
    int32_t id[WORLD_POINTS];
    float missing;  /* share of points not seen in a frame */
    float outliers; /* share of points up to 5 cm away */
    float x[WORLD_POINTS];
    float y[WORLD_POINTS];
    int32_t seen[WORLD_POINTS];
};

static inline float world_normal(struct kinematic_world *w)
{
    float sum = -6.0f;
    for (int i = 0; i < 12; i++)
        sum += grrl_random_uniform(&w->random);
    return sum;
}

static inline float world_uniform(struct kinematic_world *w, float low, float high)
{
    return low + (high - low) * grrl_random_uniform(&w->random);
}

static inline void world_init(struct kinematic_world *w, uint64_t seed)
{
    memset(w, 0, sizeof *w);
    grrl_random_init(&w->random, seed, 7);
    w->noise_m = 0.0007f;
    w->length_m = 0.13f;
}

static inline int world_add_point(struct kinematic_world *w, int body, float x, float y)
{
    w->body[w->n_points] = body;
    w->local[w->n_points] = (struct grrl_vec2){x, y};
    w->id[w->n_points] = (int32_t)w->n_points;
    return w->n_points++;
}

/* Adds a link of length_m with 8 to 13 random features. Its near end is attached to the parent's
 * far end unless anchor_m is changed. */
static inline int world_add_link(struct kinematic_world *w, int parent, char joint)
{
    int link = w->n_links++;
    w->parent[link] = parent;
    w->joint[link] = joint;
    w->anchor_m[link] = w->length_m / 2;
    w->q[link] = joint == 'R' ? world_uniform(w, -0.3f, 0.3f) : 0.0f;
    int n = 8 + (int)grrl_random_below(&w->random, 6);
    for (int i = 0; i < n; i++) {
        float x = w->length_m * (((float)i + world_uniform(w, 0.0f, 1.0f)) / (float)n - 0.5f);
        (void)world_add_point(w, link, x, world_uniform(w, -0.0175f, 0.0175f));
    }
    return link;
}

static inline void world_add_chain(struct kinematic_world *w, const char *joints, float x, float y)
{
    int last = world_add_link(w, -1, 0);
    w->root[last].p = (struct grrl_vec2){x, y};
    for (const char *j = joints; *j != '\0'; j++)
        last = world_add_link(w, last, *j);
}

static inline void world_add_background(struct kinematic_world *w, int n)
{
    for (int i = 0; i < n; i++)
        (void)world_add_point(w, -1, world_uniform(w, -1.0f, 1.0f), world_uniform(w, -0.8f, 0.8f));
}

/* Shuffles ids, so that they say nothing about the body. */
static inline void world_shuffle_ids(struct kinematic_world *w)
{
    for (int i = w->n_points - 1; i > 0; i--) {
        int j = (int)grrl_random_below(&w->random, (uint32_t)i + 1);
        int32_t t = w->id[i];
        w->id[i] = w->id[j];
        w->id[j] = t;
    }
}

static inline void world_poses(struct kinematic_world *w)
{
    for (int i = 0; i < w->n_links; i++) {
        if (w->parent[i] < 0) {
            w->pose[i] = w->root[i];
            w->pose[i].c = cosf(w->root_angle[i]);
            w->pose[i].s = sinf(w->root_angle[i]);
            continue;
        }
        struct grrl_pose parent = w->pose[w->parent[i]];
        float angle = w->joint[i] == 'R' ? w->q[i] : 0.0f;
        float slide = w->joint[i] == 'P' ? w->q[i] : 0.0f;
        struct grrl_pose pose = {.c = parent.c * cosf(angle) - parent.s * sinf(angle),
                                 .s = parent.s * cosf(angle) + parent.c * sinf(angle)};
        struct grrl_vec2 hinge =
            grrl_transform(parent, (struct grrl_vec2){w->anchor_m[i] + slide, 0.0f});
        pose.p = grrl_vec2_add(hinge, grrl_rotate(pose, (struct grrl_vec2){w->length_m / 2, 0.0f}));
        w->pose[i] = pose;
    }
}

static inline struct grrl_frame world_frame(struct kinematic_world *w)
{
    world_poses(w);
    uint32_t n = 0;
    for (int i = 0; i < w->n_points; i++) {
        if (grrl_random_uniform(&w->random) < w->missing)
            continue;
        struct grrl_vec2 at =
            w->body[i] < 0 ? w->local[i] : grrl_transform(w->pose[w->body[i]], w->local[i]);
        w->seen[n] = w->id[i];
        w->x[n] = at.x + w->noise_m * world_normal(w);
        w->y[n] = at.y + w->noise_m * world_normal(w);
        if (w->outliers > 0.0f && grrl_random_uniform(&w->random) < w->outliers) {
            w->x[n] += world_uniform(w, -0.05f, 0.05f);
            w->y[n] += world_uniform(w, -0.05f, 0.05f);
        }
        n++;
    }
    return (struct grrl_frame){n, w->seen, w->x, w->y};
}

static inline void world_rest(struct kinematic_world *w, struct grrl_perception *p, int frames)
{
    for (int i = 0; i < frames; i++) {
        struct grrl_frame frame = world_frame(w);
        grrl_perception_observe(p, &frame, false);
    }
}

/* Moves joints and root by these amounts in 120 frames, then rests. */
static inline void world_move(struct kinematic_world *w, struct grrl_perception *p, const float *dq,
                              struct grrl_vec2 shift, float turn)
{
    for (int f = 0; f < 120; f++) {
        for (int i = 0; i < w->n_links; i++)
            w->q[i] += dq[i] / 120;
        w->root[0].p = grrl_vec2_add(w->root[0].p, grrl_vec2_scale(shift, 1.0f / 120));
        w->root_angle[0] += turn / 120;
        struct grrl_frame frame = world_frame(w);
        grrl_perception_observe(p, &frame, true);
    }
    world_rest(w, p, GRRL_SETTLING_FRAMES);
}

static inline enum grrl_status world_push(struct kinematic_world *w, struct grrl_perception *p,
                                          const float *dq, struct grrl_vec2 shift, float turn)
{
    world_move(w, p, dq, shift, turn);
    return grrl_perception_update(p);
}

#endif
