/* Which body a feature moves with, against the definitions in double precision. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

static double slow_limit(int n)
{
    return (2.0 * n + 4.0 * sqrt(4.0 * n) + 4.0) * sqrt((double)scene.config.slack);
}

/* How near a decision was to the other side: then rounding decides. */
static double doubt;

static bool below(double a, double b)
{
    doubt = fmin(doubt, fabs(a - b) / fmax(1.0, fabs(b)));
    return a < b;
}

static bool slow_moves(int slot)
{
    struct point mean = {0.0, 0.0};
    double weight = 0.0;
    double cost = 0.0;
    int n = 0;
    for (int k = 0; k < scene.n_keyframes; k++)
        weight += scene.keyframe[k].weight[slot];
    for (int k = 0; k < scene.n_keyframes; k++) {
        double share = scene.keyframe[k].weight[slot] / weight;
        mean = (struct point){mean.x + share * seen_at(k, slot).x,
                              mean.y + share * seen_at(k, slot).y};
    }
    for (int k = 0; k < scene.n_keyframes; k++) {
        int w = scene.keyframe[k].weight[slot];
        if (w > 0) {
            cost += fmin(square(minus(seen_at(k, slot), mean)) / variance_of(w), 16.0);
            n++;
        }
    }
    return n > 0 && !below(cost, slow_limit(n));
}

static bool slow_body_has_moved(int body)
{
    int moved = 0;
    int all = 0;
    for (int i = 0; i < scene.n_slots; i++) {
        moved += scene.body_of[i] == body && scene.has_moved[i];
        all += scene.body_of[i] == body;
    }
    return 2 * moved > all;
}

/* The blob of the first feature that has one. */
static int slow_blob(int body)
{
    for (int i = 0; i < scene.n_slots; i++)
        if (scene.body_of[i] == body && scene.blob_of[i] != 0)
            return scene.blob_of[i];
    return 0;
}

static bool slow_may_share(int blob, bool moved, int body)
{
    bool of_one = blob == 0 || slow_blob(body) == 0 || blob == slow_blob(body);
    return of_one || (moved && slow_body_has_moved(body));
}

static bool in_view(int k, int body)
{
    return scene.pose[k][body].weight > 0.0f;
}

static bool slow_place(int slot, int body, struct point *local)
{
    struct point sum = {0.0, 0.0};
    double weight = 0.0;
    for (int k = 0; k < scene.n_keyframes; k++) {
        double w = in_view(k, body) ? scene.keyframe[k].weight[slot] : 0.0;
        struct point q = to_local(placed_of(scene.pose[k][body].pose), seen_at(k, slot));
        sum = (struct point){sum.x + w * q.x, sum.y + w * q.y};
        weight += w;
    }
    if (weight > 0.0)
        *local = (struct point){sum.x / weight, sum.y / weight};
    return weight > 0.0;
}

static double slow_cost(int slot, int body, struct point local, int *n)
{
    double cost = 0.0;
    *n = 0;
    for (int k = 0; k < scene.n_keyframes; k++) {
        const struct grrl_perception_pose *pose = &scene.pose[k][body];
        int w = scene.keyframe[k].weight[slot];
        if (w == 0 || !in_view(k, body))
            continue;
        double variance = variance_of(w) + noise_square() / (double)pose->weight +
                          noise_square() * square(local) / (2.0 * (double)pose->inertia);
        cost +=
            fmin(square(minus(seen_at(k, slot), to_world(placed_of(pose->pose), local))) / variance,
                 16.0);
        (*n)++;
    }
    return cost;
}

/* Root mean squared distance from its own body below what tells a joint. */
static bool slow_stays_close(int slot)
{
    double sum = 0.0;
    int n = 0;
    for (int k = 0; k < scene.n_keyframes; k++) {
        if (scene.keyframe[k].weight[slot] > 0 && in_view(k, scene.body_of[slot])) {
            struct placed pose = placed_of(scene.pose[k][scene.body_of[slot]].pose);
            sum += square(minus(seen_at(k, slot), to_world(pose, point_of(scene.shape[slot]))));
            n++;
        }
    }
    return n > 0 && below(sqrt(sum / n), (double)scene.config.min_slide_m);
}

