/*
 * Features into bodies: the steps one after the other, in the plainest way, on a copy; and worlds
 * whose truth is known. The parts have tests of their own.
 */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

static struct grrl_perception copy;

/* --- the plain way ------------------------------------------------------------------------------
 */

static uint16_t features_of(uint8_t body, uint16_t *slots)
{
    uint16_t n = 0;
    for (uint16_t i = 0; i < copy.n_slots; i++)
        if (copy.body_of[i] == body)
            slots[n++] = i;
    return n;
}

static uint16_t count_of(uint8_t body)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    return features_of(body, slots);
}

static void give_all(uint8_t from, uint8_t to)
{
    for (int i = 0; i < copy.n_slots; i++)
        copy.body_of[i] = copy.body_of[i] == from ? to : copy.body_of[i];
}

static void fit(uint8_t body)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n = features_of(body, slots);
    grrl_rigid_fit(&copy, slots, n, copy.shape, &copy.pose[0][body], GRRL_MAX_LINKS);
}

static void fit_every_body(void)
{
    for (uint8_t b = 0; b < copy.n_bodies; b++)
        fit(b);
}

/* All bodies but one, without its features. */
static void take_out(uint8_t body)
{
    uint8_t kept = 0;
    give_all(body, GRRL_FEATURE_NONE);
    for (uint8_t b = 0; b < copy.n_bodies; b++) {
        if (b == body)
            continue;
        give_all(b, kept);
        copy.number[kept] = copy.number[b];
        for (int k = 0; k < copy.n_keyframes; k++)
            copy.pose[k][kept] = copy.pose[k][b];
        kept++;
    }
    copy.n_bodies = kept;
}

/* Where tracks are short, what the reference keyframe did not see joins as long as it follows. */
static void extend(uint8_t body, const uint16_t *slots, uint16_t n, const float *score)
{
    uint8_t reference;
    int joined = grrl_consensus_reference(&copy, slots, n, score, &reference) ? 1 : 0;
    while (joined > 0) {
        joined = 0;
        for (int i = 0; i < n; i++) {
            uint16_t slot = slots[i];
            bool is_free = copy.body_of[slot] == GRRL_FEATURE_NONE;
            if (is_free && copy.keyframe[reference].weight[slot] == 0 &&
                grrl_assign_follows(&copy, slot, body, 2)) {
                copy.body_of[slot] = body;
                joined++;
            }
        }
        fit(body);
    }
}

static void split(uint8_t body)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t members[GRRL_MAX_FEATURES];
    float score[GRRL_MAX_KEYFRAMES];
    uint16_t n = features_of(body, slots);
    if (n < copy.config.min_features || grrl_consensus_misfit(&copy, slots, n, body, score) < 4.5f)
        return;
    uint16_t found = grrl_consensus_find(&copy, slots, n, score, members);
    if (found < copy.config.min_features) { /* once more, with those of no body */
        n = (uint16_t)(n + features_of(GRRL_FEATURE_NONE, slots + n));
        found = grrl_consensus_find(&copy, slots, n, score, members);
    }
    if (found < copy.config.min_features || found == n)
        return;
    give_all(body, GRRL_FEATURE_NONE);
    for (int i = 0; i < found; i++)
        copy.body_of[members[i]] = body;
    fit(body);
    extend(body, slots, n, score);
}

/* One less is enough in pictures, and if there are others and all moved far; but never two. */
static int least_own(uint8_t body)
{
    int others = 0;
    int far = 0;
    for (uint8_t b = 0; b < copy.n_bodies; b++) {
        others += b != body;
        far += b != body && !grrl_apart_is_little(&copy, b, body);
    }
    bool lower = copy.config.static_background ? others > 0 && far == others : true;
    return lower && copy.config.min_features > 3 ? copy.config.min_features - 1
                                                 : copy.config.min_features;
}

