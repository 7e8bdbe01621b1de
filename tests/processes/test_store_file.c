/* The experience file when the power goes, when the disk is full, and when the file is damaged. */
#define _POSIX_C_SOURCE 200809L /* O_DIRECTORY */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "disk.h"
#include "grrl/base/random.h"
#include "grrl/learner/learner.h"
#include "policy_memory.h"
#include "store_check.h"

#define PATH "folder/kept.store"
enum { CAPACITY = 64, SEED = 5, OLD = 12, NEW = 20, TEARS = 16 };

struct memory {
    struct grrl_learner learner;
    POLICY_MEMORY(CAPACITY) policy;
};

static const struct grrl_policy_type *type; /* whose file it is */

static struct memory source; /* what is saved */
static struct memory target; /* what is loaded */
static struct disk_content old_bytes;
static struct disk_content new_bytes;
static struct disk start; /* holds the old file */
static struct disk disk;
static struct disk after;
static struct grrl_store_report report;

static int append(void *context, const void *bytes, size_t size)
{
    struct disk_content *to = context;
    assert_true(to->size + size <= DISK_BYTES);
    memcpy(to->bytes + to->size, bytes, size);
    to->size += size;
    return 0;
}

static void content_of(const struct grrl_learner *learner, struct disk_content *content)
{
    struct grrl_io io = {.context = content, .write = append};
    content->size = 0;
    assert_int_equal(grrl_learner_save(learner, &io), GRRL_OK);
}

static void init(struct memory *memory)
{
    struct grrl_learner_config config;
    struct grrl_policy policy;
    grrl_learner_config_default(&config);
    assert_int_equal(grrl_policy_make(type, memory->policy.bytes, sizeof memory->policy.bytes,
                                      CAPACITY, NULL, &policy),
                     GRRL_OK);
    assert_int_equal(grrl_learner_init(&memory->learner, &config, policy), GRRL_OK);
}

/* Chains of growing length, and an action on each. */
static void learn_experience(struct memory *memory, int i)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    for (int link = 0; link < 1 + i / 2 % 5; link++) {
        assert_int_equal(grrl_graph_add_link(&graph, GRRL_PROPERTY_SMALL, NULL), GRRL_OK);
        enum grrl_joint_type joint = i % 2 == 0 ? GRRL_REVOLUTE : GRRL_PRISMATIC;
        if (link > 0)
            assert_int_equal(
                grrl_graph_add_joint(&graph, (uint8_t)(link - 1), (uint8_t)link, joint), GRRL_OK);
    }
    assert_int_equal(grrl_experience_update(&memory->policy.paper.store, &graph, 0,
                                            (uint8_t)(i % GRRL_DIRECTIONS), (float)i * 0.5f, 0.3f,
                                            NULL),
                     GRRL_OK);
}

static void learn(struct memory *memory, int from, int to)
{
    struct grrl_random random;
    grrl_random_init(&random, SEED, (uint64_t)from);
    for (int i = from; i < to; i++) {
        if (type == &grrl_policy_paper) {
            learn_experience(memory, i);
            continue;
        }
        struct grrl_context context;
        for (int part = 0; part < GRRL_CONTEXT_PARTS; part++)
            context.part[part] = (uint8_t)grrl_random_below(&random, grrl_context_max[part] + 1u);
        struct grrl_learn_policy *policy = &memory->policy.learn;
        (void)grrl_cases_learn(&policy->cases, &policy->config, grrl_context_key(&context), 1.0f);
    }
}

static int set_up(void **state)
{
    (void)state;
    init(&source);
    init(&target);
    learn(&source, 0, OLD);
    content_of(&source.learner, &old_bytes);
    learn(&source, OLD, NEW);
    content_of(&source.learner, &new_bytes);
    disk_init(&start);
    disk_put(&start, PATH, &old_bytes);
    return 0;
}

static bool same(const struct disk_content *a, const struct disk_content *b)
{
    return a->size == b->size && memcmp(a->bytes, b->bytes, a->size) == 0;
}

static enum grrl_store_result load(struct disk *from)
{
    const struct grrl_file_calls calls = disk_calls(from);
    return grrl_store_file_load(&calls, PATH, &target.learner, &report);
}

static bool save(struct disk *to)
{
    const struct grrl_file_calls calls = disk_calls(to);
    return grrl_store_file_save(&calls, PATH, &source.learner, &report);
}

/* --- power failures --------------------------------------------------------------------------- */

struct tally {
    long cuts;
    long old;
    long new;
    long lost; /* neither */
};

