/*
 * Circles and lines through trajectories, against a search without derivatives in double precision,
 * for circles given by centre and radius.
 */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "grrl/perception/trajectory.h"
#include "scene.h"

enum { MOST = 120 };

static float rows[3 * MOST];
static struct grrl_trajectory trajectory = {0, 0, rows};
static struct grrl_trajectory_config config;

/* --- the plane
 * ------------------------------------------------------------------------------------- */

static int n_kept;
static double kept[MOST][3];
static double mean[3];
static double axis_u[3];
static double axis_v[3];
static struct point flat[MOST]; /* in the plane, from the mean */
static double out_of_plane;

static double coordinate(int i, int axis)
{
    return axis < trajectory.dimensions ? (double)rows[i * trajectory.dimensions + axis] : 0.0;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of the sample and as many before as after, two at most. */
static double median_around(int i, int axis)
{
    double values[5];
    int n = 0;
    for (int away = -2; away <= 2; away++) {
        int reach = abs(away);
        if (i - reach >= 0 && i + reach < (int)trajectory.n)
            values[n++] = coordinate(i + away, axis);
    }
    qsort(values, (size_t)n, sizeof values[0], by_size);
    return values[n / 2];
}

static double product(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The direction of most spread at right angles to one given, by the power method. */
static void main_axis(const double *not_along, double *axis)
{
    double spread[3][3] = {{0.0}};
    double next[3] = {0.5, 0.4, 0.3};
    for (int i = 0; i < n_kept; i++)
        for (int k = 0; k < 9; k++)
            spread[k / 3][k % 3] += kept[i][k / 3] * kept[i][k % 3];
    for (int round = 0; round < 3000; round++) {
        double along = not_along == NULL ? 0.0 : product(next, not_along);
        for (int k = 0; k < 3; k++)
            axis[k] = next[k] - (not_along == NULL ? 0.0 : along * not_along[k]);
        double length = sqrt(product(axis, axis));
        for (int k = 0; k < 3; k++)
            axis[k] /= length;
        for (int k = 0; k < 3; k++)
            next[k] = product(spread[k], axis);
    }
}

static void find_plane(void)
{
    n_kept = 0;
    memset(mean, 0, sizeof mean);
    for (int i = 0; i < (int)trajectory.n; i++) {
        double away2 = 0.0;
        for (int k = 0; k < 3; k++)
            away2 += pow(coordinate(i, k) - median_around(i, k), 2.0);
        if (sqrt(away2) > 5.0 * (double)config.noise_m)
            continue;
        for (int k = 0; k < 3; k++)
            kept[n_kept][k] = coordinate(i, k);
        n_kept++;
    }
    for (int i = 0; i < n_kept; i++)
        for (int k = 0; k < 3; k++)
            mean[k] += kept[i][k] / n_kept;
    for (int i = 0; i < n_kept; i++)
        for (int k = 0; k < 3; k++)
            kept[i][k] -= mean[k];
    main_axis(NULL, axis_u);
    main_axis(axis_u, axis_v);
    out_of_plane = 0.0;
    for (int i = 0; i < n_kept; i++) {
        flat[i] = (struct point){product(kept[i], axis_u), product(kept[i], axis_v)};
        out_of_plane += fmax(0.0, product(kept[i], kept[i]) - square(flat[i])) / n_kept;
    }
    out_of_plane = sqrt(out_of_plane);
}

/* --- the fits
 * ---------------------------------------------------------------------------------------- */

/* A line or circle: the point nearest to the origin and the direction to it, as an angle and a
 * distance with a sign, and the curvature with a sign, 0 for a line. */
struct bow {
    double angle;
    double away;
    double bend;
};

static double miss(const struct bow *bow, struct point p)
{
    struct placed at = place(0.0, 0.0, bow->angle);
    struct point q = to_local(at, p);
    q.x -= bow->away;
    if (fabs(bow->bend) < 1e-7)
        return q.x;
    double radius = 1.0 / bow->bend; /* the centre lies at (-radius, 0) */
    double far = hypot(q.x + radius, q.y);
    return bow->bend > 0.0 ? far - radius : -(far + radius);
}

/* Cauchy's loss with a scale of three standard deviations. */
static double loss_of(const struct bow *bow)
{
    double sum = 0.0;
    for (int i = 0; i < n_kept; i++) {
        double r = miss(bow, flat[i]) / (3.0 * (double)config.noise_m);
        sum += 9.0 * log(1.0 + r * r) / n_kept;
    }
    return sum;
}

/* Tries steps along the axes and longer ones where the last went, until they are tiny. */
static struct bow improve(struct bow bow, bool curved)
{
    double step[3] = {0.1, 0.1, curved ? 1.0 : 0.0};
    double best = loss_of(&bow);
    for (int round = 0; round < 1500; round++) {
        struct bow start = bow;
        for (int k = 0; k < 6; k++) {
            struct bow next = bow;
            double by = k % 2 == 0 ? step[k / 2] : -step[k / 2];
            if (k / 2 == 0)
                next.angle += by;
            else if (k / 2 == 1)
                next.away += by;
            else
                next.bend += by;
            double loss = loss_of(&next);
            if (loss < best) {
                best = loss;
                bow = next;
                step[k / 2] *= 1.6;
            } else {
                step[k / 2] *= 0.8;
            }
        }
        struct bow beyond = {2.0 * bow.angle - start.angle, 2.0 * bow.away - start.away,
                             2.0 * bow.bend - start.bend};
        if (loss_of(&beyond) < best) {
            best = loss_of(&beyond);
            bow = beyond;
        }
        if (step[0] < 1e-9 && step[1] < 1e-9 && step[2] < 1e-8)
            break;
    }
    return bow;
}

/* From the line and from circles of several radii to either side. */
static struct bow search(bool curved)
{
    struct bow best = {1.5707963267948966, 0.0, 0.0};
    best = improve(best, false);
    for (int i = -3; i <= 3 && curved; i++) {
        struct bow start = best;
        start.bend = i < 0 ? -0.3 * pow(3.0, -i) : i > 0 ? 0.3 * pow(3.0, i) : 0.0;
        start = improve(start, true);
        best = loss_of(&start) < loss_of(&best) ? start : best;
    }
    return best;
}

static double residual_of(const struct bow *bow)
{
    double sum = 0.0;
    double weights = 0.0;
    for (int i = 0; i < n_kept; i++) {
        double r = miss(bow, flat[i]);
        double weight = 1.0 / (1.0 + pow(r / (3.0 * (double)config.noise_m), 2.0));
        sum += weight * r * r;
        weights += weight;
    }
    return sqrt(sum / weights);
}

/* The power of half waves over the trajectory: the slowest third of at most 24, beyond the mean of
 * the others, and that mean; and with 24, of the first four over the next four, else 0. */
static void slow_powers(const double *value, double *total, double *slow, double *noise,
                        double *shape)
{
    int waves = (n_kept - 1) / 3 < 8 ? (n_kept - 1) / 3 : 8;
    double half[2] = {0.0, 0.0};
    *total = 0.0;
    *slow = 0.0;
    *noise = 0.0;
    for (int i = 0; i < n_kept; i++)
        *total += value[i] * value[i] / n_kept;
    for (int k = 1; k <= 3 * waves && n_kept >= 12; k++) {
        double sum = 0.0;
        for (int i = 0; i < n_kept; i++)
            sum += 2.0 * value[i] * cos(3.14159265358979 * k * (i + 0.5) / n_kept) / n_kept;
        *(k <= waves ? slow : noise) += 0.5 * sum * sum / (k <= waves ? 1.0 : 2.0 * waves);
        if (k <= 8)
            half[k > 4] += sum * sum;
    }
    *shape = waves < 8 ? 0.0 : half[0] / half[1];
    *slow = n_kept < 12 ? *total : fmax(0.0, *slow - waves * *noise);
    double least = n_kept < 12 ? *total / fmax(1.0, n_kept - 3.0) : (*total - *slow) / n_kept;
    *noise = fmax(*noise, least);
}

static double student(double x, double degrees)
{
    double scale = tgamma(0.5 * (degrees + 1.0)) / tgamma(0.5 * degrees);
    return scale / sqrt(3.14159265358979 * degrees) *
           pow(1.0 + x * x / degrees, -0.5 * (degrees + 1.0));
}

static double log_normal(double x, double median, double spread)
{
    double z = log(x / median) / spread;
    return x > 0.0 ? exp(-0.5 * z * z) / (x * spread * sqrt(6.28318530717959)) : 0.0;
}

/* Of the turn seen, for a circle of some radius: over turns within eight scales, finely. */
static double slow_circle_density(double turn, double length, double sigma)
{
    double sum = 0.0;
    double weights = 0.0;
    for (int i = -4000; i <= 4000; i++) {
        double weight = student(i / 500.0, 4.0);
        double at = fabs(turn + sigma * i / 500.0);
        weights += weight;
        sum += 0.5 * weight * log_normal(at, length / (double)config.radius_m, 1.2);
    }
    return sum / weights;
}

/* rigid, neither, revolute, prismatic. */
static void slow_probabilities(const struct bow *circle, double turn, double length, double *p)
{
    double miss_of[MOST];
    double along[MOST];
    double most = 3.0 * residual_of(circle);
    for (int i = 0; i < n_kept; i++) {
        miss_of[i] = fmin(most, fmax(-most, miss(circle, flat[i])));
        along[i] = flat[i].x;
    }
    double total, slow, noise, moved, shape;
    slow_powers(along, &total, &moved, &noise, &shape);
    slow_powers(miss_of, &total, &slow, &noise, &shape);
    double sigma = hypot((double)config.play_rad, sqrt(slow + noise) * 12.0 * sqrt(5.0) / length);
    double line = student(turn / sigma, 4.0) / sigma;
    double circular = slow_circle_density(turn, length, sigma);
    double joint = 2.0 * student(sqrt(slow) / length / 0.006, 4.0) / 0.006;
    double other = log_normal(sqrt(slow) / length, 0.02, 1.0);
    if (shape > 0.0) {
        shape = fmin(shape, exp(1.8));
        joint *= student((log(shape) + 0.1) / 1.1, 8.0) / 1.1;
        other *= shape * log_normal(shape, exp(1.8), 0.8);
    }
    double still = 2.0 * student(sqrt(moved) / 0.0003, 4.0) / 0.0003;
    double moving = log_normal(sqrt(moved), 0.09, 1.2);
    p[0] = 0.1 * still / (0.1 * still + 0.9 * moving);
    p[1] = (1.0 - p[0]) * 0.1 * other / (0.1 * other + 0.9 * joint);
    p[2] = (1.0 - p[0] - p[1]) * circular / (circular + line);
    p[3] = 1.0 - p[0] - p[1] - p[2];
}

static struct point centre_of(const struct bow *circle)
{
    double x = circle->away - 1.0 / circle->bend;
    return (struct point){cos(circle->angle) * x, sin(circle->angle) * x};
}

/* Between the extremes, followed from sample to sample. */
static double slow_turn(struct point centre)
{
    double angle = 0.0;
    double low = 0.0;
    double high = 0.0;
    for (int i = 1; i < n_kept; i++) {
        struct point a = minus(flat[i - 1], centre);
        struct point b = minus(flat[i], centre);
        angle += atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
        low = fmin(low, angle);
        high = fmax(high, angle);
    }
    return high - low;
}

static double slow_slide(const struct bow *line)
{
    double low = 1e9;
    double high = -1e9;
    for (int i = 0; i < n_kept; i++) {
        double at = -sin(line->angle) * flat[i].x + cos(line->angle) * flat[i].y;
        low = fmin(low, at);
        high = fmax(high, at);
    }
    return high - low;
}

/* --- trajectories
 * -------------------------------------------------------------------------------------- */

static double origin[3];
static double right[3];
static double up[3];

/* A plane somewhere in space, or that of the table. */
static void make_plane(int dimensions)
{
    trajectory.dimensions = (uint8_t)dimensions;
    double turn = dimensions == 2 ? 0.0 : scene_uniform(-3.0, 3.0);
    double tilt = dimensions == 2 ? 0.0 : scene_uniform(-1.0, 1.0);
    for (int k = 0; k < 3; k++)
        origin[k] = k < dimensions ? scene_uniform(-2.0, 2.0) : 0.0;
    right[0] = cos(turn);
    right[1] = sin(turn);
    right[2] = 0.0;
    up[0] = -sin(turn) * cos(tilt);
    up[1] = cos(turn) * cos(tilt);
    up[2] = sin(tilt);
}

static void put(int i, double x, double y, double noise)
{
    for (int k = 0; k < trajectory.dimensions; k++)
        rows[i * trajectory.dimensions + k] =
            (float)(origin[k] + x * right[k] + y * up[k] + noise * scene_normal());
}

/* At a speed that changes, so that there are more samples at one end. */
static void make_arc(int n, double radius, double turn, double noise, double outliers)
{
    double skew = scene_uniform(1.0, 2.0);
    trajectory.n = (uint32_t)n;
    for (int i = 0; i < n; i++) {
        double angle = 0.7 + turn * pow((double)i / (n - 1), skew);
        put(i, radius * cos(angle), radius * sin(angle), noise);
        if (scene_chance(outliers))
            rows[i * trajectory.dimensions] += (float)scene_uniform(-0.2, 0.2);
    }
}

/* Within three standard deviations the loss is convex; beyond, a line has many minima. */
static bool is_convex(const struct bow *bow)
{
    double farthest = 0.0;
    for (int i = 0; i < n_kept; i++)
        farthest = fmax(farthest, fabs(miss(bow, flat[i])));
    return farthest < 3.0 * (double)config.noise_m;
}

static void check_line(const struct grrl_trajectory_fit *fit, const struct bow *line)
{
    double along = 0.0;
    double off = 0.0;
    for (int k = 0; k < 3; k++) {
        double direction = -sin(line->angle) * axis_u[k] + cos(line->angle) * axis_v[k];
        double across = cos(line->angle) * axis_u[k] + sin(line->angle) * axis_v[k];
        along += direction * (double)fit->prismatic.axis[k];
        off += across * ((double)fit->prismatic.point_m[k] - mean[k]);
    }
    assert_near(1e3 * (double)fit->prismatic.residual_m, 1e3 * residual_of(line), 0.02);
    assert_near(fit->prismatic.travel, slow_slide(line), 2e-3);
    assert_near(fabs(along), 1.0, 1e-4);
    assert_near(off, line->away, 5e-4);
}

/* Fast and slow; whether they could be compared. */
static bool check_fit(void)
{
    struct grrl_trajectory_fit fit;
    find_plane();
    enum grrl_status status = grrl_trajectory_fit_of(&trajectory, &config, &fit);
    assert_int_equal(status, n_kept < GRRL_TRAJECTORY_MIN_SAMPLES ? GRRL_ERR_NONE : GRRL_OK);
    if (status != GRRL_OK)
        return true;
    struct bow line = search(false);
    struct bow circle = search(true);
    double radius = 1.0 / fabs(circle.bend);
    struct point centre = centre_of(&circle);
    double normal[3];
    assert_int_equal(fit.outliers, (int)trajectory.n - n_kept);
    assert_near(1e3 * (double)fit.out_of_plane_m, 1e3 * out_of_plane, 0.02);
    assert_near(fit.revolute.probability + fit.prismatic.probability + fit.p_rigid + fit.p_neither,
                1.0, 1e-5);
    for (int k = 0; k < 3; k++)
        normal[k] =
            axis_u[(k + 1) % 3] * axis_v[(k + 2) % 3] - axis_u[(k + 2) % 3] * axis_v[(k + 1) % 3];
    bool straight = is_convex(&line);
    if (straight)
        check_line(&fit, &line);
    /* a circle may have a second minimum nearly as good */
    if (fabs((double)fit.radius_m / radius - 1.0) > 0.05)
        return false;
    assert_near(1e3 * (double)fit.revolute.residual_m, 1e3 * residual_of(&circle), 0.1);
    assert_near((double)fit.radius_m / radius, 1.0, 0.01);
    assert_near(fit.revolute.travel, slow_turn(centre), 0.01);
    double turned = 0.0;
    for (int k = 0; k < 3; k++) {
        turned += normal[k] * (double)fit.revolute.axis[k];
        double at = mean[k] + centre.x * axis_u[k] + centre.y * axis_v[k];
        assert_near(fit.revolute.point_m[k], at, 0.01 * fmax(1.0, radius));
    }
    assert_near(fabs(turned), 1.0, 1e-4);
    double p[4];
    double turn = slow_turn(centre);
    slow_probabilities(&circle, turn, fmax(turn * radius, slow_slide(&line)), p);
    assert_near(fit.p_rigid, p[0], 0.02);
    if (straight) {
        assert_near(fit.p_neither, p[1], 0.02);
        assert_near(fit.revolute.probability, p[2], 0.02);
        assert_near(fit.prismatic.probability, p[3], 0.02);
    }
    return true;
}

static void arcs_as_by_searching(void **state)
{
    (void)state;
    scene_seed("arcs_as_by_searching");
    int compared = 0;
    for (int run = 0; run < 32; run++) {
        double noise = scene_uniform(0.0003, 0.003);
        grrl_trajectory_config_default(&config);
        config.noise_m = (float)(run % 4 < 2 ? scene_uniform(0.005, 0.02) : 3.0 * noise);
        config.play_rad = (float)scene_uniform(0.02, 0.3);
        config.radius_m = (float)scene_uniform(0.2, 1.0);
        make_plane(run % 3 == 0 ? 2 : 3);
        make_arc(scene_int(20, MOST), scene_uniform(0.1, 0.8),
                 run % 4 < 2 ? scene_uniform(0.3, 0.8) : scene_uniform(0.5, 2.5), noise,
                 run % 2 == 0 ? 0.05 : 0.0);
        compared += check_fit();
    }
    print_message("%d of 32 compared\n", compared);
    assert_true(compared >= 28);
}

/* Nearly straight, few samples, more than a turn. */
static void odd_trajectories_as_by_searching(void **state)
{
    (void)state;
    scene_seed("odd_trajectories_as_by_searching");
    int compared = 0;
    grrl_trajectory_config_default(&config);
    for (int run = 0; run < 20; run++) {
        make_plane(2 + run % 2);
        config.noise_m = 0.003f;
        if (run < 8)
            make_arc(60, 0.5, scene_uniform(0.3, 0.5), 0.001, 0.0);
        else if (run < 14)
            make_arc(scene_int(GRRL_TRAJECTORY_MIN_SAMPLES, 9), 0.3, 1.5, 0.001, 0.0);
        else
            make_arc(MOST, 0.2, scene_uniform(6.5, 9.0), 0.002, 0.02);
        compared += check_fit();
    }
    print_message("%d of 20 compared\n", compared);
    assert_true(compared >= 16);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arcs_as_by_searching),
        cmocka_unit_test(odd_trajectories_as_by_searching),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
