/* Contexts: what is around a link, and what was tried on it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/learner/cases/context.h"
#include "grrl/learner/grounding.h"

#define LARGE_M 0.1f

/*
 * Three links in a row along x, each with features at its ends: a revolute joint between the first
 * two, a prismatic one between the last two, the last twice as long.
 */
static struct grrl_model chain(float turn_cos, float turn_sin, float mirror)
{
    static const float from_m[] = {0.0f, 0.1f, 0.2f};
    static const float length_m[] = {0.1f, 0.1f, 0.2f};
    struct grrl_model model;
    memset(&model, 0, sizeof model);
    for (uint8_t i = 0; i < 3; i++) {
        struct grrl_body *body = &model.body[i];
        float middle = from_m[i] + 0.5f * length_m[i];
        *body = (struct grrl_body){.number = (uint16_t)(i + 1),
                                   .n_features = 2,
                                   .centroid_m = {middle * turn_cos, middle * turn_sin * mirror},
                                   .axis = {turn_cos, turn_sin * mirror},
                                   .length_m = length_m[i],
                                   .width_m = 0.02f};
        for (int end = 0; end < 2; end++) {
            float at = from_m[i] + (float)end * length_m[i];
            model.feature_m[model.n_features] =
                (struct grrl_vec2){at * turn_cos, at * turn_sin * mirror};
            model.feature_body[model.n_features++] = i;
        }
    }
    model.n_bodies = 3;
    model.joint[0] = (struct grrl_joint){.a = 0,
                                         .b = 1,
                                         .type = GRRL_REVOLUTE,
                                         .point_m = {0.1f * turn_cos, 0.1f * turn_sin * mirror}};
    model.joint[1] = (struct grrl_joint){.a = 1,
                                         .b = 2,
                                         .type = GRRL_PRISMATIC,
                                         .point_m = {0.2f * turn_cos, 0.2f * turn_sin * mirror}};
    model.n_joints = 2;
    return model;
}

static struct grrl_trial_attempts attempts;

static int set_up(void **state)
{
    (void)state;
    memset(&attempts, 0, sizeof attempts);
    return 0;
}

static void describe(const struct grrl_model *model, uint8_t body,
                     struct grrl_context contexts[GRRL_DIRECTIONS])
{
    assert_int_equal(grrl_context_of(&attempts, model, LARGE_M, body, contexts), GRRL_OK);
}

static void a_context_says_what_is_around_the_link(void **state)
{
    (void)state;
    struct grrl_model model = chain(1.0f, 0.0f, 1.0f);
    grrl_attempts_update(&attempts, &model, LARGE_M);
    struct grrl_context contexts[GRRL_DIRECTIONS];
    describe(&model, 1, contexts);
    static const uint8_t slant[GRRL_DIRECTIONS] = {0, 1, 2, 0, 1, 2}; /* 0 45 90 180 225 270 */
    for (int d = 0; d < GRRL_DIRECTIONS; d++) {
        const uint8_t *part = contexts[d].part;
        assert_int_equal(part[GRRL_CONTEXT_DIRECTION], slant[d]);
        assert_int_equal(part[GRRL_CONTEXT_LENGTH], 1);
        assert_int_equal(part[GRRL_CONTEXT_NEIGHBOUR_LENGTH], 3);
        assert_int_equal(part[GRRL_CONTEXT_REVOLUTE], 1);
        assert_int_equal(part[GRRL_CONTEXT_PRISMATIC], 1);
        assert_int_equal(part[GRRL_CONTEXT_LONGER], 1);
        assert_int_equal(part[GRRL_CONTEXT_NEIGHBOURS], slant[d] == 2 ? 0 : 3);
        assert_int_equal(part[GRRL_CONTEXT_TRIED] + part[GRRL_CONTEXT_OTHERS_TRIED], 0);
    }
    describe(&model, 2, contexts); /* one neighbour: ahead or behind, not both */
    assert_int_equal(
        contexts[0].part[GRRL_CONTEXT_NEIGHBOURS] + contexts[3].part[GRRL_CONTEXT_NEIGHBOURS], 3);
    assert_int_equal(contexts[0].part[GRRL_CONTEXT_LONGER], 0);
    for (uint8_t i = 0; i < GRRL_CONTEXT_PARTS; i++)
        assert_true(contexts[0].part[i] <= grrl_context_max[i]);
    assert_int_equal(grrl_context_of(&attempts, &model, LARGE_M, 3, contexts), GRRL_ERR_ARGUMENT);
}

