/* Every message: round trips, cuts at each byte, forged counts and numbers. The bytes to be decoded
 * lie at the end of an exact heap block, so that the sanitizer sees any read beyond them. */
#include "wire.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/base/random.h"

static struct grrl_wire_why why;

/* One type behind a uniform face. */
struct subject {
    const char *name;
    int size;
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
    bool (*decode)(const void *data, uint32_t size);
    int (*encode)(int capacity, uint8_t *data); /* of what decode left */
};

static struct grrl_wire_points points;
static struct grrl_wire_model model;
static grrl_push_command_t push_command;
static grrl_push_status_t push_status;
static grrl_trial_t trial;
static grrl_decision_t decision;
static grrl_agent_status_t agent_status;
static struct grrl_wire_image image;
static grrl_stop_t stop;

#define FACE(type, variable, message)                                                              \
    static bool decode_##type(const void *data, uint32_t size)                                     \
    {                                                                                              \
        return grrl_wire_decode_##type(data, size, &(variable), &why);                             \
    }                                                                                              \
    static int encode_##type(int capacity, uint8_t *data)                                          \
    {                                                                                              \
        return grrl_wire_encode_##type(&(message), capacity, data, &why);                          \
    }

FACE(points, points, points.message)
FACE(model, model, model.message)
FACE(push_command, push_command, push_command)
FACE(push_status, push_status, push_status)
FACE(trial, trial, trial)
FACE(decision, decision, decision)
FACE(agent_status, agent_status, agent_status)
FACE(image, image, image.message)
FACE(stop, stop, stop)

#define N_TYPES 9
static struct subject subjects[N_TYPES] = {
    {"points", 0, {0}, decode_points, encode_points},
    {"model", 0, {0}, decode_model, encode_model},
    {"push_command", 0, {0}, decode_push_command, encode_push_command},
    {"push_status", 0, {0}, decode_push_status, encode_push_status},
    {"trial", 0, {0}, decode_trial, encode_trial},
    {"decision", 0, {0}, decode_decision, encode_decision},
    {"agent_status", 0, {0}, decode_agent_status, encode_agent_status},
    {"image", 0, {0}, decode_image, encode_image},
    {"stop", 0, {0}, decode_stop, encode_stop},
};

static void fill_points(int n)
{
    grrl_wire_bind_points(&points);
    grrl_points_t *m = &points.message;
    m->utime = 1234567890123;
    m->session_id = 42;
    m->seq = 7;
    m->trial_id = 3;
    m->ack_cmd_seq = 2;
    m->mode = GRRL_POINTS_T_LOCK_STEP;
    m->phase = GRRL_POINTS_T_SETTLED;
    m->n_points = n;
    for (int i = 0; i < n; i++) {
        points.id[i] = 1000 * i - 5;
        points.x[i] = 0.001f * (float)i;
        points.y[i] = -0.3f / (float)(i + 1);
    }
}

static void fill_model(int n_links, int n_joints, int n_features)
{
    memset(&model, 0, sizeof model);
    grrl_wire_bind_model(&model);
    grrl_model_t *m = &model.message;
    m->session_id = 43;
    m->trial_id = 3;
    m->n_links = n_links;
    m->n_joints = n_joints;
    m->n_features = n_features;
    for (int i = 0; i < n_links; i++) {
        model.link_number[i] = (int16_t)(i + 1);
        model.link_x[i] = 0.1f * (float)i;
        model.link_length[i] = 0.13f;
        model.link_size[i] = GRRL_MODEL_T_SMALL;
    }
    for (int j = 0; j < n_joints; j++) {
        model.joint_a[j] = (int8_t)(j % n_links);
        model.joint_b[j] = (int8_t)((j + 1) % n_links);
        model.joint_type[j] = (int8_t)(j & 1);
        model.joint_probability[j] = 0.75f;
        model.joint_upper[j] = 1.5f;
    }
    for (int i = 0; i < n_features; i++) {
        model.feature_id[i] = i;
        model.feature_link[i] = (int8_t)(i % (n_links + 2) - 2);
    }
}

static void fill_small(void)
{
    push_command = (grrl_push_command_t){.session_id = 43, .plant_session_id = 42, .points_seq = 7};
    push_command.kind = GRRL_PUSH_COMMAND_T_PUSH;
    push_command.cmd_seq = 1;
    push_command.start[1] = -0.123456f;
    push_command.end[0] = 0.2f;
    push_command.travel = 0.03f;
    push_command.speed = 0.08f;
    push_command.force = 10.0f;
    push_command.timeout = 2.5f;
    push_status = (grrl_push_status_t){.session_id = 42, .agent_session_id = 43, .cmd_seq = 1};
    push_status.tool[0] = 0.25f;
    trial = (grrl_trial_t){.session_id = 42, .trial_id = 1, .revision = 1, .judged_cmd_seq = -1};
    decision = (grrl_decision_t){.session_id = 43, .trial_id = 1, .cmd_seq = 1, .source_index = -1};
    decision.phi = 0.5f;
    agent_status = (grrl_agent_status_t){.session_id = 43, .received = INT64_MAX};
    stop = (grrl_stop_t){.session_id = 42, .reason = GRRL_STOP_T_LIMIT};
}

