/* Records: numbers as little-endian bytes, a checksum that runs on, and callbacks that fail. */
#include "base/record.h"
#include "support.h"

struct file {
    uint8_t bytes[256];
    size_t n;
    size_t at;
    int fails; /* what the callbacks return */
};

static int write_bytes(void *context, const void *bytes, size_t n)
{
    struct file *file = context;
    if (file->n + n > sizeof file->bytes)
        return 1;
    memcpy(file->bytes + file->n, bytes, n);
    file->n += n;
    return file->fails;
}

static int read_bytes(void *context, void *bytes, size_t n)
{
    struct file *file = context;
    if (file->at + n > file->n)
        return 1;
    memcpy(bytes, file->bytes + file->at, n);
    file->at += n;
    return file->fails;
}

static void test_bytes(void **state)
{
    (void)state;
    struct grrl_record record = {.n = 0};
    grrl_record_put(&record, UINT64_C(0x0123456789abcdef), 8);
    grrl_record_put(&record, UINT64_C(0xfedcba9876543210), 3);
    grrl_record_put_float(&record, -2.5f);
    static const uint8_t expected[] = {0xef, 0xcd, 0xab, 0x89, 0x67, 0x45, 0x23, 0x01,
                                       0x10, 0x32, 0x54, 0x00, 0x00, 0x20, 0xc0};
    assert_int_equal(record.n, sizeof expected);
    assert_memory_equal(record.bytes, expected, sizeof expected);
    record.n = 0;
    assert_true(grrl_record_take(&record, 8) == UINT64_C(0x0123456789abcdef));
    assert_true(grrl_record_take(&record, 3) == 0x543210u);
    assert_true(grrl_record_take_float(&record) == -2.5f);
    assert_int_equal(record.n, sizeof expected);
}

/* The checksum of the first record is that of its bytes; of the second, of both records' bytes. */
static void test_checksum(void **state)
{
    (void)state;
    struct file file = {.n = 0};
    struct grrl_io io = {.context = &file, .read = read_bytes, .write = write_bytes};
    struct grrl_record record = {.io = &io};
    memcpy(record.bytes, "123456789", 9);
    record.n = 9;
    assert_int_equal(grrl_record_write(&record), GRRL_OK);
    assert_int_equal(record.n, 0);
    static const uint8_t crc[] = {0x26, 0x39, 0xf4, 0xcb}; /* the check value of CRC-32 */
    assert_int_equal(file.n, 13);
    assert_memory_equal(file.bytes + 9, crc, 4);
    memcpy(record.bytes, "abc", 3);
    record.n = 3;
    assert_int_equal(grrl_record_write(&record), GRRL_OK);

    struct grrl_record again = {.io = &io};
    assert_int_equal(grrl_record_read(&again, 13), GRRL_OK);
    assert_int_equal(grrl_record_check(&again, 9), GRRL_OK);
    assert_int_equal(again.n, 0);
    assert_memory_equal(again.bytes, "123456789", 9);
    assert_int_equal(grrl_record_read(&again, 7), GRRL_OK);
    assert_int_equal(grrl_record_check(&again, 3), GRRL_OK);

    struct grrl_record second = {.io = &io}; /* without the first, the second is no record */
    file.at = 13;
    assert_int_equal(grrl_record_read(&second, 7), GRRL_OK);
    assert_int_equal(grrl_record_check(&second, 3), GRRL_ERR_CORRUPT);
}

/* Any bit that changes, in what was written or in its checksum, is seen. */
static void test_damage(void **state)
{
    (void)state;
    struct file file = {.n = 0};
    struct grrl_io io = {.context = &file, .read = read_bytes, .write = write_bytes};
    struct grrl_record record = {.io = &io};
    grrl_record_put(&record, UINT64_C(0x1122334455667788), 8);
    assert_int_equal(grrl_record_write(&record), GRRL_OK);
    for (size_t bit = 0; bit < 8 * file.n; bit++) {
        struct grrl_record damaged = {.io = &io};
        file.at = 0;
        file.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_int_equal(grrl_record_read(&damaged, file.n), GRRL_OK);
        assert_int_equal(grrl_record_check(&damaged, 8), GRRL_ERR_CORRUPT);
        assert_int_equal(damaged.n, 0);
        file.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
}

static void test_failing_callbacks(void **state)
{
    (void)state;
    for (int result = -1; result <= 1; result += 2) {
        struct file file = {.n = 8, .fails = result};
        struct grrl_io io = {.context = &file, .read = read_bytes, .write = write_bytes};
        struct grrl_record record = {.io = &io};
        grrl_record_put(&record, 1, 1);
        assert_int_equal(grrl_record_write(&record), GRRL_ERR_IO);
        assert_int_equal(record.n, 0);
        assert_int_equal(grrl_record_read(&record, 1), GRRL_ERR_IO);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_checksum),
        cmocka_unit_test(test_damage),
        cmocka_unit_test(test_failing_callbacks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
