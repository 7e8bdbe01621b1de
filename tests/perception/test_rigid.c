/* Fits of one rigid body, against a search over all angles in double precision. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

#define TOLERANCE_M 4e-6

struct slow_pose {
    struct placed at;
    double weight;
    double inertia;
};

/* A body's points in one keyframe, as far as they were seen. */
struct cloud {
    int n;
    double w[GRRL_MAX_FEATURES];
    struct point from[GRRL_MAX_FEATURES];
    struct point to[GRRL_MAX_FEATURES];
};

static double misfit_at(const struct cloud *cloud, double angle)
{
    struct placed turn = place(0.0, 0.0, angle);
    double sum = 0.0;
    for (int i = 0; i < cloud->n; i++)
        sum += cloud->w[i] * square(minus(cloud->to[i], to_world(turn, cloud->from[i])));
    return sum;
}

/* The best angle by trying. */
static double search_angle(const struct cloud *cloud)
{
    double best = 0.0;
    for (int i = 0; i < 90; i++) {
        double angle = 0.0698131700798 * i;
        best = misfit_at(cloud, angle) < misfit_at(cloud, best) ? angle : best;
    }
    double low = best - 0.07;
    double high = best + 0.07;
    for (int i = 0; i < 50; i++) {
        double a = low + (high - low) / 3.0;
        double b = high - (high - low) / 3.0;
        if (misfit_at(cloud, a) < misfit_at(cloud, b))
            high = b;
        else
            low = a;
    }
    return 0.5 * (low + high);
}

static struct slow_pose slow_fit_pose(int k, const uint16_t *slots, int n,
                                      const struct point *shape)
{
    static struct cloud cloud;
    struct slow_pose pose = {{{0.0, 0.0}, 1.0, 0.0}, 0.0, 0.0};
    struct point from = {0.0, 0.0};
    struct point to = {0.0, 0.0};
    double weight = 0.0;
    cloud.n = 0;
    for (int i = 0; i < n; i++) {
        double w = scene.keyframe[k].weight[slots[i]];
        if (w > 0.0) {
            cloud.w[cloud.n] = w;
            cloud.from[cloud.n] = shape[slots[i]];
            cloud.to[cloud.n++] = seen_at(k, slots[i]);
            weight += w;
        }
    }
    if (cloud.n < 2)
        return pose;
    for (int i = 0; i < cloud.n; i++) {
        from.x += cloud.w[i] / weight * cloud.from[i].x;
        from.y += cloud.w[i] / weight * cloud.from[i].y;
        to.x += cloud.w[i] / weight * cloud.to[i].x;
        to.y += cloud.w[i] / weight * cloud.to[i].y;
    }
    for (int i = 0; i < cloud.n; i++) {
        cloud.from[i] = minus(cloud.from[i], from);
        cloud.to[i] = minus(cloud.to[i], to);
        pose.inertia += cloud.w[i] * square(cloud.from[i]);
    }
    pose.at = place(0.0, 0.0, search_angle(&cloud));
    pose.at.p = minus(to, to_world(pose.at, from));
    pose.weight = weight;
    return pose;
}

/* The weighted mean of a feature in the body's frame. */
static bool slow_place(int slot, const struct slow_pose *poses, struct point *local)
{
    struct point sum = {0.0, 0.0};
    double weight = 0.0;
    for (int k = 0; k < scene.n_keyframes; k++) {
        double w = scene.keyframe[k].weight[slot];
        if (w > 0.0 && poses[k].weight > 0.0) {
            struct point q = to_local(poses[k].at, seen_at(k, slot));
            sum.x += w * q.x;
            sum.y += w * q.y;
            weight += w;
        }
    }
    if (weight > 0.0)
        *local = (struct point){sum.x / weight, sum.y / weight};
    return weight > 0.0;
}

/* From features to keyframes that saw two of them, and on to the others these saw; returns how many
 * features have a place. */
static int slow_spread(const uint16_t *slots, int n, uint16_t *known, int n_known,
                       struct point *shape, struct slow_pose *poses)
{
    int before = -1;
    while (n_known > before) {
        before = n_known;
        for (int i = 0; i < n; i++) {
            bool is_known = false;
            for (int j = 0; j < n_known; j++)
                is_known = is_known || known[j] == slots[i];
            if (!is_known && slow_place(slots[i], poses, &shape[slots[i]]))
                known[n_known++] = slots[i];
        }
        for (int k = 0; k < scene.n_keyframes; k++)
            if (!(poses[k].weight > 0.0))
                poses[k] = slow_fit_pose(k, known, n_known, shape);
    }
    return n_known;
}