static bool is_body(uint8_t body)
{
    int seen = 0;
    int n = count_of(body);
    bool proven = copy.config.static_background || n >= copy.config.min_features;
    for (int k = 0; k < copy.n_keyframes; k++)
        seen += copy.pose[k][body].weight > 0.0f;
    for (uint16_t i = 0; i < copy.n_slots; i++)
        if (copy.body_of[i] < copy.n_bodies && copy.body_of[i] != body)
            proven = proven || grrl_assign_follows(&copy, i, body, (uint16_t)(1 + seen / 2));
    return proven && n >= least_own(body);
}

/* New bodies of features that have none, as long as there are any. */
static void adopt(void)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t members[GRRL_MAX_FEATURES];
    float score[GRRL_MAX_KEYFRAMES];
    bool found_one = true;
    while (found_one) {
        uint16_t n = features_of(GRRL_FEATURE_NONE, slots);
        uint8_t body = copy.n_bodies;
        if (n + 1 < copy.config.min_features || body == GRRL_MAX_LINKS)
            return;
        give_all(GRRL_FEATURE_NONE, body);
        fit(body);
        (void)grrl_consensus_misfit(&copy, slots, n, body, score);
        uint16_t found = grrl_consensus_find(&copy, slots, n, score, members);
        give_all(body, GRRL_FEATURE_NONE);
        for (int i = 0; i < found && found + 1 >= copy.config.min_features; i++)
            copy.body_of[members[i]] = body;
        fit(body);
        found_one = is_body(body);
        if (found_one) {
            copy.number[copy.n_bodies++] = ++copy.n_numbers;
            extend(body, slots, n, score);
        } else {
            give_all(body, GRRL_FEATURE_NONE);
        }
    }
}

static void assign_all(void)
{
    bool changed = true;
    for (int round = 0; round < 6 && changed; round++) {
        changed = false;
        for (uint16_t i = 0; i < copy.n_slots; i++) {
            struct grrl_assign_origins origins;
            grrl_assign_find_origins(&copy, &origins);
            uint8_t best = grrl_assign_best(&copy, &origins, i, UINT32_MAX);
            changed = changed || best != copy.body_of[i];
            copy.body_of[i] = best;
        }
        if (changed)
            fit_every_body();
    }
}

static void take_out_small(void)
{
    for (uint8_t b = 0; b < copy.n_bodies; b++)
        if (!is_body(b))
            take_out(b--);
}

/* Two that look like two things at rest, and a third turns against both in one place. */
static bool are_one_at_rest(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    return grrl_structure_move_as_one(p, a, b) && grrl_apart_are_still(p, a, b) &&
           !grrl_assign_bodies_may_share(p, a, b);
}

/* The first pair that may be one becomes one, again from the start with the same first body. */
static void merge(bool (*may_merge)(const struct grrl_perception *, uint8_t, uint8_t))
{
    for (uint8_t a = 0; a + 1 < copy.n_bodies; a++) {
        uint8_t b = (uint8_t)(a + 1);
        while (b < copy.n_bodies && !may_merge(&copy, a, b))
            b++;
        if (b < copy.n_bodies) {
            give_all(b, a);
            take_out(b);
            fit(a);
            a--; /* once more */
        }
    }
}

static void cut(uint8_t a, uint8_t b)
{
    static struct grrl_rigid_group together;
    uint16_t part[2][GRRL_MAX_FEATURES];
    uint16_t n[2];
    if (!grrl_apart_is_little(&copy, a, b) || !grrl_assign_bodies_may_share(&copy, a, b))
        return;
    grrl_apart_fit_both(&copy, a, b, &together);
    float gain[2] = {grrl_cut_best(&copy, &together, a, part[0], &n[0]),
                     grrl_cut_best_cross(&copy, &together, a, part[1], &n[1])};
    int best = gain[1] > gain[0];
    if (gain[best] < 12.0f * copy.config.slack)
        return;
    int of_a = 0;
    for (int i = 0; i < n[best]; i++)
        of_a += copy.body_of[part[best][i]] == a;
    uint8_t in_part = 2 * of_a > n[best] ? a : b;
    for (int i = 0; i < together.n; i++)
        copy.body_of[together.slot[i]] = in_part == a ? b : a;
    for (int i = 0; i < n[best]; i++)
        copy.body_of[part[best][i]] = in_part;
    fit(a);
    fit(b);
}

