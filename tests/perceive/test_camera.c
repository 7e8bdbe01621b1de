/* A zoom and a tilted table: found from the tracks and undone, and nothing else is. */

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "camera.h"
#include "tracks.h"

#include "grrl/base/random.h"

enum { LINK = 16, GROUND = 30, POINTS = LINK + GROUND, FRAMES = 60 };

/* Pixels of 1 mm, as the library has them. A link turns and drifts before the ground. */
struct plan {
    float zoom;   /* of the picture, at the end */
    float grows;  /* the link alone */
    float tilt;   /* of the table, about an axis at 30 degrees */
    float radius; /* of the link's path */
    float turn;   /* of the link */
};

static const float noise_m = 0.0005f;
static const float distance_m = 2.0f;

static struct grrl_vec2 seen(struct plan plan, struct grrl_vec2 p, float t)
{
    const float c = cosf(0.5f);
    const float s = sinf(0.5f);
    float along = c * p.x + s * p.y;
    float across = -s * p.x + c * p.y;
    float scale = distance_m / (distance_m + sinf(plan.tilt) * across) * (1.0f + plan.zoom * t);
    along *= scale;
    across *= scale * cosf(plan.tilt);
    return (struct grrl_vec2){0.6f + c * along - s * across, 0.4f + s * along + c * across};
}

static struct grrl_vec2 place(struct plan plan, unsigned i, float t)
{
    if (i >= LINK)
        return (struct grrl_vec2){0.17f * ((float)(i % 6) - 2.5f), 0.16f * ((float)(i % 5) - 2.0f)};
    float c = cosf(plan.turn * t) * (1.0f + plan.grows * t);
    float s = sinf(plan.turn * t) * (1.0f + plan.grows * t);
    float x = 0.045f * ((float)(i % 8) - 3.5f);
    float y = i < 8 ? -0.05f : 0.05f;
    return (struct grrl_vec2){c * x - s * y + plan.radius * t - 0.1f,
                              s * x + c * y + 0.5f * plan.radius * t};
}

static struct grrl_tracks make(struct plan plan)
{
    struct grrl_random random;
    grrl_random_init(&random, 5, 0);
    size_t most = (size_t)FRAMES * POINTS;
    struct grrl_tracks tracks = {.n_frames = FRAMES,
                                 .n_points = most,
                                 .id = malloc(most * sizeof *tracks.id),
                                 .x = malloc(most * sizeof *tracks.x),
                                 .y = malloc(most * sizeof *tracks.y),
                                 .frame = calloc(FRAMES, sizeof *tracks.frame)};
    size_t at = 0;
    for (unsigned f = 0; f < FRAMES; f++) {
        tracks.frame[f].first = at;
        tracks.frame[f].n = POINTS;
        for (unsigned i = 0; i < POINTS; i++, at++) {
            float t = (float)f / (FRAMES - 1);
            struct grrl_vec2 p = seen(plan, place(plan, i, t), t);
            tracks.id[at] = (int32_t)i;
            tracks.x[at] = p.x + noise_m * 3.4f * (grrl_random_uniform(&random) - 0.5f);
            tracks.y[at] = p.y + noise_m * 3.4f * (grrl_random_uniform(&random) - 0.5f);
        }
    }
    return tracks;
}

/* The most that a distance on the link differs from the mean of the first ten frames, as share. */
static float bent(const struct grrl_tracks *tracks)
{
    float worst = 0.0f;
    for (unsigned pair = 0; pair < 8; pair++) {
        float first = 0.0f;
        for (unsigned f = 0; f + 10 <= FRAMES; f += 10) {
            float d = 0.0f;
            for (unsigned k = 0; k < 10; k++) {
                size_t a = tracks->frame[f + k].first + pair;
                size_t b = tracks->frame[f + k].first + (pair + 12) % LINK;
                d += 0.1f * hypotf(tracks->x[a] - tracks->x[b], tracks->y[a] - tracks->y[b]);
            }
            first = f == 0 ? d : first;
            worst = fmaxf(worst, fabsf(d / first - 1.0f));
        }
    }
    return worst;
}