static void slow_fit(const uint16_t *slots, int n, struct point *shape, struct slow_pose *poses)
{
    int reference = scene_reference(slots, n);
    uint16_t known[GRRL_MAX_FEATURES];
    int n_known = 0;
    struct point middle = {0.0, 0.0};
    struct point mean = {0.0, 0.0};
    for (int i = 0; i < n; i++)
        if (scene.keyframe[reference].weight[slots[i]] > 0)
            known[n_known++] = slots[i];
    for (int i = 0; i < n_known; i++) {
        middle.x += seen_at(reference, known[i]).x / n_known;
        middle.y += seen_at(reference, known[i]).y / n_known;
    }
    for (int i = 0; i < n; i++)
        shape[slots[i]] = mean; /* what is never seen with the others is in the middle */
    for (int i = 0; i < n_known; i++)
        shape[known[i]] = minus(seen_at(reference, known[i]), middle);
    for (int k = 0; k < scene.n_keyframes; k++)
        poses[k] = slow_fit_pose(k, known, n_known, shape);
    n_known = slow_spread(slots, n, known, n_known, shape, poses);
    for (int i = 0; i < n_known; i++) {
        (void)slow_place(known[i], poses, &shape[known[i]]);
        mean.x += shape[known[i]].x / n_known;
        mean.y += shape[known[i]].y / n_known;
    }
    for (int i = 0; i < n_known; i++)
        shape[known[i]] = minus(shape[known[i]], mean);
    for (int k = 0; k < scene.n_keyframes; k++)
        poses[k] = slow_fit_pose(k, known, n_known, shape);
}

static void assert_same_poses(const struct grrl_perception_pose *poses, int stride,
                              const struct slow_pose *slow)
{
    for (int k = 0; k < scene.n_keyframes; k++) {
        const struct grrl_perception_pose *pose = &poses[k * stride];
        assert_near(pose->weight, slow[k].weight, 1e-6);
        if (!(slow[k].weight > 0.0))
            continue;
        assert_near((double)pose->inertia / slow[k].inertia, 1.0, 1e-4);
        assert_near(pose->pose.c, slow[k].at.c, 1e-4);
        assert_near(pose->pose.s, slow[k].at.s, 1e-4);
        assert_at(pose->pose.p, slow[k].at.p, TOLERANCE_M);
    }
}

static struct grrl_vec2 shape[GRRL_MAX_FEATURES];
static struct grrl_perception_pose poses[GRRL_MAX_KEYFRAMES * GRRL_MAX_LINKS];
static struct point slow_shape[GRRL_MAX_FEATURES];
static struct slow_pose slow_poses[GRRL_MAX_KEYFRAMES];

/* One body of n features among others, fitted and compared. */
static void check_fit(int n, int n_keyframes, double noise, double missing, int stride)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    n_keyframes = scene_start(n_keyframes);
    int others = (GRRL_MAX_FEATURES - n) / 2;
    (void)scene_add_body(others < 5 ? others : 5);
    uint8_t body = scene_add_body(n);
    scene_wander(0, 0.01, 0.2);
    scene_wander(body, 0.01, 0.2);
    scene_see(noise, missing);
    uint16_t found = grrl_rigid_slots(&scene, body, slots);
    assert_int_equal(found, n);
    for (int i = 0; i < n; i++)
        assert_int_equal(scene.body_of[slots[i]], body);
    memset(poses, 0x7f, sizeof poses);
    grrl_rigid_fit(&scene, slots, found, shape, poses, (size_t)stride);
    slow_fit(slots, n, slow_shape, slow_poses);
    assert_same_poses(poses, stride, slow_poses);
    for (int i = 0; i < n && n > 1; i++)
        assert_at(shape[slots[i]], slow_shape[slots[i]], TOLERANCE_M);
}

static void fits_of_any_size(void **state)
{
    (void)state;
    scene_seed("fits_of_any_size");
    for (int run = 0; run < 60; run++) {
        check_fit(scene_int(2, 20), scene_int(1, 8), run % 3 == 0 ? 10.0 : 1.0,
                  run % 2 == 0 ? 0.3 : 0.0, run % 2 == 0 ? 1 : GRRL_MAX_LINKS);
    }
}

static void fits_at_capacity(void **state)
{
    (void)state;
    scene_seed("fits_at_capacity");
    check_fit(0, 3, 1.0, 0.0, 1);
    check_fit(1, 1, 1.0, 0.0, 1);
    check_fit(1, GRRL_MAX_KEYFRAMES, 1.0, 0.3, 1);
    check_fit(GRRL_MAX_FEATURES, GRRL_MAX_KEYFRAMES, 5.0, 0.2, GRRL_MAX_LINKS);
}

