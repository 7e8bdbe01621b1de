/* Lone points off their bodies, against counting them by hand. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

static bool slow_is_off(const struct grrl_perception *p, int slot, int k)
{
    const struct grrl_perception_pose *pose = &p->pose[k][p->body_of[slot]];
    struct point at = to_world(placed_of(pose->pose), point_of(p->shape[slot]));
    int weight = p->keyframe[k].weight[slot];
    return weight > 0 && pose->weight > 0.0f &&
           sqrt(square(minus(point_of(p->keyframe[k].point[slot]), at)) / variance_of(weight)) >
               5.0;
}

/* How many of the keyframes not examined have the feature off. */
static int slow_times_off(const struct grrl_perception *p, int slot)
{
    int n = 0;
    for (int k = 0; k < p->n_keyframes; k++)
        n += !p->keyframe[k].examined && slow_is_off(p, slot, k);
    return n;
}

static int features_off(const struct grrl_perception *p, int body, int k)
{
    int n = 0;
    for (int i = 0; i < p->n_slots; i++)
        n += p->body_of[i] == body && slow_is_off(p, i, k);
    return n;
}

/* Takes out of p what is to be taken out; returns how many. */
static unsigned slow_drop(struct grrl_perception *p)
{
    unsigned dropped = 0;
    int fresh = 0;
    for (int k = 0; k < p->n_keyframes; k++)
        fresh += !p->keyframe[k].examined;
    for (int k = 0; k < p->n_keyframes; k++) {
        if (p->keyframe[k].examined || p->keyframe[k].at_rest)
            continue;
        bool take[GRRL_MAX_FEATURES] = {false};
        for (int i = 0; i < p->n_slots; i++) {
            take[i] = p->body_of[i] < p->n_bodies && slow_is_off(p, i, k) &&
                      features_off(p, p->body_of[i], k) <= 2 &&
                      slow_times_off(p, i) <= (fresh + 3) / 4;
        }
        for (int i = 0; i < p->n_slots; i++) {
            dropped += take[i];
            p->keyframe[k].weight[i] = take[i] ? 0 : p->keyframe[k].weight[i];
        }
    }
    for (int k = 0; k < p->n_keyframes; k++)
        p->keyframe[k].examined = true;
    p->counts.outliers += dropped;
    return dropped;
}

static struct grrl_perception copy;

/* Points off at random in a share of all, some features more often than others. */
static unsigned check_drop(int n_bodies, int n_features, int n_keyframes, double share)
{
    n_keyframes = scene_start(n_keyframes);
    for (int b = 0; b < n_bodies; b++)
        scene_wander(scene_add_body(n_features), 0.01, 0.1);
    scene_add_feature(GRRL_FEATURE_BACKGROUND, 0.3, 0.3);
    scene_add_feature(GRRL_FEATURE_NONE, -0.3, 0.3);
    scene_see(1.0, 0.1);
    scene_fit(); /* before: the poses are as they should be */
    int first = scene_int(0, n_keyframes / 2);
    for (int k = 0; k < n_keyframes; k++) {
        scene.keyframe[k].examined = k < first && scene_chance(0.9);
        for (int i = 0; i < scene.n_slots; i++)
            if (scene_chance(i % 4 == 0 ? 3.0 * share : share))
                scene.keyframe[k].point[i].y += (float)scene_uniform(0.002, 0.009);
    }
    scene.counts.outliers = 7;
    copy = scene;
    unsigned expected = slow_drop(&copy);
    assert_int_equal(grrl_outliers_drop(&scene), expected > 0);
    assert_memory_equal(scene.keyframe, copy.keyframe, sizeof scene.keyframe);
    assert_int_equal(scene.counts.outliers, 7 + expected);
    assert_false(grrl_outliers_drop(&scene)); /* all are examined */
    assert_memory_equal(scene.keyframe, copy.keyframe, sizeof scene.keyframe);
    return expected;
}

static void lone_points_are_dropped_as_by_hand(void **state)
{
    (void)state;
    scene_seed("lone_points_are_dropped_as_by_hand");
    unsigned dropped = 0;
    for (int run = 0; run < 300; run++) {
        dropped += check_drop(scene_int(1, 3), scene_int(3, 12), scene_int(1, 14),
                              run % 10 == 0 ? 0.0 : scene_uniform(0.01, 0.1));
    }
    print_message("%u points dropped\n", dropped);
    assert_true(dropped > 300);
}

static void lone_points_at_capacity(void **state)
{
    (void)state;
    scene_seed("lone_points_at_capacity");
    int each = (GRRL_MAX_FEATURES - 2) / GRRL_MAX_LINKS;
    assert_true(check_drop(GRRL_MAX_LINKS, each, GRRL_MAX_KEYFRAMES, 0.02) > 0);
    (void)check_drop(1, 1, 1, 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lone_points_are_dropped_as_by_hand),
        cmocka_unit_test(lone_points_at_capacity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
