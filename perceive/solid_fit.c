/*
 * solid_fit.c: fits of rigid things to the images of their points.
 *
 * Point i, at p in space, appears in frame f at x = (a p + a3) / (1 + c p) and y = (b p + b3) / (1
 * + c p), where a, b and c belong to the frame. Frames and points are solved for in turn, each
 * linearly: multiplied by the denominator, and weighted by its last value. With c = 0 that
 * converges from the main directions of the points' motion.
 */
#include "solid_fit.h"

#include <math.h>
#include <string.h>

enum {
    DIRECTIONS = 3,
    ITERATIONS = 40,    /* to the main directions */
    ROUNDS = 20,        /* of frames and points; about ten are enough */
    FURTHER_ROUNDS = 4, /* of a point whose frames are known */
    LEAST_POINTS = 8,   /* of a near solid; fewer do not determine a projection */
    CAMERA = 11         /* parameters of a projection */
};

/* How frames map points. */
enum model { SIMILAR, AFFINE, PROJECTIVE };

/* Keeps the normal equations solvable where the points or the frames leave something open. */
#define RIDGE 1e-9
#define DEPTH_RIDGE 1e-6 /* for each point */

/* A point is at most this much nearer or farther than the middle of its thing. */
#define NEAREST 0.3
#define FARTHEST 3.0

struct fit {
    struct grrl_views views; /* scaled to about 1 */
    double scale;
    double camera[GRRL_VIEWS_FRAMES][CAMERA]; /* a, a3, b, b3, c */
    double point[GRRL_VIEWS_POINTS][DIRECTIONS];
};

/* Subtracts from the points first to end - 1 the mean of the points first to known - 1. */
static void centre_on(struct grrl_views *views, unsigned first, unsigned known, unsigned end)
{
    for (unsigned f = 0; f < views->n_frames; f++) {
        double n = 0.0;
        double x = 0.0;
        double y = 0.0;
        for (unsigned i = first; i < known; i++) {
            if (views->seen[f][i]) {
                n += 1.0;
                x += views->x[f][i];
                y += views->y[f][i];
            }
        }
        for (unsigned i = first; i < end && n > 0.0; i++) {
            views->x[f][i] -= x / n;
            views->y[f][i] -= y / n;
        }
    }
}

void grrl_views_centre(struct grrl_views *views, unsigned first, unsigned end)
{
    centre_on(views, first, end, end);
}

