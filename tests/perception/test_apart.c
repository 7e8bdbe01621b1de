/* Whether two bodies moved apart, against all pairs of rests and sums in double precision. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

struct slow_range {
    double turn;
    double shift2;
    double turn_var;
    double shift_var;
};

static bool sees(int k, int body)
{
    return scene.pose[k][body].weight > 0.0f;
}

static struct placed relative(int k, int a, int b)
{
    return seen_from(placed_of(scene.pose[k][a].pose), placed_of(scene.pose[k][b].pose));
}

/* Number of rests that average more frames than a push does. */
static int good_rests(int a, int b)
{
    int good = 0;
    for (int k = 0; k < scene.n_keyframes; k++) {
        int most = 0;
        for (int i = 0; i < scene.n_slots; i++)
            most = scene.keyframe[k].weight[i] > most ? scene.keyframe[k].weight[i] : most;
        good += scene.keyframe[k].at_rest && sees(k, a) && sees(k, b) && most > 3;
    }
    return good;
}

/* Keyframes that tell: the rests, if two of them are good. */
static int telling(int a, int b, int *keyframes)
{
    int n = 0;
    int good = good_rests(a, b);
    for (int k = 0; k < scene.n_keyframes; k++)
        if ((scene.keyframe[k].at_rest || good < 2) && sees(k, a) && sees(k, b))
            keyframes[n++] = k;
    return n;
}

/* The largest differences of two rests; a range has the first rest in it, where nothing differs. */
static struct slow_range slow_range_between(int a, int b)
{
    struct slow_range range = {0.0, 0.0, 0.0, 0.0};
    int rests[GRRL_MAX_KEYFRAMES];
    int n = telling(a, b, rests);
    double x = 0.0;
    double y = 0.0;
    for (int i = 0; i < n; i++) {
        const struct grrl_perception_pose *pa = &scene.pose[rests[i]][a];
        const struct grrl_perception_pose *pb = &scene.pose[rests[i]][b];
        struct placed first = relative(rests[0], a, b);
        struct point middle = {first.p.x / 2.0, first.p.y / 2.0};
        struct placed now = relative(rests[i], a, b);
        double turn_var =
            noise_square() / (double)pa->inertia + noise_square() / (double)pb->inertia;
        double shift_var = noise_square() / (double)pa->weight +
                           noise_square() / (double)pb->weight + turn_var * square(now.p) / 4.0;
        range.turn_var = fmax(range.turn_var, turn_var);
        range.shift_var = fmax(range.shift_var, shift_var);
        for (int j = 0; j < n; j++) {
            struct placed other = relative(rests[j], a, b);
            struct point moved = minus(to_world(now, to_local(first, middle)),
                                       to_world(other, to_local(first, middle)));
            double turn = seen_from(first, now).s - seen_from(first, other).s;
            range.turn = fmax(range.turn, turn);
            x = fmax(x, moved.x);
            y = fmax(y, moved.y);
        }
    }
    range.shift2 = x * x + y * y;
    return range;
}

static double capped(double x)
{
    return fmin(x, 100.0);
}

static double slow_evidence(uint8_t a, uint8_t b)
{
    static struct grrl_rigid_group both;
    double evidence = 0.0;
    both.n = 0;
    for (uint16_t i = 0; i < scene.n_slots; i++)
        if (scene.body_of[i] == a || scene.body_of[i] == b)
            both.slot[both.n++] = i;
    grrl_rigid_fit(&scene, both.slot, both.n, both.shape, both.pose, 1);
    for (int k = 0; k < scene.n_keyframes; k++) {
        double saved = 0.0;
        for (int i = 0; i < both.n; i++) {
            int slot = both.slot[i];
            uint8_t own = scene.body_of[slot];
            double w = scene.keyframe[k].weight[slot];
            struct point as_one =
                to_world(placed_of(both.pose[k].pose), point_of(both.shape[slot]));
            struct point alone =
                to_world(placed_of(scene.pose[k][own].pose), point_of(scene.shape[slot]));
            if (w > 0.0)
                saved += capped(square(minus(seen_at(k, slot), as_one)) / variance_of((int)w)) -
                         capped(square(minus(seen_at(k, slot), alone)) / variance_of((int)w));
        }
        if (sees(k, a) && sees(k, b) && both.pose[k].weight > 0.0f)
            evidence += fmax(saved - 12.0 * (double)scene.config.slack, 0.0);
    }
    return evidence;
}

/* --- scenes -------------------------------------------------------------------------------------
 */