static void give_back(void)
{
    for (uint8_t b = copy.n_bodies; b-- > 0 && copy.config.static_background;) {
        if (grrl_assign_body_has_moved(&copy, b) || grrl_initial_is_compact(&copy, b))
            continue;
        for (int i = 0; i < copy.n_slots; i++) {
            copy.blob_of[i] = copy.body_of[i] == b ? 0 : copy.blob_of[i];
            copy.body_of[i] = copy.body_of[i] == b ? GRRL_FEATURE_BACKGROUND : copy.body_of[i];
        }
        take_out(b);
    }
}

static void take_out_redundant(void)
{
    uint8_t b = 0;
    while (b < copy.n_bodies && copy.n_bodies > 1) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = features_of(b, slots);
        int own = 0;
        struct grrl_assign_origins origins;
        grrl_assign_find_origins(&copy, &origins);
        for (int i = 0; i < n; i++)
            own += !grrl_assign_fits_elsewhere(&copy, &origins, slots[i], n);
        if (own < least_own(b)) {
            take_out(b);
            assign_all();
        } else {
            b++;
        }
    }
}

/* Variance of a body's residuals beyond noise, each no more than what tells a joint. */
static double slow_bend(int body)
{
    double sum = 0.0;
    double n = 0.0;
    for (int i = 0; i < copy.n_slots; i++) {
        for (int k = 0; k < copy.n_keyframes; k++) {
            const struct grrl_perception_pose *pose = &copy.pose[k][body];
            int w = copy.keyframe[k].weight[i];
            if (copy.body_of[i] != body || w == 0 || !(pose->weight > 0.0f))
                continue;
            struct point miss = minus(point_of(copy.keyframe[k].point[i]),
                                      to_world(placed_of(pose->pose), point_of(copy.shape[i])));
            sum += fmin(square(miss), pow((double)copy.config.min_slide_m, 2.0)) / 2.0 -
                   (double)grrl_perception_variance(&copy, (uint8_t)w);
            n += 1.0;
        }
    }
    return sum > 0.0 ? sum / n : 0.0;
}

/* Bodies that lost all their features when another one dissolved. */
static int emptied;

static void plain_update(void)
{
    if (copy.n_bodies == 0)
        grrl_initial_segmentation(&copy);
    copy.rest_error_m = grrl_rest_error(&copy);
    for (uint16_t i = 0; i < copy.n_slots; i++)
        copy.has_moved[i] = grrl_assign_moves(&copy, i);
    fit_every_body();
    if (grrl_outliers_drop(&copy))
        fit_every_body();
    for (uint8_t b = 0; b < copy.n_bodies; b++)
        split(b);
    adopt();
    assign_all();
    adopt();
    take_out_small();
    merge(grrl_apart_may_merge);
    for (uint8_t a = 0; a < copy.n_bodies; a++)
        for (uint8_t b = (uint8_t)(a + 1); b < copy.n_bodies; b++)
            cut(a, b);
    assign_all();
    take_out_small();
    merge(are_one_at_rest);
    give_back();
    take_out_redundant();
    for (uint8_t b = copy.n_bodies; b-- > 0;) {
        if (count_of(b) == 0) {
            take_out(b);
            emptied++;
        }
    }
    for (uint8_t b = 0; b < copy.n_bodies; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        uint16_t n = features_of(b, slots);
        grrl_rigid_refit(&copy, slots, n, copy.shape, &copy.pose[0][b], GRRL_MAX_LINKS);
        copy.bend_m2[b] = (float)slow_bend(b);
    }
}

/* --- comparison ---------------------------------------------------------------------------------
 */

