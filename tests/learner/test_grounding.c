/* Pushes under motions of the model, free starts, and refusals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/base/random.h"
#include "grrl/learner/grounding.h"
#include "grrl/structure/term.h"

#define SEED UINT64_C(20080626)
#define MODELS 3000
#define TOLERANCE_M 1e-5f

/* x' = R (x, y or -y) + p: a rigid motion, or one with a mirror. */
struct motion {
    struct grrl_pose pose;
    bool mirrored;
};

static struct grrl_vec2 flip(const struct motion *motion, struct grrl_vec2 v)
{
    return (struct grrl_vec2){v.x, motion->mirrored ? -v.y : v.y};
}

static struct grrl_vec2 move_point(const struct motion *motion, struct grrl_vec2 v)
{
    return grrl_transform(motion->pose, flip(motion, v));
}

static struct grrl_vec2 move_vector(const struct motion *motion, struct grrl_vec2 v)
{
    return grrl_rotate(motion->pose, flip(motion, v));
}

static void move_model(const struct motion *motion, const struct grrl_model *model,
                       struct grrl_model *moved)
{
    *moved = *model;
    for (int i = 0; i < model->n_bodies; i++) {
        moved->body[i].centroid_m = move_point(motion, model->body[i].centroid_m);
        moved->body[i].axis = move_vector(motion, model->body[i].axis);
    }
    for (int j = 0; j < model->n_joints; j++) {
        moved->joint[j].point_m = move_point(motion, model->joint[j].point_m);
        moved->joint[j].axis = move_vector(motion, model->joint[j].axis);
    }
    for (int i = 0; i < model->n_features; i++)
        moved->feature_m[i] = move_point(motion, model->feature_m[i]);
}

static float uniform(struct grrl_random *random, float low, float high)
{
    return low + (high - low) * grrl_random_uniform(random);
}

/* A body of `n` features at random in a rectangle around `centre`. */
static uint8_t add_body(struct grrl_model *model, struct grrl_vec2 centre, float angle_rad,
                        float length_m, uint16_t n, struct grrl_random *random)
{
    struct grrl_pose pose = {centre, grrl_cos(angle_rad), grrl_sin(angle_rad)};
    struct grrl_body *body = &model->body[model->n_bodies];
    memset(body, 0, sizeof *body);
    body->number = (uint16_t)(model->n_bodies + 1);
    body->n_features = n;
    body->centroid_m = centre;
    body->axis = (struct grrl_vec2){pose.c, pose.s};
    body->length_m = length_m;
    body->width_m = 0.035f;
    for (uint16_t i = 0; i < n; i++) {
        struct grrl_vec2 local = {uniform(random, -0.5f, 0.5f) * length_m,
                                  uniform(random, -0.0175f, 0.0175f)};
        model->feature_m[model->n_features] = grrl_transform(pose, local);
        model->feature_body[model->n_features] = model->n_bodies;
        model->n_features++;
    }
    return model->n_bodies++;
}

static void add_joint(struct grrl_model *model, uint8_t a, uint8_t b, uint8_t type,
                      struct grrl_vec2 point)
{
    struct grrl_joint *joint = &model->joint[model->n_joints++];
    memset(joint, 0, sizeof *joint);
    joint->a = a < b ? a : b;
    joint->b = a < b ? b : a;
    joint->type = type;
    joint->point_m = point;
}

/* A random tree of 2 to GRRL_MAX_LINKS bodies (8 at most), sometimes with a loop. */
static void random_model(struct grrl_model *model, struct grrl_random *random)
{
    memset(model, 0, sizeof *model);
    unsigned most = GRRL_MAX_LINKS < 8 ? GRRL_MAX_LINKS : 8;
    unsigned n = 2 + grrl_random_below(random, most - 1);
    for (unsigned i = 0; i < n; i++) {
        struct grrl_vec2 at = {uniform(random, -0.3f, 0.3f), uniform(random, -0.3f, 0.3f)};
        uint8_t body = add_body(model, at, uniform(random, -GRRL_PI, GRRL_PI),
                                uniform(random, 0.05f, 0.2f), 6, random);
        if (body > 0) {
            uint8_t other = (uint8_t)grrl_random_below(random, body);
            struct grrl_vec2 point = {uniform(random, -0.3f, 0.3f), uniform(random, -0.3f, 0.3f)};
            add_joint(model, body, other, (uint8_t)grrl_random_below(random, 2), point);
        }
    }
}

