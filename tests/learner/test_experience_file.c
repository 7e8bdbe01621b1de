/* Files of experiences: round trips, cuts and damage at every byte. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/base/random.h"
#include "grrl/learner/relational_q/experience.h"
#include "memory_file.h"
#include "store_check.h"

#define SEED UINT64_C(20080628)

enum { STATES = 12, EXPERIENCES = 30, HEADER = 24, CRC = 4, EXPERIENCE = 30 };

struct fixture {
    struct grrl_experience_store store;
    struct grrl_experience_state states[STATES];
    struct grrl_experience experiences[EXPERIENCES];
};

static struct fixture original, copy;
static struct memory_file file, second;

static void init(struct fixture *fixture, uint32_t states, uint32_t experiences)
{
    grrl_experience_init(&fixture->store, fixture->states, states, fixture->experiences,
                         experiences);
}

static enum grrl_status save(const struct fixture *fixture, struct memory_file *to)
{
    to->size = 0;
    struct grrl_io io = {.context = to, .write = memory_file_write};
    return grrl_experience_save(&fixture->store, &io);
}

static enum grrl_status load(struct fixture *fixture, struct memory_file *from)
{
    from->at = 0;
    struct grrl_io io = {.context = from, .read = memory_file_read};
    uint32_t lost;
    return grrl_experience_load(&fixture->store, &io, &lost);
}

static struct grrl_graph random_graph(struct grrl_random *random)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    uint8_t n = (uint8_t)(1 + grrl_random_below(random, 6));
    for (uint8_t i = 0; i < n; i++) {
        assert_int_equal(grrl_graph_add_link(&graph, 1 + grrl_random_below(random, 2), NULL),
                         GRRL_OK);
        if (i > 0) {
            assert_int_equal(
                grrl_graph_add_joint(&graph, i, (uint8_t)grrl_random_below(random, i),
                                     (enum grrl_joint_type)grrl_random_below(random, 2)),
                GRRL_OK);
        }
    }
    return graph;
}

/* Fills the original beyond its capacity and writes it to `file`. */
static int set_up(void **state)
{
    (void)state;
    struct grrl_random random;
    grrl_random_init(&random, SEED, 1);
    file.calls_left = -1;
    second.calls_left = -1;
    init(&original, STATES, EXPERIENCES);
    init(&copy, STATES, EXPERIENCES);
    for (int i = 0; i < 80; i++) {
        struct grrl_graph graph = random_graph(&random);
        float target = 5.0f * grrl_random_uniform(&random) - 1.0f;
        if (grrl_experience_update(&original.store, &graph,
                                   (uint8_t)grrl_random_below(&random, graph.n),
                                   (uint8_t)grrl_random_below(&random, GRRL_DIRECTIONS), target,
                                   0.3f, NULL) != GRRL_OK)
            return -1;
    }
    return save(&original, &file) == GRRL_OK ? 0 : -1;
}

static void check_empty(const struct grrl_experience_store *store)
{
    assert_int_equal(store->n_states, 0);
    assert_int_equal(store->n_experiences, 0);
    assert_int_equal(store->clock, 0);
}

static void what_was_saved_is_loaded_and_saved_again(void **state)
{
    (void)state;
    assert_int_equal(original.store.n_states, STATES);
    assert_true(original.store.n_experiences > STATES);
    assert_int_equal(load(&copy, &file), GRRL_OK);
    assert_int_equal(file.at, file.size);
    check_store(&copy.store);
    assert_int_equal(copy.store.clock, original.store.clock);
    assert_int_equal(copy.store.high_water, original.store.n_experiences);
    for (uint32_t i = 0; i < original.store.n_experiences; i++) {
        const struct grrl_experience *a = &original.experiences[i];
        const struct grrl_experience *b = &copy.experiences[i];
        assert_int_equal(a->state, b->state);
        assert_int_equal(a->link, b->link);
        assert_int_equal(a->direction, b->direction);
        assert_int_equal(a->used_at, b->used_at);
        assert_memory_equal(&a->q, &b->q, sizeof a->q);
    }
    assert_int_equal(save(&copy, &second), GRRL_OK);
    assert_int_equal(second.size, file.size);
    assert_memory_equal(second.bytes, file.bytes, file.size);
}

