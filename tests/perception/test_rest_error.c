/* Position error at rest that averaging does not remove: found where it is, and only there; with
 * it, more pushes do no harm. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "scene.h"

/* A table with a body of ten features that moves from rest to rest, if it does. Every feature is
 * off by an error of its own at each rest. */
static void make(int rests, double error_m, double step_m)
{
    scene_start(3 * rests);
    (void)scene_add_body(10);
    for (int i = 0; i < 20; i++)
        (void)scene_add_feature(GRRL_FEATURE_BACKGROUND, scene_uniform(-0.5, 0.5),
                                scene_uniform(-0.5, 0.5));
    for (int i = 0; i < 10; i++)
        scene.blob_of[i] = 1;
    scene_wander(0, step_m, 10.0 * step_m);
    scene_see(1.0, 0.1);
    for (int k = 0; k < scene.n_keyframes; k++) {
        for (int i = 0; i < scene.n_slots; i++) {
            scene.keyframe[k].point[i].x += (float)(error_m * scene_normal());
            scene.keyframe[k].point[i].y += (float)(error_m * scene_normal());
        }
    }
}

static void an_error_at_rest_is_found(void **state)
{
    (void)state;
    scene_seed("an_error_at_rest_is_found");
    const double error_m[] = {0.0006, 0.0008, 0.0012};
    for (int run = 0; run < 30; run++) {
        double error = error_m[run % 3];
        make(8, error, run % 2 == 0 ? 0.0 : 0.03);
        double found = (double)grrl_rest_error(&scene);
        if (found < 0.6 * error || found > 1.6 * error)
            fail_msg("found %.2g m instead of %.2g m", found, error);
    }
}

static void without_an_error_none_is_found(void **state)
{
    (void)state;
    scene_seed("without_an_error_none_is_found");
    int found = 0;
    for (int run = 0; run < 100; run++) {
        make(4 + run % 8, 0.0, run % 2 == 0 ? 0.0 : 0.03);
        found += grrl_rest_error(&scene) > 0.0f;
    }
    assert_true(found <= 2);
}

static void little_evidence_tells_nothing(void **state)
{
    (void)state;
    scene_seed("little_evidence_tells_nothing");
    make(3, 0.001, 0.0); /* three rests */
    assert_true(grrl_rest_error(&scene) == 0.0f);
    make(8, 0.001, 0.0);
    scene.n_slots = 19; /* few of the table */
    assert_true(grrl_rest_error(&scene) == 0.0f);
    make(8, 0.001, 0.0);
    scene.config.static_background = false;
    assert_true(grrl_rest_error(&scene) == 0.0f);
    make(8, 0.02, 0.0); /* and no error hides more than can be told at all */
    assert_true(grrl_rest_error(&scene) <= scene.config.min_slide_m);
}

static void the_larger_error_counts(void **state)
{
    (void)state;
    scene_start(1);
    scene.config.model_error_m = 0.0003f;
    assert_true(grrl_perception_model_error(&scene) == 0.0003f);
    scene.rest_error_m = 0.0005f;
    assert_true(grrl_perception_model_error(&scene) == 0.0005f);
    assert_near(1e6 * (double)grrl_perception_variance(&scene, 1), 0.49 + 0.25, 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_error_at_rest_is_found),
        cmocka_unit_test(without_an_error_none_is_found),
        cmocka_unit_test(little_evidence_tells_nothing),
        cmocka_unit_test(the_larger_error_counts),
    };
    return cmocka_run_group_tests_name("rest_error", tests, NULL, NULL);
}