/* Two bodies, 1 and 2, that move apart by up to `size` metres and 7 `size` radians. */
static void make_scene(int n_features, int n_keyframes, double size, double noise)
{
    n_keyframes = scene_start(n_keyframes);
    scene.config.slack = scene_chance(0.3) ? 2.0f : 1.0f;
    scene.config.min_turn_rad = (float)scene_uniform(0.02, 0.06);
    for (int b = 0; b < 3; b++)
        (void)scene_add_body(n_features);
    scene_wander(0, 0.01, 0.1);
    scene_wander(1, 0.01, 0.1);
    for (int k = 0; k < n_keyframes; k++) {
        double turn = scene_uniform(-7.0 * size, 7.0 * size);
        struct placed step =
            place(0.13 + scene_uniform(-size, size), scene_uniform(0.0, size), turn);
        scene_body[k][2] = then(scene_body[k][1], step);
    }
    scene_see(noise, 0.1);
    scene_fit();
    for (int i = 0; i < scene.n_slots; i++) {
        scene.has_moved[i] = scene_chance(0.5);
        scene.blob_of[i] = scene_chance(0.6) ? 0 : scene.body_of[i];
    }
}

static int merged;
static int parted;
static int little;
static int unmoved;

/* At most half of the features of each moved, and nobody says when things were at rest. */
static bool slow_never_moved(int a, int b)
{
    int balance[2] = {0, 0};
    for (int i = 0; i < scene.n_slots; i++)
        for (int j = 0; j < 2; j++)
            balance[j] += scene.body_of[i] != (j == 0 ? a : b) ? 0 : scene.has_moved[i] ? 1 : -1;
    return scene.config.static_background && good_rests(a, b) < 2 && balance[0] <= 0 &&
           balance[1] <= 0;
}

static void check_scene(uint8_t a, uint8_t b)
{
    struct slow_range slow = slow_range_between(a, b);
    struct grrl_apart_range fast = grrl_apart_range_between(&scene, a, b);
    double evidence = slow_evidence(a, b);
    double slack = (double)scene.config.slack;
    double turns = slow.turn / (double)scene.config.min_turn_rad;
    double shifts = sqrt(slow.shift2) / (double)scene.config.min_slide_m;
    assert_near(fast.turn, slow.turn, 2e-5);
    assert_near(1e3 * sqrt((double)fast.shift2), 1e3 * sqrt(slow.shift2), 2e-3);
    if (slow.turn_var > 0.0) {
        assert_near((double)fast.turn_var / slow.turn_var, 1.0, 1e-3);
        assert_near((double)fast.shift_var / slow.shift_var, 1.0, 1e-3);
    }
    assert_near(grrl_apart_evidence(&scene, a, b, 1e9f), evidence, 5e-3);
    bool turned = turns > 1.0 && slow.turn > 5.0 * sqrt(slow.turn_var);
    bool shifted = shifts > 1.0 && slow.shift2 > 25.0 * slow.shift_var;
    bool doubtless = turns >= 6.0 * slack || shifts >= 6.0 * slack;
    bool may_share = grrl_assign_bodies_may_share(&scene, a, b);
    bool one = may_share && (evidence < 40.0 * slack || !(turned || shifted));
    assert_int_equal(grrl_apart_may_merge(&scene, a, b),
                     one && !(doubtless && (turned || shifted)));
    assert_int_equal(grrl_apart_is_little(&scene, a, b), turns < 6.0 && shifts < 6.0);
    assert_int_equal(grrl_apart_never_moved(&scene, a, b), slow_never_moved(a, b));
    unmoved += slow_never_moved(a, b);
    merged += one;
    parted += turned || shifted;
    little += (turned || shifted) && turns < 6.0 && shifts < 6.0;
}

static void random_bodies_apart(void **state)
{
    (void)state;
    scene_seed("random_bodies_apart");
    merged = parted = little = unmoved = 0;
    for (int run = 0; run < 400; run++) {
        make_scene(scene_int(2, 10), scene_int(1, 24), pow(10.0, scene_uniform(-4.0, -1.5)),
                   run % 4 == 0 ? scene_uniform(0.0, 1.5) : 0.3);
        check_scene(1, 2);
        check_scene(2, 1);
    }
    print_message("of 800 pairs %d may be one, %d moved apart, %d of them a little\n", merged,
                  parted, little);
    assert_true(merged > 100 && parted > 100 && little > 50 && unmoved > 20);
}

static void bodies_apart_at_capacity(void **state)
{
    (void)state;
    scene_seed("bodies_apart_at_capacity");
    make_scene(1, 1, 0.01, 1.0);
    check_scene(1, 2);
    make_scene(GRRL_MAX_FEATURES / 3, GRRL_MAX_KEYFRAMES, 0.004, 1.0);
    check_scene(1, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_bodies_apart),
        cmocka_unit_test(bodies_apart_at_capacity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