/* What another link has shown counts, wherever it is: even on another object. */
static void joints_elsewhere_count(void **state)
{
    (void)state;
    struct grrl_model model = chain(1.0f, 0.0f, 1.0f);
    struct grrl_context contexts[GRRL_DIRECTIONS];
    grrl_attempts_update(&attempts, &model, LARGE_M);
    static const uint8_t elsewhere[] = {2, 0, 1};
    for (uint8_t body = 0; body < 3; body++) {
        describe(&model, body, contexts);
        for (int d = 0; d < GRRL_DIRECTIONS; d++)
            assert_int_equal(contexts[d].part[GRRL_CONTEXT_ELSEWHERE], elsewhere[body]);
    }
    model.body[3] = model.body[2];
    model.body[3].number = 4;
    model.n_bodies = 4;
    describe(&model, 3, contexts);
    assert_int_equal(contexts[0].part[GRRL_CONTEXT_ELSEWHERE], 3);
}

static void an_object_may_be_turned_and_mirrored(void **state)
{
    (void)state;
    struct grrl_model model = chain(1.0f, 0.0f, 1.0f);
    grrl_attempts_update(&attempts, &model, LARGE_M);
    for (uint8_t body = 0; body < 3; body++) {
        struct grrl_context plain[GRRL_DIRECTIONS];
        describe(&model, body, plain);
        for (int mirror = -1; mirror <= 1; mirror += 2) {
            struct grrl_model turned = chain(0.6f, 0.8f, (float)mirror);
            struct grrl_context contexts[GRRL_DIRECTIONS];
            describe(&turned, body, contexts);
            assert_memory_equal(contexts, plain, sizeof plain);
        }
    }
}

static void what_was_tried_is_remembered_until_the_link_changes(void **state)
{
    (void)state;
    struct grrl_model model = chain(1.0f, 0.0f, 1.0f);
    struct grrl_context contexts[GRRL_DIRECTIONS];
    grrl_attempts_update(&attempts, &model, LARGE_M);
    for (int i = 0; i < 5; i++)
        grrl_attempts_add(&attempts, model.body[1].number, 2);
    grrl_attempts_add(&attempts, model.body[1].number, 0);
    describe(&model, 1, contexts);
    assert_int_equal(contexts[2].part[GRRL_CONTEXT_TRIED], 3);
    assert_int_equal(contexts[2].part[GRRL_CONTEXT_OTHERS_TRIED], 1);
    assert_int_equal(contexts[0].part[GRRL_CONTEXT_TRIED], 1);
    assert_int_equal(contexts[1].part[GRRL_CONTEXT_TRIED], 0);
    assert_int_equal(contexts[1].part[GRRL_CONTEXT_OTHERS_TRIED], 2);
    describe(&model, 0, contexts);
    assert_int_equal(contexts[2].part[GRRL_CONTEXT_TRIED], 0);
    model.body[0].length_m *= 2.0f; /* another link's business */
    grrl_attempts_update(&attempts, &model, LARGE_M);
    describe(&model, 1, contexts);
    assert_int_equal(contexts[2].part[GRRL_CONTEXT_TRIED], 3);
    model.n_joints = 1; /* this one's */
    grrl_attempts_update(&attempts, &model, LARGE_M);
    describe(&model, 1, contexts);
    assert_int_equal(contexts[2].part[GRRL_CONTEXT_TRIED], 0);
    grrl_attempts_add(&attempts, model.body[1].number, 2);
    model.body[1].number = 7; /* gone, and somebody else in its place */
    grrl_attempts_update(&attempts, &model, LARGE_M);
    describe(&model, 1, contexts);
    assert_int_equal(contexts[2].part[GRRL_CONTEXT_TRIED], 0);
    model.body[1].number = 2;
    grrl_attempts_update(&attempts, &model, LARGE_M);
    describe(&model, 1, contexts);
    assert_int_equal(contexts[2].part[GRRL_CONTEXT_TRIED], 0);
}

