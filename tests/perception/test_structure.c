/*
 * The joints of all bodies and the model, against a search over all cycles and plain lists. The
 * evidence is given: this file defines grrl_joints_weigh and grrl_cut_hidden_joint itself, so that
 * the library's own are not linked.
 */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

static struct {
    bool accepted[GRRL_MAX_LINKS][GRRL_MAX_LINKS];
    struct grrl_joint_evidence of[GRRL_MAX_LINKS][GRRL_MAX_LINKS];
    float hidden[GRRL_MAX_LINKS];
} given;

bool grrl_joints_weigh(const struct grrl_perception *p, uint8_t a, uint8_t b,
                       struct grrl_joint_evidence *e)
{
    assert_true(p == &scene);
    assert_true(a < b && b < p->n_bodies);
    *e = given.of[a][b];
    return given.accepted[a][b];
}

float grrl_cut_hidden_joint(const struct grrl_perception *p, uint8_t body)
{
    assert_true(p == &scene);
    return given.hidden[body];
}

/* --- random evidence
 * ------------------------------------------------------------------------------ */

static struct grrl_joint_evidence random_evidence(uint8_t a, uint8_t b)
{
    struct grrl_joint_evidence e = {.a = a, .b = b};
    bool revolute = scene_chance(0.6);
    e.type = revolute ? GRRL_REVOLUTE : GRRL_PRISMATIC;
    e.order = (float)scene_uniform(-10.0, 6.0);
    e.weight = (float)scene_uniform(8.0, 80.0);
    e.p[0] = (float)scene_uniform(0.0, 0.4);
    e.p[1] = (float)scene_uniform(0.0, 0.4);
    e.p[2] = 1.0f - e.p[0] - e.p[1];
    double angle = scene_uniform(-1.5, 1.5);
    e.fit = (struct grrl_joint_fit){
        .excited = scene_chance(0.7),
        .lower = -(float)scene_uniform(0.0, 0.005),
        .upper = (float)scene_uniform(0.0, 0.006),
        .in_a = {(float)scene_int(-2, 2) * 0.015f, (float)scene_int(0, 1) * 0.015f},
        .in_b = {(float)scene_int(-2, 2) * 0.015f, (float)scene_int(0, 1) * 0.015f},
        .axis_in_a = {(float)cos(angle), (float)sin(angle)},
        .point_variance = (float)scene_uniform(0.1, 1.0),
        .axis_variance = (float)scene_uniform(0.1, 1.0)};
    if (revolute) {
        e.fit.axis_in_a = (struct grrl_vec2){0.0f, 0.0f};
        e.fit.upper *= 40.0f;
    }
    return e;
}

/* Random bodies, the evidence of each pair, and where the last keyframe saw what. */
static void make_scene(int n_bodies, int n_features, double joined)
{
    (void)scene_start(scene_int(1, 3));
    for (int b = 0; b < n_bodies; b++)
        scene_wander(scene_add_body(scene_int(1, n_features)), 0.01, 0.1);
    while (scene.n_slots + 2 < GRRL_MAX_FEATURES && scene_chance(0.7))
        (void)scene_add_feature(scene_chance(0.5) ? GRRL_FEATURE_BACKGROUND : GRRL_FEATURE_NONE,
                                scene_uniform(-0.4, 0.4), scene_uniform(-0.4, 0.4));
    scene_see(1.0, 0.0);
    for (int k = 0; k < scene.n_keyframes; k++) {
        for (int b = 0; b < n_bodies; b++) {
            struct placed at = scene_body[k][b];
            scene.pose[k][b] = (struct grrl_perception_pose){
                {{(float)at.p.x, (float)at.p.y}, (float)at.c, (float)at.s},
                scene_chance(0.85) ? 20.0f : 0.0f,
                1.0f,
                0.0f};
        }
    }
    for (int i = 0; i < scene.n_slots; i++)
        scene.shape[i] = (struct grrl_vec2){(float)scene_shape[i].x, (float)scene_shape[i].y};
    memset(&given, 0, sizeof given);
    for (uint8_t a = 0; a < n_bodies; a++) {
        given.hidden[a] = scene_chance(0.3) ? (float)scene_uniform(0.0, 5.0) : 0.0f;
        for (uint8_t b = (uint8_t)(a + 1); b < n_bodies; b++) {
            given.accepted[a][b] = scene_chance(joined);
            given.of[a][b] = random_evidence(a, b);
        }
    }
}

