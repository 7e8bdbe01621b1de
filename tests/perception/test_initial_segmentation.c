/* What may be a body at first sight, against all thresholds and the closure of all neighbours. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

static bool seen(int slot)
{
    return scene.keyframe[0].weight[slot] > 0;
}

static double distance2(int a, int b)
{
    return square(minus(seen_at(0, a), seen_at(0, b)));
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* To the second nearest; 1e9: there is none. */
static double slow_neighbour2(int slot)
{
    double all[GRRL_MAX_FEATURES];
    int n = 0;
    for (int i = 0; i < scene.n_slots; i++)
        if (i != slot && seen(i))
            all[n++] = distance2(slot, i);
    qsort(all, (size_t)n, sizeof all[0], by_size);
    return n >= 2 ? all[1] : 1e9;
}

/* Otsu: the threshold at which the classes' means lie apart most, weighted. */
static double slow_reach(void)
{
    double all[GRRL_MAX_FEATURES];
    int n = 0;
    for (int i = 0; i < scene.n_slots; i++)
        if (seen(i))
            all[n++] = slow_neighbour2(i);
    qsort(all, (size_t)n, sizeof all[0], by_size);
    int dense = n;
    double best = 0.0;
    for (int split = 1; split < n; split++) {
        double mean[2] = {0.0, 0.0};
        for (int i = 0; i < n; i++)
            mean[i >= split] += log(all[i] + 1e-9) / (i < split ? split : n - split);
        double apart = mean[1] - mean[0];
        if (apart * apart * split * (n - split) > best && apart > 1.4) {
            best = apart * apart * split * (n - split);
            dense = split;
        }
    }
    return 3.0 * sqrt(all[dense / 2]);
}

static bool linked[GRRL_MAX_FEATURES][GRRL_MAX_FEATURES];

/* Which features hang together by steps shorter than reach, among those of `body` or all. */
static void close_neighbours(double reach2, int body)
{
    for (int i = 0; i < scene.n_slots; i++)
        for (int j = 0; j < scene.n_slots; j++)
            linked[i][j] = seen(i) && seen(j) && distance2(i, j) < reach2 &&
                           (body < 0 || (scene.body_of[i] == body && scene.body_of[j] == body));
    for (int k = 0; k < scene.n_slots; k++)
        for (int i = 0; i < scene.n_slots; i++)
            for (int j = 0; j < scene.n_slots && linked[i][k]; j++)
                linked[i][j] = linked[i][j] || linked[k][j];
}

static int size_of_group(int slot)
{
    int n = 0;
    for (int i = 0; i < scene.n_slots; i++)
        n += linked[slot][i];
    return n;
}

/* Dense clusters and sparse points on one keyframe. */
static void strew(int clusters, int each, int sparse)
{
    int capacity = GRRL_MAX_FEATURES;
    (void)scene_start(1);
    scene.config.min_features = (uint8_t)scene_int(3, 6);
    for (int c = 0; c < clusters; c++) {
        double x = scene_uniform(-0.4, 0.4);
        double y = scene_uniform(-0.4, 0.4);
        int n = scene_int(each / 2, each);
        for (int i = 0; i < n && scene.n_slots < capacity; i++)
            (void)scene_add_feature(9, x + scene_uniform(-0.03, 0.03),
                                    y + scene_uniform(-0.03, 0.03));
    }
    for (int i = 0; i < sparse && scene.n_slots < capacity; i++)
        (void)scene_add_feature(9, scene_uniform(-1.0, 1.0), scene_uniform(-1.0, 1.0));
    scene_see(1.0, 0.1);
}

static void check_segmentation(void)
{
    int n_seen = 0;
    for (int i = 0; i < scene.n_slots; i++)
        n_seen += seen(i);
    grrl_initial_segmentation(&scene);
    double reach = n_seen >= 3 ? slow_reach() : 0.0;
    close_neighbours(reach * reach, -1);
    assert_near(sqrt((double)scene.reach2_m2), reach, 1e-4);
    int n = 0;
    int body_of_group[GRRL_MAX_FEATURES]; /* a group is told by its first feature */
    for (int i = 0; i < scene.n_slots; i++) {
        int first = 0;
        while (first < i && !linked[i][first])
            first++;
        bool is_large = seen(i) && size_of_group(i) >= scene.config.min_features + 1;
        if (first == i)
            body_of_group[i] = is_large && n < GRRL_MAX_LINKS ? n++ : GRRL_FEATURE_BACKGROUND;
        bool in_body = body_of_group[first] != GRRL_FEATURE_BACKGROUND;
        assert_int_equal(scene.body_of[i], body_of_group[first]);
        assert_int_equal(scene.blob_of[i], in_body ? body_of_group[first] + 1 : 0);
    }
    for (int b = 0; b < n; b++)
        assert_int_equal(scene.number[b], b + 1);
    assert_int_equal(scene.n_bodies, n);
    assert_int_equal(scene.n_numbers, n);
}

