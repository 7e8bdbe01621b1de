/* Four points of the table: the map through them, what they must be, and the horizon. */

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rectify.h"

#include "grrl/base/random.h"

/* A pinhole above a table, tilted by `tilt` about an axis at `roll`; y points down. */
struct view {
    double tilt;
    double roll;
};

/* The pixel that shows a position (mm), 2 m away with a focal length of 1000 pixels. */
static void see(struct view view, double x, double y, double px[2])
{
    double along = cos(view.roll) * x + sin(view.roll) * y;
    double across = cos(view.roll) * y - sin(view.roll) * x;
    double far = 2000.0 + sin(view.tilt) * across;
    px[0] = 640.0 + 1000.0 * along / far;
    px[1] = 360.0 - 1000.0 * cos(view.tilt) * across / far;
}

static const double corner[GRRL_RECTIFY_POINTS][2] = {
    {-310.0, -180.0}, {280.0, -200.0}, {300.0, 190.0}, {-290.0, 230.0}};

static struct grrl_rectify rectify_of(struct view view)
{
    struct grrl_rectify rectify;
    struct grrl_rectify_point point[GRRL_RECTIFY_POINTS];
    for (int i = 0; i < GRRL_RECTIFY_POINTS; i++) {
        point[i] = (struct grrl_rectify_point){.table = {corner[i][0], corner[i][1]}};
        see(view, corner[i][0], corner[i][1], point[i].px);
    }
    assert_null(grrl_rectify_from(point, &rectify));
    return rectify;
}

static void the_table_comes_back(void **state)
{
    (void)state;
    enum { POINTS = 200, FRAMES = 2 };
    struct grrl_random random;
    grrl_random_init(&random, 7, 0);
    for (int run = 0; run < 40; run++) {
        struct view view = {1.1 * (double)grrl_random_uniform(&random),
                            6.3 * (double)grrl_random_uniform(&random)};
        struct grrl_rectify rectify = rectify_of(view);
        int32_t id[POINTS];
        float x[POINTS];
        float y[POINTS];
        double truth[POINTS][2];
        struct grrl_tracks_frame frame[FRAMES] = {{.first = 0, .n = POINTS / 2},
                                                  {.first = POINTS / 2, .n = POINTS / 2}};
        struct grrl_tracks tracks = {
            .n_points = POINTS, .id = id, .x = x, .y = y, .n_frames = FRAMES, .frame = frame};
        for (int i = 0; i < POINTS; i++) {
            double px[2];
            id[i] = i % (POINTS / 2);
            truth[i][0] = 1000.0 * (double)grrl_random_uniform(&random) - 500.0;
            truth[i][1] = 1000.0 * (double)grrl_random_uniform(&random) - 500.0;
            see(view, truth[i][0], truth[i][1], px);
            x[i] = (float)px[0];
            y[i] = (float)px[1];
        }
        assert_true(grrl_rectify_tracks(&rectify, &tracks));
        assert_int_equal(tracks.n_points, POINTS);
        for (int i = 0; i < POINTS; i++)
            assert_true(hypot((double)x[i] - truth[i][0], (double)y[i] - truth[i][1]) < 0.05);
    }
}

static void a_pixel_has_a_size(void **state)
{
    (void)state;
    assert_true(fabs(rectify_of((struct view){0.0, 0.4}).table_per_pixel - 2.0) < 1e-9);
    double seen_aside = rectify_of((struct view){0.8, 0.4}).table_per_pixel;
    assert_true(seen_aside > 2.2 && seen_aside < 2.6); /* 2 / sqrt(cos 0.8) = 2.4 */
}