static void fill_image(int32_t width, int32_t height, int8_t encoding, int32_t n_bytes)
{
    grrl_wire_bind_image(&image);
    grrl_image_t *m = &image.message;
    m->utime = 1234567890123;
    m->session_id = 42;
    m->seq = 7;
    m->trial_id = 3;
    m->ack_cmd_seq = 2;
    m->agent_session_id = 43;
    m->mode = GRRL_POINTS_T_LOCK_STEP;
    m->phase = GRRL_POINTS_T_REST;
    m->width = width;
    m->height = height;
    m->encoding = encoding;
    m->n_bytes = n_bytes;
    for (int32_t i = 0; i < n_bytes && i < GRRL_WIRE_MAX_PICTURE; i++)
        image.data[i] = (uint8_t)(i * 7);
}

static int setup(void **state)
{
    (void)state;
    fill_points(3);
    fill_model(3, 2, 5);
    fill_small();
    fill_image(17, 19, GRRL_IMAGE_T_RAW_GREY, 17 * 19);
    for (size_t i = 0; i < N_TYPES; i++) {
        struct subject *s = &subjects[i];
        s->size = s->encode(GRRL_WIRE_MAX_BYTES, s->bytes);
        if (s->size <= 0)
            return -1;
    }
    return 0;
}

/* Decodes a copy in a block of exactly this size. */
static bool decode_exact(const struct subject *s, const uint8_t *data, int size)
{
    uint8_t *block = malloc(size > 0 ? (size_t)size : 1);
    assert_non_null(block);
    memcpy(block, data, (size_t)size);
    why.text[0] = '\0';
    bool good = s->decode(block, (uint32_t)size);
    assert_true(good || why.text[0] != '\0');
    free(block);
    return good;
}

static void round_trip_gives_the_same_bytes(void **state)
{
    (void)state;
    for (size_t i = 0; i < N_TYPES; i++) {
        struct subject *s = &subjects[i];
        uint8_t again[GRRL_WIRE_MAX_BYTES];
        assert_true(decode_exact(s, s->bytes, s->size));
        assert_int_equal(s->encode(GRRL_WIRE_MAX_BYTES, again), s->size);
        assert_memory_equal(again, s->bytes, (size_t)s->size);
    }
}

/* Ours and the generated decoder agree on what the bytes mean. */
static void decoding_agrees_with_the_generated_decoder(void **state)
{
    (void)state;
    grrl_model_t other;
    assert_true(decode_exact(&subjects[1], subjects[1].bytes, subjects[1].size));
    assert_int_equal(grrl_model_t_decode(subjects[1].bytes, 0, subjects[1].size, &other),
                     subjects[1].size);
    assert_int_equal(other.n_links, model.message.n_links);
    assert_memory_equal(other.link_x, model.link_x, 3 * sizeof(float));
    assert_memory_equal(other.link_number, model.link_number, 3 * sizeof(int16_t));
    assert_memory_equal(other.feature_id, model.feature_id, 5 * sizeof(int32_t));
    assert_memory_equal(other.feature_link, model.feature_link, 5);
    grrl_model_t_decode_cleanup(&other);
}

static void every_cut_is_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < N_TYPES; i++)
        for (int size = 0; size < subjects[i].size; size++)
            assert_false(decode_exact(&subjects[i], subjects[i].bytes, size));
}

static void a_byte_too_many_is_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < N_TYPES; i++) {
        struct subject s = subjects[i];
        s.bytes[s.size] = 0;
        assert_false(decode_exact(&s, s.bytes, s.size + 1));
    }
}

static void a_wrong_fingerprint_is_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < N_TYPES; i++) {
        for (int bit = 0; bit < 64; bit++) {
            struct subject s = subjects[i];
            s.bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
            assert_false(decode_exact(&s, s.bytes, s.size));
        }
        for (size_t j = 0; j < N_TYPES; j++)
            if (i != j)
                assert_false(decode_exact(&subjects[i], subjects[j].bytes, subjects[j].size));
    }
}

static void put32(uint8_t *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> (24 - 8 * i));
}

