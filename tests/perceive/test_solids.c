/* Pieces of boxes that turn before a camera are joined; flat links, slides and other things stay.
 */

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "draw.h"
#include "solids.h"

enum { FRAMES = 60, MOST = 5, EACH = 16 };

/* A part of a thing that perception has found as a body. */
struct part {
    int thing;
    double from[3]; /* its points lie between the two corners, in the frame of the thing, in mm */
    double to[3];
};

/* The pose of a thing at a time from 0 to 1. */
struct pose {
    double at[3];  /* mm, the camera is at the origin and looks along z */
    double in;     /* turned in the plane of the image, rad */
    double out[2]; /* and out of it */
};

static struct grrl_model model;
static struct grrl_solids solids;
static struct grrl_perception_config config;
static int32_t ids[FRAMES * MOST * EACH];
static float xs[FRAMES * MOST * EACH];
static float ys[FRAMES * MOST * EACH];
static struct grrl_tracks_frame frames[FRAMES];
static struct grrl_tracks tracks;

/* Where a camera with a focal length of 800 pixels sees a point. */
static void see(const struct pose *pose, const double *p, double *x, double *y)
{
    double u = cos(pose->in) * p[0] - sin(pose->in) * p[1];
    double v = sin(pose->in) * p[0] + cos(pose->in) * p[1];
    double w = p[2] * cos(pose->out[0]) - u * sin(pose->out[0]);
    u = u * cos(pose->out[0]) + p[2] * sin(pose->out[0]);
    double depth = w * cos(pose->out[1]) - v * sin(pose->out[1]) + pose->at[2];
    v = v * cos(pose->out[1]) + w * sin(pose->out[1]);
    *x = 320.0 + 800.0 * (u + pose->at[0]) / depth;
    *y = 240.0 + 800.0 * (v + pose->at[1]) / depth;
}

/* Films the parts, each EACH points, and makes the model that has each of them as a body. missing:
 * the share of points that the tracker misses. */
static void film(const struct part *part, int n, struct pose (*pose_of)(int thing, double t),
                 double missing)
{
    double point[MOST * EACH][3];
    size_t at = 0;
    model = (struct grrl_model){.n_bodies = (uint8_t)n, .n_features = (uint16_t)(n * EACH)};
    for (int i = 0; i < n * EACH; i++) {
        for (int k = 0; k < 3; k++)
            point[i][k] = uniform(part[i / EACH].from[k], part[i / EACH].to[k]);
        model.feature_id[i] = 7 * i;
        model.feature_body[i] = (uint8_t)(i / EACH);
        model.body[i / EACH].number = (uint16_t)(i / EACH + 1);
        model.body[i / EACH].n_features = EACH;
    }
    for (int f = 0; f < FRAMES; f++) {
        frames[f] = (struct grrl_tracks_frame){.first = at, .pushing = true};
        for (int i = 0; i < n * EACH; i++) {
            struct pose pose = pose_of(part[i / EACH].thing, (double)f / (FRAMES - 1));
            double x, y;
            see(&pose, point[i], &x, &y);
            xs[at] = (float)(1e-3 * (x + 0.4 * normal()));
            ys[at] = (float)(1e-3 * (y + 0.4 * normal()));
            ids[at] = model.feature_id[i];
            model.feature_m[i] = (struct grrl_vec2){xs[at], ys[at]};
            if (uniform(0.0, 1.0) >= missing) {
                at++;
                frames[f].n++;
            }
        }
    }
    tracks = (struct grrl_tracks){
        .n_points = at, .id = ids, .x = xs, .y = ys, .n_frames = FRAMES, .frame = frames};
    grrl_perception_config_camera(&config, 0.001f);
}

/* Puts a joint between each body and the next. */
static void chain(void)
{
    for (uint8_t b = 0; b + 1 < model.n_bodies; b++)
        model.joint[model.n_joints++] =
            (struct grrl_joint){.a = b, .b = (uint8_t)(b + 1), .probability = 0.9f};
}