/* Without noise the truth comes out. */
static void exact_points_give_the_true_motion(void **state)
{
    (void)state;
    scene_seed("exact_points_give_the_true_motion");
    for (int run = 0; run < 20; run++) {
        (void)scene_start(6);
        (void)scene_add_body(9);
        scene_wander(0, 0.1, 1.0);
        scene_see(0.0, 0.2);
        scene_fit();
        for (int k = 1; k < 6; k++) {
            struct placed true_step = seen_from(scene_body[0][0], scene_body[k][0]);
            struct placed first = placed_of(scene.pose[0][0].pose);
            struct placed now = placed_of(scene.pose[k][0].pose);
            assert_true(scene.pose[k][0].weight > 0.0f);
            assert_near(seen_from(first, now).c, true_step.c, 1e-4);
            assert_near(seen_from(first, now).s, true_step.s, 1e-4);
        }
    }
}

/* Two points in one place have no direction. */
static void points_in_one_place_have_no_pose(void **state)
{
    (void)state;
    (void)scene_start(2);
    (void)scene_add_body(3);
    for (int i = 0; i < 3; i++)
        scene_shape[i] = (struct point){0.25, 0.5};
    scene_see(0.0, 0.0);
    scene_fit();
    assert_true(scene.pose[0][0].weight == 0.0f);
    assert_true(scene.pose[1][0].weight == 0.0f);
}

/* Takes points off their body in some keyframes, up to more than a third of them. */
static void take_off(double distance)
{
    for (int k = 0; k < scene.n_keyframes; k++) {
        double share = scene_uniform(0.0, 0.5);
        for (int i = 0; i < scene.n_slots; i++) {
            if (scene_chance(share)) {
                scene.keyframe[k].point[i].x += (float)scene_uniform(-distance, distance);
                scene.keyframe[k].point[i].y += (float)scene_uniform(-distance, distance);
            }
        }
    }
}

/* Leaves out the farthest point, one after the other, and searches for the pose of the rest. */
static struct slow_pose slow_refit(int k, const uint16_t *slots, int n, const struct point *local,
                                   struct slow_pose before)
{
    uint16_t kept[GRRL_MAX_FEATURES];
    int n_kept = 0;
    struct slow_pose pose = before;
    for (int i = 0; i < n; i++)
        if (scene.keyframe[k].weight[slots[i]] > 0)
            kept[n_kept++] = slots[i];
    int least = n_kept - n_kept / 3;
    while (pose.weight > 0.0) {
        int worst = -1;
        double worst2 = 0.0;
        double slide = (double)scene.config.min_slide_m;
        for (int i = 0; i < n_kept; i++) {
            double d2 = square(minus(seen_at(k, kept[i]), to_world(pose.at, local[kept[i]])));
            bool off =
                d2 > slide * slide && d2 > 25.0 * variance_of(scene.keyframe[k].weight[kept[i]]);
            if (off && d2 > worst2) {
                worst = i;
                worst2 = d2;
            }
        }
        if (worst < 0)
            break;
        kept[worst] = kept[--n_kept];
        if (n_kept < least)
            return before;
        pose = slow_fit_pose(k, kept, n_kept, local);
    }
    return pose;
}

static void check_refit(int n, int n_keyframes, double distance)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    n_keyframes = scene_start(n_keyframes);
    uint8_t body = scene_add_body(n);
    scene_wander(body, 0.02, 0.3);
    scene_see(1.0, 0.1);
    take_off(distance);
    uint16_t found = grrl_rigid_slots(&scene, body, slots);
    grrl_rigid_fit(&scene, slots, found, shape, poses, GRRL_MAX_LINKS);
    for (int i = 0; i < n; i++)
        slow_shape[i] = point_of(shape[i]);
    for (int k = 0; k < n_keyframes; k++) {
        const struct grrl_perception_pose *pose = &poses[k * GRRL_MAX_LINKS];
        struct slow_pose before = {placed_of(pose->pose), (double)pose->weight,
                                   (double)pose->inertia};
        slow_poses[k] = slow_refit(k, slots, n, slow_shape, before);
    }
    grrl_rigid_refit(&scene, slots, found, shape, poses, GRRL_MAX_LINKS);
    assert_same_poses(poses, GRRL_MAX_LINKS, slow_poses);
}

static void points_off_the_body_are_left_out(void **state)
{
    (void)state;
    scene_seed("points_off_the_body_are_left_out");
    for (int run = 0; run < 60; run++)
        check_refit(scene_int(2, 14), scene_int(1, 10), run % 2 == 0 ? 0.03 : 0.004);
    check_refit(1, 1, 0.01);
    check_refit(GRRL_MAX_FEATURES, GRRL_MAX_KEYFRAMES, 0.02);
}