/* What a load finds after the disk has come back as *fate has it. */
static void check_fate(const struct disk_fate *fate, struct tally *tally)
{
    static struct disk_content loaded;
    disk_reboot(&disk, fate, &after);
    tally->cuts++;
    enum grrl_store_result result = load(&after);
    bool whole = result == GRRL_STORE_LOADED || result == GRRL_STORE_NEW;
    content_of(&target.learner, &loaded);
    if (whole && same(&loaded, &old_bytes))
        tally->old++;
    else if (whole && same(&loaded, &new_bytes))
        tally->new ++;
    else
        tally->lost++;
}

/* Every way in which the disk may come back, but for the place of the tear. */
static void check_fates(struct tally *tally)
{
    size_t size = 0;
    for (int file = 0; file < disk.n_files; file++)
        if (disk_is_volatile(&disk, file) && disk.now[file].size > size)
            size = disk.now[file].size;
    for (unsigned changes = 0; changes < 1u << disk.n_changes; changes++) {
        for (size_t at = 0; at <= size; at += DISK_BLOCK) {
            struct disk_fate fate = {changes, at, false, SIZE_MAX};
            check_fate(&fate, tally);
            fate.zeros = true;
            check_fate(&fate, tally);
            fate = (struct disk_fate){changes, size, false, at};
            check_fate(&fate, tally);
        }
        struct disk_fate all = {changes, size, false, SIZE_MAX};
        check_fate(&all, tally);
    }
}

/* Saves, and pulls the plug at every call, and within every write at every byte, each TEARS-th of
 * them with every fate. The calls of a whole save. */
static long cut_everywhere(struct tally *tally)
{
    const struct disk_fate all_written = {~0u, SIZE_MAX, false, SIZE_MAX};
    for (long call = 0;; call++) {
        for (size_t torn = 0;; torn++) {
            disk = start;
            disk.cut_at = call;
            disk.torn = torn;
            disk.cut_write = false;
            bool saved = save(&disk);
            if (!disk.off) {
                assert_true(saved);
                return call;
            }
            if (torn % TEARS == 0)
                check_fates(tally);
            else
                check_fate(&all_written, tally);
            if (!disk.cut_write)
                break;
        }
    }
}

static void a_cut_anywhere_leaves_the_old_or_the_new(void **state)
{
    (void)state;
    struct tally tally = {0};
    long calls = cut_everywhere(&tally);
    print_message("%ld cuts at %ld calls of a save: %ld left the old file, %ld the new one, "
                  "%ld lost data\n",
                  tally.cuts, calls, tally.old, tally.new, tally.lost);
    assert_int_equal(tally.lost, 0);
    assert_true(tally.old > 500);
    assert_true(tally.new > 0);
    assert_true(tally.cuts > 1500);
}

static void what_save_has_reported_stays(void **state)
{
    (void)state;
    struct tally tally = {0};
    disk = start;
    assert_true(save(&disk));
    check_fates(&tally);
    assert_int_equal(tally.new, tally.cuts);
    /* and over what a cut save left behind */
    disk = start;
    disk.cut_at = 4;
    disk.torn = 3;
    assert_false(save(&disk));
    const struct disk_fate fate = {~0u, SIZE_MAX, false, SIZE_MAX};
    disk_reboot(&disk, &fate, &after);
    assert_non_null(disk_content(&after, PATH ".new"));
    assert_true(save(&after));
    assert_true(same(disk_content(&after, PATH), &new_bytes));
}

static void the_first_save_of_all_is_cut_without_harm(void **state)
{
    (void)state;
    struct tally tally = {0};
    init(&source);
    content_of(&source.learner, &old_bytes); /* no experience: as without a file */
    learn(&source, 0, NEW);
    content_of(&source.learner, &new_bytes);
    disk_init(&start);
    (void)cut_everywhere(&tally);
    assert_int_equal(tally.lost, 0);
    assert_true(tally.new > 0);
}

/* A disk whose syncs do nothing loses data in some of these cuts: the checks above see it. */
static void a_disk_that_lies_is_found_out(void **state)
{
    (void)state;
    struct tally tally = {0};
    start.syncs_lie = true;
    (void)cut_everywhere(&tally);
    assert_true(tally.lost > 100);
    start.syncs_lie = false;
    start.folder_syncs_lie = true;
    disk = start;
    assert_true(save(&disk));
    tally = (struct tally){0};
    check_fates(&tally);
    assert_true(tally.old > 0); /* although the save was reported */
}