static void a_loaded_store_goes_on_like_the_first(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    assert_int_equal(load(&copy, &file), GRRL_OK);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 2);
    const struct grrl_recall_config config = {.deepest = GRRL_RECALL_SUBSTRUCTURE,
                                              .budget = GRRL_MATCH_BUDGET,
                                              .states = GRRL_RECALL_STATES};
    for (int i = 0; i < 100; i++) {
        struct grrl_graph graph = random_graph(&random);
        static struct grrl_recall a, b;
        grrl_experience_recall(&original.store, &graph, &config, &a);
        grrl_experience_recall(&copy.store, &graph, &config, &b);
        uint8_t link = (uint8_t)grrl_random_below(&random, graph.n);
        uint8_t direction = (uint8_t)grrl_random_below(&random, GRRL_DIRECTIONS);
        for (uint8_t k = 0; k < graph.n; k++)
            for (int d = 0; d < GRRL_DIRECTIONS; d++)
                assert_int_equal(a.entry[k][d].experience, b.entry[k][d].experience);
        uint32_t x, y;
        assert_int_equal(
            grrl_experience_update(&original.store, &graph, link, direction, 1.0f, 0.3f, &x),
            GRRL_OK);
        assert_int_equal(
            grrl_experience_update(&copy.store, &graph, link, direction, 1.0f, 0.3f, &y), GRRL_OK);
        assert_int_equal(x, y);
    }
}

static void an_empty_store_is_a_file_too(void **state)
{
    (void)state;
    init(&original, 1, 1);
    assert_int_equal(save(&original, &file), GRRL_OK);
    assert_int_equal(file.size, HEADER + CRC);
    const uint8_t start[] = {'G', 'R', 'R', 'L', 'e', 'x', 'p', 0, 3, 0, GRRL_MAX_PROPERTIES, 6};
    assert_memory_equal(file.bytes, start, sizeof start);
    assert_int_equal(load(&copy, &file), GRRL_OK);
    check_empty(&copy.store);
}

static void a_torn_file_gives_what_was_whole(void **state)
{
    (void)state;
    size_t whole = file.size;
    uint32_t total = original.store.n_experiences;
    for (size_t size = 0; size < whole; size++) {
        uint32_t lost;
        file.size = size;
        file.at = 0;
        const struct grrl_io io = {.context = &file, .read = memory_file_read};
        assert_int_equal(grrl_experience_load(&copy.store, &io, &lost), GRRL_ERR_IO);
        check_store(&copy.store);
        size_t records = size + total * (size_t)EXPERIENCE > whole
                             ? (size + total * (size_t)EXPERIENCE - whole) / EXPERIENCE
                             : 0;
        assert_int_equal(copy.store.n_experiences, records);
        assert_int_equal(lost, size < HEADER + CRC ? 0 : total - records);
        for (uint32_t i = 0; i < records; i++) {
            assert_memory_equal(&copy.experiences[i].q, &original.experiences[i].q,
                                sizeof(struct grrl_q));
        }
    }
}

static void a_failing_callback_is_told(void **state)
{
    (void)state;
    int records = 1 + (int)original.store.n_states + (int)original.store.n_experiences;
    for (int calls = 0; calls < records; calls++) {
        second.calls_left = calls;
        assert_int_equal(save(&original, &second), GRRL_ERR_IO);
    }
    second.calls_left = records;
    assert_int_equal(save(&original, &second), GRRL_OK);
    /* One call reads the header, two each state, one each experience. */
    int before = 1 + 2 * (int)original.store.n_states;
    for (int calls = 0; calls < before + (int)original.store.n_experiences; calls++) {
        int whole = calls - before;
        file.calls_left = calls;
        assert_int_equal(load(&copy, &file), GRRL_ERR_IO);
        check_store(&copy.store);
        assert_int_equal(copy.store.n_experiences, whole > 0 ? whole : 0);
    }
}

static void no_damaged_byte_goes_unseen(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 3);
    for (size_t i = 0; i < file.size; i++) {
        uint8_t was = file.bytes[i];
        file.bytes[i] = (uint8_t)(was ^ (1u + grrl_random_below(&random, 255)));
        enum grrl_status status = load(&copy, &file);
        if (i < 8) {
            assert_int_equal(status, GRRL_ERR_FORMAT);
        } else if (i < 10) {
            assert_int_equal(status, GRRL_ERR_VERSION);
        } else if (i < HEADER + CRC) {
            assert_int_equal(status, GRRL_ERR_CORRUPT);
        } else { /* a wrong number of links makes the record longer than the file, or too big */
            assert_true(status == GRRL_ERR_CORRUPT || status == GRRL_ERR_IO ||
                        status == GRRL_ERR_VERSION);
        }
        check_empty(&copy.store);
        file.bytes[i] = was;
    }
    assert_int_equal(load(&copy, &file), GRRL_OK);
}