static float apart(struct grrl_vec2 a, struct grrl_vec2 b)
{
    return grrl_vec2_length(grrl_vec2_sub(a, b));
}

static void motions_of_the_model_move_frame_and_push(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 1);
    struct grrl_grounding_config config;
    grrl_grounding_config_default(&config);
    static struct grrl_model model, moved;
    for (int i = 0; i < MODELS; i++) {
        random_model(&model, &random);
        float angle = uniform(&random, -GRRL_PI, GRRL_PI);
        struct motion motion = {{{uniform(&random, -0.5f, 0.5f), uniform(&random, -0.5f, 0.5f)},
                                 grrl_cos(angle),
                                 grrl_sin(angle)},
                                grrl_random_below(&random, 2) == 1};
        move_model(&motion, &model, &moved);
        for (uint8_t body = 0; body < model.n_bodies; body++) {
            if (grrl_random_below(&random, 2) == 1) /* an axis has no sign */
                moved.body[body].axis = grrl_vec2_scale(moved.body[body].axis, -1.0f);
            struct grrl_link_frame a, b;
            assert_int_equal(grrl_grounding_frame(&model, body, &a), GRRL_OK);
            assert_int_equal(grrl_grounding_frame(&moved, body, &b), GRRL_OK);
            assert_true(apart(move_vector(&motion, a.forward), b.forward) < TOLERANCE_M);
            assert_true(apart(move_vector(&motion, a.side), b.side) < TOLERANCE_M);
            for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
                struct grrl_push p, q;
                assert_int_equal(grrl_grounding_push(&model, &config, body, direction, &p),
                                 GRRL_OK);
                assert_int_equal(grrl_grounding_push(&moved, &config, body, direction, &q),
                                 GRRL_OK);
                assert_true(apart(move_point(&motion, p.start_m), q.start_m) < TOLERANCE_M);
                assert_true(apart(move_point(&motion, p.end_m), q.end_m) < TOLERANCE_M);
            }
        }
    }
}

/* Links of `length_m` in a row along x, joined where they meet, the first around the origin. */
static void row(struct grrl_model *model, unsigned n, const float *length_m)
{
    struct grrl_random random;
    grrl_random_init(&random, SEED, 2);
    memset(model, 0, sizeof *model);
    float x = 0.0f;
    for (unsigned i = 0; i < n; i++) {
        x += i > 0 ? 0.5f * length_m[i] : 0.0f;
        (void)add_body(model, (struct grrl_vec2){x, 0.0f}, 0.0f, length_m[i], 6, &random);
        x += 0.5f * length_m[i];
        if (i > 0) {
            add_joint(model, (uint8_t)(i - 1), (uint8_t)i, GRRL_REVOLUTE,
                      (struct grrl_vec2){x - length_m[i], 0.0f});
        }
    }
}

static float forward_x(const struct grrl_model *model, uint8_t body)
{
    struct grrl_link_frame frame;
    assert_int_equal(grrl_grounding_frame(model, body, &frame), GRRL_OK);
    return frame.forward.x;
}

static void forward_points_away_from_what_holds_the_link(void **state)
{
    (void)state;
    static struct grrl_model model;
    const float equal[] = {0.1f, 0.1f, 0.1f, 0.1f};
    row(&model, 4, equal);
    assert_true(forward_x(&model, 0) == -1.0f);
    assert_true(forward_x(&model, 3) == 1.0f);
    assert_true(forward_x(&model, 1) == -1.0f); /* two links to the right, one to the left */
    assert_true(forward_x(&model, 2) == 1.0f);

    row(&model, 3, equal); /* alike on both sides: away from the joint discovered first */
    assert_true(forward_x(&model, 1) == 1.0f);
    struct grrl_joint swap = model.joint[0];
    model.joint[0] = model.joint[1];
    model.joint[1] = swap;
    assert_true(forward_x(&model, 1) == -1.0f);

    const float longer[] = {0.1f, 0.1f, 0.2f};
    row(&model, 3, longer);
    assert_true(forward_x(&model, 1) == -1.0f);
    model.body[2].length_m = 0.101f; /* not longer beyond noise */
    assert_true(forward_x(&model, 1) == 1.0f);
}

