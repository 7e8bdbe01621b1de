/*
 * cmocka.h: the part of CMocka's interface that the library's tests use, for machines without
 * CMocka, which is packaged for hosts only. A failed assertion ends its test, not the others.
 */
#ifndef CMOCKA_H
#define CMOCKA_H

#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

struct CMUnitTest {
    const char *name;
    void (*test)(void **state);
    int (*setup)(void **state);
};

#define cmocka_unit_test(test)                                                                     \
    {                                                                                              \
#test, test, NULL                                                                          \
    }
#define cmocka_unit_test_setup(test, setup)                                                        \
    {                                                                                              \
#test, test, setup                                                                         \
    }

enum { CMOCKA_FAILED = 1, CMOCKA_SKIPPED };

static jmp_buf cmocka_end_of_test;

#define print_message(...) ((void)printf(__VA_ARGS__))

#define fail_msg(...)                                                                              \
    do {                                                                                           \
        printf("%s:%d: ", __FILE__, __LINE__);                                                     \
        printf(__VA_ARGS__);                                                                       \
        printf("\n");                                                                              \
        longjmp(cmocka_end_of_test, CMOCKA_FAILED);                                                \
    } while (0)
#define skip() longjmp(cmocka_end_of_test, CMOCKA_SKIPPED)

static inline void cmocka_check(int fine, const char *what, const char *file, int line)
{
    if (!fine) {
        printf("%s:%d: %s\n", file, line, what);
        longjmp(cmocka_end_of_test, CMOCKA_FAILED);
    }
}

#define CMOCKA_CHECK(fine, what) cmocka_check(fine, what, __FILE__, __LINE__)
#define assert_true(x) CMOCKA_CHECK((x) ? 1 : 0, #x)
#define assert_false(x) CMOCKA_CHECK((x) ? 0 : 1, "not: " #x)
#define assert_null(x) CMOCKA_CHECK((x) == NULL, #x " is NULL")
#define assert_non_null(x) CMOCKA_CHECK((x) != NULL, #x " is not NULL")
#define assert_int_equal(a, b) CMOCKA_CHECK((uintmax_t)(a) == (uintmax_t)(b), #a " == " #b)
#define assert_int_not_equal(a, b) CMOCKA_CHECK((uintmax_t)(a) != (uintmax_t)(b), #a " != " #b)
#define assert_ptr_equal(a, b) CMOCKA_CHECK((const void *)(a) == (const void *)(b), #a " == " #b)
#define assert_in_range(x, low, high)                                                              \
    CMOCKA_CHECK((uintmax_t)(x) >= (uintmax_t)(low) && (uintmax_t)(x) <= (uintmax_t)(high),        \
                 #x " within " #low ", " #high)
#define assert_string_equal(a, b) CMOCKA_CHECK(strcmp(a, b) == 0, #a " == " #b)
#define assert_string_not_equal(a, b) CMOCKA_CHECK(strcmp(a, b) != 0, #a " != " #b)
#define assert_memory_equal(a, b, n) CMOCKA_CHECK(memcmp(a, b, n) == 0, #a " == " #b)

#define cmocka_run_group_tests(tests, setup, teardown)                                             \
    ((void)(setup), (void)(teardown), cmocka_run(tests, sizeof(tests) / sizeof((tests)[0])))

/* The tests that failed. */
static inline int cmocka_run(const struct CMUnitTest *tests, size_t n)
{
    static const char *const results[] = {"fine", "FAILED", "skipped"};
    static volatile int failed;
    static volatile size_t i;
    for (i = 0; i < n; i++) {
        void *state = NULL;
        int result = setjmp(cmocka_end_of_test);
        if (result == 0) {
            if (tests[i].setup != NULL && tests[i].setup(&state) != 0)
                fail_msg("the set-up failed");
            tests[i].test(&state);
        }
        failed += result == CMOCKA_FAILED;
        printf("%s: %s\n", tests[i].name, results[result]);
    }
    printf("%u tests, %d failed\n", (unsigned)n, failed);
    return failed;
}

#endif
