/*
 * geometry.h: planar vectors, poses and the few mathematical functions the library needs.
 *
 * Single precision, built only from + - * / and the correctly rounded square root, so every machine
 * computes the same bits. (C libraries differ in the last bit of sinf and atan2f.)
 */
#ifndef GRRL_GEOMETRY_H
#define GRRL_GEOMETRY_H

#include <stdbool.h>

#include "grrl/base/api.h"

GRRL_API_BEGIN

#define GRRL_PI 3.14159265358979f

struct grrl_vec2 {
    float x;
    float y;
};

/* Rotates by the angle with cosine c and sine s, then translates by p: world = R local + p. */
struct grrl_pose {
    struct grrl_vec2 p;
    float c;
    float s;
};

/* Absolute error below 3e-7 for |angle| <= 100 rad (NaN beyond 8192 rad) and 4e-7 rad for atan2;
 * relative error 1e-6 for exp and log. exp saturates at 0 (below FLT_MIN) and at FLT_MAX; log of
 * zero or less is -FLT_MAX; atan2 of two zeros is 0. */
float grrl_sin(float angle_rad);
float grrl_cos(float angle_rad);
float grrl_atan2(float y, float x);
float grrl_exp(float x);
float grrl_log(float x);
float grrl_sqrt(float x);

bool grrl_is_finite(float x);

/* Inline, for they are called more often than anything else. A caller who wants the library's bits
 * from them compiles with -ffp-contract=off, as the library does. */

static inline struct grrl_vec2 grrl_vec2_add(struct grrl_vec2 a, struct grrl_vec2 b)
{
    struct grrl_vec2 result = {a.x + b.x, a.y + b.y};
    return result;
}

static inline struct grrl_vec2 grrl_vec2_sub(struct grrl_vec2 a, struct grrl_vec2 b)
{
    struct grrl_vec2 result = {a.x - b.x, a.y - b.y};
    return result;
}

static inline struct grrl_vec2 grrl_vec2_scale(struct grrl_vec2 a, float factor)
{
    struct grrl_vec2 result = {a.x * factor, a.y * factor};
    return result;
}

static inline float grrl_vec2_dot(struct grrl_vec2 a, struct grrl_vec2 b)
{
    return a.x * b.x + a.y * b.y;
}

static inline float grrl_vec2_cross(struct grrl_vec2 a, struct grrl_vec2 b)
{
    return a.x * b.y - a.y * b.x;
}

static inline float grrl_vec2_length(struct grrl_vec2 a)
{
    return grrl_sqrt(grrl_vec2_dot(a, a));
}

static inline struct grrl_vec2 grrl_rotate(struct grrl_pose pose, struct grrl_vec2 local)
{
    struct grrl_vec2 result = {pose.c * local.x - pose.s * local.y,
                               pose.s * local.x + pose.c * local.y};
    return result;
}

static inline struct grrl_vec2 grrl_unrotate(struct grrl_pose pose, struct grrl_vec2 world)
{
    struct grrl_vec2 result = {pose.c * world.x + pose.s * world.y,
                               pose.c * world.y - pose.s * world.x};
    return result;
}

static inline struct grrl_vec2 grrl_transform(struct grrl_pose pose, struct grrl_vec2 local)
{
    return grrl_vec2_add(grrl_rotate(pose, local), pose.p);
}

static inline struct grrl_vec2 grrl_untransform(struct grrl_pose pose, struct grrl_vec2 world)
{
    return grrl_unrotate(pose, grrl_vec2_sub(world, pose.p));
}

/* Wraps the angle into (-pi, pi]; NaN beyond 8192 rad. */
float grrl_wrap_rad(float angle_rad);

/*
 * The principal axes of the symmetric 2 x 2 matrix (xx, xy; xy, yy). *major >= *minor are the
 * eigenvalues. *axis is the unit eigenvector of *major, with axis.x > 0 or axis = (0, 1). It is (1,
 * 0) if the eigenvalues are equal, or if the numbers are too large or too small to tell them apart.
 */
void grrl_principal_axes(float xx, float xy, float yy, float *major, float *minor,
                         struct grrl_vec2 *axis);

GRRL_API_END

#endif
