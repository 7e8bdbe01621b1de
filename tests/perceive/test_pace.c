/* How fast points move, and ids that were given anew. */

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "pace.h"
#include "tracks.h"

#include "grrl/base/random.h"

enum { POINTS = 24, MAX_FRAMES = 60 };

/* Half of the points rest, half move along x by `step` a frame; every point has a new id after
 * `life` frames, at a time of its own, and is `gap` frames late with it. */
struct plan {
    unsigned frames;
    float step;
    float noise;
    unsigned life;
    unsigned gap;
};

static struct grrl_tracks make(struct plan plan)
{
    struct grrl_random random;
    grrl_random_init(&random, 11, 0);
    size_t most = (size_t)plan.frames * POINTS;
    struct grrl_tracks tracks = {.n_frames = plan.frames,
                                 .id = malloc(most * sizeof *tracks.id),
                                 .x = malloc(most * sizeof *tracks.x),
                                 .y = malloc(most * sizeof *tracks.y),
                                 .frame = calloc(plan.frames, sizeof *tracks.frame)};
    for (unsigned f = 0; f < plan.frames; f++) {
        tracks.frame[f].first = tracks.n_points;
        for (unsigned generation = 0; generation <= plan.frames / plan.life + 1; generation++) {
            for (unsigned i = 0; i < POINTS; i++) { /* by ascending id */
                unsigned age = f + i * 5 % plan.life;
                if (age / plan.life != generation || (generation > 0 && age % plan.life < plan.gap))
                    continue;
                size_t at = tracks.n_points++;
                tracks.id[at] = (int32_t)(generation * 100 + i);
                tracks.x[at] = 0.05f * (float)(i % 6) + (i % 2 > 0 ? plan.step * (float)f : 0.0f) +
                               plan.noise * (grrl_random_uniform(&random) - 0.5f);
                tracks.y[at] =
                    0.05f * (float)(i / 6) + plan.noise * (grrl_random_uniform(&random) - 0.5f);
                tracks.frame[f].n++;
            }
        }
    }
    return tracks;
}

static struct grrl_perception_config configured(struct plan plan)
{
    struct grrl_perception_config config;
    grrl_perception_config_default(&config);
    struct grrl_tracks tracks = make(plan);
    assert_true(grrl_pace_configure(&tracks, &config));
    grrl_tracks_free(&tracks);
    return config;
}

static void a_slow_recording_changes_nothing(void **state)
{
    (void)state;
    struct grrl_perception_config before;
    grrl_perception_config_default(&before);
    struct grrl_perception_config after =
        configured((struct plan){MAX_FRAMES, 0.002f, 0.001f, 1000, 0});
    assert_memory_equal(&before, &after, sizeof before);
}

static void what_moves_fast_is_no_outlier(void **state)
{
    (void)state;
    struct grrl_perception_config config = configured((struct plan){6, 0.025f, 0.001f, 1000, 0});
    assert_true(config.jump_m > 0.05f && config.jump_m < 0.2f);
    assert_int_equal(config.push_frames, 1);
    config = configured((struct plan){2, 0.3f, 0.001f, 1000, 0}); /* two pictures */
    assert_true(config.jump_m > 0.3f);
}

static void short_tracks_need_short_windows(void **state)
{
    (void)state;
    struct grrl_perception_config config =
        configured((struct plan){MAX_FRAMES, 0.002f, 0.001f, 8, 0});
    assert_int_equal(config.push_frames, 1);
    assert_true(config.jump_m == 0.015f);
}

static void assert_ids(const struct grrl_tracks *tracks, size_t n)
{
    assert_int_equal(grrl_tracks_count_ids(tracks), n);
    for (size_t f = 0; f < tracks->n_frames; f++)
        for (size_t i = 1; i < tracks->frame[f].n; i++)
            assert_true(tracks->id[tracks->frame[f].first + i] >
                        tracks->id[tracks->frame[f].first + i - 1]);
}

static void renewed_ids_become_one_track(void **state)
{
    (void)state;
    for (unsigned gap = 0; gap < 3; gap++) {
        struct grrl_tracks tracks = make((struct plan){MAX_FRAMES, 0.002f, 0.001f, 15, gap});
        size_t before = grrl_tracks_count_ids(&tracks);
        assert_true(before > 4 * POINTS);
        assert_true(grrl_tracks_join_renewed(&tracks, 0.0007f));
        assert_ids(&tracks, POINTS);
        assert_int_equal(tracks.n_renewed, before - POINTS);
        grrl_tracks_free(&tracks);
    }
}

/* Where the followers are too late, and where no track ends, all stays as it is. */
static void other_tracks_stay(void **state)
{
    (void)state;
    const struct plan plans[] = {{MAX_FRAMES, 0.002f, 0.001f, 15, 5},
                                 {MAX_FRAMES, 0.002f, 0.001f, 1000, 0},
                                 {1, 0.002f, 0.001f, 1000, 0}};
    for (size_t i = 0; i < sizeof plans / sizeof plans[0]; i++) {
        struct grrl_tracks tracks = make(plans[i]);
        size_t before = grrl_tracks_count_ids(&tracks);
        assert_true(grrl_tracks_join_renewed(&tracks, 0.0007f));
        assert_ids(&tracks, before);
        assert_int_equal(tracks.n_renewed, 0);
        grrl_tracks_free(&tracks);
    }
}

/* Two points within the noise of one another: nobody tells which of the two goes on. */
static void an_open_choice_is_none(void **state)
{
    (void)state;
    int32_t id[] = {1, 2, 1, 2, 3, 4, 3, 4};
    float x[] = {0.1f, 0.1005f, 0.1f, 0.1005f, 0.1f, 0.1005f, 0.1f, 0.1005f};
    float y[] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    struct grrl_tracks_frame frame[] = {
        {.first = 0, .n = 2}, {.first = 2, .n = 2}, {.first = 4, .n = 2}, {.first = 6, .n = 2}};
    struct grrl_tracks tracks = {
        .n_points = 8, .id = id, .x = x, .y = y, .n_frames = 4, .frame = frame};
    assert_true(grrl_tracks_join_renewed(&tracks, 0.0007f));
    assert_int_equal(tracks.n_renewed, 0);
    assert_int_equal(id[4], 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slow_recording_changes_nothing),
        cmocka_unit_test(what_moves_fast_is_no_outlier),
        cmocka_unit_test(short_tracks_need_short_windows),
        cmocka_unit_test(renewed_ids_become_one_track),
        cmocka_unit_test(other_tracks_stay),
        cmocka_unit_test(an_open_choice_is_none),
    };
    return cmocka_run_group_tests_name("pace", tests, NULL, NULL);
}
