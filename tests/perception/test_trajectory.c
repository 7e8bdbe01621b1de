/* Trajectories of handles: known circles and lines, with noise, outliers and short arcs. */

#include "support.h"

#include <math.h>

#include "grrl/perception/trajectory.h"

enum { MOST = 800 };

static float rows[3 * MOST];

/* A plane in space: an origin and two unit vectors at right angles. */
static const double origin[3] = {0.4, -0.3, 1.1};
static const double along[3] = {0.6, 0.0, 0.8};
static const double across[3] = {0.64, 0.6, -0.48};

static double normal(struct grrl_random *random)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++)
        sum += (double)grrl_random_uniform(random);
    return sum;
}

static void put(struct grrl_random *random, uint32_t i, double x, double y, double noise)
{
    for (int k = 0; k < 3; k++)
        rows[3 * i + (uint32_t)k] =
            (float)(origin[k] + x * along[k] + y * across[k] + noise * normal(random));
}

static struct grrl_trajectory arc(struct grrl_random *random, uint32_t n, double radius,
                                  double turn, double noise)
{
    for (uint32_t i = 0; i < n; i++) {
        double angle = 0.7 + turn * i / (n - 1);
        put(random, i, radius * cos(angle), radius * sin(angle), noise);
    }
    return (struct grrl_trajectory){n, 3, rows};
}

static struct grrl_trajectory line(struct grrl_random *random, uint32_t n, double length,
                                   double noise)
{
    for (uint32_t i = 0; i < n; i++)
        put(random, i, length * i / (n - 1), 0.2, noise);
    return (struct grrl_trajectory){n, 3, rows};
}

static struct grrl_trajectory_fit fit(struct grrl_trajectory trajectory)
{
    struct grrl_trajectory_config config;
    grrl_trajectory_config_default(&config);
    struct grrl_trajectory_fit result;
    assert_int_equal(grrl_trajectory_fit_of(&trajectory, &config, &result), GRRL_OK);
    return result;
}

static double distance(const float *a, const double *b)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++)
        sum += ((double)a[k] - b[k]) * ((double)a[k] - b[k]);
    return sqrt(sum);
}

static double cosine(const float *a, const double *b)
{
    return fabs((double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2]);
}

static void test_circle(void **state)
{
    (void)state;
    struct grrl_random random = support_random("circle");
    const double hinge[3] = {along[1] * across[2] - along[2] * across[1],
                             along[2] * across[0] - along[0] * across[2],
                             along[0] * across[1] - along[1] * across[0]};
    for (int i = 0; i < 50; i++) {
        double radius = 0.2 + 0.6 * i / 50;
        struct grrl_trajectory_fit result = fit(arc(&random, 200, radius, 1.5, 0.003));
        assert_int_equal(result.answer, GRRL_TRAJECTORY_REVOLUTE);
        assert_true(result.revolute.probability > 0.9f || radius < 0.35);
        assert_true(fabs((double)result.radius_m - radius) < 0.02 * radius + 0.003);
        assert_true(distance(result.revolute.point_m, origin) < 0.03 * radius + 0.005);
        assert_true(cosine(result.revolute.axis, hinge) > 0.995);
        assert_true(fabs((double)result.revolute.travel - 1.5) < 0.09);
        assert_true(result.revolute.residual_m < 0.004f && result.out_of_plane_m < 0.004f);
    }
}

static void test_line(void **state)
{
    (void)state;
    struct grrl_random random = support_random("line");
    for (int i = 0; i < 50; i++) {
        double length = 0.1 + 0.5 * i / 50;
        struct grrl_trajectory_fit result = fit(line(&random, 150, length, 0.003));
        assert_int_equal(result.answer, GRRL_TRAJECTORY_PRISMATIC);
        assert_true(cosine(result.prismatic.axis, along) > 0.99);
        assert_true(fabs((double)result.prismatic.travel - length) < 0.02);
        assert_true(result.prismatic.residual_m < 0.004f);
    }
}