static double dot(const double *a, const double *b, unsigned n)
{
    double sum = 0.0;
    for (unsigned i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Centres each frame on the first `known` points and scales all alike. What is not seen becomes 0,
 * the centre. */
static void normalise(struct fit *fit, unsigned known)
{
    struct grrl_views *views = &fit->views;
    double sum = 0.0;
    double n = 0.0;
    centre_on(views, 0, known, views->n_points);
    for (unsigned f = 0; f < views->n_frames; f++) {
        for (unsigned i = 0; i < views->n_points; i++) {
            if (!views->seen[f][i])
                views->x[f][i] = views->y[f][i] = 0.0;
            if (i >= known)
                continue;
            n += views->seen[f][i];
            sum += views->x[f][i] * views->x[f][i] + views->y[f][i] * views->y[f][i];
        }
    }
    fit->scale = n > 0.0 && sum > 0.0 ? sqrt(sum / n) : 1.0;
    for (unsigned f = 0; f < views->n_frames; f++) {
        for (unsigned i = 0; i < views->n_points; i++) {
            views->x[f][i] /= fit->scale;
            views->y[f][i] /= fit->scale;
        }
    }
}

/* --- the start -------------------------------------------------------------------------------- */

/* to = W^T W from, for the matrix W of all rows of x and y. */
static void through_views(const struct grrl_views *views, const double *from, double *to)
{
    memset(to, 0, GRRL_VIEWS_POINTS * sizeof *to);
    for (unsigned row = 0; row < 2 * views->n_frames; row++) {
        const double *w = row % 2 == 0 ? views->x[row / 2] : views->y[row / 2];
        double image = dot(w, from, views->n_points);
        for (unsigned i = 0; i < views->n_points; i++)
            to[i] += image * w[i];
    }
}

/* Gram and Schmidt. */
static void make_orthonormal(double direction[][GRRL_VIEWS_POINTS], unsigned n)
{
    for (unsigned k = 0; k < DIRECTIONS; k++) {
        for (unsigned l = 0; l < k; l++) {
            double along = dot(direction[k], direction[l], n);
            for (unsigned i = 0; i < n; i++)
                direction[k][i] -= along * direction[l][i];
        }
        double length = sqrt(dot(direction[k], direction[k], n));
        for (unsigned i = 0; i < n; i++)
            direction[k][i] = length > 0.0 ? direction[k][i] / length : 0.0;
    }
}

/* The points at their coefficients in the main directions, by subspace iteration. */
static void start(struct fit *fit)
{
    double direction[DIRECTIONS][GRRL_VIEWS_POINTS];
    double next[DIRECTIONS][GRRL_VIEWS_POINTS];
    unsigned n = fit->views.n_points;
    for (unsigned k = 0; k < DIRECTIONS; k++)
        for (unsigned i = 0; i < n; i++)
            direction[k][i] = cos((double)((k + 1) * (2 * i + 1)));
    make_orthonormal(direction, n);
    for (unsigned round = 0; round < ITERATIONS; round++) {
        for (unsigned k = 0; k < DIRECTIONS; k++)
            through_views(&fit->views, direction[k], next[k]);
        memcpy(direction, next, sizeof next);
        make_orthonormal(direction, n);
    }
    for (unsigned i = 0; i < n; i++)
        for (unsigned k = 0; k < DIRECTIONS; k++)
            fit->point[i][k] = direction[k][i] * sqrt(n);
}

/* The points where the frame that sees most of them has them; the others at the centre. */
static void start_from_one_frame(struct fit *fit)
{
    const struct grrl_views *views = &fit->views;
    unsigned most = 0;
    unsigned best = 0;
    for (unsigned f = 0; f < views->n_frames; f++) {
        unsigned n = 0;
        for (unsigned i = 0; i < views->n_points; i++)
            n += views->seen[f][i];
        best = n > most ? f : best;
        most = n > most ? n : most;
    }
    for (unsigned i = 0; i < views->n_points; i++) {
        fit->point[i][0] = views->x[best][i];
        fit->point[i][1] = views->y[best][i];
        fit->point[i][2] = 0.0;
    }
}

/* --- rounds ----------------------------------------------------------------------------------- */

static double denominator(const double *camera, const double *point)
{
    double d = 1.0 + dot(camera + 8, point, DIRECTIONS);
    return d < NEAREST ? NEAREST : d > FARTHEST ? FARTHEST : d;
}

/* Solves m x = g for a symmetric positive m, of which the lower half is given, by Cholesky's
 * method; g becomes x. */
static void solve(double m[CAMERA][CAMERA], double *g, unsigned n)
{
    for (unsigned k = 0; k < n; k++) {
        m[k][k] = sqrt(fmax(m[k][k], RIDGE));
        for (unsigned i = k + 1; i < n; i++)
            m[i][k] /= m[k][k];
        for (unsigned j = k + 1; j < n; j++)
            for (unsigned i = j; i < n; i++)
                m[i][j] -= m[i][k] * m[j][k];
    }
    for (unsigned i = 0; i < n; i++) {
        for (unsigned j = 0; j < i; j++)
            g[i] -= m[i][j] * g[j];
        g[i] /= m[i][i];
    }
    for (unsigned i = n; i-- > 0;) {
        for (unsigned j = i + 1; j < n; j++)
            g[i] -= m[j][i] * g[j];
        g[i] /= m[i][i];
    }
}

/* Adds the equation row . x = value, with a weight, to normal equations. */
static void add_equation(double m[CAMERA][CAMERA], double *g, const double *row, unsigned n,
                         double value, double weight)
{
    for (unsigned i = 0; i < n; i++) {
        if (row[i] == 0.0)
            continue;
        g[i] += weight * row[i] * value;
        for (unsigned j = 0; j <= i; j++)
            m[i][j] += weight * row[i] * row[j];
    }
}

static void solve_similar(struct fit *fit, unsigned f)
{
    double m[CAMERA][CAMERA] = {{0.0}};
    double g[CAMERA] = {0.0};
    for (unsigned i = 0; i < fit->views.n_points; i++) {
        const double *p = fit->point[i];
        const double row_x[4] = {p[0], -p[1], 1.0, 0.0};
        const double row_y[4] = {p[1], p[0], 0.0, 1.0};
        if (!fit->views.seen[f][i])
            continue;
        add_equation(m, g, row_x, 4, fit->views.x[f][i], 1.0);
        add_equation(m, g, row_y, 4, fit->views.y[f][i], 1.0);
    }
    for (unsigned k = 0; k < 4; k++)
        m[k][k] += RIDGE;
    solve(m, g, 4);
    const double camera[CAMERA] = {g[0], -g[1], 0.0, g[2], g[1], g[0], 0.0, g[3]};
    memcpy(fit->camera[f], camera, sizeof camera);
}

static void solve_camera(struct fit *fit, unsigned f, bool projective)
{
    double m[CAMERA][CAMERA] = {{0.0}};
    double g[CAMERA] = {0.0};
    unsigned n = projective ? CAMERA : 8;
    for (unsigned i = 0; i < fit->views.n_points; i++) {
        const double *p = fit->point[i];
        double x = fit->views.x[f][i];
        double y = fit->views.y[f][i];
        double d = denominator(fit->camera[f], p);
        double row_x[CAMERA] = {p[0], p[1], p[2], 1.0};
        double row_y[CAMERA] = {0.0, 0.0, 0.0, 0.0, p[0], p[1], p[2], 1.0};
        if (!fit->views.seen[f][i])
            continue;
        for (unsigned k = 0; k < DIRECTIONS; k++) {
            row_x[8 + k] = -x * p[k];
            row_y[8 + k] = -y * p[k];
        }
        add_equation(m, g, row_x, n, x, 1.0 / (d * d));
        add_equation(m, g, row_y, n, y, 1.0 / (d * d));
    }
    for (unsigned k = 0; k < n; k++)
        m[k][k] += k < 8 ? RIDGE : DEPTH_RIDGE * fit->views.n_points;
    solve(m, g, n);
    memcpy(fit->camera[f], g, sizeof g);
}

/* The first `rank` coordinates of a point; the others stay. */
static void solve_point(struct fit *fit, unsigned i, unsigned rank)
{
    double m[CAMERA][CAMERA] = {{0.0}};
    double g[CAMERA] = {0.0};
    for (unsigned f = 0; f < fit->views.n_frames; f++) {
        const double *camera = fit->camera[f];
        double x = fit->views.x[f][i];
        double y = fit->views.y[f][i];
        double d = denominator(camera, fit->point[i]);
        double row_x[DIRECTIONS];
        double row_y[DIRECTIONS];
        if (!fit->views.seen[f][i])
            continue;
        for (unsigned k = 0; k < DIRECTIONS; k++) {
            row_x[k] = camera[k] - x * camera[8 + k];
            row_y[k] = camera[4 + k] - y * camera[8 + k];
        }
        double rest_x = dot(row_x + rank, fit->point[i] + rank, DIRECTIONS - rank);
        double rest_y = dot(row_y + rank, fit->point[i] + rank, DIRECTIONS - rank);
        add_equation(m, g, row_x, rank, x - camera[3] - rest_x, 1.0 / (d * d));
        add_equation(m, g, row_y, rank, y - camera[7] - rest_y, 1.0 / (d * d));
    }
    for (unsigned k = 0; k < rank; k++)
        m[k][k] += RIDGE;
    solve(m, g, rank);
    memcpy(fit->point[i], g, rank * sizeof g[0]);
}

/* The squared residuals of a point, in units of the scale; in how many frames it is seen. */
static double residual_of_point(const struct fit *fit, unsigned i, unsigned *seen)
{
    const double *p = fit->point[i];
    double sum = 0.0;
    *seen = 0;
    for (unsigned f = 0; f < fit->views.n_frames; f++) {
        const double *camera = fit->camera[f];
        double d = denominator(camera, p);
        double x = (dot(camera, p, DIRECTIONS) + camera[3]) / d - fit->views.x[f][i];
        double y = (dot(camera + 4, p, DIRECTIONS) + camera[7]) / d - fit->views.y[f][i];
        sum += fit->views.seen[f][i] ? x * x + y * y : 0.0;
        *seen += fit->views.seen[f][i];
    }
    return sum;
}

static double residual_of(const struct fit *fit)
{
    double sum = 0.0;
    unsigned seen;
    for (unsigned i = 0; i < fit->views.n_points; i++)
        sum += residual_of_point(fit, i, &seen);
    return sum * fit->scale * fit->scale;
}

/* The least squared residuals of the rounds. */
static double refine(struct fit *fit, enum model model, unsigned rank)
{
    double best = HUGE_VAL;
    for (unsigned round = 0; round < ROUNDS; round++) {
        for (unsigned f = 0; f < fit->views.n_frames; f++)
            if (model == SIMILAR)
                solve_similar(fit, f);
            else
                solve_camera(fit, f, model == PROJECTIVE);
        for (unsigned i = 0; i < fit->views.n_points; i++)
            solve_point(fit, i, rank);
        best = fmin(best, residual_of(fit));
    }
    return best;
}

/* --- the models ------------------------------------------------------------------------------- */

double grrl_fit_similar(const struct grrl_views *views)
{
    struct fit fit = {.views = *views};
    normalise(&fit, views->n_points);
    start_from_one_frame(&fit);
    return refine(&fit, SIMILAR, 2);
}

double grrl_fit_flat(const struct grrl_views *views)
{
    struct fit fit = {.views = *views};
    normalise(&fit, views->n_points);
    start(&fit);
    for (unsigned i = 0; i < views->n_points; i++)
        fit.point[i][2] = 0.0;
    return refine(&fit, AFFINE, 2);
}

double grrl_fit_solid(const struct grrl_views *views)
{
    struct fit fit = {.views = *views};
    normalise(&fit, views->n_points);
    start(&fit);
    return refine(&fit, AFFINE, DIRECTIONS);
}

double grrl_fit_near_solid(const struct grrl_views *views)
{
    struct fit fit = {.views = *views};
    normalise(&fit, views->n_points);
    start(&fit);
    double distant = refine(&fit, AFFINE, DIRECTIONS);
    return views->n_points < LEAST_POINTS ? distant
                                          : fmin(distant, refine(&fit, PROJECTIVE, DIRECTIONS));
}

double grrl_fit_near_layers(const struct grrl_views *views, unsigned second)
{
    struct fit fit = {.views = *views};
    normalise(&fit, views->n_points);
    struct grrl_views whole = fit.views;
    grrl_views_centre(&fit.views, 0, second);
    grrl_views_centre(&fit.views, second, views->n_points);
    start(&fit);
    fit.views = whole;
    for (unsigned i = 0; i < views->n_points; i++)
        fit.point[i][2] = i < second ? 0.0 : 1.0;
    return refine(&fit, PROJECTIVE, 2);
}

void grrl_fit_further_points(const struct grrl_views *views, unsigned known, double *variance)
{
    struct fit fit = {.views = *views};
    normalise(&fit, known);
    fit.views.n_points = known;
    start(&fit);
    (void)refine(&fit, AFFINE, DIRECTIONS);
    if (known >= LEAST_POINTS)
        (void)refine(&fit, PROJECTIVE, DIRECTIONS);
    for (unsigned i = known; i < views->n_points; i++) {
        unsigned seen;
        for (int round = 0; round < FURTHER_ROUNDS; round++)
            solve_point(&fit, i, DIRECTIONS);
        double residuals = residual_of_point(&fit, i, &seen) * fit.scale * fit.scale;
        variance[i - known] =
            2 * seen > DIRECTIONS ? residuals / (2.0 * seen - DIRECTIONS) : HUGE_VAL;
    }
}

static double at_most_all(double parameters, unsigned n_frames, unsigned n_points)
{
    return fmin(parameters, 2.0 * n_frames * n_points);
}

double grrl_similar_parameters(unsigned n_frames, unsigned n_points)
{
    return at_most_all(4.0 * n_frames + 2.0 * n_points - 4.0, n_frames, n_points);
}

double grrl_flat_parameters(unsigned n_frames, unsigned n_points)
{
    return at_most_all(6.0 * n_frames + 2.0 * n_points - 6.0, n_frames, n_points);
}

double grrl_solid_parameters(unsigned n_frames, unsigned n_points)
{
    return at_most_all(8.0 * n_frames + 3.0 * n_points - 12.0, n_frames, n_points);
}

double grrl_near_layers_parameters(unsigned n_frames, unsigned n_points)
{
    return at_most_all(11.0 * n_frames + 2.0 * n_points - 8.0, n_frames, n_points);
}

double grrl_near_solid_parameters(unsigned n_frames, unsigned n_points)
{
    if (n_points < LEAST_POINTS)
        return grrl_solid_parameters(n_frames, n_points);
    return at_most_all(11.0 * n_frames + 3.0 * n_points - 15.0, n_frames, n_points);
}