/* Places and costs of features, their own body's and others', for poses that are given. */
static void places_and_costs(void **state)
{
    (void)state;
    scene_seed("places_and_costs");
    for (int run = 0; run < 60; run++) {
        (void)scene_start(scene_int(1, GRRL_MAX_KEYFRAMES));
        scene.config.model_error_m = (float)scene_uniform(0.0001, 0.001);
        (void)scene_add_body(scene_int(2, 10));
        (void)scene_add_body(scene_int(2, 10));
        scene_wander(0, 0.001, 0.01);
        scene_wander(1, 0.001, 0.01);
        scene_see(1.5, 0.3);
        scene_fit();
        for (uint16_t i = 0; i < scene.n_slots; i++) {
            uint8_t body = (uint8_t)scene_int(0, 1);
            struct grrl_vec2 local = {7.0f, 7.0f};
            struct point slow = {7.0, 7.0};
            for (int k = 0; k < scene.n_keyframes; k++) {
                slow_poses[k] = (struct slow_pose){placed_of(scene.pose[k][body].pose),
                                                   (double)scene.pose[k][body].weight,
                                                   (double)scene.pose[k][body].inertia};
            }
            bool placed = grrl_rigid_place(&scene, i, &scene.pose[0][body], GRRL_MAX_LINKS, &local);
            assert_int_equal(placed, slow_place(i, slow_poses, &slow));
            assert_at(local, slow, TOLERANCE_M);
            double cost = 0.0;
            int n = 0;
            for (int k = 0; k < scene.n_keyframes; k++) {
                int w = scene.keyframe[k].weight[i];
                if (w > 0 && slow_poses[k].weight > 0.0) {
                    struct point miss =
                        minus(seen_at(k, i), to_world(slow_poses[k].at, point_of(local)));
                    double pose_variance =
                        noise_square() * (1.0 / slow_poses[k].weight +
                                          square(point_of(local)) / (2.0 * slow_poses[k].inertia));
                    double d2 = square(miss) / (variance_of(w) + pose_variance);
                    cost += fmin(d2, (double)GRRL_COST_CAP);
                    n++;
                }
            }
            uint16_t count = 77;
            float fast = grrl_rigid_cost(&scene, i, local, &scene.pose[0][body], GRRL_MAX_LINKS,
                                         GRRL_COST_ANY, &count);
            assert_int_equal(count, n);
            assert_near(fast, cost, 2e-3);
            float enough = (float)scene_uniform(0.0, 1.5) * fast;
            count = 77;
            float given_up = grrl_rigid_cost(&scene, i, local, &scene.pose[0][body], GRRL_MAX_LINKS,
                                             enough, &count);
            assert_true(fast > enough ? given_up > enough && count == 77
                                      : given_up == fast && count == n);
        }
    }
}

/* Where two keyframes rule a feature out, its cost is too high wherever it lies; most of those that
 * cost too much are ruled out. */
static void far_features_are_off(void **state)
{
    (void)state;
    scene_seed("far_features_are_off");
    int off = 0;
    int costly = 0;
    for (int run = 0; run < 200; run++) {
        double size = pow(10.0, scene_uniform(-3.5, -1.0));
        (void)scene_start(scene_int(1, GRRL_MAX_KEYFRAMES));
        (void)scene_add_body(scene_int(2, 10));
        (void)scene_add_body(scene_int(2, 10));
        scene_wander(0, size, 10.0 * size);
        scene_wander(1, size, 10.0 * size);
        scene_see(1.0, 0.2);
        scene_fit();
        for (uint16_t i = 0; i < scene.n_slots; i++) {
            const struct grrl_perception_pose *of_other = &scene.pose[0][1];
            float enough = (float)scene_uniform(0.0, 8.0) * (float)scene.n_keyframes;
            struct grrl_vec2 local = {0.0f, 0.0f};
            uint16_t n;
            bool is_off = grrl_rigid_is_off(&scene, i, of_other, GRRL_MAX_LINKS, enough);
            (void)grrl_rigid_place(&scene, i, of_other, GRRL_MAX_LINKS, &local);
            for (int at = 0; at < 4; at++) {
                float cost =
                    grrl_rigid_cost(&scene, i, local, of_other, GRRL_MAX_LINKS, GRRL_COST_ANY, &n);
                assert_true(!is_off || cost > enough);
                costly += at == 0 && cost > enough ? 1 : 0;
                local.x += (float)scene_uniform(-3.0 * size, 3.0 * size);
            }
            off += is_off ? 1 : 0;
        }
    }
    print_message("%d of %d costly features found\n", off, costly);
    assert_true(4 * off > costly);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fits_of_any_size),
        cmocka_unit_test(fits_at_capacity),
        cmocka_unit_test(exact_points_give_the_true_motion),
        cmocka_unit_test(points_in_one_place_have_no_pose),
        cmocka_unit_test(points_off_the_body_are_left_out),
        cmocka_unit_test(places_and_costs),
        cmocka_unit_test(far_features_are_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