static void assert_same_bodies(void)
{
    assert_int_equal(scene.n_bodies, copy.n_bodies);
    assert_int_equal(scene.n_numbers, copy.n_numbers);
    assert_memory_equal(scene.number, copy.number, scene.n_bodies * sizeof copy.number[0]);
    assert_memory_equal(scene.body_of, copy.body_of, sizeof copy.body_of);
    assert_memory_equal(scene.blob_of, copy.blob_of, sizeof copy.blob_of);
    assert_memory_equal(scene.has_moved, copy.has_moved, sizeof copy.has_moved);
    assert_memory_equal(scene.keyframe, copy.keyframe, sizeof copy.keyframe);
    for (int b = 0; b < scene.n_bodies; b++) {
        assert_near(1e9 * (double)scene.bend_m2[b], 1e9 * (double)copy.bend_m2[b], 5e-3);
        for (int k = 0; k < scene.n_keyframes; k++) {
            const struct grrl_perception_pose *one = &scene.pose[k][b];
            const struct grrl_perception_pose *other = &copy.pose[k][b];
            assert_true(one->weight == other->weight);
            if (one->weight > 0.0f) {
                assert_true(one->inertia == other->inertia);
                assert_memory_equal(&one->pose, &other->pose, sizeof one->pose);
            }
        }
    }
    for (int i = 0; i < scene.n_slots; i++)
        if (scene.body_of[i] < scene.n_bodies)
            assert_memory_equal(&scene.shape[i], &copy.shape[i], sizeof copy.shape[i]);
}

/* What perception believes can be published: every body has a feature, a number of its own and
 * poses that are finite. */
static void assert_publishable(void)
{
    for (uint8_t b = 0; b < scene.n_bodies; b++) {
        uint16_t slots[GRRL_MAX_FEATURES];
        assert_true(grrl_rigid_slots(&scene, b, slots) > 0);
        for (int other = 0; other < b; other++)
            assert_true(scene.number[other] != scene.number[b]);
        for (int k = 0; k < scene.n_keyframes; k++) {
            assert_true(grrl_is_finite(scene.pose[k][b].pose.p.x));
            assert_true(grrl_is_finite(scene.pose[k][b].pose.s));
        }
        assert_true(grrl_is_finite(scene.bend_m2[b]));
    }
}

static void check_update(void)
{
    copy = scene;
    plain_update();
    grrl_bodies_update(&scene);
    assert_same_bodies();
    assert_publishable();
}

/* --- scenes -------------------------------------------------------------------------------------
 */

static uint8_t link_of[GRRL_MAX_FEATURES];

/* A chain of links whose joints turn or slide at random, a few features of the table beside it.
 * What perception shall find out is forgotten. */
static void make_chain(int n_links, int n_features, int n_keyframes, double size, double noise,
                       double missing, double outliers)
{
    n_keyframes = scene_start(n_keyframes);
    scene.config.static_background = scene_chance(0.85);
    scene.config.slack = scene_chance(0.2) ? 2.0f : 1.0f;
    double q[GRRL_MAX_LINKS] = {0.0};
    for (int b = 0; b < n_links; b++)
        (void)scene_add_body(n_features);
    scene_wander(0, scene_chance(0.5) ? 0.01 : 0.0, scene_chance(0.5) ? 0.1 : 0.0);
    for (int k = 0; k < n_keyframes; k++) {
        for (int b = 1; b < n_links; b++) {
            bool slides = b % 2 == 0;
            if (scene_chance(1.5 / n_links))
                q[b] = scene_uniform(-size, size) * (slides ? 0.05 : 1.0);
            struct placed joint = slides ? place(0.13 + q[b], 0.0, 0.0)
                                         : then(place(0.065, 0.0, q[b]), place(0.065, 0.0, 0.0));
            scene_body[k][b] = then(scene_body[k][b - 1], joint);
        }
    }
    struct placed last = scene_body[0][n_links - 1];
    for (int i = 0; i < 12 && scene.n_slots < GRRL_MAX_FEATURES; i++) {
        struct point beside = to_world(last, (struct point){0.02 * i - 0.05, 0.03});
        double far = i < 5 ? 0.0 : 1.0;
        (void)scene_add_feature(GRRL_FEATURE_BACKGROUND, beside.x + scene_uniform(-far, far),
                                beside.y + scene_uniform(-far, far));
    }
    scene_see(noise, missing);
    for (int k = 0; k < n_keyframes; k++)
        for (int i = 0; i < scene.n_slots; i++)
            if (scene_chance(outliers))
                scene.keyframe[k].point[i].x += (float)scene_uniform(-0.02, 0.02);
    memcpy(link_of, scene.body_of, sizeof link_of);
    memset(scene.body_of, GRRL_FEATURE_NONE, sizeof scene.body_of);
    scene.n_bodies = 0;
    scene.n_numbers = 0;
}