static uint32_t naive_crc(uint32_t crc, const uint8_t *bytes, size_t n)
{
    uint32_t value = crc ^ UINT32_C(0xffffffff);
    for (size_t i = 0; i < n; i++) {
        for (unsigned bit = 0; bit < 8; bit++) {
            uint32_t low = (value ^ (uint32_t)(bytes[i] >> bit)) & 1u;
            value = (value >> 1) ^ (low != 0 ? UINT32_C(0xedb88320) : 0);
        }
    }
    return value ^ UINT32_C(0xffffffff);
}

static void put_crc(uint8_t *at, uint32_t crc)
{
    for (unsigned i = 0; i < CRC; i++)
        at[i] = (uint8_t)(crc >> (8 * i));
}

/* Makes all CRCs right again, as far as the records can be told apart. */
static void sign(struct memory_file *damaged)
{
    uint8_t *bytes = damaged->bytes;
    unsigned n_states = bytes[12] | (unsigned)bytes[13] << 8;
    uint32_t crc = naive_crc(0, bytes, HEADER);
    put_crc(bytes + HEADER, crc);
    size_t at = HEADER + CRC;
    for (unsigned record = 0; at < damaged->size; record++) {
        size_t size = record < n_states ? 1 + (size_t)bytes[at] * 16 : EXPERIENCE - 4;
        if (at + size + CRC > damaged->size)
            return;
        crc = naive_crc(crc, bytes + at, size);
        put_crc(bytes + at + size, crc);
        at += size + CRC;
    }
}

static void the_crc_is_the_common_one(void **state)
{
    (void)state;
    assert_int_equal(naive_crc(0, (const uint8_t *)"123456789", 9), 0xcbf43926);
    memcpy(&second, &file, sizeof file);
    sign(&second);
    assert_memory_equal(second.bytes, file.bytes, file.size);
}

static void damage_with_a_right_crc_harms_nothing(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 4);
    unsigned refused = 0;
    for (int round = 0; round < 4000; round++) {
        memcpy(&second, &file, sizeof file);
        for (unsigned k = grrl_random_below(&random, 3) + 1; k > 0; --k) {
            size_t at = 12 + grrl_random_below(&random, (uint32_t)(file.size - 12));
            uint8_t *byte = &second.bytes[at];
            *byte = (uint8_t)(grrl_random_below(&random, 2) == 0 ? *byte ^ 1u << at % 8
                                                                 : grrl_random_next(&random));
        }
        sign(&second);
        if (load(&copy, &second) == GRRL_OK) {
            check_store(&copy.store);
            struct grrl_graph graph = random_graph(&random);
            const struct grrl_recall_config config = {
                .deepest = GRRL_RECALL_SUBSTRUCTURE, .budget = 1000, .states = 64};
            static struct grrl_recall recall;
            grrl_experience_recall(&copy.store, &graph, &config, &recall);
        } else {
            refused++;
            check_empty(&copy.store);
        }
    }
    assert_true(refused > 1000);
}

/* Offset of experience `i`; all states come before. */
static size_t experience_at(unsigned i)
{
    return file.size - (size_t)(original.store.n_experiences - i) * EXPERIENCE;
}

static void content_that_save_never_writes_is_corrupt(void **state)
{
    (void)state;
    size_t first = experience_at(0);
    const struct {
        size_t at;
        uint8_t value;
    } damage[] = {
        {HEADER + CRC, 0},           /* a state without links */
        {HEADER + CRC, 33},          /* more than any build has */
        {first + 0, STATES},         /* no such state */
        {first + 1, 1},              /* */
        {first + 4, 32},             /* no such link */
        {first + 5, 6},              /* no such direction */
        {first + 9, 0xff},           /* used later than the clock says */
        {first + 13, 0x7f},          /* the value 1e38 or so */
        {first + 17, 0xff},          /* the mean likewise */
        {first + 21, 0xbf},          /* a negative sum of squares */
        {experience_at(1) - 4, 0xff} /* a wrong CRC alone, not signed again below */
    };
    enum { DAMAGES = sizeof damage / sizeof damage[0] };
    for (unsigned i = 0; i < DAMAGES; i++) {
        memcpy(&second, &file, sizeof file);
        assert_int_not_equal(second.bytes[damage[i].at], damage[i].value);
        second.bytes[damage[i].at] = damage[i].value;
        if (i + 1 < DAMAGES)
            sign(&second);
        assert_int_equal(load(&copy, &second), GRRL_ERR_CORRUPT);
        check_empty(&copy.store);
    }
    memcpy(&second, &file, sizeof file); /* one experience twice */
    memcpy(second.bytes + experience_at(1), second.bytes + first, EXPERIENCE);
    sign(&second);
    assert_int_equal(load(&copy, &second), GRRL_ERR_CORRUPT);
    memcpy(&second, &file, sizeof file); /* nothing met */
    memset(second.bytes + first + 22, 0, 4);
    sign(&second);
    assert_int_equal(load(&copy, &second), GRRL_ERR_CORRUPT);
    memcpy(&second, &file, sizeof file); /* experiences exchanged, each with its own CRC */
    memcpy(second.bytes + first, file.bytes + experience_at(1), EXPERIENCE);
    memcpy(second.bytes + experience_at(1), file.bytes + first, EXPERIENCE);
    assert_int_equal(load(&copy, &second), GRRL_ERR_CORRUPT);
}

