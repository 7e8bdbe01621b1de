/* Frames on a line that damages, loses and adds bytes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/base/random.h"
#include "link.h"

static struct onboard_receiver receiver;
static struct onboard_packet packet;
static uint8_t line[ONBOARD_LINK_BYTES];

static int setup(void **state)
{
    (void)state;
    onboard_link_init(&receiver, &packet);
    return 0;
}

static struct {
    int frames;
    int damaged;
} seen;

static void take(const uint8_t *bytes, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        enum onboard_link_event event = onboard_link_take(&receiver, bytes[i]);
        seen.frames += event == ONBOARD_LINK_FRAME;
        seen.damaged += event == ONBOARD_LINK_DAMAGED;
    }
}

/* Bytes with runs of zeros and of others, of all lengths around that of a block. */
static void fill(uint8_t *bytes, uint16_t n, struct grrl_random *random)
{
    uint16_t i = 0;
    while (i < n) {
        bool zeros = grrl_random_below(random, 2) == 0;
        uint32_t run = grrl_random_below(random, zeros ? 4 : 600) + 1;
        for (; run > 0 && i < n; run--)
            bytes[i++] = zeros ? 0 : (uint8_t)(grrl_random_below(random, 255) + 1);
    }
}

static size_t make_frame(uint8_t sequence, const uint8_t *bytes, uint16_t n)
{
    size_t length = onboard_link_encode(sequence, ONBOARD_FRAME, bytes, n, line);
    assert_in_range(length, ONBOARD_LINK_HEAD + n + ONBOARD_LINK_CRC + 3, ONBOARD_LINK_BYTES);
    return length;
}

static void assert_is_frame(uint8_t sequence, const uint8_t *bytes, uint16_t n)
{
    assert_int_equal(receiver.sequence, sequence);
    assert_int_equal(packet.type, ONBOARD_FRAME);
    assert_int_equal(packet.n, n);
    if (n > 0)
        assert_memory_equal(packet.bytes, bytes, n);
}

static void test_every_length_comes_back(void **state)
{
    static uint8_t bytes[ONBOARD_MAX_BYTES];
    struct grrl_random random;
    (void)state;
    grrl_random_init(&random, 11, 0);
    for (uint16_t n = 0; n <= ONBOARD_MAX_BYTES; n++) {
        seen.frames = seen.damaged = 0;
        fill(bytes, n, &random);
        size_t length = make_frame((uint8_t)n, bytes, n);
        for (size_t i = 1; i + 1 < length; i++)
            assert_int_not_equal(line[i], 0);
        take(line, length);
        assert_int_equal(seen.frames, 1);
        assert_int_equal(seen.damaged, 0);
        assert_is_frame((uint8_t)n, bytes, n);
    }
}

static void test_crc_is_the_usual_one(void **state)
{
    (void)state;
    size_t length = onboard_link_encode('1', '2', (const uint8_t *)"", 0, line);
    /* "12" and a length of 0, as Python's zlib.crc32(b"12\0\0") has it: 0x4e3c7126 */
    static const uint8_t expected[] = {0, 3, '1', '2', 1, 5, 0x26, 0x71, 0x3c, 0x4e, 0};
    assert_int_equal(length, sizeof expected);
    assert_memory_equal(line, expected, sizeof expected);
}

static void test_every_changed_byte_is_noticed(void **state)
{
    static uint8_t bytes[300], good[ONBOARD_LINK_BYTES];
    struct grrl_random random;
    (void)state;
    grrl_random_init(&random, 12, 0);
    fill(bytes, sizeof bytes, &random);
    size_t length = make_frame(9, bytes, sizeof bytes);
    memcpy(good, line, length);
    for (size_t i = 1; i + 1 < length; i++) {
        for (unsigned change = 1; change < 256; change++) {
            seen.frames = seen.damaged = 0;
            memcpy(line, good, length);
            line[i] = (uint8_t)(line[i] ^ change);
            take(line, length);
            assert_int_equal(seen.frames, 0);
            assert_in_range(seen.damaged, 1, 2);
            take(good, length); /* the next one is not lost with it */
            assert_int_equal(seen.frames, 1);
        }
    }
}