static struct grrl_camera undone(struct plan plan, float *bent_before, float *bent_after)
{
    struct grrl_camera camera;
    struct grrl_tracks tracks = make(plan);
    *bent_before = bent(&tracks);
    assert_true(grrl_camera_undo(&tracks, 2.0f * noise_m, &camera));
    *bent_after = bent(&tracks);
    grrl_tracks_free(&tracks);
    return camera;
}

static void a_zoom_is_undone(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        float before;
        float after;
        float zoom = i == 0 ? 0.3f : -0.2f;
        struct grrl_camera camera =
            undone((struct plan){.zoom = zoom, .radius = 0.2f, .turn = 1.6f}, &before, &after);
        assert_true(camera.zoomed);
        assert_false(camera.tilted);
        float expected = zoom > 0.0f ? zoom : 1.0f / (1.0f + zoom) - 1.0f;
        assert_true(fabsf(camera.zoom - expected) < 0.02f);
        assert_true(before > 0.15f);
        assert_true(after < 0.02f);
    }
}

static void a_tilted_table_is_seen_from_above(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        const float tilts[] = {0.35f, 0.52f, -0.52f};
        float before;
        float after;
        struct grrl_camera camera =
            undone((struct plan){.tilt = tilts[i], .radius = 0.3f, .turn = 1.6f}, &before, &after);
        assert_true(camera.tilted);
        assert_false(camera.zoomed);
        assert_true(fabsf(camera.tilt_rad - fabsf(tilts[i])) < 0.08f);
        assert_true(before > 0.04f);
        assert_true(after < 0.02f);
    }
}

/* What is seen from above, or grows alone, comes through to the last bit. */
static void nothing_else_is_undone(void **state)
{
    (void)state;
    const struct plan plans[] = {
        {.radius = 0.2f, .turn = 1.6f}, {.turn = 1.6f}, {.grows = 0.25f, .turn = 0.3f}};
    for (size_t i = 0; i < sizeof plans / sizeof plans[0]; i++) {
        struct grrl_camera camera;
        struct grrl_tracks tracks = make(plans[i]);
        struct grrl_tracks same = make(plans[i]);
        assert_true(grrl_camera_undo(&tracks, 2.0f * noise_m, &camera));
        assert_false(camera.zoomed);
        assert_false(camera.tilted);
        assert_memory_equal(tracks.x, same.x, tracks.n_points * sizeof *tracks.x);
        assert_memory_equal(tracks.y, same.y, tracks.n_points * sizeof *tracks.y);
        grrl_tracks_free(&tracks);
        grrl_tracks_free(&same);
    }
}

static void the_answer_is_in_the_picture(void **state)
{
    (void)state;
    struct grrl_camera camera;
    static struct grrl_model above;
    static struct grrl_model picture;
    struct plan plan = {.tilt = 0.52f, .radius = 0.3f, .turn = 1.6f};
    struct grrl_tracks tracks = make(plan);
    struct grrl_tracks original = make(plan);
    assert_true(grrl_camera_undo(&tracks, 2.0f * noise_m, &camera));
    assert_true(camera.tilted);
    above.n_features = POINTS;
    for (uint16_t i = 0; i < POINTS; i++)
        above.feature_m[i] = (struct grrl_vec2){tracks.x[i], tracks.y[i]};
    above.n_bodies = 1;
    above.body[0].centroid_m = above.feature_m[0];
    above.body[0].axis = (struct grrl_vec2){1.0f, 0.0f};
    above.body[0].length_m = 0.1f;
    grrl_camera_to_picture(&camera, &above, &picture);
    for (uint16_t i = 0; i < POINTS; i++) {
        assert_true(fabsf(picture.feature_m[i].x - original.x[i]) < 1e-4f);
        assert_true(fabsf(picture.feature_m[i].y - original.y[i]) < 1e-4f);
    }
    assert_true(fabsf(picture.body[0].centroid_m.x - original.x[0]) < 1e-4f);
    assert_true(fabsf(grrl_vec2_length(picture.body[0].axis) - 1.0f) < 1e-4f);
    grrl_tracks_free(&tracks);
    grrl_tracks_free(&original);
}

