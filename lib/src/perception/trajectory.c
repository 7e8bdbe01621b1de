/*
 * trajectory.c: fits a circle and a line to the path of one point.
 */
#include "grrl/perception/trajectory.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "grrl/base/geometry.h"
#include "perception/trajectory_evidence.h"

/* Coordinates beyond this are refused, and radii are limited to it: the squares of both stay far
 * from the limits of a float. */
#define FARTHEST_M 1000.0f

/* Positions that scatter by less count as one place: a float resolves no finer part of a metre. */
#define STILL_M 1e-6f

/* A sample this far from the running median is an outlier: noise alone gets there about 4 times in
 * 10^6. */
#define OUTLIER_SIGMAS 5.0f

/* Residual with weight one half (Cauchy's loss): noise reaches it once in 370 samples, so the fit
 * loses little efficiency. */
#define CAUCHY_SIGMAS 3.0f

/* Lower bounds for squared quantities under a root, which only rounding makes negative, and for 1 +
 * 4 a d of a curve that exists. */
#define LEAST_SQUARE 1e-6f
#define LEAST_EXISTING 1e-3f

/* Marquardt's (1963) damping: the initial value, and the factors after a good and a bad step. A
 * step that lowers the loss by a smaller share than CONVERGED is the last. */
#define FIRST_DAMPING 1e-3f
#define LESS_DAMPING 0.1f
#define MORE_DAMPING 10.0f
#define CONVERGED 1e-5f

#define LEAST_PIVOT 1e-12f /* added to the diagonal to avoid division by zero */

enum {
    WINDOW = 2, /* samples before and after in the running median, which outvotes two outliers */
    MAX_STEPS = 25,   /* of the fit; it converges in about ten */
    MAX_DAMPINGS = 8, /* tried per step: up to 10^8 times the first */
    SWEEPS = 8        /* of Jacobi's method, which converges quadratically: four would be enough */
};

/* A trajectory in its plane: u and v are its two main axes, w is normal to them. */
struct view {
    const struct grrl_trajectory *trajectory;
    float outlier_m;
    float noise_m;
    float origin[3];
    float u[3];
    float v[3];
    float w[3];
};

/*
 * A circle or a line in Chernov and Lesort's parameters: the points with a |p|^2 + e (p . n) + d =
 * 0, where n = (cos, sin) of the angle and e^2 = 1 + 4 a d. a is half the curvature, 0 for a line;
 * then n is its normal and -d its distance from the origin.
 */
struct curve {
    float a;
    float d;
    float angle;
};

/* The normal equations of a step, and the loss at the point where they were set up. */
struct normal {
    float h[3][3];
    float g[3];
    float loss; /* mean over the samples, in units of the variance */
    float residual2;
    float weight;
};

void grrl_trajectory_config_default(struct grrl_trajectory_config *config)
{
    *config = (struct grrl_trajectory_config){
        .noise_m = 0.01f, .radius_m = 0.3f, .play_rad = 0.09f, .decided = 2.0f / 3.0f};
}

/* --- samples ---------------------------------------------------------------------------------- */

static float coordinate(const struct grrl_trajectory *t, uint32_t i, uint8_t axis)
{
    return axis < t->dimensions ? t->rows_m[(size_t)i * t->dimensions + axis] : 0.0f;
}

/* The median along one axis of a sample and its neighbours in time, at most WINDOW on each side and
 * equally many. */
static float running_median(const struct grrl_trajectory *t, uint32_t i, uint8_t axis)
{
    float sorted[2 * WINDOW + 1];
    uint32_t reach = i < t->n - 1 - i ? i : t->n - 1 - i;
    reach = reach < WINDOW ? reach : WINDOW;
    unsigned n = 0;
    for (uint32_t j = i - reach; j <= i + reach; j++) {
        float value = coordinate(t, j, axis);
        unsigned k = n++;
        for (; k > 0 && sorted[k - 1] > value; k--)
            sorted[k] = sorted[k - 1];
        sorted[k] = value;
    }
    return sorted[reach];
}

/* Whether a sample is close to its neighbours. */
static bool is_kept(const struct view *view, uint32_t i)
{
    float sum = 0.0f;
    for (uint8_t axis = 0; axis < view->trajectory->dimensions; axis++) {
        float away =
            coordinate(view->trajectory, i, axis) - running_median(view->trajectory, i, axis);
        sum += away * away;
    }
    return sum <= view->outlier_m * view->outlier_m;
}