/* Two boxes that turn; three faces of the first and two of the second. */
static const struct part boxes[] = {{0, {-150, -100, -100}, {150, 100, -100}},
                                    {1, {-90, -90, -90}, {90, 90, -90}},
                                    {0, {150, -100, -100}, {150, 100, 100}},
                                    {0, {-150, -100, -100}, {150, -100, 100}},
                                    {1, {-90, 90, -90}, {90, 90, 90}}};

static struct pose boxes_turn(int thing, double t)
{
    if (thing == 0)
        return (struct pose){{-250, 60 * sin(3 * t), 1500}, 0.3 * t, {-0.3 - 0.7 * t, 0.4 * t}};
    return (struct pose){
        {250 - 80 * t, 0, 1400 - 100 * t}, 0.0, {0.5 * sin(4 * t), -0.3 - 0.6 * t}};
}

static void check_boxes(void)
{
    assert_int_equal(model.n_bodies, 2);
    assert_int_equal(model.n_joints, 0);
    assert_int_equal(solids.origin[0], 0);
    assert_true(solids.solid[0]);
    assert_int_equal(solids.origin[1], 1);
    assert_true(solids.solid[1]);
    assert_int_equal(model.body[0].number, 1);
    assert_int_equal(model.body[1].number, 2);
    assert_int_equal(model.body[0].n_features, 3 * EACH);
    for (int i = 0; i < model.n_features; i++)
        assert_int_equal(model.feature_body[i], boxes[i / EACH].thing);
}

static void boxes_become_whole(void **state)
{
    (void)state;
    for (int run = 0; run < 3; run++) {
        grrl_random_init(&random_numbers, 11, (uint64_t)run);
        film(boxes, 5, boxes_turn, run % 2 == 0 ? 0.0 : 0.05);
        chain();
        assert_true(grrl_solids_join(&tracks, &config, &model, &solids));
        check_boxes();
        /* in pixels it is some 150 to 300 wide, at about 190 from the left */
        assert_true(model.body[0].length_m > 0.1f && model.body[0].length_m < 0.3f);
        assert_true(model.body[0].width_m <= model.body[0].length_m);
        assert_true(fabsf(model.body[0].centroid_m.x - 0.19f) < 0.06f);
    }
}

/* A link on the table and one hinged to it, which turns by 60 degrees. */
static const struct part links[] = {{0, {-200, -30, 0}, {0, 30, 0}},
                                    {1, {0, -30, 0}, {200, 30, 0}}};

static struct pose links_turn(int thing, double t)
{
    return (struct pose){{50 * t, 30 * t, 1500}, 0.2 * t + (thing == 1 ? t : 0.0), {0.0, 0.0}};
}

/* The same, seen from 40 degrees aside: flat links that turn out of the plane of the image. */
static struct pose links_turn_aside(int thing, double t)
{
    struct pose pose = links_turn(thing, t);
    pose.out[1] = 0.7;
    return pose;
}

/* The second link slides along the first, which turns; both seen from aside. */
static struct pose links_slide_aside(int thing, double t)
{
    double turn = 0.6 * t;
    double along = thing == 1 ? 80.0 * t : 0.0;
    double c = cos(0.7) * sin(turn) * along;
    return (struct pose){
        {cos(turn) * along, c, 1500 - sin(0.7) * sin(turn) * along}, turn, {0.0, 0.7}};
}

static void check_apart(struct pose (*pose_of)(int thing, double t), const char *what)
{
    for (int run = 0; run < 3; run++) {
        grrl_random_init(&random_numbers, 12, (uint64_t)run);
        film(links, 2, pose_of, 0.0);
        chain();
        struct grrl_model before = model;
        assert_true(grrl_solids_join(&tracks, &config, &model, &solids));
        if (model.n_bodies != 2)
            fail_msg("%s: run %d", what, run);
        assert_int_equal(model.n_joints, 1);
        assert_memory_equal(&model, &before, sizeof model);
        assert_false(solids.solid[0]);
        assert_false(solids.solid[1]);
        assert_int_equal(solids.origin[1], 1);
    }
}

static void links_stay_apart(void **state)
{
    (void)state;
    check_apart(links_turn, "a hinge");
    check_apart(links_turn_aside, "a hinge from aside");
    check_apart(links_slide_aside, "a slide from aside");
}