static void a_joint_in_the_middle_leaves_it_to_the_neighbour(void **state)
{
    (void)state;
    static struct grrl_model model;
    const float equal[] = {0.1f, 0.1f};
    row(&model, 2, equal);
    model.joint[0].point_m.x = -0.001f;
    assert_true(forward_x(&model, 0) == -1.0f);
    model.body[1].centroid_m.x = -0.05f;
    assert_true(forward_x(&model, 0) == 1.0f);
    model.joint[0].point_m.x = 0.05f; /* a pivot counts, a point of a sliding axis does not */
    assert_true(forward_x(&model, 0) == -1.0f);
    model.joint[0].type = GRRL_PRISMATIC;
    assert_true(forward_x(&model, 0) == 1.0f);
}

static void side_points_towards_the_rest(void **state)
{
    (void)state;
    static struct grrl_model model;
    struct grrl_link_frame frame;
    const float equal[] = {0.1f, 0.1f, 0.1f};
    row(&model, 3, equal);
    model.body[2].centroid_m.y = 0.05f;
    assert_int_equal(grrl_grounding_frame(&model, 0, &frame), GRRL_OK);
    assert_true(frame.forward.x == -1.0f && frame.side.y == 1.0f);
    model.body[2].n_features = 1;
    model.body[1].centroid_m.y = -0.01f; /* 6 x 1 cm weigh more than 1 x 5 cm */
    assert_int_equal(grrl_grounding_frame(&model, 0, &frame), GRRL_OK);
    assert_true(frame.side.y == -1.0f);
    model.n_joints = 0; /* alone: counter-clockwise */
    assert_int_equal(grrl_grounding_frame(&model, 0, &frame), GRRL_OK);
    assert_true(frame.forward.x == 1.0f && frame.side.y == 1.0f);
}

static void every_joint_of_a_loop_is_followed_once(void **state)
{
    (void)state;
    static struct grrl_model model;
    const float equal[] = {0.1f, 0.1f, 0.1f, 0.1f};
    row(&model, 4, equal);
    add_joint(&model, 3, 0, GRRL_REVOLUTE, (struct grrl_vec2){-0.05f, 0.0f});
    for (uint8_t body = 0; body < 4; body++) {
        struct grrl_link_frame frame;
        assert_int_equal(grrl_grounding_frame(&model, body, &frame), GRRL_OK);
    }
    assert_true(forward_x(&model, 0) == -1.0f); /* alike: away from joint 0 on the right */
}

static void a_push_starts_free_behind_the_link_and_ends_beyond_it(void **state)
{
    (void)state;
    static struct grrl_model model;
    memset(&model, 0, sizeof model);
    struct grrl_grounding_config config;
    grrl_grounding_config_default(&config);
    model.n_bodies = 1;
    model.body[0] = (struct grrl_body){
        .number = 1, .n_features = 4, .axis = {1.0f, 0.0f}, .length_m = 0.1f, .width_m = 0.04f};
    const struct grrl_vec2 at[] = {{-0.05f, 0.02f}, {-0.04f, 0.0f}, {0.05f, -0.02f}, {0.02f, 0.0f}};
    memcpy(model.feature_m, at, sizeof at);
    model.n_features = 4;
    struct grrl_push push;
    assert_int_equal(grrl_grounding_push(&model, &config, 0, 0, &push), GRRL_OK);
    /* behind the feature in the corridor; the corner at -5 cm is just clear */
    assert_true(fabsf(push.start_m.x + 0.065f) < 1e-6f && push.start_m.y == 0.0f);
    assert_true(fabsf(push.end_m.x - (0.05f + 0.03f + 0.015f)) < 1e-6f);
    assert_true(push.travel_m == 0.03f && push.speed_m_s == 0.08f && push.force_n == 10.0f &&
                push.timeout_s == 2.5f);
    /* across: nothing of the link lies in the corridor around x = 0 */
    assert_int_equal(grrl_grounding_push(&model, &config, 0, 2, &push), GRRL_OK);
    assert_true(fabsf(push.start_m.y + 0.02f + 0.025f) < 1e-6f && fabsf(push.start_m.x) < 1e-6f);

    model.feature_body[4] = 1; /* another body in the way of the start */
    model.feature_m[4] = (struct grrl_vec2){-0.08f, 0.0f};
    model.n_features = 5;
    model.n_bodies = 2;
    assert_int_equal(grrl_grounding_push(&model, &config, 0, 0, &push), GRRL_OK);
    assert_true(fabsf(push.start_m.x + 0.105f) < 1e-6f);
    model.feature_body[4] = GRRL_FEATURE_BACKGROUND; /* what the table shows is not in the way */
    assert_int_equal(grrl_grounding_push(&model, &config, 0, 0, &push), GRRL_OK);
    assert_true(fabsf(push.start_m.x + 0.065f) < 1e-6f);
}