static void a_key_holds_a_whole_context(void **state)
{
    (void)state;
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++) {
        for (unsigned value = 0; value <= grrl_context_max[i]; value++) {
            struct grrl_context a = {{0}};
            struct grrl_context b = {{0}};
            for (unsigned part = 0; part < GRRL_CONTEXT_PARTS; part++)
                a.part[part] = b.part[part] = (uint8_t)(part % (grrl_context_max[part] + 1u));
            b.part[i] = (uint8_t)value;
            uint32_t key = grrl_context_key(&b);
            for (unsigned part = 0; part < GRRL_CONTEXT_PARTS; part++)
                assert_int_equal(grrl_context_part(key, part), b.part[part]);
            unsigned differ = a.part[i] != b.part[i];
            uint32_t all = grrl_context_key_bits((1u << GRRL_CONTEXT_PARTS) - 1u);
            uint32_t other = all & ~grrl_context_key_bits((uint16_t)(1u << i));
            assert_int_equal(grrl_context_differences(grrl_context_key(&a), key, all), differ);
            assert_int_equal(grrl_context_differences(grrl_context_key(&a), key, other), 0);
        }
    }
    struct grrl_context least = {{0}};
    struct grrl_context most;
    memcpy(most.part, grrl_context_max, sizeof most.part);
    assert_int_equal(
        grrl_context_differences(grrl_context_key(&least), grrl_context_key(&most), UINT32_MAX),
        GRRL_CONTEXT_PARTS);
}

/* A single body whose features thin out ahead. */
static void the_shape_of_an_unmoved_body_counts(void **state)
{
    (void)state;
    struct grrl_model model = chain(1.0f, 0.0f, 1.0f);
    struct grrl_context contexts[GRRL_DIRECTIONS];
    grrl_attempts_update(&attempts, &model, LARGE_M);
    describe(&model, 0, contexts);
    assert_int_equal(contexts[0].part[GRRL_CONTEXT_SKEW], 0); /* joints are known */
    model.n_bodies = 1;
    model.n_joints = 0;
    model.n_features = 4;
    for (uint8_t i = 0; i < 4; i++) {
        static const float x_m[] = {0.02f, 0.02f, 0.02f, 0.14f};
        model.feature_body[i] = 0;
        model.feature_m[i] = (struct grrl_vec2){x_m[i], i % 2 == 0 ? 0.01f : -0.01f};
    }
    static const float width_m[] = {0.02f, 0.05f, 0.09f};
    for (uint8_t aspect = 0; aspect < 3; aspect++) {
        model.body[0].width_m = width_m[aspect];
        describe(&model, 0, contexts);
        assert_int_equal(contexts[0].part[GRRL_CONTEXT_ASPECT], aspect);
        assert_int_equal(contexts[0].part[GRRL_CONTEXT_SKEW], 2);
        assert_int_equal(contexts[3].part[GRRL_CONTEXT_SKEW], 1);
        assert_int_equal(contexts[2].part[GRRL_CONTEXT_SKEW], 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_context_says_what_is_around_the_link, set_up),
        cmocka_unit_test_setup(joints_elsewhere_count, set_up),
        cmocka_unit_test_setup(an_object_may_be_turned_and_mirrored, set_up),
        cmocka_unit_test_setup(a_key_holds_a_whole_context, set_up),
        cmocka_unit_test_setup(the_shape_of_an_unmoved_body_counts, set_up),
        cmocka_unit_test_setup(what_was_tried_is_remembered_until_the_link_changes, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
