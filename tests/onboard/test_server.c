/* The controller's end of the line: each request is done once and answered as often as it comes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "server.h"

static struct onboard_controller controller;
static struct onboard_server server;
static struct onboard_packet request, answer;
static struct onboard_receiver receiver;
static uint8_t line[ONBOARD_LINK_BYTES];

static size_t bytes_sent;

/* What is on the line goes to the server, its answers to the receiver; how many came. */
static int exchange(const uint8_t *bytes, size_t n)
{
    int answers = 0;
    for (size_t i = 0; i < n; i++) {
        size_t sent = onboard_server_take(&server, bytes[i]);
        assert_in_range(sent, 0, sizeof server.line);
        for (size_t j = 0; j < sent; j++)
            answers += onboard_link_take(&receiver, server.line[j]) == ONBOARD_LINK_FRAME;
        bytes_sent += sent;
    }
    return answers;
}

static int ask(uint8_t sequence)
{
    size_t n = onboard_link_encode(sequence, request.type, request.bytes, request.n, line);
    return exchange(line, n);
}

static enum grrl_status status_of_answer(void)
{
    return (enum grrl_status)(int8_t)onboard_get(&answer, 1);
}

static int setup(void **state)
{
    (void)state;
    onboard_controller_init(&controller, NULL);
    onboard_server_init(&server, &controller);
    onboard_link_init(&receiver, &answer);
    onboard_put_open(&request, 3, "learn");
    assert_int_equal(ask(0), 1);
    assert_int_equal(answer.type, ONBOARD_DONE);
    assert_int_equal(status_of_answer(), GRRL_OK);
    onboard_packet_begin(&request, ONBOARD_TRIAL);
    onboard_put(&request, 1, 4);
    assert_int_equal(ask(1), 1);
    assert_int_equal(answer.type, ONBOARD_DONE);
    return 0;
}

static void put_frame(void)
{
    static const int32_t id[3] = {5, 6, 7};
    static const float x[3] = {0.1f, 0.2f, 0.3f}, y[3] = {0.0f, 0.1f, 0.0f};
    const struct grrl_frame frame = {3, id, x, y};
    onboard_put_frame(&request, &frame, false);
}

static void test_repeated_request_is_done_once(void **state)
{
    (void)state;
    put_frame();
    for (int i = 0; i < 5; i++) {
        assert_int_equal(ask(2), 1);
        assert_int_equal(answer.type, ONBOARD_DONE);
        assert_int_equal(receiver.sequence, 2);
    }
    assert_int_equal(controller.learner.perception.counts.frames, 1);
    assert_int_equal(server.repeated, 4);
    assert_int_equal(ask(3), 1);
    assert_int_equal(controller.learner.perception.counts.frames, 2);
    onboard_packet_begin(&request, ONBOARD_PERCEIVE);
    assert_int_equal(ask(4), 1);
    assert_int_equal(answer.type, ONBOARD_MODEL);
    assert_int_equal(status_of_answer(), GRRL_OK);
    uint64_t once = controller.hashes.models;
    assert_int_equal(ask(4), 1);
    assert_int_equal(answer.type, ONBOARD_MODEL);
    assert_true(controller.hashes.models == once);
}

/* A damaged request is complained of at once and changes nothing, not even what is repeated. */
static void test_damaged_request(void **state)
{
    (void)state;
    put_frame();
    size_t n = onboard_link_encode(2, request.type, request.bytes, request.n, line);
    for (size_t i = 1; i + 1 < n; i++) {
        static uint8_t damaged[ONBOARD_LINK_BYTES];
        memcpy(damaged, line, n);
        damaged[i] = (uint8_t)(damaged[i] ^ 0x80);
        assert_in_range(exchange(damaged, n), 1, 2);
        assert_int_equal(answer.type, ONBOARD_BAD);
        assert_int_equal(onboard_get(&answer, 4), server.damaged);
    }
    assert_int_equal(controller.learner.perception.counts.frames, 0);
    assert_in_range(server.damaged, n - 2, 2 * n);
    assert_int_equal(exchange(line, n), 1);
    assert_int_equal(answer.type, ONBOARD_DONE);
    assert_int_equal(controller.learner.perception.counts.frames, 1);
}

static void test_open_begins_anew_whatever_was_before(void **state)
{
    (void)state;
    put_frame();
    assert_int_equal(ask(2), 1);
    for (int i = 0; i < 2; i++) { /* its first answer may be lost */
        onboard_put_open(&request, 3, "paper");
        assert_int_equal(ask(0), 1);
        assert_int_equal(answer.type, ONBOARD_DONE);
        assert_int_equal(controller.learner.perception.counts.frames, 0);
        assert_ptr_equal(controller.learner.policy.type, &grrl_policy_paper);
    }
}

static void test_what_cannot_be_done_is_refused(void **state)
{
    (void)state;
    onboard_packet_begin(&request, 99);
    assert_int_equal(ask(2), 1);
    assert_int_equal(answer.type, ONBOARD_REFUSED);
    assert_int_equal(status_of_answer(), GRRL_ERR_FORMAT);

    onboard_put_open(&request, 3, "learn");
    request.bytes[0]++; /* links */
    assert_int_equal(ask(0), 1);
    assert_int_equal(answer.type, ONBOARD_REFUSED);
    assert_int_equal(status_of_answer(), GRRL_ERR_VERSION);

    onboard_put_open(&request, 3, "learn");
    request.bytes[request.n - 1] = 'x'; /* a name without an end */
    assert_int_equal(ask(0), 1);
    assert_int_equal(status_of_answer(), GRRL_ERR_FORMAT);

    onboard_put_open(&request, 3, "random"); /* not in the image */
    assert_int_equal(ask(0), 1);
    assert_int_equal(status_of_answer(), GRRL_ERR_NONE);

    onboard_controller_init(&controller, NULL); /* it was restarted */
    onboard_server_init(&server, &controller);
    put_frame();
    assert_int_equal(ask(7), 1);
    assert_int_equal(answer.type, ONBOARD_REFUSED);
    assert_int_equal(status_of_answer(), GRRL_ERR_ORDER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_repeated_request_is_done_once, setup),
        cmocka_unit_test_setup(test_damaged_request, setup),
        cmocka_unit_test_setup(test_open_begins_anew_whatever_was_before, setup),
        cmocka_unit_test_setup(test_what_cannot_be_done_is_refused, setup),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