static float sum_of(const struct grrl_trajectory_fit *fit)
{
    return fit->revolute.probability + fit->prismatic.probability + fit->p_rigid + fit->p_neither;
}

/* The more there is to see of an arc, the surer; one of a few degrees cannot be told from a line.
 */
static void test_short_arcs(void **state)
{
    (void)state;
    struct grrl_random random = support_random("short_arcs");
    float last = 0.0f;
    for (int i = 1; i <= 12; i++) {
        struct grrl_trajectory_fit result = fit(arc(&random, 300, 0.5, 0.1 * i, 0.001));
        float probability = result.revolute.probability;
        assert_true(fabsf(sum_of(&result) - 1.0f) < 1e-5f);
        if (i <= 2)
            assert_int_equal(result.answer, GRRL_TRAJECTORY_UNDETERMINED);
        if (i >= 6) /* 0.6 rad: the arc rises 22 mm above its chord */
            assert_true(probability > last - 1e-3f && fabsf(result.radius_m - 0.5f) < 0.05f);
        last = probability;
    }
    assert_true(last > 0.99f);
}

static void test_more_than_a_turn(void **state)
{
    (void)state;
    struct grrl_random random = support_random("more_than_a_turn");
    struct grrl_trajectory_fit result = fit(arc(&random, 400, 0.3, 9.0, 0.002));
    assert_int_equal(result.answer, GRRL_TRAJECTORY_REVOLUTE);
    assert_true(fabsf(result.revolute.travel - 9.0f) < 0.05f);
    assert_true(fabsf(result.radius_m - 0.3f) < 0.003f);
}

static void test_outliers(void **state)
{
    (void)state;
    struct grrl_random random = support_random("outliers");
    for (int i = 0; i < 20; i++) {
        bool turns = i % 2 == 0;
        struct grrl_trajectory trajectory =
            turns ? arc(&random, 200, 0.4, 1.5, 0.002) : line(&random, 200, 0.5, 0.002);
        for (uint32_t k = 3; k < 200; k += 11)
            rows[3 * k + grrl_random_below(&random, 3)] += (k & 1u) != 0 ? 0.7f : -2.0f;
        struct grrl_trajectory_fit result = fit(trajectory);
        assert_int_equal(result.outliers, 18);
        assert_int_equal(result.answer,
                         turns ? GRRL_TRAJECTORY_REVOLUTE : GRRL_TRAJECTORY_PRISMATIC);
        if (turns)
            assert_true(fabsf(result.radius_m - 0.4f) < 0.01f);
    }
}

/* However fast, a sample in line with its neighbours is no outlier, at the ends neither. */
static void test_fast_and_exact(void **state)
{
    (void)state;
    struct grrl_random random = support_random("fast_and_exact");
    struct grrl_trajectory_fit result = fit(line(&random, 40, 30.0, 0.0));
    assert_int_equal(result.outliers, 0);
    assert_int_equal(result.answer, GRRL_TRAJECTORY_PRISMATIC);
    assert_true(fabsf(result.prismatic.travel - 30.0f) < 1e-3f);
}

/* A camera twice as fast, or the handle moved the other way round, changes next to nothing. */
static void test_rate_and_direction(void **state)
{
    (void)state;
    struct grrl_random random = support_random("rate_and_direction");
    struct grrl_trajectory trajectory = arc(&random, 200, 0.5, 0.5, 0.003);
    struct grrl_trajectory_fit all = fit(trajectory);
    static float other[3 * MOST];
    for (uint32_t i = 0; i < 200; i++)
        memcpy(&other[3 * i], &rows[3 * (199 - i)], 3 * sizeof *other);
    struct grrl_trajectory_fit back = fit((struct grrl_trajectory){200, 3, other});
    assert_true(fabsf(all.revolute.probability - back.revolute.probability) < 0.01f);
    assert_true(fabsf(all.radius_m - back.radius_m) < 0.002f);
    for (uint32_t i = 0; i < 100; i++)
        memcpy(&other[3 * i], &rows[6 * i], 3 * sizeof *other);
    struct grrl_trajectory_fit half = fit((struct grrl_trajectory){100, 3, other});
    assert_true(fabsf(all.revolute.probability - half.revolute.probability) < 0.1f);
}