/* --- the slow way: which joints ------------------------------------------------------------------
 */

struct slow_joint {
    const struct grrl_joint_evidence *e;
    double order;
};

static struct slow_joint candidates[GRRL_MAX_LINKS * GRRL_MAX_LINKS];
static int n_candidates;
static const struct grrl_joint_evidence *taken[GRRL_MAX_JOINTS];
static int n_taken;

/* Where the joint lies in the frame of one of its bodies. */
static struct point pivot_in(const struct grrl_joint_evidence *e, int body)
{
    return point_of(e->a == body ? e->fit.in_a : e->fit.in_b);
}

static bool has(const struct grrl_joint_evidence *e, int body)
{
    return e->a == body || e->b == body;
}

static double range_of(const struct grrl_joint_evidence *e)
{
    return (double)e->fit.upper - (double)e->fit.lower;
}

/* A slide explained by pivots of both bodies on a third. */
static bool turns_explain(const struct grrl_joint_evidence *slide)
{
    for (int i = 0; i < n_candidates; i++) {
        for (int j = 0; j < n_candidates; j++) {
            const struct grrl_joint_evidence *x = candidates[i].e;
            const struct grrl_joint_evidence *y = candidates[j].e;
            if (x->type != GRRL_REVOLUTE || y->type != GRRL_REVOLUTE || !has(x, slide->a) ||
                !has(y, slide->b))
                continue;
            int third = x->a == slide->a ? x->b : x->a;
            if (!has(y, third) || third == slide->b || third == slide->a)
                continue;
            double between = sqrt(square(minus(pivot_in(x, third), pivot_in(y, third))));
            if (between * range_of(x) > 0.5 * range_of(slide))
                return true;
        }
    }
    return false;
}

static void slow_candidates(void)
{
    n_candidates = 0;
    for (int a = 0; a < scene.n_bodies; a++) {
        for (int b = a + 1; b < scene.n_bodies; b++) {
            const struct grrl_joint_evidence *e = &given.of[a][b];
            bool is_short = range_of(e) < 5.0 * (double)scene.config.min_slide_m;
            bool bent = (double)given.hidden[a] + (double)given.hidden[b] > 3.5;
            if (given.accepted[a][b] && !(e->type == GRRL_PRISMATIC && is_short && bent))
                candidates[n_candidates++] = (struct slow_joint){e, (double)e->order};
        }
    }
    for (int i = 0; i < n_candidates; i++)
        if (candidates[i].e->type == GRRL_PRISMATIC && turns_explain(candidates[i].e))
            candidates[i].order -= 20.0;
}

/* Links on the shortest way from a to b over what is taken, by Floyd and Warshall; 0: no way. */
static int links_between(int a, int b)
{
    int joints[GRRL_MAX_LINKS][GRRL_MAX_LINKS];
    for (int i = 0; i < GRRL_MAX_LINKS; i++)
        for (int j = 0; j < GRRL_MAX_LINKS; j++)
            joints[i][j] = i == j ? 0 : 1000;
    for (int i = 0; i < n_taken; i++)
        joints[taken[i]->a][taken[i]->b] = joints[taken[i]->b][taken[i]->a] = 1;
    for (int k = 0; k < GRRL_MAX_LINKS; k++)
        for (int i = 0; i < GRRL_MAX_LINKS; i++)
            for (int j = 0; j < GRRL_MAX_LINKS; j++)
                if (joints[i][k] + joints[k][j] < joints[i][j])
                    joints[i][j] = joints[i][k] + joints[k][j];
    return joints[a][b] >= 1000 ? 0 : joints[a][b] + 1;
}

/* A pivot on a pin that is there already: of a taken joint the first body in common counts. */
static bool is_on_a_pin(const struct grrl_joint_evidence *e)
{
    for (int i = 0; i < n_taken; i++) {
        int common = has(taken[i], e->a) ? e->a : e->b;
        if (e->type == GRRL_REVOLUTE && taken[i]->type == GRRL_REVOLUTE && has(taken[i], common) &&
            sqrt(square(minus(pivot_in(taken[i], common), pivot_in(e, common)))) <
                0.2 * (double)scene.config.gap_m)
            return true;
    }
    return false;
}

static bool joins_what_is_apart(const struct grrl_joint_evidence *e)
{
    return links_between(e->a, e->b) == 0;
}

