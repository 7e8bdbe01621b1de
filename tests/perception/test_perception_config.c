/* What a configuration of perception may be. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

static void configurations_of_a_tracker_and_a_camera(void **state)
{
    (void)state;
    struct grrl_perception_config tracker;
    struct grrl_perception_config camera;
    grrl_perception_config_default(&tracker);
    grrl_perception_config_camera(&camera, 0.001f);
    (void)scene_start(0);
    const float *a = &tracker.noise_m;
    const float *b = &scene.config.noise_m;
    for (int i = 0; i < 10; i++)
        assert_true(a[i] == b[i]);
    assert_int_equal(tracker.min_features, 4);
    assert_true(tracker.static_background);
    static const double pixels[] = {0.001, 0.0012, 0.004, 0.05, 100.0, 0.035, 0.005, 0.1, 0.2, 5.0};
    b = &camera.noise_m;
    for (int i = 0; i < 10; i++)
        assert_true(is_near((double)b[i] / pixels[i], 1.0, 1e-5));
    assert_int_equal(camera.min_features, 4);
    assert_false(camera.static_background);
    grrl_perception_config_camera(&camera, 0.002f);
    assert_true(is_near((double)camera.keyframe_m, 0.008, 1e-6));
    assert_true(is_near((double)camera.slack, 5.0, 1e-6));
    assert_int_equal(grrl_perception_init(&scene, &camera), GRRL_OK);
    assert_memory_equal(&scene.config.noise_m, &camera.noise_m, 10 * sizeof(float));
    assert_false(scene.config.static_background);
}

static void wrong_configurations_are_refused(void **state)
{
    (void)state;
    static const float wrong[] = {0.0f, -1.0f, NAN, INFINITY, -INFINITY};
    struct grrl_perception_config config;
    for (int field = 0; field < 10; field++) {
        for (int i = 0; i < 5; i++) {
            grrl_perception_config_default(&config);
            (&config.noise_m)[field] = wrong[i];
            assert_int_equal(grrl_perception_init(&scene, &config), GRRL_ERR_ARGUMENT);
        }
    }
    grrl_perception_config_default(&config);
    config.slack = 0.99f;
    assert_int_equal(grrl_perception_init(&scene, &config), GRRL_ERR_ARGUMENT);
    config.slack = 1.0f;
    config.min_features = 2;
    assert_int_equal(grrl_perception_init(&scene, &config), GRRL_ERR_ARGUMENT);
    config.min_features = 3;
    assert_int_equal(grrl_perception_init(&scene, &config), GRRL_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(configurations_of_a_tracker_and_a_camera),
        cmocka_unit_test(wrong_configurations_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