static void test_two_dimensions(void **state)
{
    (void)state;
    float flat[2 * 60];
    for (int i = 0; i < 60; i++) {
        flat[2 * i] = 0.3f * cosf(0.03f * (float)i);
        flat[2 * i + 1] = 0.3f * sinf(0.03f * (float)i);
    }
    struct grrl_trajectory_fit result = fit((struct grrl_trajectory){60, 2, flat});
    assert_int_equal(result.answer, GRRL_TRAJECTORY_REVOLUTE);
    assert_true(fabsf(result.radius_m - 0.3f) < 1e-3f);
    assert_true(fabsf(result.revolute.point_m[0]) < 1e-3f);
    assert_true(fabsf(result.revolute.point_m[1]) < 1e-3f);
    assert_true(result.revolute.point_m[2] == 0.0f && result.out_of_plane_m == 0.0f);
}

static void test_what_is_refused(void **state)
{
    (void)state;
    struct grrl_random random = support_random("what_is_refused");
    struct grrl_trajectory_config config;
    struct grrl_trajectory_fit result;
    grrl_trajectory_config_default(&config);
    struct grrl_trajectory trajectory = line(&random, 50, 0.5, 0.001);
    trajectory.n = GRRL_TRAJECTORY_MIN_SAMPLES - 1;
    assert_int_equal(grrl_trajectory_fit_of(&trajectory, &config, &result), GRRL_ERR_NONE);
    trajectory.n = GRRL_TRAJECTORY_MIN_SAMPLES;
    assert_int_equal(grrl_trajectory_fit_of(&trajectory, &config, &result), GRRL_OK);
    trajectory.dimensions = 4;
    assert_int_equal(grrl_trajectory_fit_of(&trajectory, &config, &result), GRRL_ERR_ARGUMENT);
    trajectory.dimensions = 3;
    float *const fields[] = {&config.noise_m, &config.radius_m, &config.play_rad, &config.decided};
    for (int i = 0; i < 12; i++) {
        float kept = *fields[i % 4];
        *fields[i % 4] = i < 4 ? 0.0f : i < 8 ? NAN : INFINITY;
        assert_int_equal(grrl_trajectory_fit_of(&trajectory, &config, &result), GRRL_ERR_ARGUMENT);
        *fields[i % 4] = kept;
    }
    for (int i = 0; i < 3; i++) {
        rows[7] = i == 0 ? NAN : i == 1 ? INFINITY : -1001.0f;
        assert_int_equal(grrl_trajectory_fit_of(&trajectory, &config, &result), GRRL_ERR_NUMBER);
    }
    for (int i = 0; i < 4; i++) { /* a kilometre, and more */
        rows[7] = (i % 2 == 0 ? 1000.0f : 1000.1f) * (i < 2 ? 1.0f : -1.0f);
        enum grrl_status status = grrl_trajectory_fit_of(&trajectory, &config, &result);
        assert_int_equal(status == GRRL_ERR_NUMBER, i % 2 == 1);
    }
    for (uint32_t i = 0; i < 15; i++)
        rows[i] = (float)(i / 3) * 10.0f; /* all but the ends are in line */
    rows[7] = 500.0f;
    trajectory.n = 5;
    assert_int_equal(grrl_trajectory_fit_of(&trajectory, &config, &result), GRRL_ERR_NONE);
}

