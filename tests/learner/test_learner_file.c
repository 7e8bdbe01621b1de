/* What a learner has learned, as a file: saved and loaded, torn, of another policy, of an older
 * version. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "chain_learner.h"
#include "memory_file.h"

static struct memory_file file = {.calls_left = -1};

static void what_was_learned_can_be_saved(void **state)
{
    (void)state;
    const struct grrl_io io = memory_file_io(&file);
    for (int i = 0; i < LEARNERS; i++) {
        uint32_t hash = 0;
        uint32_t a = 0;
        uint32_t b = 0;
        init(&one, learners[i], SEED);
        (void)run_trials(&one, "RPRP", 1, 10, &hash);
        file.size = file.at = 0;
        assert_int_equal(grrl_learner_save(&one.learner, &io), GRRL_OK);
        init(&two, learners[i], SEED);
        assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_OK);
        assert_int_equal(file.at, file.size);
        assert_int_equal(grrl_learner_usage(&two.learner).n, grrl_learner_usage(&one.learner).n);
        unsigned pushes = run_trials(&one, "RPRP", 11, 10, &a);
        assert_int_equal(run_trials(&two, "RPRP", 11, 10, &b), pushes);
        assert_int_equal(a, b);
        for (size_t cut = 0; cut < file.size; cut += cut < 200 ? 1 : 37) {
            size_t whole = file.size;
            file.size = cut;
            file.at = 0;
            assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_ERR_IO);
            assert_int_equal(grrl_learner_usage(&two.learner).n, 0);
            file.size = whole;
        }
    }
}

/* A file is of one policy; learn and greedy keep the same cases. */
static void a_file_of_another_policy_is_refused(void **state)
{
    (void)state;
    const struct grrl_io io = memory_file_io(&file);
    for (int i = 0; i < LEARNERS; i++) {
        for (int j = 0; j < LEARNERS; j++) {
            uint32_t hash = 0;
            init(&one, learners[i], SEED);
            (void)run_trials(&one, "RPR", 1, 3, &hash);
            file.size = file.at = 0;
            assert_int_equal(grrl_learner_save(&one.learner, &io), GRRL_OK);
            init(&two, learners[j], SEED);
            bool same = (learners[i] == &grrl_policy_paper) == (learners[j] == &grrl_policy_paper);
            assert_int_equal(grrl_learner_load(&two.learner, &io),
                             same ? GRRL_OK : GRRL_ERR_POLICY);
        }
    }
}

static void a_policy_that_does_not_learn_has_no_file(void **state)
{
    (void)state;
    const struct grrl_io io = memory_file_io(&file);
    init(&one, &grrl_policy_random, SEED);
    assert_int_equal(grrl_learner_save(&one.learner, &io), GRRL_ERR_NONE);
    assert_int_equal(grrl_learner_load(&one.learner, &io), GRRL_ERR_NONE);
    grrl_learner_clear(&one.learner);
}

/* What stood before and behind what `learner` learned in a file of version 0.1.0: the section of
 * the other learner, empty. */
static const unsigned char no_experiences[] = {
    'G', 'R', 'R', 'L', 'e', 'x', 'p', 0, 2, 0, GRRL_MAX_PROPERTIES, GRRL_DIRECTIONS};

static void put(const void *bytes, size_t n)
{
    memcpy(file.bytes + file.size, bytes, n);
    file.size += n;
}

/* CRC-32 (IEEE 802.3). */
static void put_crc(size_t from)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = from; i < file.size; i++) {
        crc ^= file.bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = (crc >> 1) ^ ((crc & 1u) != 0 ? UINT32_C(0xedb88320) : 0u);
    }
    crc = ~crc;
    const unsigned char bytes[4] = {(unsigned char)crc, (unsigned char)(crc >> 8),
                                    (unsigned char)(crc >> 16), (unsigned char)(crc >> 24)};
    put(bytes, 4);
}

static void old_files_load(void **state)
{
    (void)state;
    static unsigned char learned[sizeof file.bytes];
    const unsigned char zeros[12] = {0};
    const struct grrl_io io = memory_file_io(&file);
    uint32_t hash = 0;
    init(&one, &grrl_policy_learn, SEED);
    (void)run_trials(&one, "RPR", 1, 5, &hash);
    file.size = file.at = 0;
    assert_int_equal(grrl_learner_save(&one.learner, &io), GRRL_OK);
    size_t n = file.size;
    memcpy(learned, file.bytes, n);
    file.size = file.at = 0;
    put(no_experiences, sizeof no_experiences);
    put(zeros, 12);
    put_crc(0);
    put(learned, n);
    init(&two, &grrl_policy_learn, SEED);
    assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_OK);
    assert_int_equal(file.at, file.size);
    assert_int_equal(grrl_learner_usage(&two.learner).n, grrl_learner_usage(&one.learner).n);
    while (--file.size > 0) {
        file.at = 0;
        assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_ERR_IO);
    }
    file.size = sizeof no_experiences + 12 + 4 + n;
    file.bytes[13] ^= 1; /* damaged: it would hold 256 states */
    file.at = 0;
    assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_ERR_POLICY);
    file.bytes[13] ^= 1;
    file.bytes[20] ^= 1; /* its clock */
    file.at = 0;
    assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_ERR_CORRUPT);
    /* and the policy paper finds nothing of its own in it, but cases */
    file.bytes[20] ^= 1;
    file.at = 0;
    init(&two, &grrl_policy_paper, SEED);
    assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_ERR_POLICY);
    /* with both sections empty it is a file for either */
    init(&one, &grrl_policy_learn, SEED);
    file.size = file.at = 0;
    put(no_experiences, sizeof no_experiences);
    put(zeros, 12);
    put_crc(0);
    assert_int_equal(grrl_learner_save(&one.learner, &io), GRRL_OK);
    assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_OK);
    assert_int_equal(file.at, file.size);
    file.bytes[file.size - 1] ^= 1;
    file.at = 0;
    assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_ERR_CORRUPT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(what_was_learned_can_be_saved, set_up),
        cmocka_unit_test_setup(a_file_of_another_policy_is_refused, set_up),
        cmocka_unit_test_setup(a_policy_that_does_not_learn_has_no_file, set_up),
        cmocka_unit_test_setup(old_files_load, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