static void a_call_that_fails_is_told_and_leaves_a_whole_file(void **state)
{
    (void)state;
    for (long call = 0;; call++) {
        disk = start;
        disk.fail_at = call;
        bool saved = save(&disk);
        bool failed = disk.calls > call;
        if (!failed) {
            assert_true(saved);
            break;
        }
        assert_false(saved);
        assert_non_null(strstr(report.text, PATH));
        disk_power_on(&disk);
        const struct disk_content *content = disk_content(&disk, PATH);
        assert_true(same(content, &old_bytes) || same(content, &new_bytes));
        assert_true(save(&disk)); /* and later, with room again */
        assert_true(same(disk_content(&disk, PATH), &new_bytes));
    }
}

/* --- damage ----------------------------------------------------------------------------------- */

/* A name under which exactly these bytes are. */
static const char *name_of(struct disk *on, const struct disk_content *content)
{
    for (int i = 0; i < DISK_NAMES; i++)
        if (on->names.entry[i].file >= 0 && same(&on->now[on->names.entry[i].file], content))
            return on->names.entry[i].path;
    return NULL;
}

static void load_damaged(const struct disk_content *content, enum grrl_store_result *result)
{
    disk_init(&disk);
    disk_put(&disk, PATH, content);
    *result = load(&disk);
    assert_true(report.text[0] != '\0');
    const char *name = name_of(&disk, content);
    assert_non_null(name); /* nothing is lost */
    assert_string_equal(name, *result == GRRL_STORE_SET_ASIDE ? PATH ".damaged" : PATH);
    assert_true(*result != GRRL_STORE_SET_ASIDE || strstr(report.text, PATH ".damaged") != NULL);
}

/* What the target knows is the beginning of what the source knows. */
static void check_kept(void)
{
    if (type == &grrl_policy_paper) {
        const struct grrl_experience_store *kept = &target.policy.paper.store;
        check_store(kept);
        for (uint32_t i = 0; i < kept->n_experiences; i++)
            assert_memory_equal(&kept->experiences[i].q,
                                &source.policy.paper.store.experiences[i].q, sizeof(struct grrl_q));
    } else {
        const struct grrl_case_base *kept = &target.policy.learn.cases;
        for (uint32_t i = 0; i < kept->n; i++)
            assert_int_equal(kept->cases[i].key, source.policy.learn.cases.cases[i].key);
    }
}

static void a_torn_end_is_cut_and_counted(void **state)
{
    (void)state;
    static struct disk_content cut;
    enum grrl_store_result result;
    uint32_t most = 0;
    cut = new_bytes;
    for (size_t size = 0; size < new_bytes.size; size++) {
        cut.size = size;
        load_damaged(&cut, &result);
        assert_int_equal(result, GRRL_STORE_SET_ASIDE);
        check_kept();
        uint32_t n = grrl_learner_usage(&target.learner).n;
        assert_true(n >= most); /* a longer file never gives less */
        most = n;
        char count[64];
        (void)snprintf(count, sizeof count, "%lu entries before the end", (unsigned long)n);
        assert_non_null(strstr(report.text, count));
    }
    /* all but the very last record */
    assert_int_equal(most + 1, grrl_learner_usage(&source.learner).n);
    assert_non_null(strstr(report.text, "at least 1 are lost"));
}

static void any_damaged_byte_is_told_and_set_aside(void **state)
{
    (void)state;
    static struct disk_content damaged;
    static struct disk_content loaded;
    static struct disk_content nothing;
    enum grrl_store_result result;
    init(&source);
    content_of(&source.learner, &nothing);
    int refused = 0;
    for (size_t at = 0; at < new_bytes.size; at++) {
        damaged = new_bytes;
        damaged.bytes[at] ^= 0x41;
        load_damaged(&damaged, &result);
        assert_int_not_equal(result, GRRL_STORE_LOADED);
        refused += result == GRRL_STORE_REFUSED;
        if (strstr(report.text, "the file ends early") != NULL)
            continue; /* a count of links that leads beyond the end: what was before is kept */
        content_of(&target.learner, &loaded);
        assert_true(same(&loaded, &nothing));
    }
    /* Another program's file, by its magic; of paper also another version, told before the CRC. */
    assert_int_equal(refused, type == &grrl_policy_paper ? 8 + 2 : 8);
}

static void bytes_behind_the_end_are_damage(void **state)
{
    (void)state;
    static struct disk_content longer;
    enum grrl_store_result result;
    longer = new_bytes;
    longer.bytes[longer.size++] = 0;
    load_damaged(&longer, &result);
    assert_int_equal(result, GRRL_STORE_SET_ASIDE);
}