static int slow_best(int slot)
{
    int own = scene.body_of[slot];
    int best = GRRL_FEATURE_NONE;
    double best_excess = 0.0;
    bool is_table = own == GRRL_FEATURE_BACKGROUND && scene.blob_of[slot] == 0;
    for (int b = 0; b < scene.n_bodies && !is_table; b++) {
        struct point local = point_of(scene.shape[slot]);
        int n;
        if (b != own && !(slow_may_share(scene.blob_of[slot], scene.has_moved[slot], b) &&
                          slow_place(slot, b, &local)))
            continue;
        double excess = slow_cost(slot, b, local, &n) - slow_limit(n) - (b == own ? 2.0 : 0.0);
        if (n > 0 && below(excess, best_excess)) {
            best = b;
            best_excess = excess;
        }
    }
    if (best == GRRL_FEATURE_NONE && own < scene.n_bodies && slow_stays_close(slot))
        best = own;
    if (!scene.has_moved[slot] && (scene.blob_of[slot] == 0 || best == GRRL_FEATURE_NONE))
        best = GRRL_FEATURE_BACKGROUND;
    return best;
}

static bool slow_fits_elsewhere(int slot, int n_own)
{
    int n;
    double own = slow_cost(slot, scene.body_of[slot], point_of(scene.shape[slot]), &n);
    double leverage = 3.0 / (2.0 * n_own);
    double saved = 2.0 * n * (1.0 - (1.0 - leverage) / (1.0 + leverage));
    for (int b = 0; b < scene.n_bodies; b++) {
        struct point local;
        if (b == scene.body_of[slot] ||
            !slow_may_share(scene.blob_of[slot], scene.has_moved[slot], b) ||
            !slow_place(slot, b, &local))
            continue;
        if (!below(own + 8.0 + saved, slow_cost(slot, b, local, &n)))
            return true;
    }
    return false;
}

/* --- scenes -------------------------------------------------------------------------------------
 */

/* Bodies that move apart a little; features in the wrong body, in none and on the table; blobs. */
static void make_scene(int n_bodies, int n_features, int n_keyframes)
{
    n_keyframes = scene_start(n_keyframes);
    scene.config.slack = scene_chance(0.3) ? 2.0f : 1.0f;
    scene.config.model_error_m = (float)scene_uniform(0.0001, 0.0005);
    double size = pow(10.0, scene_uniform(-3.5, -1.5));
    for (int b = 0; b < n_bodies; b++) {
        (void)scene_add_body(n_features);
        scene_wander(b, 0.01, 0.1);
        for (int k = 0; k < n_keyframes && b > 0; k++) {
            double turn = scene_uniform(-5.0 * size, 5.0 * size);
            scene_body[k][b] = then(scene_body[k][0], place(0.1, scene_uniform(0.0, size), turn));
        }
    }
    for (int i = 0; i < 6; i++)
        (void)scene_add_feature(GRRL_FEATURE_BACKGROUND, scene_uniform(-0.3, 0.3), 0.0);
    scene_see(scene_uniform(0.8, 1.6), 0.2);
    for (int i = 0; i < scene.n_slots; i += 3) /* features that stray from their body */
        for (int k = 0; k < n_keyframes; k++)
            scene.keyframe[k].point[i].y += (float)scene_uniform(-0.003, 0.003);
    scene_fit();
    for (int k = 0; k < n_keyframes; k++)
        for (int b = 0; b < n_bodies; b++)
            scene.pose[k][b].weight = scene_chance(0.1) ? 0.0f : scene.pose[k][b].weight;
    for (int i = 0; i < scene.n_slots; i++) {
        scene.has_moved[i] = scene_chance(0.7);
        scene.blob_of[i] = (uint8_t)(scene_chance(0.7) ? scene_int(1, 2) : 0);
        if (scene_chance(0.2))
            scene.body_of[i] = (uint8_t)(scene_chance(0.5)   ? scene_int(0, n_bodies - 1)
                                         : scene_chance(0.5) ? GRRL_FEATURE_NONE
                                                             : GRRL_FEATURE_BACKGROUND);
    }
}

static uint8_t best_now(uint16_t slot, uint32_t changed)
{
    struct grrl_assign_origins origins;
    grrl_assign_find_origins(&scene, &origins);
    return grrl_assign_best(&scene, &origins, slot, changed);
}

static bool fits_elsewhere_now(uint16_t slot, uint16_t n_own)
{
    struct grrl_assign_origins origins;
    grrl_assign_find_origins(&scene, &origins);
    return grrl_assign_fits_elsewhere(&scene, &origins, slot, n_own);
}

static int compared;
static int doubtful;

static void check(int fast, int slow)
{
    compared++;
    if (doubt < 1e-3)
        doubtful++;
    else
        assert_int_equal(fast, slow);
}