static void a_state_in_another_order_is_corrupt(void **state)
{
    (void)state;
    init(&original, 1, 1);
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    assert_int_equal(grrl_graph_add_link(&graph, GRRL_PROPERTY_SMALL, NULL), GRRL_OK);
    assert_int_equal(grrl_graph_add_link(&graph, GRRL_PROPERTY_LARGE, NULL), GRRL_OK);
    assert_int_equal(grrl_graph_add_joint(&graph, 0, 1, GRRL_REVOLUTE), GRRL_OK);
    assert_int_equal(grrl_experience_update(&original.store, &graph, 0, 0, 1.0f, 0.3f, NULL),
                     GRRL_OK);
    assert_int_equal(save(&original, &file), GRRL_OK);
    assert_int_equal(load(&copy, &file), GRRL_OK);
    uint8_t *label = file.bytes + HEADER + CRC + 1;
    uint8_t first = label[0];
    label[0] = label[16];
    label[16] = first;
    sign(&file);
    assert_int_equal(load(&copy, &file), GRRL_ERR_CORRUPT);
    check_empty(&copy.store);
}

static void other_versions_and_builds_are_told(void **state)
{
    (void)state;
    const struct {
        size_t at;
        uint8_t value;
    } other[] = {{8, 1}, {9, 1}, {10, GRRL_MAX_PROPERTIES + 1}, {11, 8}};
    for (unsigned i = 0; i < sizeof other / sizeof other[0]; i++) {
        memcpy(&second, &file, sizeof file);
        second.bytes[other[i].at] = other[i].value;
        sign(&second);
        assert_int_equal(load(&copy, &second), GRRL_ERR_VERSION);
        check_empty(&copy.store);
    }
}

static void a_file_larger_than_the_store_is_told(void **state)
{
    (void)state;
    init(&copy, original.store.n_states, original.store.n_experiences);
    assert_int_equal(load(&copy, &file), GRRL_OK);
    init(&copy, (uint32_t)(original.store.n_states - 1), EXPERIENCES);
    assert_int_equal(load(&copy, &file), GRRL_ERR_FULL);
    check_empty(&copy.store);
    init(&copy, STATES, (uint32_t)(original.store.n_experiences - 1));
    assert_int_equal(load(&copy, &file), GRRL_ERR_FULL);
    init(&copy, 1, 1);
    assert_int_equal(load(&copy, &file), GRRL_ERR_FULL);
    check_empty(&copy.store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(what_was_saved_is_loaded_and_saved_again, set_up),
        cmocka_unit_test_setup(a_loaded_store_goes_on_like_the_first, set_up),
        cmocka_unit_test_setup(an_empty_store_is_a_file_too, set_up),
        cmocka_unit_test_setup(a_torn_file_gives_what_was_whole, set_up),
        cmocka_unit_test_setup(a_failing_callback_is_told, set_up),
        cmocka_unit_test_setup(no_damaged_byte_goes_unseen, set_up),
        cmocka_unit_test_setup(the_crc_is_the_common_one, set_up),
        cmocka_unit_test_setup(damage_with_a_right_crc_harms_nothing, set_up),
        cmocka_unit_test_setup(content_that_save_never_writes_is_corrupt, set_up),
        cmocka_unit_test_setup(a_state_in_another_order_is_corrupt, set_up),
        cmocka_unit_test_setup(other_versions_and_builds_are_told, set_up),
        cmocka_unit_test_setup(a_file_larger_than_the_store_is_told, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