/* Exactly in one place, and with the noise of a tracker. */
static void test_rigid(void **state)
{
    (void)state;
    struct grrl_random random = support_random("rigid");
    memset(rows, 0, sizeof rows);
    struct grrl_trajectory_fit result = fit((struct grrl_trajectory){50, 3, rows});
    assert_int_equal(result.answer, GRRL_TRAJECTORY_RIGID);
    assert_true(result.p_rigid == 1.0f && sum_of(&result) == 1.0f);
    for (int run = 0; run < 20; run++) {
        result = fit(line(&random, 40 + 18 * (uint32_t)run, 0.0, 0.0005 + 0.0001 * run));
        assert_int_equal(result.answer, GRRL_TRAJECTORY_RIGID);
        result = fit(line(&random, 40 + 18 * (uint32_t)run, 0.05, 0.0005 + 0.0001 * run));
        assert_true(result.p_rigid < 0.01f);
    }
}

/* From below a nanometre to a hundred metres there are probabilities. */
static void test_any_size(void **state)
{
    (void)state;
    struct grrl_random random = support_random("any_size");
    for (int run = 0; run < 60; run++) {
        double size = pow(10.0, -10.0 + 0.2 * run);
        struct grrl_trajectory_fit result =
            fit(arc(&random, 60, size, 1.0, fmin(0.02 * size, 0.005)));
        assert_true(fabsf(sum_of(&result) - 1.0f) < 1e-5f);
        assert_true(result.p_rigid >= 0.0f && result.p_neither >= 0.0f);
        assert_true(result.revolute.probability >= 0.0f && result.prismatic.probability >= 0.0f);
    }
}

/* A sine is no joint, whatever its noise; of a line with a kink little is sure. */
static void test_neither(void **state)
{
    (void)state;
    struct grrl_random random = support_random("neither");
    for (int run = 0; run < 40; run++) {
        uint32_t n = 30 + 9 * (uint32_t)run;
        double length = 0.1 + 0.01 * run;
        for (uint32_t i = 0; i < n; i++) {
            double s = (double)i / (n - 1);
            double y = run % 2 == 0 ? 0.12 * sin(6.2832 * s) : s < 0.6 ? 0.0 : 1.2 * (s - 0.6);
            put(&random, i, length * s, length * y, 0.002 * length * (1 + run % 5));
        }
        struct grrl_trajectory_fit result = fit((struct grrl_trajectory){n, 3, rows});
        if (run % 2 == 0)
            assert_int_equal(result.answer, GRRL_TRAJECTORY_NEITHER);
        else
            assert_true(result.revolute.probability < 0.9f && result.p_neither > 0.1f);
    }
}

/* 30 degrees that are 8 mm off a line and 3 mm off a circle, by noise, in many samples; and the
 * handle of something small. */
static void test_many_samples(void **state)
{
    (void)state;
    struct grrl_random random = support_random("many_samples");
    for (int run = 0; run < 20; run++) {
        struct grrl_trajectory_fit result = fit(arc(&random, 736, 0.73, 0.5236, 0.003));
        assert_true(fabsf(result.revolute.residual_m - 0.003f) < 3e-4f);
        assert_true(fabsf(result.prismatic.residual_m - 0.008f) < 8e-4f);
        assert_true(result.effective_samples > 50.0f && result.effective_samples <= 736.0f);
        assert_int_equal(result.answer, GRRL_TRAJECTORY_REVOLUTE);
        result = fit(arc(&random, 100, 0.03, 1.0, 0.0002));
        assert_int_equal(result.answer, GRRL_TRAJECTORY_REVOLUTE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_circle),
        cmocka_unit_test(test_line),
        cmocka_unit_test(test_short_arcs),
        cmocka_unit_test(test_more_than_a_turn),
        cmocka_unit_test(test_outliers),
        cmocka_unit_test(test_fast_and_exact),
        cmocka_unit_test(test_rate_and_direction),
        cmocka_unit_test(test_two_dimensions),
        cmocka_unit_test(test_rigid),
        cmocka_unit_test(test_any_size),
        cmocka_unit_test(test_neither),
        cmocka_unit_test(test_many_samples),
        cmocka_unit_test(test_what_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
