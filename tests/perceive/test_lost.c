/* Lost points are found where the recording shows them, and only there; tracks are chosen by length
 * and spread. */

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tracks.h"

#include "grrl/base/random.h"

enum { FRAMES = 60, MAX_POINTS = 400 };

/* A recording under construction: every point in every frame, unless it is taken away. */
struct scene {
    unsigned n_points;
    float x[FRAMES][MAX_POINTS];
    float y[FRAMES][MAX_POINTS];
    bool absent[FRAMES][MAX_POINTS];
};

static struct scene scene;

/* Half of the points rest, half turn about (400, 300) by a degree a frame, with noise in pixels.
 * step: what coordinates are rounded to, 0: not at all. */
static void make(unsigned n_points, float noise, float step)
{
    struct grrl_random random;
    grrl_random_init(&random, 7, 0);
    memset(&scene, 0, sizeof scene);
    scene.n_points = n_points;
    for (unsigned f = 0; f < FRAMES; f++) {
        for (unsigned i = 0; i < n_points; i++) {
            float angle = i % 2 == 0 ? 0.0f : 0.0174533f * (float)f;
            float u = 20.0f + 1.7f * (float)(i * 37 % 101);
            float v = 11.3f * (float)(i % 7) - 30.0f;
            float x = 400.0f + u * cosf(angle) - v * sinf(angle);
            float y = 300.0f + u * sinf(angle) + v * cosf(angle);
            x += noise * (grrl_random_uniform(&random) - 0.5f);
            y += noise * (grrl_random_uniform(&random) - 0.5f);
            scene.x[f][i] = step > 0.0f ? step * roundf(x / step) : x;
            scene.y[f][i] = step > 0.0f ? step * roundf(y / step) : y;
        }
    }
}

static void put(unsigned i, unsigned from, unsigned to, float x, float y)
{
    for (unsigned f = from; f < to; f++) {
        scene.x[f][i] = x;
        scene.y[f][i] = y;
    }
}

static void freeze(unsigned i, unsigned from, unsigned to)
{
    put(i, from + 1, to, scene.x[from][i], scene.y[from][i]);
}

static struct grrl_tracks tracks_of_scene(void)
{
    size_t n = (size_t)scene.n_points * FRAMES;
    struct grrl_tracks tracks = {.n_frames = FRAMES};
    tracks.id = malloc(n * sizeof *tracks.id);
    tracks.x = malloc(n * sizeof *tracks.x);
    tracks.y = malloc(n * sizeof *tracks.y);
    tracks.frame = calloc(FRAMES, sizeof *tracks.frame);
    assert_true(tracks.id != NULL && tracks.x != NULL && tracks.y != NULL && tracks.frame != NULL);
    for (unsigned f = 0; f < FRAMES; f++) {
        tracks.frame[f].first = tracks.n_points;
        for (unsigned i = 0; i < scene.n_points; i++) {
            if (scene.absent[f][i])
                continue;
            tracks.id[tracks.n_points] = (int32_t)i;
            tracks.x[tracks.n_points] = scene.x[f][i];
            tracks.y[tracks.n_points++] = scene.y[f][i];
            tracks.frame[f].n++;
        }
    }
    return tracks;
}

/* What is taken away of the scene. */
static struct grrl_tracks_lost lost_of_scene(void)
{
    struct grrl_tracks tracks = tracks_of_scene();
    size_t before = tracks.n_points;
    assert_true(grrl_tracks_drop_lost(&tracks));
    struct grrl_tracks_lost lost = tracks.lost;
    assert_int_equal(tracks.n_points + lost.marked + lost.frozen, before);
    size_t n = 0;
    for (size_t f = 0; f < tracks.n_frames; f++) {
        assert_int_equal(tracks.frame[f].first, n);
        n += tracks.frame[f].n;
    }
    assert_int_equal(n, tracks.n_points);
    grrl_tracks_free(&tracks);
    return lost;
}

static void test_marks(void **state)
{
    (void)state;
    make(20, 0.5f, 0.0f);
    assert_int_equal(lost_of_scene().marked, 0);
    put(3, 10, 15, 0.0f, 0.0f);
    assert_int_equal(lost_of_scene().marked, 5); /* one track, in many frames */
    put(4, 30, 31, 0.0f, 0.0f);
    put(9, 0, 7, 0.0f, 0.0f);
    put(9, 50, FRAMES, 0.0f, 0.0f);
    put(7, 0, FRAMES, 0.0f, 0.0f); /* never seen at all */
    struct grrl_tracks_lost lost = lost_of_scene();
    assert_int_equal(lost.marked, 5 + 1 + 7 + 10 + FRAMES);
    assert_int_equal(lost.frozen, 0);
    make(20, 0.5f, 1.0f); /* whole pixels, and another mark */
    put(3, 10, 15, -1.0f, -1.0f);
    put(5, 20, 21, -1.0f, -1.0f);
    assert_int_equal(lost_of_scene().marked, 6);
}