static void check_scene(void)
{
    for (uint16_t i = 0; i < scene.n_slots; i++) {
        doubt = 1.0;
        int expected = slow_moves(i);
        check(grrl_assign_moves(&scene, i), expected);
        doubt = 1.0;
        expected = slow_best(i);
        check(best_now(i, UINT32_MAX), expected);
        uint16_t n_own = (uint16_t)scene_int(4, 12);
        doubt = 1.0;
        if (scene.body_of[i] < scene.n_bodies) {
            expected = slow_fits_elsewhere(i, n_own);
            check(fits_elsewhere_now(i, n_own), expected);
        }
    }
    for (uint8_t a = 0; a < scene.n_bodies; a++) {
        assert_int_equal(grrl_assign_body_has_moved(&scene, a), slow_body_has_moved(a));
        for (uint8_t b = 0; b < scene.n_bodies; b++)
            assert_int_equal(grrl_assign_bodies_may_share(&scene, a, b),
                             slow_may_share(slow_blob(a), slow_body_has_moved(a), b));
    }
}

static void features_of_random_bodies(void **state)
{
    (void)state;
    scene_seed("features_of_random_bodies");
    compared = doubtful = 0;
    for (int run = 0; run < 250; run++) {
        make_scene(scene_int(1, 4), scene_int(1, 9), scene_int(1, 14));
        check_scene();
    }
    print_message("%d compared, %d too near to call\n", compared, doubtful);
    assert_true(doubtful * 20 < compared);
}

static void features_at_capacity(void **state)
{
    (void)state;
    scene_seed("features_at_capacity");
    make_scene(1, 1, 1);
    check_scene();
    make_scene(GRRL_MAX_LINKS, (GRRL_MAX_FEATURES - 6) / GRRL_MAX_LINKS, GRRL_MAX_KEYFRAMES);
    check_scene();
}

/* Known truth: features that were given to the wrong body go back to their own. */
static void features_find_their_body(void **state)
{
    (void)state;
    scene_seed("features_find_their_body");
    int wrong = 0;
    for (int run = 0; run < 20; run++) {
        (void)scene_start(12);
        for (int b = 0; b < 3; b++)
            scene_wander(scene_add_body(12), 0.03, 0.5);
        scene_see(1.0, 0.1);
        scene_fit();
        for (uint16_t i = 0; i < scene.n_slots; i++) {
            uint8_t body = scene.body_of[i];
            scene.has_moved[i] = true;
            scene.body_of[i] = GRRL_FEATURE_NONE;
            wrong += best_now(i, UINT32_MAX) != body;
            scene.body_of[i] = body;
            wrong += best_now(i, UINT32_MAX) != body;
        }
    }
    print_message("%d of %d features elsewhere\n", wrong, 2 * 20 * 36);
    assert_true(wrong <= 4);
}

/* After some features have changed sides, only those bodies need to be tried. */
static void bodies_that_did_not_change_need_not_be_tried(void **state)
{
    (void)state;
    scene_seed("bodies_that_did_not_change_need_not_be_tried");
    int moved = 0;
    for (int run = 0; run < 60; run++) {
        make_scene(scene_int(3, 5), scene_int(4, 9), scene_int(2, 14));
        for (int round = 0; round < 3; round++) {
            uint32_t changed = 0;
            for (uint16_t i = 0; i < scene.n_slots; i++) {
                uint8_t was = scene.body_of[i];
                uint8_t best = best_now(i, UINT32_MAX);
                scene.body_of[i] = best;
                changed |= was == best || was >= scene.n_bodies ? 0u : UINT32_C(1) << was;
                changed |= was == best || best >= scene.n_bodies ? 0u : UINT32_C(1) << best;
                moved += was != best ? 1 : 0;
            }
            for (uint8_t b = 0; b < scene.n_bodies; b++) {
                uint16_t slots[GRRL_MAX_FEATURES];
                uint16_t n = grrl_rigid_slots(&scene, b, slots);
                if ((changed >> b & 1u) != 0)
                    grrl_rigid_fit(&scene, slots, n, scene.shape, &scene.pose[0][b],
                                   GRRL_MAX_LINKS);
            }
            for (uint16_t i = 0; i < scene.n_slots; i++)
                assert_int_equal(best_now(i, changed), best_now(i, UINT32_MAX));
        }
    }
    print_message("%d features moved\n", moved);
    assert_true(moved > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(features_of_random_bodies),
        cmocka_unit_test(features_at_capacity),
        cmocka_unit_test(features_find_their_body),
        cmocka_unit_test(bodies_that_did_not_change_need_not_be_tried),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