static void forged_counts_are_refused(void **state)
{
    (void)state;
    const uint32_t forged[] = {4,          5,          255,        256,        257, 0x10000,
                               0x40000000, 0x7fffffff, 0x80000000, 0xffffffff, 2};
    const struct {
        int subject, at;
    } counts[] = {{0, 50}, {1, 32}, {1, 36}, {1, 40}, {7, 59}};
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++)
        for (size_t v = 0; v < sizeof forged / sizeof forged[0]; v++) {
            struct subject s = subjects[counts[c].subject];
            uint8_t before[4];
            memcpy(before, s.bytes + counts[c].at, 4);
            put32(s.bytes + counts[c].at, forged[v]);
            if (memcmp(before, s.bytes + counts[c].at, 4) == 0)
                continue; /* it happens to be the true one */
            assert_false(decode_exact(&s, s.bytes, s.size));
        }
}

/* Each float of each type, by where it stands in the messages of setup. */
static void numbers_that_are_not_finite_are_refused(void **state)
{
    (void)state;
    enum { MODEL_LINKS = 44 + 3 * 2, MODEL_JOINTS = MODEL_LINKS + 5 * 3 * 4 + 3 + 3 * 2 };
    const struct {
        int subject, first, n;
    } runs[] = {
        {0, 54 + 3 * 4, 2 * 3}, /* x, y of three points */
        {1, MODEL_LINKS, 5 * 3}, {1, MODEL_JOINTS, 6 * 2},          {2, 8 + 8 * 4 + 4 * 3 + 1, 8},
        {3, 8 + 24 + 8 + 2, 2},  {5, 8 + 16 + 8 + 4 + 2 + 2 + 4, 6}};
    const struct {
        uint32_t word;
        const char *text;
    } bad[] = {{0x7fc00000, "nan"}, {0xffc00001, "nan"}, {0x7f800000, "inf"}, {0xff800000, "-inf"}};
    for (size_t r = 0; r < sizeof runs / sizeof runs[0]; r++)
        for (int k = 0; k < runs[r].n; k++)
            for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
                struct subject s = subjects[runs[r].subject];
                put32(s.bytes + runs[r].first + 4 * k, bad[b].word);
                assert_false(decode_exact(&s, s.bytes, s.size));
                assert_non_null(strstr(why.text, bad[b].text));
            }
}

/* ... and there is no float beside those: what is accepted with such a word in it, at any offset,
 * holds it as whole numbers and gives the same bytes back. */
static void what_is_accepted_encodes_to_the_same_bytes(void **state)
{
    (void)state;
    const uint32_t words[] = {0x7fc00000, 0xffc00001, 0x7f800000, 0xff800000, 0x7fffffff, 0};
    for (size_t i = 0; i < N_TYPES; i++)
        for (size_t w = 0; w < sizeof words / sizeof words[0]; w++)
            for (int at = 8; at + 4 <= subjects[i].size; at++) {
                uint8_t again[GRRL_WIRE_MAX_BYTES];
                struct subject s = subjects[i];
                put32(s.bytes + at, words[w]);
                if (!decode_exact(&s, s.bytes, s.size))
                    continue;
                assert_int_equal(s.encode(GRRL_WIRE_MAX_BYTES, again), s.size);
                assert_memory_equal(again, s.bytes, (size_t)s.size);
            }
}

static void links_that_do_not_exist_are_refused(void **state)
{
    (void)state;
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
    fill_model(3, 2, 5);
    model.joint_b[1] = 3;
    assert_int_equal(encode_model(GRRL_WIRE_MAX_BYTES, bytes), -1);
    model.joint_b[1] = model.joint_a[1];
    assert_int_equal(encode_model(GRRL_WIRE_MAX_BYTES, bytes), -1);
    fill_model(3, 2, 5);
    model.feature_link[4] = 3;
    assert_int_equal(encode_model(GRRL_WIRE_MAX_BYTES, bytes), -1);
    /* the same on the receiver's side: the last byte of the message is the last feature_link */
    struct subject s = subjects[1];
    s.bytes[s.size - 1] = 3;
    assert_false(decode_exact(&s, s.bytes, s.size));
}

static void the_largest_messages_fit(void **state)
{
    (void)state;
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
    fill_points(GRRL_WIRE_MAX_POINTS);
    int size = encode_points(GRRL_WIRE_MAX_BYTES, bytes);
    assert_true(size > 0);
    assert_true(decode_exact(&subjects[0], bytes, size));
    assert_int_equal(encode_points(size - 1, bytes), -1);
    fill_model(GRRL_WIRE_MAX_LINKS, GRRL_WIRE_MAX_JOINTS, GRRL_WIRE_MAX_POINTS);
    size = encode_model(GRRL_WIRE_MAX_BYTES, bytes);
    assert_true(size > 0);
    assert_true(decode_exact(&subjects[1], bytes, size));
    fill_points(0);
    size = encode_points(GRRL_WIRE_MAX_BYTES, bytes);
    assert_true(decode_exact(&subjects[0], bytes, size));
    points.message.n_points = GRRL_WIRE_MAX_POINTS + 1;
    assert_int_equal(encode_points(GRRL_WIRE_MAX_BYTES, bytes), -1);
}

