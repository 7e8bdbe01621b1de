/* Elementary functions against the C library's, poses and axes. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/base/geometry.h"
#include "grrl/base/random.h"

#define SEED UINT64_C(20080625)
#define SAMPLES 400000

static double worst(double a, double b)
{
    return b > a || b != b ? b : a;
}

static void sines_are_accurate(void **state)
{
    (void)state;
    double error = 0.0;
    for (int i = -SAMPLES; i <= SAMPLES; i++) {
        float x = (float)i * (100.0f / SAMPLES);
        error = worst(error, fabs((double)grrl_sin(x) - sin((double)x)));
        error = worst(error, fabs((double)grrl_cos(x) - cos((double)x)));
    }
    print_message("sin, cos: %g\n", error);
    assert_true(error < 1e-7);
    assert_true(grrl_sin(0.0f) == 0.0f && grrl_cos(0.0f) == 1.0f);
    assert_true(isnan(grrl_sin(INFINITY)) && isnan(grrl_cos(NAN)) && isnan(grrl_sin(-1e9f)));
}

static void atan2_is_accurate_in_every_quadrant(void **state)
{
    (void)state;
    double error = 0.0;
    const float radius[] = {1e-30f, 1e-3f, 1.0f, 1e20f};
    for (int i = -SAMPLES / 4; i <= SAMPLES / 4; i++) {
        double angle = (double)i * (4.0 * (double)GRRL_PI / SAMPLES);
        for (unsigned r = 0; r < sizeof radius / sizeof radius[0]; r++) {
            float x = radius[r] * (float)cos(angle);
            float y = radius[r] * (float)sin(angle);
            double difference = fabs((double)grrl_atan2(y, x) - atan2((double)y, (double)x));
            error = worst(error, difference);
        }
    }
    print_message("atan2: %g\n", error);
    assert_true(error < 2.8e-7);
    assert_true(grrl_atan2(0.0f, 0.0f) == 0.0f);
    assert_true(grrl_atan2(0.0f, -1.0f) == GRRL_PI);
    assert_true(grrl_atan2(1.0f, 0.0f) == 0.5f * GRRL_PI);
    assert_true(grrl_atan2(-1.0f, 0.0f) == -0.5f * GRRL_PI);
}

static void exp_is_accurate_and_saturates(void **state)
{
    (void)state;
    double error = 0.0;
    for (int i = 0; i <= SAMPLES; i++) {
        float x = -87.33f + (float)i * (88.72f + 87.33f) / SAMPLES;
        double truth = exp((double)x);
        error = worst(error, fabs((double)grrl_exp(x) - truth) / truth);
    }
    print_message("exp: %g\n", error);
    assert_true(error < 1e-7);
    assert_true(grrl_exp(0.0f) == 1.0f);
    assert_true(grrl_exp(89.0f) == FLT_MAX && grrl_exp(INFINITY) == FLT_MAX);
    assert_true(grrl_exp(-88.0f) == 0.0f && grrl_exp(-INFINITY) == 0.0f);
    assert_true(isnan(grrl_exp(NAN)));
}

static void log_is_accurate_over_the_whole_range(void **state)
{
    (void)state;
    double error = 0.0;
    for (uint32_t bits = 1; bits < UINT32_C(0x7f800000); bits += 4001) {
        float x;
        memcpy(&x, &bits, sizeof x);
        double truth = log((double)x);
        if (x == 1.0f)
            continue;
        error = worst(error, fabs(((double)grrl_log(x) - truth) / truth));
    }
    for (int i = -2000; i <= 2000; i++) { /* near one, where the result vanishes */
        float x = 1.0f + (float)i * FLT_EPSILON;
        double truth = log((double)x);
        if (i != 0)
            error = worst(error, fabs(((double)grrl_log(x) - truth) / truth));
    }
    print_message("log: %g\n", error);
    assert_true(error < 1e-7);
    assert_true(grrl_log(1.0f) == 0.0f);
    assert_true(grrl_log(0.0f) == -FLT_MAX && grrl_log(-1.0f) == -FLT_MAX);
    assert_true(isnan(grrl_log(NAN)) && isinf(grrl_log(INFINITY)));
}

static void finiteness_is_told(void **state)
{
    (void)state;
    assert_true(grrl_is_finite(0.0f) && grrl_is_finite(-FLT_MAX) && grrl_is_finite(FLT_MIN / 2));
    assert_false(grrl_is_finite(NAN));
    assert_false(grrl_is_finite(INFINITY));
    assert_false(grrl_is_finite(-INFINITY));
}