static void little_to_see_is_left_alone(void **state)
{
    (void)state;
    struct grrl_camera camera;
    struct grrl_tracks tracks = make((struct plan){.zoom = 0.3f, .tilt = 0.5f});
    tracks.n_frames = 3;
    tracks.n_points = (size_t)3 * POINTS;
    assert_true(grrl_camera_undo(&tracks, noise_m, &camera));
    assert_false(camera.tilted);
    tracks.n_frames = 0;
    tracks.n_points = 0;
    assert_true(grrl_camera_undo(&tracks, noise_m, &camera));
    assert_false(camera.zoomed || camera.tilted);
    grrl_tracks_free(&tracks);
}

/* A hinge with few points at random places: `still` at rest, `moving` turn about the origin. */
static struct grrl_tracks make_hinge(unsigned still, unsigned moving, uint64_t seed)
{
    struct grrl_random random;
    grrl_random_init(&random, seed, 0);
    struct grrl_tracks tracks = make((struct plan){.radius = 0.0f});
    float place[POINTS][2];
    for (unsigned i = 0; i < still + moving; i++) {
        place[i][0] = (i < still ? -0.2f : 0.2f) * grrl_random_uniform(&random);
        place[i][1] = 0.04f * (grrl_random_uniform(&random) - 0.5f);
    }
    tracks.n_points = 0;
    for (unsigned f = 0; f < FRAMES; f++) {
        tracks.frame[f].first = tracks.n_points;
        tracks.frame[f].n = still + moving;
        for (unsigned i = 0; i < still + moving; i++) {
            float turn = i < still ? 0.1f : 0.4f + 1.05f * (float)f / (FRAMES - 1);
            size_t at = tracks.n_points++;
            tracks.id[at] = (int32_t)i;
            tracks.x[at] = cosf(turn) * place[i][0] - sinf(turn) * place[i][1] +
                           noise_m * 3.4f * (grrl_random_uniform(&random) - 0.5f);
            tracks.y[at] = sinf(turn) * place[i][0] + cosf(turn) * place[i][1] +
                           noise_m * 3.4f * (grrl_random_uniform(&random) - 0.5f);
        }
    }
    return tracks;
}

/* With few points most pairs have one on each body: their distances say nothing about the camera.
 */
static void a_few_points_do_not_reveal_the_camera(void **state)
{
    (void)state;
    static const unsigned counts[][2] = {{3, 3}, {5, 5}, {14, 3}, {12, 12}};
    for (unsigned i = 0; i < 4 * 20; i++) {
        struct grrl_camera camera;
        struct grrl_tracks tracks = make_hinge(counts[i / 20][0], counts[i / 20][1], i);
        assert_true(grrl_camera_undo(&tracks, 2.0f * noise_m, &camera));
        if (camera.zoomed || camera.tilted)
            fail_msg("%u and %u points, seed %u: zoom %g, tilt %g", counts[i / 20][0],
                     counts[i / 20][1], i, (double)camera.zoom, (double)camera.tilt_rad);
        grrl_tracks_free(&tracks);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_zoom_is_undone),
        cmocka_unit_test(a_tilted_table_is_seen_from_above),
        cmocka_unit_test(nothing_else_is_undone),
        cmocka_unit_test(the_answer_is_in_the_picture),
        cmocka_unit_test(little_to_see_is_left_alone),
        cmocka_unit_test(a_few_points_do_not_reveal_the_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