/* A point that passes through the origin, or lies there, has been seen. */
static void test_a_point_at_the_origin(void **state)
{
    (void)state;
    make(20, 0.0f, 0.0f);
    put(6, 0, FRAMES, 0.0f, 0.0f);
    put(3, 10, 11, 0.0f, 0.0f); /* one track, one frame: an outlier */
    assert_int_equal(lost_of_scene().marked, 0);
    make(20, 0.0f, 0.0f);
    for (unsigned f = 0; f < FRAMES; f++) {
        put(2, f, f + 1, (float)f - 20.0f, 0.0f);
        put(4, f, f + 1, (float)f - 30.0f, 0.0f);
        put(8, f, f + 1, f < 30 ? 0.0f : (float)f - 29.0f, 0.0f);
    }
    assert_int_equal(lost_of_scene().marked, 0);
}

static void test_frozen(void **state)
{
    (void)state;
    make(20, 0.5f, 0.0f);
    freeze(3, 20, 32);
    freeze(5, 40, FRAMES);
    freeze(8, 10, 12);
    assert_int_equal(lost_of_scene().frozen, 11 + 19);
    make(20, 0.5f, 0.0f); /* most tracks are lost at some time */
    for (unsigned i = 0; i < 14; i++)
        freeze(i, 10 + i, 30 + 2 * i);
    struct grrl_tracks_lost lost = lost_of_scene();
    assert_int_equal(lost.frozen, 14 * 19 + 91);
    assert_int_equal(lost.marked, 0);
    make(20, 0.7f, 0.01f); /* as text with two decimals */
    freeze(3, 20, 32);
    assert_int_equal(lost_of_scene().frozen, 11);
}

/* Where seen points stand still, standing still says nothing. */
static void test_not_frozen(void **state)
{
    (void)state;
    make(20, 0.0f, 0.0f); /* the rest is without noise */
    freeze(3, 20, 32);
    assert_int_equal(lost_of_scene().frozen, 0);
    make(20, 0.7f, 1.0f); /* whole pixels */
    freeze(3, 20, 32);
    freeze(4, 20, 42);
    assert_int_equal(lost_of_scene().frozen, 0);
    make(20, 0.0f, 0.0f); /* of two moving bodies one comes to rest */
    for (unsigned i = 0; i < 20; i += 2)
        for (unsigned f = 0; f < FRAMES; f++)
            put(i, f, f + 1, scene.x[0][i] + (float)f, scene.y[0][i]);
    for (unsigned i = 1; i < 20; i += 2)
        freeze(i, 30, FRAMES);
    assert_int_equal(lost_of_scene().frozen, 0);
}

static void test_choose(void **state)
{
    (void)state;
    make(MAX_POINTS, 0.5f, 0.0f);
    for (unsigned i = 0; i < MAX_POINTS; i++) /* a grid of 20 x 20, the upper half sees half */
        for (unsigned f = 0; f < FRAMES; f++) {
            put(i, f, f + 1, (float)(i % 20), (float)(i / 20));
            scene.absent[f][i] = i >= MAX_POINTS / 2 && (f < 10 || f >= 45);
            scene.absent[f][i] = i % 4 == 1 ? f > 9 : scene.absent[f][i];
        }
    struct grrl_tracks tracks = tracks_of_scene();
    size_t before = tracks.n_points;
    assert_true(grrl_tracks_choose(&tracks, 100));
    assert_int_equal(grrl_tracks_count_ids(&tracks), 100);
    assert_int_equal(tracks.left_out.n, MAX_POINTS - 100);
    assert_int_equal(tracks.n_points + tracks.left_out.n_points, before);
    unsigned blocks[25] = {0}; /* of 4 x 4 */
    bool left[MAX_POINTS] = {false};
    for (size_t i = 0; i < tracks.left_out.n; i++) {
        assert_true(i == 0 || tracks.left_out.id[i] > tracks.left_out.id[i - 1]);
        left[tracks.left_out.id[i]] = true;
    }
    for (unsigned i = 0; i < MAX_POINTS; i++) {
        blocks[i / 80 * 5 + i % 20 / 4] += !left[i];
        assert_true(left[i] || i % 4 != 1); /* the short ones are out */
    }
    for (unsigned i = 0; i < 25; i++)
        assert_in_range(blocks[i], 2, 6); /* 4 would be even */
    grrl_tracks_free(&tracks);
    tracks = tracks_of_scene();
    assert_true(grrl_tracks_choose(&tracks, MAX_POINTS));
    assert_int_equal(tracks.left_out.n, 0);
    assert_int_equal(tracks.n_points, before);
    grrl_tracks_free(&tracks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_marks),  cmocka_unit_test(test_a_point_at_the_origin),
        cmocka_unit_test(test_frozen), cmocka_unit_test(test_not_frozen),
        cmocka_unit_test(test_choose),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