static void test_cut_anywhere_the_next_frame_arrives(void **state)
{
    static uint8_t bytes[260], good[ONBOARD_LINK_BYTES];
    struct grrl_random random;
    (void)state;
    grrl_random_init(&random, 13, 0);
    fill(bytes, sizeof bytes, &random);
    size_t length = make_frame(10, bytes, sizeof bytes);
    memcpy(good, line, length);
    for (size_t cut = 0; cut + 1 < length; cut++) {
        seen.frames = seen.damaged = 0;
        take(good, cut);
        take(good, length);
        assert_int_equal(seen.frames, 1);
        assert_int_equal(seen.damaged, cut > 1);
        take(good + length - cut, cut); /* the other half */
        take(good, length);
        assert_int_equal(seen.frames, 2);
        assert_is_frame(10, bytes, sizeof bytes);
    }
}

static void test_every_lost_byte_is_noticed(void **state)
{
    static uint8_t bytes[260], good[ONBOARD_LINK_BYTES];
    (void)state;
    for (unsigned i = 0; i < sizeof bytes; i++)
        bytes[i] = (uint8_t)(i * 7);
    size_t length = make_frame(10, bytes, sizeof bytes);
    memcpy(good, line, length);
    for (size_t lost = 1; lost + 1 < length; lost++) {
        seen.frames = 0;
        take(good, lost);
        take(good + lost + 1, length - lost - 1);
        assert_int_equal(seen.frames, 0);
    }
}

static void test_garbage_between_frames(void **state)
{
    static uint8_t bytes[100], good[ONBOARD_LINK_BYTES];
    struct grrl_random random;
    (void)state;
    grrl_random_init(&random, 14, 0);
    fill(bytes, sizeof bytes, &random);
    size_t length = make_frame(11, bytes, sizeof bytes);
    memcpy(good, line, length);
    seen.frames = 0;
    for (int round = 0; round < 300; round++) {
        for (uint32_t n = grrl_random_below(&random, 3 * ONBOARD_LINK_BYTES); n > 0; n--) {
            uint8_t byte = (uint8_t)grrl_random_below(&random, 256);
            take(&byte, 1);
        }
        assert_int_equal(seen.frames, round);
        take(good, length);
        assert_int_equal(seen.frames, round + 1);
        assert_is_frame(11, bytes, sizeof bytes);
    }
}

/* Longer than any frame, without a zero: nothing is written beyond the packet, and it ends. */
static void test_endless_frame(void **state)
{
    static uint8_t good[ONBOARD_LINK_BYTES];
    const uint8_t byte = 0xff, zero = 0;
    (void)state;
    size_t length = make_frame(12, NULL, 0);
    memcpy(good, line, length);
    seen.frames = seen.damaged = 0;
    for (unsigned i = 0; i < 10 * ONBOARD_LINK_BYTES; i++)
        take(&byte, 1);
    take(&zero, 1);
    assert_int_equal(seen.damaged, 1);
    take(good, length);
    assert_int_equal(seen.frames, 1);
}

static void test_numbers_leave_out_zero(void **state)
{
    (void)state;
    assert_int_equal(onboard_link_next(0), 1);
    assert_int_equal(onboard_link_next(254), 255);
    assert_int_equal(onboard_link_next(255), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_every_length_comes_back, setup),
        cmocka_unit_test_setup(test_crc_is_the_usual_one, setup),
        cmocka_unit_test_setup(test_every_changed_byte_is_noticed, setup),
        cmocka_unit_test_setup(test_cut_anywhere_the_next_frame_arrives, setup),
        cmocka_unit_test_setup(test_every_lost_byte_is_noticed, setup),
        cmocka_unit_test_setup(test_garbage_between_frames, setup),
        cmocka_unit_test_setup(test_endless_frame, setup),
        cmocka_unit_test(test_numbers_leave_out_zero),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