static void angles_wrap(void **state)
{
    (void)state;
    for (int i = -SAMPLES; i <= SAMPLES; i++) {
        float x = (float)i * (100.0f / SAMPLES);
        float wrapped = grrl_wrap_rad(x);
        assert_true(wrapped > -GRRL_PI && wrapped <= GRRL_PI);
        double turn = remainder((double)wrapped - (double)x, 2.0 * 3.14159265358979323846);
        assert_true(fabs(turn) < 4e-7);
    }
    for (int turns = -1299; turns <= 1299; turns += 2) { /* the floats around odd multiples of pi */
        float x = (float)((double)turns * 3.14159265358979323846);
        for (int i = 0; i < 10; i++)
            x = nextafterf(x, -1e9f);
        for (int i = 0; i < 20; i++, x = nextafterf(x, 1e9f)) {
            float wrapped = grrl_wrap_rad(x);
            assert_true(wrapped > -GRRL_PI && wrapped <= GRRL_PI);
            double turn = remainder((double)wrapped - (double)x, 2.0 * 3.14159265358979323846);
            assert_true(fabs(turn) < 4e-7);
        }
    }
    assert_true(grrl_wrap_rad(GRRL_PI) == GRRL_PI);
    assert_true(fabsf(grrl_wrap_rad(-GRRL_PI) - GRRL_PI) < 4e-7f);
    assert_true(isnan(grrl_wrap_rad(INFINITY)));
}

static float uniform(struct grrl_random *random, float low, float high)
{
    return low + (high - low) * grrl_random_uniform(random);
}

static void poses_turn_shift_and_undo(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 1);
    struct grrl_pose quarter = {{1.0f, 2.0f}, 0.0f, 1.0f};
    struct grrl_vec2 moved = grrl_transform(quarter, (struct grrl_vec2){3.0f, 0.0f});
    assert_true(moved.x == 1.0f && moved.y == 5.0f);
    for (int i = 0; i < 2000; i++) {
        float angle = uniform(&random, -GRRL_PI, GRRL_PI);
        struct grrl_pose pose = {
            {uniform(&random, -1, 1), uniform(&random, -1, 1)}, grrl_cos(angle), grrl_sin(angle)};
        struct grrl_vec2 p = {uniform(&random, -1, 1), uniform(&random, -1, 1)};
        struct grrl_vec2 back = grrl_untransform(pose, grrl_transform(pose, p));
        assert_true(grrl_vec2_length(grrl_vec2_sub(back, p)) < 1e-6f);
        struct grrl_vec2 turned = grrl_rotate(pose, p);
        assert_true(fabsf(grrl_vec2_dot(turned, turned) - grrl_vec2_dot(p, p)) < 1e-6f);
        float turn = grrl_atan2(grrl_vec2_cross(p, turned), grrl_vec2_dot(p, turned));
        if (grrl_vec2_length(p) > 0.01f)
            assert_true(fabsf(grrl_wrap_rad(turn - angle)) < 3e-6f);
    }
}

static void principal_axes_rebuild_the_matrix(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 2);
    const float magnitude[] = {1e-30f, 1e-6f, 1.0f, 1e30f};
    for (int i = 0; i < 20000; i++) {
        float m = magnitude[i % 4];
        float xx = m * uniform(&random, -1, 1);
        float xy = m * uniform(&random, -1, 1) * ((i & 4) != 0 ? 1e-6f : 1.0f);
        float yy = m * uniform(&random, -1, 1);
        float major, minor;
        struct grrl_vec2 u;
        grrl_principal_axes(xx, xy, yy, &major, &minor, &u);
        assert_true(major >= minor);
        assert_true(u.x > 0.0f || (u.x == 0.0f && u.y == 1.0f));
        assert_true(fabsf(grrl_vec2_length(u) - 1.0f) < 1e-6f);
        assert_true(fabsf(major * u.x * u.x + minor * u.y * u.y - xx) < 3e-6f * m);
        assert_true(fabsf((major - minor) * u.x * u.y - xy) < 3e-6f * m);
        assert_true(fabsf(major * u.y * u.y + minor * u.x * u.x - yy) < 3e-6f * m);
    }
}

static void degenerate_matrices_have_axes_too(void **state)
{
    (void)state;
    const float matrix[][3] = {{0.0f, 0.0f, 0.0f}, {2.0f, 0.0f, 2.0f},     {1e-44f, 0.0f, 1e-44f},
                               {NAN, 0.0f, 1.0f},  {INFINITY, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}};
    for (unsigned i = 0; i < sizeof matrix / sizeof matrix[0]; i++) {
        float major, minor;
        struct grrl_vec2 axis;
        grrl_principal_axes(matrix[i][0], matrix[i][1], matrix[i][2], &major, &minor, &axis);
        assert_true(axis.x == 1.0f && axis.y == 0.0f);
    }
    float major, minor;
    struct grrl_vec2 axis;
    grrl_principal_axes(0.0f, 0.0f, 3.0f, &major, &minor, &axis);
    assert_true(axis.x == 0.0f && axis.y == 1.0f && major == 3.0f && minor == 0.0f);
    grrl_principal_axes(1.0f, -1.0f, 1.0f, &major, &minor, &axis);
    assert_true(axis.x > 0.0f && fabsf(axis.x + axis.y) < 1e-6f);
    assert_true(fabsf(major - 2.0f) < 1e-6f && fabsf(minor) < 1e-6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sines_are_accurate),
        cmocka_unit_test(atan2_is_accurate_in_every_quadrant),
        cmocka_unit_test(exp_is_accurate_and_saturates),
        cmocka_unit_test(log_is_accurate_over_the_whole_range),
        cmocka_unit_test(finiteness_is_told),
        cmocka_unit_test(angles_wrap),
        cmocka_unit_test(poses_turn_shift_and_undo),
        cmocka_unit_test(principal_axes_rebuild_the_matrix),
        cmocka_unit_test(degenerate_matrices_have_axes_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