static void backing_off_has_an_end(void **state)
{
    (void)state;
    static struct grrl_model model;
    memset(&model, 0, sizeof model);
    struct grrl_grounding_config config;
    grrl_grounding_config_default(&config);
    model.n_bodies = 2;
    model.body[0].axis = (struct grrl_vec2){1.0f, 0.0f};
    for (uint16_t i = 0; i < 60; i++) {
        model.feature_m[i] = (struct grrl_vec2){-0.01f * (float)i, 0.0f};
        model.feature_body[i] = i == 0 ? 0 : 1;
    }
    model.n_features = 60;
    struct grrl_push push;
    assert_int_equal(grrl_grounding_push(&model, &config, 0, 0, &push), GRRL_OK);
    assert_true(fabsf(push.start_m.x + 0.425f) < 1e-4f);
}

static void what_does_not_exist_is_refused(void **state)
{
    (void)state;
    static struct grrl_model model;
    const float one[] = {0.1f};
    row(&model, 1, one);
    struct grrl_grounding_config config;
    grrl_grounding_config_default(&config);
    struct grrl_push push;
    struct grrl_link_frame frame;
    assert_int_equal(grrl_grounding_frame(&model, 1, &frame), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_grounding_push(&model, &config, 1, 0, &push), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_grounding_push(&model, &config, 0, GRRL_DIRECTIONS, &push),
                     GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_grounding_push(&model, &config, 0, 5, &push), GRRL_OK);
}

static void configurations_are_checked(void **state)
{
    (void)state;
    struct grrl_grounding_config config;
    grrl_grounding_config_default(&config);
    assert_int_equal(grrl_grounding_config_check(&config), GRRL_OK);
    float *const field[] = {&config.finger_radius_m, &config.clearance_m, &config.travel_m,
                            &config.speed_m_s,       &config.force_n,     &config.timeout_s};
    const float wrong[] = {0.0f, -1.0f, NAN, INFINITY};
    for (unsigned i = 0; i < sizeof field / sizeof field[0]; i++) {
        for (unsigned j = 0; j < sizeof wrong / sizeof wrong[0]; j++) {
            float was = *field[i];
            *field[i] = wrong[j];
            assert_int_equal(grrl_grounding_config_check(&config), GRRL_ERR_ARGUMENT);
            *field[i] = was;
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motions_of_the_model_move_frame_and_push),
        cmocka_unit_test(forward_points_away_from_what_holds_the_link),
        cmocka_unit_test(a_joint_in_the_middle_leaves_it_to_the_neighbour),
        cmocka_unit_test(side_points_towards_the_rest),
        cmocka_unit_test(every_joint_of_a_loop_is_followed_once),
        cmocka_unit_test(a_push_starts_free_behind_the_link_and_ends_beyond_it),
        cmocka_unit_test(backing_off_has_an_end),
        cmocka_unit_test(what_does_not_exist_is_refused),
        cmocka_unit_test(configurations_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