static bool closes_a_loop(const struct grrl_joint_evidence *e)
{
    return links_between(e->a, e->b) >= 4 && e->weight > 40.0f && !is_on_a_pin(e);
}

static int by_order(const void *a, const void *b)
{
    double x = ((const struct slow_joint *)a)->order;
    double y = ((const struct slow_joint *)b)->order;
    return (x < y) - (x > y);
}

/* First a forest, then loops. What is taken changes places with the first of those passed over, so
 * that the second pass does not try all in the order of the first. */
static void slow_structure(void)
{
    slow_candidates();
    qsort(candidates, (size_t)n_candidates, sizeof candidates[0], by_order);
    n_taken = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = n_taken; i < n_candidates; i++) {
            const struct grrl_joint_evidence *e = candidates[i].e;
            if (n_taken == GRRL_MAX_JOINTS || !(pass == 0 ? joins_what_is_apart : closes_a_loop)(e))
                continue;
            struct slow_joint passed_over = candidates[n_taken];
            candidates[n_taken] = candidates[i];
            candidates[i] = passed_over;
            taken[n_taken++] = e;
        }
    }
}

/* --- the slow way: what is said of them
 * ----------------------------------------------------------- */

static void check_joint(const struct grrl_joint *joint, const struct grrl_joint_evidence *e)
{
    int seen = 0; /* last; where a body is not seen, nothing tells of its joints */
    for (int k = 0; k < scene.n_keyframes; k++)
        seen = scene.pose[k][e->a].weight > 0.0f ? k : seen;
    struct placed at = placed_of(scene.pose[seen][e->a].pose);
    struct point axis = {at.c * (double)e->fit.axis_in_a.x - at.s * (double)e->fit.axis_in_a.y,
                         at.s * (double)e->fit.axis_in_a.x + at.c * (double)e->fit.axis_in_a.y};
    double v = (double)e->fit.point_variance;
    assert_int_equal(joint->a, e->a);
    assert_int_equal(joint->b, e->b);
    assert_int_equal(joint->type, e->type);
    assert_true(joint->probability == (e->type == GRRL_REVOLUTE ? e->p[0] : e->p[1]));
    assert_true(joint->p_revolute == e->p[0]);
    assert_true(joint->p_prismatic == e->p[1]);
    assert_true(joint->p_disconnected == e->p[2]);
    assert_true(joint->lower == e->fit.lower && joint->upper == e->fit.upper);
    assert_at(joint->point_m, to_world(at, point_of(e->fit.in_a)), 1e-6);
    assert_at(joint->axis, axis, 1e-5);
    assert_near(joint->axis_sd_rad, sqrt((double)e->fit.axis_variance), 1e-5);
    /* v in all directions, but none along a line of sliding */
    bool slides = e->type == GRRL_PRISMATIC;
    assert_near(joint->point_cov_m2[0], slides ? v * (1.0 - axis.x * axis.x) : v, 1e-5);
    assert_near(joint->point_cov_m2[1], slides ? -v * axis.x * axis.y : 0.0, 1e-5);
    assert_near(joint->point_cov_m2[2], slides ? v * (1.0 - axis.y * axis.y) : v, 1e-5);
}

/* The taken joint of a pair of numbers, -1: none. */
static int taken_of_numbers(uint16_t first, uint16_t second)
{
    for (int i = 0; i < n_taken; i++) {
        uint16_t a = scene.number[taken[i]->a];
        uint16_t b = scene.number[taken[i]->b];
        if ((a == first && b == second) || (a == second && b == first))
            return i;
    }
    return -1;
}

/* Joints of the model before that hold still, in its order; then the others as they were taken. */
static void check_joints(const struct grrl_model *before)
{
    bool told[GRRL_MAX_JOINTS] = {false};
    int n = 0;
    assert_int_equal(scene.model.n_joints, n_taken);
    for (int j = 0; j < before->n_joints; j++) {
        int i = taken_of_numbers(before->body[before->joint[j].a].number,
                                 before->body[before->joint[j].b].number);
        if (i >= 0) {
            assert_false(told[i]);
            told[i] = true;
            check_joint(&scene.model.joint[n++], taken[i]);
        }
    }
    for (int i = 0; i < n_taken; i++)
        if (!told[i])
            check_joint(&scene.model.joint[n++], taken[i]);
}

