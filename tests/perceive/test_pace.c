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

/* --- a link of two points ----------------------------------------------------------------------
 */

enum { STILL = 6 };

/* Points at rest, and `movers` that move by a tenth in each of 11 frames; one in three frames
 * misses the first point. */
struct few {
    int32_t id[11 * 16];
    float x[11 * 16];
    float y[11 * 16];
    struct grrl_tracks_frame frame[11];
    struct grrl_tracks tracks;
};

static void make_few(struct few *few, unsigned movers)
{
    memset(few, 0, sizeof *few);
    few->tracks = (struct grrl_tracks){
        .id = few->id, .x = few->x, .y = few->y, .frame = few->frame, .n_frames = 11};
    for (unsigned f = 0; f < 11; f++) {
        few->frame[f] = (struct grrl_tracks_frame){.first = few->tracks.n_points, .pushing = true};
        for (unsigned i = f % 3 == 2 ? 1 : 0; i < STILL + movers; i++) {
            size_t at = few->tracks.n_points++;
            few->id[at] = (int32_t)(3 * i);
            few->x[at] = 0.2f * (float)i + (i >= STILL ? 0.1f * (float)f : 0.0f);
            few->frame[f].n++;
        }
    }
}

static unsigned count_stops(const struct few *few)
{
    unsigned stops = 0;
    for (unsigned f = 0; f < 11; f++)
        stops += few->frame[f].pushing ? 0u : 1u;
    return stops;
}

static void frames_in_which_two_points_moved_count_as_rest(void **state)
{
    (void)state;
    static struct few few;
    make_few(&few, 2);
    assert_true(grrl_pace_stop_for_two(&few.tracks, 0.25f, 1));
    assert_int_equal(count_stops(&few), 3); /* by 0.3: frames 3, 6 and 9 */
    assert_false(few.frame[3].pushing || few.frame[6].pushing || few.frame[9].pushing);
}

static void other_frames_stay_pushes(void **state)
{
    (void)state;
    static const struct {
        unsigned movers;
        float distance;
        unsigned keyframes;
    } cases[] = {{1, 0.25f, 1},  /* a single point is an outlier */
                 {2, 0.25f, 2},  /* not twice as many stops as keyframes */
                 {2, 0.05f, 5},  /* keyframes enough */
                 {2, 1.05f, 1},  /* nothing moved so far */
                 {0, 0.25f, 2}}; /* nothing moved at all */
    static struct few few;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        make_few(&few, cases[i].movers);
        assert_false(grrl_pace_stop_for_two(&few.tracks, cases[i].distance, cases[i].keyframes));
        assert_int_equal(count_stops(&few), 0);
    }
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
        cmocka_unit_test(frames_in_which_two_points_moved_count_as_rest),
        cmocka_unit_test(other_frames_stay_pushes),
    };
    return cmocka_run_group_tests_name("pace", tests, NULL, NULL);
}