static void a_cut_while_setting_aside_loses_nothing(void **state)
{
    (void)state;
    static struct disk_content damaged;
    damaged = new_bytes;
    damaged.bytes[100] ^= 1;
    long cuts = 0;
    for (long call = 0;; call++) {
        disk_init(&disk);
        disk_put(&disk, PATH, &damaged);
        disk_put(&disk, PATH ".damaged", &old_bytes); /* from another time */
        disk.cut_at = call;
        enum grrl_store_result result = load(&disk);
        if (!disk.off) {
            assert_int_equal(result, GRRL_STORE_SET_ASIDE);
            assert_string_equal(name_of(&disk, &damaged), PATH ".damaged.2");
            break;
        }
        for (unsigned changes = 0; changes < 1u << disk.n_changes; changes++) {
            const struct disk_fate fate = {changes, SIZE_MAX, false, SIZE_MAX};
            disk_reboot(&disk, &fate, &after);
            assert_non_null(name_of(&after, &damaged));
            assert_non_null(name_of(&after, &old_bytes));
            cuts++;
        }
    }
    print_message("%ld cuts while a damaged file was set aside, none lost data\n", cuts);
    assert_true(cuts >= 8);
}

static void what_cannot_be_set_aside_is_left_and_told(void **state)
{
    (void)state;
    static struct disk_content damaged;
    damaged = new_bytes;
    damaged.bytes[100] ^= 1;
    int failures = 0;
    for (long call = 0; call < 100; call++) {
        disk_init(&disk);
        disk_put(&disk, PATH, &damaged);
        disk.fail_at = call;
        enum grrl_store_result result = load(&disk);
        if (disk.calls <= call)
            break;
        failures++;
        assert_non_null(name_of(&disk, &damaged));
        assert_true(result == GRRL_STORE_REFUSED || result == GRRL_STORE_SET_ASIDE);
        assert_int_equal(grrl_learner_usage(&target.learner).n, 0);
    }
    assert_true(failures >= 8);
}

static void no_file_is_no_experience(void **state)
{
    (void)state;
    disk_init(&disk);
    assert_int_equal(load(&disk), GRRL_STORE_NEW);
    assert_string_equal(report.text, "");
    assert_int_equal(grrl_learner_usage(&target.learner).n, 0);
}

/* What a new store starts with is used whole or not at all, and stays as it is. */
static void a_store_to_start_from_stays_as_it_is(void **state)
{
    (void)state;
    static struct disk_content loaded;
    const struct grrl_file_calls calls = disk_calls(&disk);
    for (size_t size = 0; size <= new_bytes.size; size++) {
        static struct disk_content cut;
        cut = new_bytes;
        cut.size = size;
        disk_init(&disk);
        disk_put(&disk, PATH, &cut);
        bool whole = size == new_bytes.size;
        assert_int_equal(grrl_store_file_copy(&calls, PATH, &target.learner, &report), whole);
        assert_int_equal(strlen(report.text) == 0, whole);
        assert_string_equal(name_of(&disk, &cut), PATH);
        if (whole)
            content_of(&target.learner, &loaded);
        else
            assert_int_equal(grrl_learner_usage(&target.learner).n, 0);
    }
    assert_true(same(&loaded, &new_bytes));
    disk_init(&disk);
    assert_false(grrl_store_file_copy(&calls, PATH, &target.learner, &report));
    assert_non_null(strstr(report.text, PATH));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_cut_anywhere_leaves_the_old_or_the_new, set_up),
        cmocka_unit_test_setup(what_save_has_reported_stays, set_up),
        cmocka_unit_test_setup(the_first_save_of_all_is_cut_without_harm, set_up),
        cmocka_unit_test_setup(a_disk_that_lies_is_found_out, set_up),
        cmocka_unit_test_setup(a_call_that_fails_is_told_and_leaves_a_whole_file, set_up),
        cmocka_unit_test_setup(a_torn_end_is_cut_and_counted, set_up),
        cmocka_unit_test_setup(any_damaged_byte_is_told_and_set_aside, set_up),
        cmocka_unit_test_setup(bytes_behind_the_end_are_damage, set_up),
        cmocka_unit_test_setup(a_store_to_start_from_stays_as_it_is, set_up),
        cmocka_unit_test_setup(a_cut_while_setting_aside_loses_nothing, set_up),
        cmocka_unit_test_setup(what_cannot_be_set_aside_is_left_and_told, set_up),
        cmocka_unit_test_setup(no_file_is_no_experience, set_up),
    };
    type = &grrl_policy_learn;
    int failed = cmocka_run_group_tests_name("learn", tests, NULL, NULL);
    type = &grrl_policy_paper;
    return failed + cmocka_run_group_tests_name("paper", tests, NULL, NULL);
}