static struct point slow_feature(int slot)
{
    const struct grrl_perception_pose *poses = scene.pose[scene.n_keyframes - 1];
    uint8_t body = scene.body_of[slot];
    if (body < scene.n_bodies && poses[body].weight > 0.0f)
        return to_world(placed_of(poses[body].pose), point_of(scene.shape[slot]));
    return point_of(scene.last[slot]);
}

/* The widest extent in a direction of what belongs to a body. */
static double extent(int body, double angle)
{
    double low = 1e9;
    double high = -1e9;
    for (int i = 0; i < scene.n_slots; i++) {
        struct point q = slow_feature(i);
        double at = cos(angle) * q.x + sin(angle) * q.y;
        if (scene.body_of[i] == body) {
            low = fmin(low, at);
            high = fmax(high, at);
        }
    }
    return high - low;
}

static double variance_along(int body, struct point mean, double angle)
{
    double sum = 0.0;
    for (int i = 0; i < scene.n_slots; i++) {
        struct point d = minus(slow_feature(i), mean);
        double at = cos(angle) * d.x + sin(angle) * d.y;
        sum += scene.body_of[i] == body ? at * at : 0.0;
    }
    return sum;
}

static void check_body(int body)
{
    const struct grrl_body *told = &scene.model.body[body];
    struct point sum = {0.0, 0.0};
    int n = 0;
    for (int i = 0; i < scene.n_slots; i++) {
        if (scene.body_of[i] == body) {
            sum = (struct point){sum.x + slow_feature(i).x, sum.y + slow_feature(i).y};
            n++;
        }
    }
    struct point mean = {sum.x / n, sum.y / n};
    assert_int_equal(told->number, scene.number[body]);
    assert_int_equal(told->n_features, n);
    assert_at(told->centroid_m, mean, 1e-6);
    assert_near(hypot((double)told->axis.x, (double)told->axis.y), 1.0, 1e-5);
    double angle = atan2((double)told->axis.y, (double)told->axis.x);
    double along = variance_along(body, mean, angle);
    for (int i = 0; i < 60; i++) /* no direction has more variance */
        assert_true(variance_along(body, mean, 3.14159265 * i / 60) <= along * 1.001 + 1e-9);
    assert_near(told->length_m, extent(body, angle), 2e-6);
    assert_near(told->width_m, extent(body, angle + 1.5707963267948966), 2e-6);
}

static void check_pairs(void)
{
    struct grrl_pair pair;
    for (uint8_t a = 0; a < scene.n_bodies + 1; a++) {
        for (uint8_t b = 0; b < scene.n_bodies + 1; b++) {
            if (a == b || a >= scene.n_bodies || b >= scene.n_bodies) {
                assert_int_equal(grrl_perception_pair(&scene, a, b, &pair), GRRL_ERR_ARGUMENT);
                continue;
            }
            const struct grrl_joint_evidence *e = a < b ? &given.of[a][b] : &given.of[b][a];
            float third = 1.0f / 3.0f;
            bool joined = taken_of_numbers(scene.number[a], scene.number[b]) >= 0;
            assert_int_equal(grrl_perception_pair(&scene, a, b, &pair), GRRL_OK);
            assert_true(pair.p_revolute == (e->fit.excited ? e->p[0] : third));
            assert_true(pair.p_prismatic == (e->fit.excited ? e->p[1] : third));
            assert_true(pair.p_disconnected == (e->fit.excited ? e->p[2] : third));
            assert_int_equal(pair.relation, joined ? GRRL_RELATION_JOINED
                                            : e->fit.excited && e->p[2] >= 0.95f
                                                ? GRRL_RELATION_DISCONNECTED
                                                : GRRL_RELATION_UNDETERMINED);
        }
    }
}

static struct grrl_model before;

static void check_structure(void)
{
    before = scene.model;
    grrl_structure_update(&scene);
    slow_structure();
    assert_int_equal(scene.model.n_bodies, scene.n_bodies);
    assert_int_equal(scene.model.n_features, scene.n_slots);
    check_joints(&before);
    for (int i = 0; i < scene.n_slots; i++) {
        assert_int_equal(scene.model.feature_id[i], scene.id[i]);
        assert_int_equal(scene.model.feature_body[i], scene.body_of[i]);
        assert_at(scene.model.feature_m[i], slow_feature(i), 1e-6);
    }
    for (int b = 0; b < scene.n_bodies; b++)
        check_body(b);
    check_pairs();
}

