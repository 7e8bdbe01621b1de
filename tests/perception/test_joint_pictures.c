/* Evidence for a slide seen by a camera: ways that come back, and turns in front of a background.
 */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

#define VARIANCE 4e-6f /* expected of a position: 2 mm */

/* From the equations in docs/perception.md, for n keyframes; `scatter` is the sum of squares across
 * the line. */
static double evidence_of(double distance, int n, double scatter)
{
    double variance = (2.0 * (double)VARIANCE + scatter) / n;
    double s2 = 4.0 * variance / (distance * distance);
    double evidence = 2.0 * log(2.0 * (double)GRRL_PI / sqrt(2.0 * (double)GRRL_PI * s2));
    return fmin(fmax(evidence, 0.0), 9.0);
}

static void put(int k, int body, struct placed at)
{
    scene.pose[k][body] = (struct grrl_perception_pose){
        .pose = {{(float)at.p.x, (float)at.p.y}, (float)at.c, (float)at.s},
        .weight = 10.0f,
        .inertia = 0.01f};
}

/* Body 1 slides to these places along the x axis of body 0, one per keyframe. */
static void slide_to(const double *places, int n)
{
    n = scene_start(n);
    (void)scene_add_body(8);
    (void)scene_add_body(8);
    for (int k = 0; k < n; k++) {
        struct placed a = place(0.3, -0.1, 0.7 * k);
        put(k, 0, a);
        put(k, 1, then(a, place(places[k], 0.05, 0.0)));
    }
}

static double evidence_along(float x)
{
    struct grrl_joint_evidence e = {.a = 0, .b = 1, .fit = {.axis_in_a = {x, 0.0f}}};
    return (double)grrl_joint_slide_in_pictures(&scene, &e, VARIANCE);
}

static void check(const double *places, int n, double evidence)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        slide_to(places, n);
        assert_near(evidence_along((float)sign), evidence, 1e-3);
    }
}

#define CHECK(evidence, ...)                                                                       \
    check((const double[]){__VA_ARGS__}, (int)(sizeof((double[]){__VA_ARGS__}) / sizeof(double)),  \
          (evidence))

static void a_way_back_counts_over_the_shorter_stroke(void **state)
{
    (void)state;
    scene_seed("a_way_back_counts_over_the_shorter_stroke");
    CHECK(0.0, 0.0, 0.02, 0.04);
    CHECK(evidence_of(0.04, 5, 0.0), 0.0, 0.02, 0.04, 0.02, 0.0);
    CHECK(evidence_of(0.01, 3, 0.0), 0.0, 0.04, 0.03);
    CHECK(evidence_of(0.01, 3, 0.0), 0.03, 0.04, 0.0);
    CHECK(evidence_of(0.04, 4, 0.0) + evidence_of(0.02, 4, 0.0), 0.0, 0.04, 0.0, 0.02);
    CHECK(0.0, 0.0, 0.001, 0.0, 0.001); /* below min_slide_m */
    CHECK(0.0, 0.0, 0.02, 0.019, 0.04);
    CHECK(9.0, 0.0, 1.0, 0.0);
}

static void keyframes_that_miss_a_body_are_skipped(void **state)
{
    (void)state;
    scene_seed("keyframes_that_miss_a_body_are_skipped");
    slide_to((const double[]){9.0, 0.0, 0.04, -9.0, 0.0}, 5);
    scene.pose[0][0].weight = 0.0f;
    scene.pose[3][1].weight = 0.0f;
    assert_near(evidence_along(1.0f), evidence_of(0.04, 3, 0.0), 1e-3);
}

static void the_line_is_as_exact_as_it_was_followed(void **state)
{
    (void)state;
    scene_seed("the_line_is_as_exact_as_it_was_followed");
    const double across[] = {0.002, -0.001, -0.002, 0.0, 0.001};
    slide_to((const double[]){0.0, 0.01, 0.02, 0.01, 0.0}, 5);
    for (int k = 0; k < 5; k++) {
        struct placed a = place(0.3, -0.1, 0.7 * k);
        put(k, 1, then(a, place(0.01 * (k < 3 ? k : 4 - k), across[k], 0.0)));
    }
    assert_near(evidence_along(1.0f), evidence_of(0.02, 5, 1e-5), 1e-3);
}

/* A pair that slides over this many keyframes and turns by a step in those between the two told, in
 * front of a background that turns, too. */
struct turn {
    int n;
    double slide;
    double step;
    int from;
    int to;
};

static double evidence_of_a_turn(struct turn turn, double background, bool visible)
{
    int n = scene_start(turn.n);
    double turned = 0.0;
    for (int k = 0; k < n; k++) {
        turned += k > turn.from && k <= turn.to ? turn.step : 0.0;
        struct placed a = place(0.0, 0.0, turned);
        put(k, 0, a);
        put(k, 1, then(a, place(turn.slide * k / (n - 1), 0.05, 0.0)));
        put(k, 2, place(0.0, 0.0, background * k));
    }
    scene.n_bodies = 3;
    for (int k = 0; k < n; k++)
        scene.pose[k][2].inertia = visible ? 0.1f : 0.03f; /* 3.2 or 1.7 times as wide */
    return evidence_along(1.0f);
}

static void a_common_turn_counts_before_a_background_at_rest(void **state)
{
    (void)state;
    scene_seed("a_common_turn_counts_before_a_background_at_rest");
    const struct turn none = {6, 0.05, 0.0, 0, 5};
    const struct turn turn = {6, 0.05, 0.04, 0, 5};
    assert_near(evidence_of_a_turn(turn, 0.0, true), 30.0, 1e-3);
    assert_near(evidence_of_a_turn(turn, 0.0, false), 0.0, 1e-3);
    assert_near(evidence_of_a_turn(turn, 0.04, true), 0.0, 1e-3); /* the camera rolls */
    assert_near(evidence_of_a_turn(none, 0.04, true), 0.0, 1e-3); /* the third body turns */
}

/* However slow it is, but not at the ends, where a hand may hold it. */
static void a_common_turn_counts_on_the_way(void **state)
{
    (void)state;
    scene_seed("a_common_turn_counts_on_the_way");
    int n = GRRL_MAX_KEYFRAMES < 20 ? GRRL_MAX_KEYFRAMES : 20;
    const struct turn turns[] = {
        {n, 0.012, 0.05, n / 2 - 2, n / 2}, {n, 0.012, 0.1, 0, 1}, {n, 0.012, 0.1, n - 2, n - 1}};
    assert_near(evidence_of_a_turn(turns[0], 0.0, true), 30.0, 1e-3);
    assert_near(evidence_of_a_turn(turns[1], 0.0, true), 0.0, 1e-3);
    assert_near(evidence_of_a_turn(turns[2], 0.0, true), 0.0, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_way_back_counts_over_the_shorter_stroke),
        cmocka_unit_test(keyframes_that_miss_a_body_are_skipped),
        cmocka_unit_test(the_line_is_as_exact_as_it_was_followed),
        cmocka_unit_test(a_common_turn_counts_before_a_background_at_rest),
        cmocka_unit_test(a_common_turn_counts_on_the_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
