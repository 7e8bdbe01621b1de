/* Answers read back: what was put in, and nothing from bytes that are none. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "packet.h"

static struct onboard_packet packet, again;
static struct grrl_model model, read_model;

static int setup(void **state)
{
    (void)state;
    memset(&model, 0, sizeof model);
    model.n_bodies = 3;
    model.n_joints = 2;
    model.n_features = 5;
    for (uint8_t i = 0; i < 3; i++) {
        model.body[i] = (struct grrl_body){.number = (uint16_t)(i + 300),
                                           .n_features = i,
                                           .centroid_m = {0.1f * i, -2.0f},
                                           .axis = {0.6f, 0.8f},
                                           .length_m = 0.13f,
                                           .width_m = 0.035f};
    }
    for (uint8_t i = 0; i < 2; i++) {
        model.joint[i] = (struct grrl_joint){.a = i,
                                             .b = (uint8_t)(i + 1),
                                             .type = i,
                                             .probability = 0.9f,
                                             .p_revolute = 0.05f,
                                             .point_cov_m2 = {1.0f, 2.0f, 3.0f},
                                             .lower = -0.5f,
                                             .upper = 0.25f};
    }
    for (uint8_t i = 0; i < 5; i++) {
        model.feature_id[i] = -7 - i;
        model.feature_m[i] = (struct grrl_vec2){0.01f * i, 1.0f};
        model.feature_body[i] = i < 3 ? i : i == 3 ? GRRL_FEATURE_BACKGROUND : GRRL_FEATURE_NONE;
    }
    onboard_packet_begin(&packet, ONBOARD_MODEL);
    onboard_put_model(&packet, &model);
    return 0;
}

static void test_model(void **state)
{
    (void)state;
    assert_true(onboard_get_model(&packet, &read_model));
    onboard_packet_begin(&again, ONBOARD_MODEL);
    onboard_put_model(&again, &read_model);
    assert_int_equal(again.n, packet.n);
    assert_memory_equal(again.bytes, packet.bytes, packet.n);
    assert_int_equal(read_model.feature_id[4], -11);
    assert_int_equal(read_model.body[2].number, 302);
    assert_int_equal(read_model.joint[1].type, 1);
}

static void test_model_cut_or_longer(void **state)
{
    (void)state;
    uint16_t all = packet.n;
    for (packet.n = 0; packet.n < all; packet.n++) {
        packet.at = 0;
        packet.bad = false;
        assert_false(onboard_get_model(&packet, &read_model));
    }
    packet.n = (uint16_t)(all + 1);
    packet.at = 0;
    packet.bad = false;
    assert_false(onboard_get_model(&packet, &read_model));
}

/* Each count, and each index that points somewhere else. */
static void test_model_forged(void **state)
{
    (void)state;
    const size_t joints = 4 + 3 * 28, features = joints + 2 * 59;
    const struct {
        size_t at;
        uint8_t value;
    } forged[] = {{0, GRRL_MAX_LINKS + 1},
                  {1, GRRL_MAX_JOINTS + 1},
                  {3, 0x7f},
                  {joints, 3},
                  {joints + 1, 0xff},
                  {joints + 2, GRRL_JOINT_TYPES},
                  {features + 12, 3},
                  {packet.n - 1, 0x80}};
    for (size_t i = 0; i < sizeof forged / sizeof forged[0]; i++) {
        again = packet;
        again.bytes[forged[i].at] = forged[i].value;
        assert_false(onboard_get_model(&again, &read_model));
    }
}

static void test_decision(void **state)
{
    (void)state;
    const struct grrl_decision decision = {
        .choice = {.link = 4,
                   .direction = 5,
                   .reason = GRRL_CHOICE_EXPLOIT,
                   .source = {GRRL_SOURCE_CASES, 3, 70000},
                   .value = 1.5f,
                   .lower = 1.25f,
                   .upper = 1.75f,
                   .phi = 0.5f},
        .body_number = 301,
        .push = {{0.1f, 0.2f}, {0.3f, 0.4f}, 0.03f, 0.08f, 10.0f, 2.5f}};
    struct grrl_decision other;
    onboard_packet_begin(&packet, ONBOARD_DECISION);
    onboard_put_decision(&packet, &decision);
    assert_true(onboard_get_decision(&packet, &other));
    onboard_packet_begin(&again, ONBOARD_DECISION);
    onboard_put_decision(&again, &other);
    assert_memory_equal(again.bytes, packet.bytes, packet.n);
    assert_int_equal(other.choice.source.kind, GRRL_SOURCE_CASES);
    assert_int_equal(other.choice.source.index, 70000);
    const size_t direction = 8 * 4 + 2 + 1;
    packet.at = 0;
    packet.bytes[direction] = GRRL_DIRECTIONS;
    assert_false(onboard_get_decision(&packet, &other));
    packet.at = 0;
    packet.bytes[direction] = 0;
    packet.n--;
    assert_false(onboard_get_decision(&packet, &other));
}

static void test_lesson(void **state)
{
    (void)state;
    const struct grrl_update update = {2.0f, 2.5f, 9};
    const struct grrl_usage usage = {12, 256, 3};
    struct grrl_update other;
    struct grrl_usage used;
    onboard_packet_begin(&packet, ONBOARD_UPDATE);
    onboard_put_update(&packet, &update, &usage);
    assert_true(onboard_get_update(&packet, &other, &used));
    assert_memory_equal(&other, &update, sizeof update);
    assert_memory_equal(&used, &usage, sizeof usage);
    packet.at = 0;
    packet.n--;
    assert_false(onboard_get_update(&packet, &other, &used));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_model, setup),
        cmocka_unit_test_setup(test_model_cut_or_longer, setup),
        cmocka_unit_test_setup(test_model_forged, setup),
        cmocka_unit_test(test_decision),
        cmocka_unit_test(test_lesson),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
