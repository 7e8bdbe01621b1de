/* The noise of a tracker, told from its points. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

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

/* --- against all differences, one by one
 * ------------------------------------------------------------ */

enum { IDS = 12, MAX_DIFFERENCES = 20000 };

static double difference[MAX_DIFFERENCES];
static int n_differences;

/* Sixteen equal steps from a power of two to the next, from 2^-24 m on. */
static unsigned bin_of(double size)
{
    int octave = -24;
    if (size < ldexp(1.0, -24))
        return 0;
    while (size >= ldexp(1.0, octave + 1))
        octave++;
    unsigned bin = 16u * (unsigned)(octave + 24) + (unsigned)(16.0 * (ldexp(size, -octave) - 1.0));
    return bin < GRRL_NOISE_BINS ? bin : GRRL_NOISE_BINS - 1;
}

/* Points of a few ids that come and go, some wrong or twice in a frame. */
static void observe_by_hand(int frames, float scatter_m)
{
    static float x[IDS][3];
    static float y[IDS][3];
    int seen[IDS] = {0}; /* frames in a row */
    for (int f = 0; f < frames; f++) {
        int32_t id[2 * IDS];
        float at_x[2 * IDS];
        float at_y[2 * IDS];
        uint32_t n = 0;
        for (int i = 0; i < IDS; i++) {
            bool visible = world_uniform(&world, 0.0f, 1.0f) < 0.9f;
            bool wrong = world_uniform(&world, 0.0f, 1.0f) < 0.02f;
            seen[i] = visible && !wrong ? seen[i] + 1 : 0;
            if (!visible)
                continue;
            for (int k = 2; k > 0; k--) {
                x[i][k] = x[i][k - 1];
                y[i][k] = y[i][k - 1];
            }
            x[i][0] = scatter_m * world_normal(&world);
            y[i][0] = scatter_m * world_normal(&world);
            id[n] = 1000 * i - 5000;
            at_x[n] = wrong && i % 2 == 0 ? NAN : x[i][0];
            at_y[n++] = wrong && i % 2 == 1 ? -INFINITY : y[i][0];
            if (i == 3) { /* twice: the first counts */
                id[n] = id[n - 1];
                at_x[n] = at_y[n] = 7.0f;
                n += wrong ? 0u : 1u;
            }
            if (seen[i] >= 3) {
                float dx = x[i][0] - 2.0f * x[i][1] + x[i][2];
                float dy = y[i][0] - 2.0f * y[i][1] + y[i][2];
                difference[n_differences++] = fabs((double)dx);
                difference[n_differences++] = fabs((double)dy);
            }
        }
        struct grrl_frame frame = {n, id, at_x, at_y};
        grrl_noise_observe(&noise, &frame);
    }
}

static int by_size(const void *a, const void *b)
{
    double p = *(const double *)a;
    double q = *(const double *)b;
    return (p > q) - (p < q);
}

/* From the median of the sorted list, without what lies beyond five standard deviations. */
static double slow_estimate(void)
{
    int n = n_differences;
    double spread = 0.0;
    qsort(difference, (size_t)n, sizeof difference[0], by_size);
    for (int round = 0; round < 20; round++) {
        spread = difference[n / 2] / 0.67449;
        while (n > 0 && difference[n - 1] > 5.0 * spread)
            n--;
    }
    return spread / sqrt(6.0);
}

static void every_difference_is_counted(void **state)
{
    (void)state;
    for (int run = 0; run < 10; run++) {
        unsigned bin[GRRL_NOISE_BINS] = {0};
        start((uint64_t)run + 30, 0.0f);
        n_differences = 0;
        float scatter = 1e-7f * powf(8.0f, (float)run); /* 100 nm to 13 m */
        observe_by_hand(300, scatter);
        for (int i = 0; i < n_differences; i++)
            bin[bin_of(difference[i])]++;
        assert_int_equal(noise.n_samples, n_differences);
        for (int i = 0; i < GRRL_NOISE_BINS; i++)
            assert_int_equal(noise.bin[i], bin[i]);
        assert_within(0.02f, estimate(), (float)slow_estimate());
    }
}

/* A hundred differences, from above and from below; a half of them too small to tell. */
static void limits_of_an_estimate(void **state)
{
    (void)state;
    float sigma_m;
    start(50, 0.0f);
    noise.n_samples = noise.bin[200] = GRRL_NOISE_MIN_SAMPLES - 1;
    assert_int_equal(grrl_noise_estimate(&noise, &sigma_m), GRRL_ERR_NONE);
    noise.n_samples = noise.bin[200] = GRRL_NOISE_MIN_SAMPLES;
    assert_int_equal(grrl_noise_estimate(&noise, &sigma_m), GRRL_OK);
    noise.bin[0] = 50;
    noise.bin[200] = 50;
    assert_int_equal(grrl_noise_estimate(&noise, &sigma_m), GRRL_ERR_NUMBER);
    noise.bin[0] = 49;
    noise.bin[200] = 51;
    assert_int_equal(grrl_noise_estimate(&noise, &sigma_m), GRRL_OK);
}

/* A median within a bin, told by its share: bin 200 begins at 2^-12 (1 + 8 / 16), 201 at
 * 2^-12 (1 + 9 / 16). */
static void medians_lie_within_their_bin(void **state)
{
    (void)state;
    start(51, 0.0f);
    for (uint32_t below = 0; below < 50; below += 10) {
        noise.n_samples = 100;
        noise.bin[100] = below;
        noise.bin[200] = 100 - below;
        double share = (50.0 - below) / (100.0 - below);
        double edge = ldexp(1.0 + 8.0 / 16.0 + share / 16.0, -12);
        assert_within(1e-3f, estimate(), (float)(edge / 0.67449 / sqrt(6.0)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_at_rest_tell),
        cmocka_unit_test(gaps_and_outliers_do_not_count),
        cmocka_unit_test(ids_that_change_hands_do_not_count),
        cmocka_unit_test(a_steady_motion_has_no_second_difference),
        cmocka_unit_test(too_little_to_tell),
        cmocka_unit_test(every_difference_is_counted),
        cmocka_unit_test(limits_of_an_estimate),
        cmocka_unit_test(medians_lie_within_their_bin),
        cmocka_unit_test(more_points_than_fit_and_wrong_ones_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