/* --- tests --------------------------------------------------------------------------------------
 */

static void structures_of_random_evidence(void **state)
{
    (void)state;
    scene_seed("structures_of_random_evidence");
    int loops = 0;
    int orders = 0;
    for (int run = 0; run < 400; run++) {
        make_scene(scene_int(1, 8), 6, scene_uniform(0.2, 1.0));
        check_structure();
        loops += n_taken >= scene.n_bodies;
        /* the same bodies with other evidence; one is gone, and its number */
        if (scene.n_bodies > 1)
            scene.number[scene_int(0, scene.n_bodies - 1)] = 500;
        for (uint8_t a = 0; a < scene.n_bodies; a++)
            for (uint8_t b = (uint8_t)(a + 1); b < scene.n_bodies; b++)
                given.of[a][b].order = (float)scene_uniform(-10.0, 6.0);
        check_structure();
        orders += before.n_joints > 2 && scene.model.n_joints > 2;
        check_structure();
    }
    print_message("%d of 400 with a loop, %d with joints to be kept in order\n", loops, orders);
    assert_true(loops > 30 && orders > 100);
}

/* All bodies and joints that fit, and one body of one feature. */
static void structures_at_capacity(void **state)
{
    (void)state;
    scene_seed("structures_at_capacity");
    for (int run = 0; run < 20; run++) {
        make_scene(GRRL_MAX_LINKS, GRRL_MAX_FEATURES / GRRL_MAX_LINKS, 1.0);
        check_structure();
        check_structure();
    }
    make_scene(1, 1, 1.0);
    check_structure();
    assert_int_equal(scene.model.body[0].n_features, 1);
    assert_true(scene.model.body[0].length_m == 0.0f && scene.model.body[0].width_m == 0.0f);
}

/* A ring of n links; whether the last joint of weight w closes it. */
static bool is_closed(int n, float weight, float pin_apart)
{
    make_scene(n, 6, 0.0);
    for (uint8_t a = 0; a < n; a++) {
        uint8_t b = (uint8_t)((a + 1) % n);
        uint8_t low = a < b ? a : b;
        uint8_t high = a < b ? b : a;
        struct grrl_joint_evidence *e = &given.of[low][high];
        given.accepted[low][high] = true;
        *e = (struct grrl_joint_evidence){.a = low, .b = high, .type = GRRL_REVOLUTE};
        e->weight = b == 0 ? weight : 100.0f;
        e->order = b == 0 ? 1.0f : 2.0f;
        e->fit.in_a.x = e->fit.in_b.x = b == 0 ? pin_apart : 0.0f;
    }
    check_structure();
    return scene.model.n_joints == n;
}

static void loops_of_four_links_and_more_close(void **state)
{
    (void)state;
    scene_seed("loops_of_four_links_and_more_close");
    assert_false(is_closed(3, 100.0f, 0.1f));
    assert_true(is_closed(4, 100.0f, 0.1f));
    assert_true(is_closed(5, 41.0f, 0.1f));
    assert_false(is_closed(5, 39.0f, 0.1f));
    assert_false(is_closed(5, 100.0f, 0.019f)); /* on one pin */
    assert_true(is_closed(5, 100.0f, 0.021f));
    assert_true(is_closed(GRRL_MAX_LINKS, 100.0f, 0.1f));
}

/* The probability of 0.95 is sure enough. */
static void sure_pairs_are_disconnected(void **state)
{
    (void)state;
    scene_seed("sure_pairs_are_disconnected");
    static const float probabilities[] = {0.94f, 0.9499f, 0.95f, 0.96f};
    for (int i = 0; i < 4; i++) {
        struct grrl_pair pair;
        make_scene(2, 6, 0.0);
        given.of[0][1].fit.excited = true;
        given.of[0][1].p[2] = probabilities[i];
        check_structure();
        assert_int_equal(grrl_perception_pair(&scene, 0, 1, &pair), GRRL_OK);
        assert_int_equal(pair.relation,
                         i < 2 ? GRRL_RELATION_UNDETERMINED : GRRL_RELATION_DISCONNECTED);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(structures_of_random_evidence),
        cmocka_unit_test(structures_at_capacity),
        cmocka_unit_test(loops_of_four_links_and_more_close),
        cmocka_unit_test(sure_pairs_are_disconnected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