/* A box that turns fast beside a board at rest. */
static const struct part fast[] = {{0, {-100, -100, -100}, {100, 100, 100}},
                                   {2, {-300, -200, 0}, {300, 200, 0}}};

static struct pose box_turns_fast(int thing, double t)
{
    if (thing == 2)
        return (struct pose){{0, 0, 1800}, 0.0, {0.0, 0.0}};
    return (struct pose){{60 * t, 0, 1500}, 1.5 * t, {0.9 * sin(4 * t), 0.9 * t}};
}

/* Perception finds splinters of the box, or nothing. */
static void splinters_and_loose_points_become_whole(void **state)
{
    (void)state;
    for (int run = 0; run < 6; run++) {
        bool splinters = run % 2 == 0;
        grrl_random_init(&random_numbers, 14, (uint64_t)run);
        film(fast, 2, box_turns_fast, 0.0);
        for (int i = 0; i < EACH; i++)
            model.feature_body[i] = (uint8_t)(splinters ? i / 4 : GRRL_FEATURE_NONE);
        for (int i = EACH; i < 2 * EACH; i++)
            model.feature_body[i] = splinters ? 4 : 0;
        model.n_bodies = splinters ? 5 : 1;
        chain();
        assert_true(grrl_solids_join(&tracks, &config, &model, &solids));
        assert_int_equal(model.n_bodies, 2);
        assert_int_equal(model.n_joints, 0);
        assert_true(solids.solid[splinters ? 0 : 1]);
        assert_false(solids.solid[splinters ? 1 : 0]);
        int whole = 0;
        for (int i = 0; i < EACH; i++)
            whole += model.feature_body[i] == (splinters ? 0 : 1);
        assert_true(whole > EACH / 2);
        for (int i = EACH; i < 2 * EACH; i++)
            assert_int_equal(model.feature_body[i], splinters ? 1 : 0);
    }
}

static struct pose links_slide_beside_a_board(int thing, double t)
{
    return thing == 2 ? box_turns_fast(2, t) : links_slide_aside(thing, t);
}

/* With four points each, two links that slide are as little a solid as with many. */
static void small_links_stay_apart(void **state)
{
    (void)state;
    static const struct part parts[] = {{0, {-200, -30, 0}, {0, 30, 0}},
                                        {2, {-300, -200, 0}, {300, 200, 0}},
                                        {1, {0, -30, 0}, {200, 30, 0}}};
    for (int run = 0; run < 3; run++) {
        grrl_random_init(&random_numbers, 15, (uint64_t)run);
        film(parts, 3, links_slide_beside_a_board, 0.0);
        for (int i = 0; i < model.n_features; i++)
            if (model.feature_body[i] != 1 && i % EACH >= 4)
                model.feature_body[i] = GRRL_FEATURE_BACKGROUND;
        assert_true(grrl_solids_join(&tracks, &config, &model, &solids));
        assert_int_equal(model.n_bodies, 3);
    }
}

/* With too few frames, points or bodies nothing is joined and nothing is read beyond the arrays. */
static void little_to_go_by(void **state)
{
    (void)state;
    for (size_t n = 0; n < 8; n++) {
        grrl_random_init(&random_numbers, 13, 0);
        film(boxes, 5, boxes_turn, 0.0);
        tracks.n_frames = n;
        assert_true(grrl_solids_join(&tracks, &config, &model, &solids));
        if (n < 6)
            assert_int_equal(model.n_bodies, 5);
    }
    film(boxes, 5, boxes_turn, 0.8);
    assert_true(grrl_solids_join(&tracks, &config, &model, &solids));
    assert_int_equal(model.n_bodies, 5);
    model = (struct grrl_model){.n_bodies = 0};
    assert_true(grrl_solids_join(&tracks, &config, &model, &solids));
    assert_int_equal(model.n_bodies, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_become_whole),
        cmocka_unit_test(links_stay_apart),
        cmocka_unit_test(splinters_and_loose_points_become_whole),
        cmocka_unit_test(small_links_stay_apart),
        cmocka_unit_test(little_to_go_by),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