/* Bodies as an earlier update may have left them: the links, but for features near the joints,
 * which pose as bodies of their own. */
static void misjudge(double reach)
{
    uint8_t n_links = 0;
    for (int i = 0; i < scene.n_slots; i++) {
        bool on_link = link_of[i] != GRRL_FEATURE_BACKGROUND;
        n_links = on_link && link_of[i] >= n_links ? (uint8_t)(link_of[i] + 1) : n_links;
    }
    scene.n_bodies = n_links;
    for (int i = 0; i < scene.n_slots; i++) {
        int far_end = scene_shape[i].x > 0.0 ? link_of[i] : link_of[i] - 1;
        bool beside = link_of[i] < n_links && fabs(scene_shape[i].x) > 0.065 - reach &&
                      far_end >= 0 && far_end + 1 < n_links && n_links + far_end < GRRL_MAX_LINKS;
        uint8_t body = beside ? (uint8_t)(n_links + far_end) : link_of[i];
        scene.body_of[i] = body;
        scene.blob_of[i] = link_of[i] < n_links ? 1 : 0;
        scene.n_bodies = beside && body >= scene.n_bodies ? (uint8_t)(body + 1) : scene.n_bodies;
    }
    for (int b = 0; b < scene.n_bodies; b++)
        scene.number[b] = ++scene.n_numbers;
}

/* Four bodies of an earlier update, on two links, each seen for part of the time only. */
static void make_pieces(void)
{
    enum { PIECES = 4 };
    uint8_t piece_of[GRRL_MAX_FEATURES];
    int first[PIECES];
    int last[PIECES];
    int n_keyframes = scene_start(scene_int(4, 8));
    (void)scene_add_body(0);
    (void)scene_add_body(0);
    for (uint8_t piece = 0; piece < PIECES; piece++) {
        uint8_t body = (uint8_t)scene_int(0, 1);
        double along = scene_uniform(-0.05, 0.05);
        first[piece] = scene_int(0, 2);
        last[piece] = scene_int(n_keyframes - 3, n_keyframes - 1);
        for (int i = scene_int(4, 8); i > 0; i--)
            piece_of[scene_add_feature(body, along + scene_uniform(-0.02, 0.02),
                                       scene_uniform(-0.02, 0.02))] = piece;
    }
    scene_wander(0, 0.05, 0.1);
    scene_wander(1, 0.05, 0.1);
    scene_see(1.8, 0.3);
    scene.n_bodies = PIECES;
    scene.n_numbers = 0;
    for (int b = 0; b < PIECES; b++)
        scene.number[b] = ++scene.n_numbers;
    for (int i = 0; i < scene.n_slots; i++) {
        scene.body_of[i] = piece_of[i];
        scene.blob_of[i] = 1;
        for (int k = 0; k < n_keyframes; k++)
            if (k < first[piece_of[i]] || k > last[piece_of[i]])
                scene.keyframe[k].weight[i] = 0;
    }
}

