/* slow_near.h: whether bodies are near their joint (joint_place.c), in double precision, with
 * distances sorted and extremes listed. */
#ifndef TESTS_PERCEPTION_SLOW_NEAR_H
#define TESTS_PERCEPTION_SLOW_NEAR_H

#include "scene.h"

/* How near a decision of the slow way was to the other side, relative: then rounding decides. */
static double doubt;

static bool above(double a, double b)
{
    doubt = fmin(doubt, fabs(a - b) / fmax(fmax(fabs(a), fabs(b)), 1e-9));
    return a > b;
}

struct slow_fit {
    double excess;
    bool excited;
    double lower;
    double upper;
    struct point in_a;
    struct point in_b;
    struct point axis;
    double point_variance;
    double axis_variance;
    bool determined; /* well enough for single precision */
};

/* From its middle to its farthest feature. */
static double slow_half_extent(int body)
{
    double far2 = 0.0;
    for (int i = 0; i < scene.n_slots; i++)
        if (scene.body_of[i] == body)
            far2 = fmax(far2, square(point_of(scene.shape[i])));
    return sqrt(far2);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* To the third nearest feature of a body. */
static double slow_distance(int body, struct point local)
{
    double distance[GRRL_MAX_FEATURES];
    int n = 0;
    for (int i = 0; i < scene.n_slots; i++)
        if (scene.body_of[i] == body)
            distance[n++] = sqrt(square(minus(point_of(scene.shape[i]), local)));
    qsort(distance, (size_t)n, sizeof distance[0], by_size);
    return n >= 3 ? distance[2] : sqrt(1e9);
}

static double slow_gap(int a, int b, int k)
{
    double best = 1e9;
    for (int i = 0; i < scene.n_slots; i++) {
        struct point world = to_world(placed_of(scene.pose[k][b].pose), point_of(scene.shape[i]));
        if (scene.body_of[i] == b)
            best = fmin(best, slow_distance(a, to_local(placed_of(scene.pose[k][a].pose), world)));
    }
    return best;
}

/* Whether body c holds the pivot: it lies nearer than `far` when both were seen last, and the pivot
 * stayed within a link's width there, unless it is far away from everything. */
static bool slow_holds(int c, int a, struct point in_a, double far)
{
    struct point at[GRRL_MAX_KEYFRAMES];
    double gap = (double)scene.config.gap_m;
    double strayed = 0.0;
    int n = 0;
    for (int k = 0; k < scene.n_keyframes; k++) {
        if (!(scene.pose[k][a].weight > 0.0f) || !(scene.pose[k][c].weight > 0.0f))
            continue;
        struct point pivot = to_world(placed_of(scene.pose[k][a].pose), in_a);
        at[n] = to_local(placed_of(scene.pose[k][c].pose), pivot);
        strayed = fmax(strayed, sqrt(square(minus(at[n], at[0]))));
        n++;
    }
    if (n == 0)
        return false;
    bool passes_by = above(strayed, 0.2 * gap) && !above(far, 1.5 * gap);
    return above(far, slow_distance(c, at[n - 1])) && !passes_by;
}

static bool slow_lies_between(int a, int b, struct point in_a, double far)
{
    bool held = false;
    for (int c = 0; c < scene.n_bodies; c++)
        held = (c != a && c != b && slow_holds(c, a, in_a, far)) || held;
    return held;
}

/* Whether a further body is closer to both than `far` in keyframe k. */
static bool slow_stands_between(int a, int b, int k, double far)
{
    bool stands = false;
    for (int c = 0; c < scene.n_bodies; c++)
        if (c != a && c != b && scene.pose[k][c].weight > 0.0f)
            stands = (above(far, slow_gap(a, c, k)) && above(far, slow_gap(b, c, k))) || stands;
    return stands;
}

/* Whether a and b are near the joint that their motion suggests. */
static bool slow_is_near(int a, int b, bool revolute, const struct slow_fit *fit, double support)
{
    double gap = (double)scene.config.gap_m;
    if (revolute) {
        double da = slow_distance(a, fit->in_a);
        double db = slow_distance(b, fit->in_b);
        bool near = !above(fmax(da, db), gap);
        bool certain = above(support, 30.0);
        bool reached = !above(da, gap + 1.5 * slow_half_extent(a)) &&
                       !above(db, gap + 1.5 * slow_half_extent(b));
        return near || (certain && reached && !slow_lies_between(a, b, fit->in_a, fmax(da, db)));
    }
    bool near = true;
    double far = above(support, 30.0) ? slow_half_extent(a) + slow_half_extent(b) : 0.0;
    gap += fit->upper - fit->lower;
    for (int k = 0; k < scene.n_keyframes; k++) {
        bool both = scene.pose[k][a].weight > 0.0f && scene.pose[k][b].weight > 0.0f;
        if (both && scene.keyframe[k].at_rest) {
            double d = slow_gap(a, b, k);
            bool reached = !above(d, gap + far);
            near = (!above(d, gap) || (reached && !slow_stands_between(a, b, k, d))) && near;
        }
    }
    return near;
}

#endif