static void the_largest_picture_fits(void **state)
{
    (void)state;
    static uint8_t bytes[GRRL_WIRE_MAX_IMAGE_BYTES];
    struct subject s = subjects[7];
    fill_image(4096, 1024, GRRL_IMAGE_T_RAW_GREY, GRRL_WIRE_MAX_PICTURE);
    int size = encode_image(GRRL_WIRE_MAX_IMAGE_BYTES, bytes);
    assert_true(size > GRRL_WIRE_MAX_PICTURE);
    memset(image.data, 0, sizeof image.data);
    assert_true(decode_exact(&s, bytes, size));
    for (int32_t i = 0; i < GRRL_WIRE_MAX_PICTURE; i += 4097)
        assert_int_equal(image.data[i], (uint8_t)(i * 7));
    assert_int_equal(encode_image(size - 1, bytes), -1);
    fill_image(640, 480, GRRL_IMAGE_T_JPEG, GRRL_WIRE_MAX_PICTURE + 1);
    assert_int_equal(encode_image(GRRL_WIRE_MAX_IMAGE_BYTES, bytes), -1);
}

/* A picture without coding that is not width times height would be read beyond its end. */
static void a_picture_of_another_size_is_refused(void **state)
{
    (void)state;
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
    struct subject s = subjects[7];
    fill_image(17, 20, GRRL_IMAGE_T_RAW_GREY, 17 * 19);
    assert_int_equal(encode_image(GRRL_WIRE_MAX_BYTES, bytes), -1);
    assert_non_null(strstr(why.text, "340"));
    fill_image(17, 19, GRRL_IMAGE_T_RAW_BGR, 17 * 19);
    assert_int_equal(encode_image(GRRL_WIRE_MAX_BYTES, bytes), -1);
    fill_image(17, 19, GRRL_IMAGE_T_JPEG, 100); /* coded, it may have any */
    assert_true(encode_image(GRRL_WIRE_MAX_BYTES, bytes) > 0);
    enum { HEIGHT_AT = 8 + 3 * 8 + 2 * 4 + 8 + 2 + 4 };
    put32(s.bytes + HEIGHT_AT, 20); /* on the receiver's side */
    assert_false(decode_exact(&s, s.bytes, s.size));
    put32(s.bytes + HEIGHT_AT, 0x7fffffff);
    assert_false(decode_exact(&s, s.bytes, s.size));
}

static void floats_pass_bit_for_bit(void **state)
{
    (void)state;
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
    const uint32_t patterns[] = {0x3dcccccd, 0x80000000, 0x00000001, 0xbeaaaaab};
    for (size_t i = 0; i < sizeof patterns / sizeof patterns[0]; i++) {
        memcpy(&push_command.start[0], &patterns[i], 4);
        int size = encode_push_command(GRRL_WIRE_MAX_BYTES, bytes);
        memset(push_command.start, 0, sizeof push_command.start);
        assert_true(decode_exact(&subjects[2], bytes, size));
        assert_memory_equal(&push_command.start[0], &patterns[i], 4);
    }
}

/* Random damage behind a right fingerprint: refused or harmless. */
static void damaged_messages_do_no_harm(void **state)
{
    (void)state;
    struct grrl_random random;
    grrl_random_init(&random, 1, 0);
    for (int round = 0; round < 20000; round++) {
        struct subject s = subjects[round % N_TYPES];
        for (uint32_t n = 1 + grrl_random_below(&random, 4); n > 0; n--)
            s.bytes[8 + grrl_random_below(&random, (uint32_t)s.size - 8)] =
                (uint8_t)grrl_random_next(&random);
        (void)decode_exact(&s, s.bytes, s.size);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(round_trip_gives_the_same_bytes, setup),
        cmocka_unit_test_setup(decoding_agrees_with_the_generated_decoder, setup),
        cmocka_unit_test_setup(every_cut_is_refused, setup),
        cmocka_unit_test_setup(a_byte_too_many_is_refused, setup),
        cmocka_unit_test_setup(a_wrong_fingerprint_is_refused, setup),
        cmocka_unit_test_setup(forged_counts_are_refused, setup),
        cmocka_unit_test_setup(numbers_that_are_not_finite_are_refused, setup),
        cmocka_unit_test_setup(what_is_accepted_encodes_to_the_same_bytes, setup),
        cmocka_unit_test_setup(links_that_do_not_exist_are_refused, setup),
        cmocka_unit_test_setup(the_largest_messages_fit, setup),
        cmocka_unit_test_setup(the_largest_picture_fits, setup),
        cmocka_unit_test_setup(a_picture_of_another_size_is_refused, setup),
        cmocka_unit_test_setup(floats_pass_bit_for_bit, setup),
        cmocka_unit_test_setup(damaged_messages_do_no_harm, setup),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