static void clusters_are_bodies(void **state)
{
    (void)state;
    scene_seed("clusters_are_bodies");
    int bodies = 0;
    for (int run = 0; run < 150; run++) {
        strew(scene_int(0, 4), scene_int(4, 24), scene_int(0, 30));
        check_segmentation();
        bodies += scene.n_bodies;
    }
    print_message("%d bodies in 150 scenes\n", bodies);
    assert_true(bodies > 150);
}

/* Points in one place have the least distance, not none. */
static void points_in_one_place(void **state)
{
    (void)state;
    scene_seed("points_in_one_place");
    for (int run = 0; run < 40; run++) {
        (void)scene_start(1);
        int n = scene_int(6, 30);
        for (int i = 0; i < n; i++)
            (void)scene_add_feature(9, 0.01 * (i / 3), 0.0);
        for (int i = 0; i < n; i++)
            (void)scene_add_feature(9, scene_uniform(-0.0002, 0.0002), 1.0);
        scene_see(0.01, 0.0);
        check_segmentation();
    }
}

static void segmentation_at_capacity(void **state)
{
    (void)state;
    scene_seed("segmentation_at_capacity");
    for (int n = 0; n < 4; n++) { /* fewer than three tell nothing */
        strew(0, 0, n);
        check_segmentation();
    }
    strew(3, GRRL_MAX_FEATURES / 3, GRRL_MAX_FEATURES);
    check_segmentation();
    for (int run = 0; run < 3; run++) { /* more groups than links */
        (void)scene_start(1);
        scene.config.min_features = 3;
        for (int i = 0; i < GRRL_MAX_FEATURES; i++)
            (void)scene_add_feature(9, 0.2 * (i / 5) + 0.001 * (i % 5), 0.002 * (i % 2));
        scene_see(0.0, 0.0);
        check_segmentation();
        assert_int_equal(scene.n_bodies, GRRL_MAX_LINKS);
    }
}

/* Known truth: a dense object on a sparse table, and nothing of the table. */
static void objects_stand_out(void **state)
{
    (void)state;
    scene_seed("objects_stand_out");
    for (int run = 0; run < 30; run++) {
        (void)scene_start(1);
        for (int i = 0; i < 30; i++)
            (void)scene_add_feature(9, 0.004 * i, scene_uniform(-0.015, 0.015));
        for (int i = 0; i < 30; i++)
            (void)scene_add_feature(9, 0.3 * (i % 6) - 0.75, 0.3 * (i / 6) + 0.25);
        scene_see(1.0, 0.0);
        grrl_initial_segmentation(&scene);
        assert_int_equal(scene.n_bodies, 1);
        for (int i = 0; i < 60; i++)
            assert_int_equal(scene.body_of[i], i < 30 ? 0 : GRRL_FEATURE_BACKGROUND);
    }
}

/* A camera that moves: all that is seen is one body. */
static void without_background_all_is_one(void **state)
{
    (void)state;
    scene_seed("without_background_all_is_one");
    strew(2, 8, 10);
    scene.config.static_background = false;
    grrl_initial_segmentation(&scene);
    assert_int_equal(scene.n_bodies, 1);
    assert_int_equal(scene.number[0], 1);
    for (int i = 0; i < scene.n_slots; i++) {
        assert_int_equal(scene.body_of[i], 0);
        assert_int_equal(scene.blob_of[i], 1);
    }
}

/* Whether a group of a body's features is large enough. */
static void compact_bodies(void **state)
{
    (void)state;
    scene_seed("compact_bodies");
    int compact = 0;
    for (int run = 0; run < 300; run++) {
        strew(2, 12, 12);
        scene.reach2_m2 = (float)pow(scene_uniform(0.0, 0.05), 2.0);
        for (int i = 0; i < scene.n_slots; i++)
            scene.body_of[i] = (uint8_t)scene_int(0, 1);
        close_neighbours((double)scene.reach2_m2, 1);
        bool expected = false;
        for (int i = 0; i < scene.n_slots; i++)
            expected = expected || (seen(i) && scene.body_of[i] == 1 &&
                                    size_of_group(i) >= scene.config.min_features);
        assert_int_equal(grrl_initial_is_compact(&scene, 1), expected);
        compact += expected;
    }
    print_message("%d of 300 compact\n", compact);
    assert_true(compact > 50 && compact < 250);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clusters_are_bodies),           cmocka_unit_test(points_in_one_place),
        cmocka_unit_test(segmentation_at_capacity),      cmocka_unit_test(objects_stand_out),
        cmocka_unit_test(without_background_all_is_one), cmocka_unit_test(compact_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