/* Updates with some of the keyframes, with more and with all. */
static void check_chain(void)
{
    int n_keyframes = scene.n_keyframes;
    for (int seen = scene_int(1, 3); seen < n_keyframes; seen += scene_int(1, 6)) {
        scene.n_keyframes = (uint8_t)seen;
        check_update();
    }
    scene.n_keyframes = (uint8_t)n_keyframes;
    check_update();
}

static int most_bodies;

static void steps_on_random_chains(void **state)
{
    (void)state;
    scene_seed("steps_on_random_chains");
    int bodies = 0;
    for (int run = 0; run < 150; run++) {
        make_chain(scene_int(1, 5), scene_int(3, 12), scene_int(1, 20),
                   pow(10.0, scene_uniform(-1.5, 0.0)), run % 3 == 0 ? 2.0 : 1.0,
                   run % 2 == 0 ? 0.2 : 0.0, run % 4 == 0 ? 0.03 : 0.0);
        check_chain();
        bodies += scene.n_bodies;
        most_bodies = scene.n_bodies > most_bodies ? scene.n_bodies : most_bodies;
    }
    print_message("%d bodies in 150 scenes, %d at most\n", bodies, most_bodies);
    assert_true(bodies > 200 && most_bodies >= 5);
}

/* Bodies that features beside the joints pose as. */
static void steps_on_misjudged_chains(void **state)
{
    (void)state;
    scene_seed("steps_on_misjudged_chains");
    int gone = 0;
    for (int run = 0; run < 100; run++) {
        make_chain(scene_int(2, 4), scene_int(10, 24), scene_int(4, 20), 0.5, 1.0, 0.1, 0.0);
        misjudge(scene_uniform(0.005, 0.03));
        int before = scene.n_bodies;
        check_update();
        gone += scene.n_bodies < before;
    }
    print_message("%d of 100 with fewer bodies\n", gone);
    assert_true(gone > 30);
}

/* A body may lose all its features when another one dissolves; it must not be left behind. */
static void steps_that_empty_a_body(void **state)
{
    (void)state;
    scene_seed("steps_that_empty_a_body");
    emptied = 0;
    for (int run = 0; run < 4000; run++) {
        make_pieces();
        check_update();
    }
    print_message("%d bodies emptied in 4000 scenes\n", emptied);
    assert_true(emptied > 0);
}

static void steps_at_capacity(void **state)
{
    (void)state;
    scene_seed("steps_at_capacity");
    make_chain(1, 1, 1, 0.1, 1.0, 0.0, 0.0);
    check_chain();
    make_chain(GRRL_MAX_LINKS, GRRL_MAX_FEATURES / GRRL_MAX_LINKS, GRRL_MAX_KEYFRAMES, 0.6, 1.0,
               0.05, 0.0);
    check_chain();
    /* more things than bodies: each feature pair by itself */
    make_chain(GRRL_MAX_LINKS, GRRL_MAX_FEATURES / GRRL_MAX_LINKS, 12, 1.0, 1.0, 0.0, 0.5);
    scene.config.min_features = 3;
    check_chain();
}

/* Known truth: the features of a link are one body, and of no other link. */
static void links_are_found(void **state)
{
    (void)state;
    scene_seed("links_are_found");
    int wrong = 0;
    int features = 0;
    for (int run = 0; run < 20; run++) {
        make_chain(3, 12, 20, 0.6, 1.0, 0.0, 0.0);
        check_update();
        for (int i = 0; i < 36; i++) {
            int same = 0;
            for (int j = 0; j < 36; j++) {
                bool together = scene.body_of[i] == scene.body_of[j];
                same += together == (link_of[i] == link_of[j]);
            }
            wrong += same < 30;
            features++;
        }
    }
    print_message("%d of %d features elsewhere\n", wrong, features);
    assert_true(20 * wrong < features);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_on_random_chains),  cmocka_unit_test(steps_on_misjudged_chains),
        cmocka_unit_test(steps_that_empty_a_body), cmocka_unit_test(steps_at_capacity),
        cmocka_unit_test(links_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
