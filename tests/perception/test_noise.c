/* The noise of a tracker, told from its points. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "kinematic_world.h"

static struct kinematic_world world;
static struct grrl_noise noise;

static void start(uint64_t seed, float noise_m)
{
    world_init(&world, seed);
    world.noise_m = noise_m;
    world_add_chain(&world, "RPR", -0.2f, 0.0f);
    world_add_background(&world, 20);
    world_shuffle_ids(&world);
    grrl_noise_init(&noise);
}

static void observe(int frames)
{
    for (int i = 0; i < frames; i++) {
        struct grrl_frame frame = world_frame(&world);
        grrl_noise_observe(&noise, &frame);
    }
}

static float estimate(void)
{
    float sigma_m = -1.0f;
    assert_int_equal(grrl_noise_estimate(&noise, &sigma_m), GRRL_OK);
    return sigma_m;
}

static void assert_within(float share, float sigma_m, float truth_m)
{
    if (!(fabsf(sigma_m / truth_m - 1.0f) < share))
        fail_msg("%g instead of %g", (double)sigma_m, (double)truth_m);
}

static void frames_at_rest_tell(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        float truth = 1e-5f * powf(3.0f, (float)seed); /* 30 um to 0.6 m */
        start(seed, truth);
        observe(10);
        assert_within(0.15f, estimate(), truth);
        observe(190);
        assert_within(0.04f, estimate(), truth);
    }
}

static void gaps_and_outliers_do_not_count(void **state)
{
    (void)state;
    start(20, 0.0007f);
    world.missing = 0.2f;
    world.outliers = 0.05f;
    observe(200);
    assert_within(0.05f, estimate(), 0.0007f);
}

/* A mean would be a centimetre off. */
static void ids_that_change_hands_do_not_count(void **state)
{
    (void)state;
    start(21, 0.0007f);
    for (int f = 0; f < 100; f++) {
        if (f % 20 == 10)
            world_shuffle_ids(&world);
        observe(1);
    }
    assert_within(0.15f, estimate(), 0.0007f);
}

static void a_steady_motion_has_no_second_difference(void **state)
{
    (void)state;
    start(22, 0.0007f);
    for (int f = 0; f < 200; f++) {
        world.root[0].p.x += 0.002f;
        world.root_angle[0] += 0.01f;
        observe(1);
    }
    assert_within(0.05f, estimate(), 0.0007f);
}

static void too_little_to_tell(void **state)
{
    (void)state;
    float sigma_m = 5.0f;
    start(23, 0.0007f);
    assert_int_equal(grrl_noise_estimate(&noise, &sigma_m), GRRL_ERR_NONE);
    observe(2);
    assert_int_equal(grrl_noise_estimate(&noise, &sigma_m), GRRL_ERR_NONE);
    start(23, 0.0f);
    world.noise_m = 0.0f;
    observe(20);
    assert_int_equal(grrl_noise_estimate(&noise, &sigma_m), GRRL_ERR_NUMBER);
    assert_true(sigma_m == 5.0f);
}

static void more_points_than_fit_and_wrong_ones_are_left_out(void **state)
{
    (void)state;
    enum { N = 3 * GRRL_MAX_FEATURES };
    static int32_t id[N];
    static float x[N];
    static float y[N];
    start(24, 0.0f);
    for (int f = 0; f < 50; f++) {
        for (int i = 0; i < N; i++) {
            id[i] = i % 2 == 0 ? INT32_MIN + i : INT32_MAX - i;
            x[i] = 0.3f + 0.002f * world_normal(&world);
            y[i] = 0.002f * world_normal(&world);
        }
        x[7] = NAN;
        y[8] = INFINITY;
        id[20] = id[21] = 77; /* twice in a frame */
        struct grrl_frame frame = {N, id, x, y};
        grrl_noise_observe(&noise, &frame);
    }
    assert_within(0.05f, estimate(), 0.002f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_at_rest_tell),
        cmocka_unit_test(gaps_and_outliers_do_not_count),
        cmocka_unit_test(ids_that_change_hands_do_not_count),
        cmocka_unit_test(a_steady_motion_has_no_second_difference),
        cmocka_unit_test(too_little_to_tell),
        cmocka_unit_test(more_points_than_fit_and_wrong_ones_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