static void beyond_the_horizon_is_no_table(void **state)
{
    (void)state;
    struct grrl_rectify rectify = rectify_of((struct view){1.0, 0.0});
    double horizon = 360.0 - 1000.0 * cos(1.0) / sin(1.0);
    int32_t id[] = {1, 2, 3, 4};
    float x[] = {600.0f, 640.0f, 700.0f, 640.0f};
    float y[] = {(float)horizon - 100.0f, (float)horizon + 50.0f, (float)horizon - 1.0f, 360.0f};
    struct grrl_tracks_frame frame = {.n = 4};
    struct grrl_tracks tracks = {
        .n_points = 4, .id = id, .x = x, .y = y, .n_frames = 1, .frame = &frame};
    assert_true(grrl_rectify_tracks(&rectify, &tracks));
    assert_int_equal(tracks.n_points, 2);
    assert_int_equal(tracks.lost.beyond, 2);
    assert_int_equal(frame.n, 2);
    assert_int_equal(id[0], 2);
    assert_int_equal(id[1], 4);
    assert_true(y[0] > 5000.0f && isfinite(y[0]));
}

static void four_points_of_a_plane(void **state)
{
    (void)state;
    struct grrl_rectify rectify;
    struct grrl_rectify_point point[GRRL_RECTIFY_POINTS] = {
        {{0, 0}, {0, 0}}, {{100, 0}, {1, 0}}, {{100, 100}, {1, 1}}, {{0, 100}, {0, 1}}};
    assert_null(grrl_rectify_from(point, &rectify));
    point[2] = (struct grrl_rectify_point){{200, 1}, {1, 1}}; /* pixels 1, 2 and 3 on a line */
    assert_non_null(strstr(grrl_rectify_from(point, &rectify), "no three of them on a line"));
    point[2] = (struct grrl_rectify_point){{100, 100}, {2, 0}}; /* positions 1, 2 and 3 */
    assert_non_null(strstr(grrl_rectify_from(point, &rectify), "no three of them on a line"));
    point[2] = (struct grrl_rectify_point){{100, 100}, {0, 1}}; /* two alike */
    assert_non_null(strstr(grrl_rectify_from(point, &rectify), "no three of them on a line"));
    point[2] = (struct grrl_rectify_point){{100, 100}, {0, 1}};
    point[3] = (struct grrl_rectify_point){{0, 100}, {1, 1}}; /* exchanged */
    assert_non_null(strstr(grrl_rectify_from(point, &rectify), "seen from one side"));
}

static void the_option_is_read(void **state)
{
    (void)state;
    struct grrl_rectify_point point[GRRL_RECTIFY_POINTS];
    assert_null(grrl_rectify_parse("1,2=3,4  -5,6.5=7e1,8 9,10=11,12\t13,14=15,-.5 ", point));
    assert_true(point[0].px[0] == 1.0 && point[0].px[1] == 2.0 && point[0].table[0] == 3.0);
    assert_true(point[1].px[0] == -5.0 && point[1].px[1] == 6.5 && point[1].table[0] == 70.0);
    assert_true(point[3].px[0] == 13.0 && point[3].table[1] == -0.5);
    static const char *const wrong[] = {
        "",
        "1,2=3,4 5,6=7,8 9,10=11,12",
        "1,2=3,4 5,6=7,8 9,10=11,12 13,14=15,16 17,18=19,20",
        "1,2=3,4 5,6=7,8 9,10=11,12 13,14=15",
        "1,2=3,4 5,6=7,8 9,10=11,12 13,14=15,",
        "1,2=3,4 5,6=7,8 9,10=11,12 13,14=15,16x",
        "1,2=3,4 5,6=7,8 9,10=11,12 13, 14=15,16",
        "1,2=3,4 5,6=7,8 9,10=11,12 nan,14=15,16",
        "1,2:3,4 5,6:7,8 9,10:11,12 13,14:15,16",
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        assert_non_null(grrl_rectify_parse(wrong[i], point));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_comes_back),
        cmocka_unit_test(a_pixel_has_a_size),
        cmocka_unit_test(beyond_the_horizon_is_no_table),
        cmocka_unit_test(four_points_of_a_plane),
        cmocka_unit_test(the_option_is_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