static float dot3(const float *a, const float *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void offset_from_origin(const struct view *view, uint32_t i, float *offset)
{
    for (uint8_t axis = 0; axis < 3; axis++)
        offset[axis] = coordinate(view->trajectory, i, axis) - view->origin[axis];
}

static struct grrl_vec2 project(const struct view *view, uint32_t i)
{
    float offset[3];
    offset_from_origin(view, i, offset);
    return (struct grrl_vec2){dot3(offset, view->u), dot3(offset, view->v)};
}

/* --- the plane -------------------------------------------------------------------------------- */

/* One Jacobi rotation that makes m[p][q] zero, also applied to the columns of `axes`. */
static void jacobi_rotate(float m[3][3], float axes[3][3], int p, int q)
{
    if (m[p][q] == 0.0f)
        return;
    float ratio = (m[q][q] - m[p][p]) / (2.0f * m[p][q]);
    float t = 1.0f / ((ratio < 0.0f ? -ratio : ratio) + grrl_sqrt(ratio * ratio + 1.0f));
    t = ratio < 0.0f ? -t : t;
    float c = 1.0f / grrl_sqrt(t * t + 1.0f);
    float s = t * c;
    for (int i = 0; i < 3; i++) {
        float mip = m[i][p];
        float miq = m[i][q];
        m[i][p] = c * mip - s * miq;
        m[i][q] = s * mip + c * miq;
        float aip = axes[i][p];
        float aiq = axes[i][q];
        axes[i][p] = c * aip - s * aiq;
        axes[i][q] = s * aip + c * aiq;
    }
    for (int i = 0; i < 3; i++) {
        float mpi = m[p][i];
        float mqi = m[q][i];
        m[p][i] = c * mpi - s * mqi;
        m[q][i] = s * mpi + c * mqi;
    }
}

/* Sets u, v and w from a covariance, in order of decreasing spread, right-handed. */
static void main_axes(float m[3][3], struct view *view)
{
    float axes[3][3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        jacobi_rotate(m, axes, 0, 1);
        jacobi_rotate(m, axes, 0, 2);
        jacobi_rotate(m, axes, 1, 2);
    }
    int first = m[1][1] > m[0][0] ? 1 : 0;
    first = m[2][2] > m[first][first] ? 2 : first;
    int second = first == 0 ? 1 : 0;
    int third = 3 - first - second;
    if (m[third][third] > m[second][second])
        second = third;
    for (int i = 0; i < 3; i++) {
        view->u[i] = axes[i][first];
        view->v[i] = axes[i][second];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;
        view->w[i] = view->u[j] * view->v[k] - view->u[k] * view->v[j];
    }
}

/* Moves the origin to the mean of the kept samples and counts them. */
static uint32_t find_origin(struct view *view)
{
    uint32_t n = 0;
    float sum[3] = {0.0f};
    for (uint8_t axis = 0; axis < 3; axis++)
        view->origin[axis] = coordinate(view->trajectory, view->trajectory->n / 2, axis);
    for (uint32_t i = 0; i < view->trajectory->n; i++) {
        if (is_kept(view, i)) {
            float offset[3];
            offset_from_origin(view, i, offset);
            for (uint8_t axis = 0; axis < 3; axis++)
                sum[axis] += offset[axis];
            n++;
        }
    }
    for (uint8_t axis = 0; axis < 3 && n > 0; axis++)
        view->origin[axis] += sum[axis] / (float)n;
    return n;
}

/* Origin and axes of the kept samples; false: apart from rounding they are all in one place. */
static bool find_plane(struct view *view, struct grrl_trajectory_fit *fit)
{
    float spread[3][3] = {{0.0f}};
    float turned[3][3];
    uint32_t n = find_origin(view);
    fit->outliers = view->trajectory->n - n;
    for (uint32_t i = 0; i < view->trajectory->n; i++) {
        if (is_kept(view, i)) {
            float offset[3];
            offset_from_origin(view, i, offset);
            for (int k = 0; k < 9; k++)
                spread[k / 3][k % 3] += offset[k / 3] * offset[k % 3];
        }
    }
    if (!(spread[0][0] + spread[1][1] + spread[2][2] > STILL_M * STILL_M * (float)n))
        return false;
    memcpy(turned, spread, sizeof turned);
    main_axes(turned, view);
    float across = 0.0f;
    for (int a = 0; a < 3; a++)
        across += view->w[a] * dot3(spread[a], view->w);
    fit->out_of_plane_m = grrl_sqrt(across > 0.0f ? across / (float)n : 0.0f);
    return true;
}

/* --- fitting ---------------------------------------------------------------------------------- */

/* The signed distance of a point from a curve and, unless NULL, its derivatives with respect to a,
 * d and angle. */
static float distance(const struct curve *curve, struct grrl_vec2 p, float *derivative)
{
    float c = grrl_cos(curve->angle);
    float s = grrl_sin(curve->angle);
    float e2 = 1.0f + 4.0f * curve->a * curve->d;
    float e = grrl_sqrt(e2 > LEAST_SQUARE ? e2 : LEAST_SQUARE);
    float square = grrl_vec2_dot(p, p);
    float along = c * p.x + s * p.y;
    float power = curve->a * square + e * along + curve->d;
    float root2 = 1.0f + 4.0f * curve->a * power;
    float root = grrl_sqrt(root2 > LEAST_SQUARE ? root2 : LEAST_SQUARE);
    float result = 2.0f * power / (1.0f + root);
    if (derivative != NULL) {
        /* power = r + a r^2 for the distance r, and root = 1 + 2 a r */
        derivative[0] = (square + 2.0f * curve->d / e * along - result * result) / root;
        derivative[1] = (1.0f + 2.0f * curve->a / e * along) / root;
        derivative[2] = e * (c * p.y - s * p.x) / root;
    }
    return result;
}

/* The loss of a curve; with `step`, also the normal equations of a Gauss-Newton step. */
static void evaluate(const struct view *view, const struct curve *curve, bool step,
                     struct normal *normal)
{
    float reach2 = CAUCHY_SIGMAS * CAUCHY_SIGMAS * view->noise_m * view->noise_m;
    uint32_t n = 0;
    memset(normal, 0, sizeof *normal);
    for (uint32_t i = 0; i < view->trajectory->n; i++) {
        if (!is_kept(view, i))
            continue;
        float j[3];
        float r = distance(curve, project(view, i), step ? j : NULL);
        float weight = 1.0f / (1.0f + r * r / reach2);
        normal->loss += CAUCHY_SIGMAS * CAUCHY_SIGMAS * grrl_log(1.0f + r * r / reach2);
        normal->residual2 += weight * r * r;
        normal->weight += weight;
        n++;
        for (int k = 0; k < 9 && step; k++) {
            normal->h[k / 3][k % 3] += weight * j[k / 3] * j[k % 3];
            normal->g[k / 3] -= k % 3 == 0 ? weight * j[k / 3] * r : 0.0f;
        }
    }
    normal->loss /= (float)n;
}

/* Solves (h + damping diag h) x = g in the unknowns from `first` on; the others stay zero. */
static void solve_damped(const struct normal *normal, float damping, int first, float *x)
{
    float m[3][4];
    memset(x, 0, 3 * sizeof *x);
    for (int i = first; i < 3; i++) {
        memcpy(m[i], normal->h[i], sizeof normal->h[i]);
        m[i][i] += damping * m[i][i] + LEAST_PIVOT;
        m[i][3] = normal->g[i];
    }
    for (int i = first; i < 3; i++) { /* symmetric and positive: no pivoting */
        for (int r = i + 1; r < 3; r++) {
            float factor = m[r][i] / m[i][i];
            for (int c = i; c < 4; c++)
                m[r][c] -= factor * m[i][c];
        }
    }
    for (int i = 2; i >= first; i--) {
        x[i] = m[i][3];
        for (int c = i + 1; c < 3; c++)
            x[i] -= m[i][c] * x[c];
        x[i] /= m[i][i];
    }
}

/* Levenberg and Marquardt's method starting from the given curve; `a` is fixed unless `curved`. */
static void refine(const struct view *view, bool curved, struct curve *curve, struct normal *normal)
{
    float damping = FIRST_DAMPING;
    evaluate(view, curve, true, normal);
    for (int step = 0; step < MAX_STEPS; step++) {
        struct curve next;
        struct normal next_normal;
        bool better = false;
        for (int i = 0; i < MAX_DAMPINGS && !better; i++) {
            float x[3];
            solve_damped(normal, damping, curved ? 0 : 1, x);
            next = (struct curve){curve->a + x[0], curve->d + x[1],
                                  grrl_wrap_rad(curve->angle + x[2])};
            bool exists = 1.0f + 4.0f * next.a * next.d > LEAST_EXISTING;
            if (exists)
                evaluate(view, &next, true, &next_normal);
            better = exists && next_normal.loss < normal->loss;
            damping *= better ? LESS_DAMPING : MORE_DAMPING;
        }
        if (!better)
            return;
        bool done = normal->loss - next_normal.loss < CONVERGED * normal->loss;
        *curve = next;
        *normal = next_normal;
        if (done)
            return;
    }
}

/* Kasa's algebraic fit, linear and in one pass: the starting point for a long arc. false: no
 * circle. */
static bool algebraic_circle(const struct view *view, struct curve *curve)
{
    struct normal sums = {.loss = 0.0f};
    for (uint32_t i = 0; i < view->trajectory->n; i++) {
        if (is_kept(view, i)) {
            struct grrl_vec2 p = project(view, i);
            float row[3] = {p.x, p.y, 1.0f};
            for (int k = 0; k < 9; k++) {
                sums.h[k / 3][k % 3] += row[k / 3] * row[k % 3];
                sums.g[k / 3] += k % 3 == 0 ? row[k / 3] * grrl_vec2_dot(p, p) : 0.0f;
            }
        }
    }
    float x[3]; /* |p|^2 = 2 centre . p + radius^2 - |centre|^2 */
    solve_damped(&sums, 0.0f, 0, x);
    struct grrl_vec2 centre = {0.5f * x[0], 0.5f * x[1]};
    float radius = grrl_sqrt(x[2] + grrl_vec2_dot(centre, centre));
    if (!grrl_is_finite(radius) || !(radius > 0.0f))
        return false;
    *curve = (struct curve){0.5f / radius, -0.5f * x[2] / radius, grrl_atan2(-centre.y, -centre.x)};
    return true;
}

/* --- the answer ------------------------------------------------------------------------------- */

static void to_space(const struct view *view, struct grrl_vec2 p, float *point)
{
    for (int i = 0; i < 3; i++)
        point[i] = view->origin[i] + p.x * view->u[i] + p.y * view->v[i];
}

static void describe_line(const struct view *view, const struct curve *line,
                          struct grrl_trajectory_model *model)
{
    struct grrl_vec2 normal = {grrl_cos(line->angle), grrl_sin(line->angle)};
    struct grrl_vec2 along = {normal.y, -normal.x};
    float low = 0.0f;
    float high = 0.0f;
    for (uint32_t i = 0; i < view->trajectory->n; i++) {
        float at = grrl_vec2_dot(along, project(view, i));
        if (is_kept(view, i)) {
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
    }
    to_space(view, grrl_vec2_scale(normal, -line->d), model->point_m);
    for (int i = 0; i < 3; i++)
        model->axis[i] = along.x * view->u[i] + along.y * view->v[i];
    model->travel = high - low;
}

/* The angle between the extremes, accumulated from sample to sample, so it may exceed a full turn.
 */
static float angle_travelled(const struct view *view, struct grrl_vec2 centre)
{
    float angle = 0.0f;
    float low = 0.0f;
    float high = 0.0f;
    bool started = false;
    struct grrl_vec2 last = {0.0f, 0.0f};
    for (uint32_t i = 0; i < view->trajectory->n; i++) {
        if (!is_kept(view, i))
            continue;
        struct grrl_vec2 arm = grrl_vec2_sub(project(view, i), centre);
        angle += started ? grrl_atan2(grrl_vec2_cross(last, arm), grrl_vec2_dot(last, arm)) : 0.0f;
        low = angle < low ? angle : low;
        high = angle > high ? angle : high;
        last = arm;
        started = true;
    }
    return high - low;
}

static void describe_circle(const struct view *view, const struct curve *circle,
                            struct grrl_trajectory_fit *fit)
{
    const float straightest = 0.5f / FARTHEST_M;
    float a = circle->a;
    if (a > -straightest && a < straightest)
        a = a < 0.0f ? -straightest : straightest;
    float e2 = 1.0f + 4.0f * a * circle->d;
    float arm = -grrl_sqrt(e2 > 0.0f ? e2 : 0.0f) / (2.0f * a);
    struct grrl_vec2 centre = {arm * grrl_cos(circle->angle), arm * grrl_sin(circle->angle)};
    fit->radius_m = 0.5f / (a < 0.0f ? -a : a);
    to_space(view, centre, fit->revolute.point_m);
    memcpy(fit->revolute.axis, view->w, sizeof view->w);
    fit->revolute.travel = angle_travelled(view, centre);
}

/* The residuals of a curve, clipped so that a few remaining outliers make no difference. */
static struct grrl_trajectory_residuals residuals_of(const struct view *view, uint32_t n,
                                                     const struct curve *curve, float rms_m)
{
    struct grrl_trajectory_spectrum spectrum;
    grrl_trajectory_spectrum_begin(&spectrum, n);
    for (uint32_t i = 0; i < view->trajectory->n; i++) {
        if (is_kept(view, i)) {
            float r = distance(curve, project(view, i), NULL);
            float most = CAUCHY_SIGMAS * rms_m;
            grrl_trajectory_spectrum_add(&spectrum, r > most ? most : r < -most ? -most : r);
        }
    }
    return grrl_trajectory_spectrum_end(&spectrum);
}

static struct grrl_trajectory_residuals places_of(const struct view *view, uint32_t n)
{
    struct grrl_trajectory_spectrum spectrum;
    grrl_trajectory_spectrum_begin(&spectrum, n);
    for (uint32_t i = 0; i < view->trajectory->n; i++)
        if (is_kept(view, i))
            grrl_trajectory_spectrum_add(&spectrum, project(view, i).x);
    return grrl_trajectory_spectrum_end(&spectrum);
}

static void fit_models(const struct view *view, const struct grrl_trajectory_config *config,
                       struct grrl_trajectory_fit *fit)
{
    struct curve line = {.angle = 0.5f * GRRL_PI}; /* along the main axis u; v is its normal */
    struct normal line_normal;
    refine(view, false, &line, &line_normal);
    struct curve circle = line;
    struct normal circle_normal;
    refine(view, true, &circle, &circle_normal);
    struct curve other;
    struct normal other_normal;
    if (algebraic_circle(view, &other)) {
        refine(view, true, &other, &other_normal);
        if (other_normal.loss < circle_normal.loss) {
            circle = other;
            circle_normal = other_normal;
        }
    }
    fit->prismatic.residual_m = grrl_sqrt(line_normal.residual2 / line_normal.weight);
    fit->revolute.residual_m = grrl_sqrt(circle_normal.residual2 / circle_normal.weight);
    describe_line(view, &line, &fit->prismatic);
    describe_circle(view, &circle, fit);
    uint32_t n = view->trajectory->n - fit->outliers;
    float arc_m = fit->radius_m * fit->revolute.travel;
    struct grrl_trajectory_clues clues = {
        .residuals = residuals_of(view, n, &circle, fit->revolute.residual_m),
        .places = places_of(view, n),
        .length_m = arc_m > fit->prismatic.travel ? arc_m : fit->prismatic.travel,
        .turn_rad = fit->revolute.travel};
    grrl_trajectory_weigh(config, &clues, fit);
}

enum grrl_status grrl_trajectory_fit_of(const struct grrl_trajectory *trajectory,
                                        const struct grrl_trajectory_config *config,
                                        struct grrl_trajectory_fit *fit)
{
    if (trajectory->dimensions < 2 || trajectory->dimensions > 3 ||
        !grrl_is_finite(config->noise_m) || !(config->noise_m > 0.0f) ||
        !grrl_is_finite(config->radius_m) || !(config->radius_m > 0.0f) ||
        !grrl_is_finite(config->play_rad) || !(config->play_rad > 0.0f) ||
        !(config->decided >= 0.5f && config->decided <= 1.0f))
        return GRRL_ERR_ARGUMENT;
    if (trajectory->n < GRRL_TRAJECTORY_MIN_SAMPLES)
        return GRRL_ERR_NONE;
    for (size_t i = 0; i < (size_t)trajectory->n * trajectory->dimensions; i++)
        if (!(trajectory->rows_m[i] >= -FARTHEST_M && trajectory->rows_m[i] <= FARTHEST_M))
            return GRRL_ERR_NUMBER;
    struct view view = {.trajectory = trajectory,
                        .outlier_m = OUTLIER_SIGMAS * config->noise_m,
                        .noise_m = config->noise_m};
    struct grrl_trajectory_fit result = {.answer = GRRL_TRAJECTORY_RIGID, .p_rigid = 1.0f};
    bool moved = find_plane(&view, &result);
    if (trajectory->n - result.outliers < GRRL_TRAJECTORY_MIN_SAMPLES)
        return GRRL_ERR_NONE;
    if (moved)
        fit_models(&view, config, &result);
    *fit = result;
    return GRRL_OK;
}
