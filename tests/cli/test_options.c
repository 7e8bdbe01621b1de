/* The option table: values and their ranges, messages, --help, and what is refused. */
#define _POSIX_C_SOURCE 200809L

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/options.h"

static struct {
    bool quiet;
    const char *log;
    int trials;
    uint32_t damage;
    uint64_t seed;
    double noise_m;
    char shape;
    char letters[8]; /* of --add, in order */
} values;

static const char *take_shape(void *context, const char *text)
{
    if (strlen(text) != 1)
        return "one letter";
    *(char *)context = text[0];
    return NULL;
}

static const char *take_letter(void *context, const char *text)
{
    (void)context;
    (void)strncat(values.letters, text, 1);
    return strcmp(text, "?") != 0 ? NULL : "a letter";
}

static struct grrl_program program = {.name = "grrl-test",
                                      .usage = "grrl-test [OPTION]...",
                                      .intro = "Tests.\n",
                                      .outro = "Exit status: 0.\n"};

static enum grrl_options_result result;
static int first;
static char output[4096]; /* both streams */

/* Parses what stands between the spaces of a line. */
static void parse(const char *line)
{
    static char words[256];
    char *argv[32] = {(char[]){"grrl-test"}};
    int argc = 1;
    (void)snprintf(words, sizeof words, "%s", line);
    for (char *word = strtok(words, " "); word != NULL; word = strtok(NULL, " "))
        argv[argc++] = word;
    const struct grrl_option rows[] = {
        grrl_option_flag("quiet", "print errors only", &values.quiet),
        grrl_option_text("log", "FILE", "write a log", &values.log),
        grrl_option_int("trials", "N", "trials (1)", 1, 100, &values.trials),
        grrl_option_u32("damage", "N", "damage one byte\nin N", 0, UINT32_MAX, &values.damage),
        grrl_option_u64("seed", "N", "seed (1)", 0, UINT64_MAX, &values.seed),
        grrl_option_number("noise", "MM", "of a point", 0.0, 100.0, 0.001, &values.noise_m),
        grrl_option_call("shape", "X", "a letter", take_shape, &values.shape),
        grrl_option_each("add", "X", "a letter", take_letter, &values),
    };
    memset(&values, 0, sizeof values);
    FILE *file = tmpfile();
    assert_non_null(file);
    int streams[] = {dup(STDOUT_FILENO), dup(STDERR_FILENO)};
    (void)fflush(stdout);
    (void)dup2(fileno(file), STDOUT_FILENO);
    (void)dup2(fileno(file), STDERR_FILENO);
    result = grrl_options_parse(&program, rows, sizeof rows / sizeof rows[0], argc, argv, &first);
    (void)fflush(stdout);
    (void)dup2(streams[0], STDOUT_FILENO);
    (void)dup2(streams[1], STDERR_FILENO);
    (void)close(streams[0]);
    (void)close(streams[1]);
    rewind(file);
    output[fread(output, 1, sizeof output - 1, file)] = '\0';
    (void)fclose(file);
}

static void refused(const char *line, const char *message)
{
    parse(line);
    assert_int_equal(result, GRRL_OPTIONS_BAD);
    assert_string_equal(output, message);
}

static void every_kind_takes_its_value(void **state)
{
    (void)state;
    parse("--quiet --log a.lcm --trials 100 --damage=4294967295 --seed 18446744073709551615 "
          "--noise 0.5 --shape x");
    assert_int_equal(result, GRRL_OPTIONS_RUN);
    assert_string_equal(output, "");
    assert_true(values.quiet);
    assert_string_equal(values.log, "a.lcm");
    assert_int_equal(values.trials, 100);
    assert_int_equal(values.damage, UINT32_MAX);
    assert_true(values.seed == UINT64_MAX);
    assert_true(values.noise_m == 0.5 * 0.001);
    assert_int_equal(values.shape, 'x');
    parse("");
    assert_int_equal(result, GRRL_OPTIONS_RUN);
    assert_false(values.quiet);
    assert_null(values.log);
    assert_int_equal(values.trials, 0); /* as it was */
}

static void wrong_values_are_refused(void **state)
{
    (void)state;
    const char *trials = "grrl-test: --trials %s: must be a whole number from 1 to 100\n";
    const char *wrong[] = {"0", "101", "-1", "+5", "1e1", "2x", "x", "99999999999999999999"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        char line[80], message[120];
        (void)snprintf(line, sizeof line, "--trials=%s", wrong[i]);
        (void)snprintf(message, sizeof message, trials, wrong[i]);
        refused(line, message);
        assert_int_equal(values.trials, 0);
    }
    refused("--damage 4294967296",
            "grrl-test: --damage 4294967296: must be a whole number from 0 to 4294967295\n");
    refused("--seed 18446744073709551616",
            "grrl-test: --seed 18446744073709551616: must be a whole number from 0\n");
    refused("--noise x", "grrl-test: --noise x: must be a number from 0 to 100\n");
    refused("--noise 100.1", "grrl-test: --noise 100.1: must be a number from 0 to 100\n");
    refused("--noise -0.1", "grrl-test: --noise -0.1: must be a number from 0 to 100\n");
    refused("--noise nan", "grrl-test: --noise nan: must be a number from 0 to 100\n");
    refused("--noise 1mm", "grrl-test: --noise 1mm: must be a number from 0 to 100\n");
    refused("--shape xy", "grrl-test: --shape xy: must be one letter\n");
}

static void numbers_fit_a_float(void **state)
{
    (void)state;
    double value = 7.0;
    assert_false(grrl_option_number_of("1e39", &value));
    assert_false(grrl_option_number_of("-1e39", &value));
    assert_false(grrl_option_number_of("inf", &value));
    assert_false(grrl_option_number_of("", &value));
    assert_true(value == 7.0);
    assert_true(grrl_option_number_of("-2.5e3", &value) && value == -2500.0);
}

static void an_option_is_given_once(void **state)
{
    (void)state;
    refused("--seed 1 --quiet --seed 1", "grrl-test: --seed: given twice\nTry grrl-test --help\n");
    refused("--quiet --quie", "grrl-test: --quiet: given twice\nTry grrl-test --help\n");
    refused("--log a --lo=b", "grrl-test: --log: given twice\nTry grrl-test --help\n");
    parse("--add a --quiet --add b"); /* but for those that add up */
    assert_int_equal(result, GRRL_OPTIONS_RUN);
    assert_string_equal(values.letters, "ab");
    refused("--add a --add ?", "grrl-test: --add ?: must be a letter\n");
    parse("--quiet"); /* a new command line begins anew */
    assert_int_equal(result, GRRL_OPTIONS_RUN);
}

static void unknown_options_point_to_help(void **state)
{
    (void)state;
    const char *lines[] = {"--nonsense", "--seed", "--quiet=1", "-x", "--"};
    for (size_t i = 0; i + 1 < sizeof lines / sizeof lines[0]; i++) {
        parse(lines[i]);
        assert_int_equal(result, GRRL_OPTIONS_BAD);
        assert_non_null(strstr(output, "grrl-test: "));
        assert_non_null(strstr(output, "\nTry grrl-test --help\n"));
    }
    parse("--");
    assert_int_equal(result, GRRL_OPTIONS_RUN);
}

static void arguments_are_counted(void **state)
{
    (void)state;
    refused("--quiet extra", "grrl-test: extra: there are no arguments, only options\n"
                             "Try grrl-test --help\n");
    program.max_arguments = 2;
    program.arguments = "two files at most";
    parse("one --quiet -- --two");
    assert_int_equal(result, GRRL_OPTIONS_RUN);
    assert_true(values.quiet);
    assert_int_equal(first, 3); /* of five words */
    refused("one - three --quiet", "grrl-test: three: two files at most\nTry grrl-test --help\n");
    program.max_arguments = 0;
    program.arguments = NULL;
}

static void help_lists_the_table(void **state)
{
    (void)state;
    const char *lines[] = {"--help", "-h", "--seed 1 -h --trials 0"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        parse(lines[i]);
        assert_int_equal(result, GRRL_OPTIONS_DONE);
        assert_string_equal(output, "Usage: grrl-test [OPTION]...\n"
                                    "Tests.\n"
                                    "\n"
                                    "  --quiet     print errors only\n"
                                    "  --log FILE  write a log\n"
                                    "  --trials N  trials (1)\n"
                                    "  --damage N  damage one byte\n"
                                    "              in N\n"
                                    "  --seed N    seed (1)\n"
                                    "  --noise MM  of a point\n"
                                    "  --shape X   a letter\n"
                                    "  --add X     a letter\n"
                                    "  --help      print this help\n"
                                    "  --version   print the version\n"
                                    "\n"
                                    "Exit status: 0.\n");
    }
    parse("--version");
    assert_int_equal(result, GRRL_OPTIONS_DONE);
    assert_string_equal(output, "grrl-test " GRRL_VERSION "\n");
}

static void a_full_table_parses(void **state)
{
    (void)state;
    static char names[GRRL_OPTIONS_MAX][16];
    struct grrl_option rows[GRRL_OPTIONS_MAX];
    bool flags[GRRL_OPTIONS_MAX] = {false};
    for (int i = 0; i < GRRL_OPTIONS_MAX; i++) {
        (void)snprintf(names[i], sizeof names[i], "o%dx", i);
        rows[i] = grrl_option_flag(names[i], "", &flags[i]);
    }
    char last[20];
    (void)snprintf(last, sizeof last, "--o%dx", GRRL_OPTIONS_MAX - 1);
    char *argv[] = {(char[]){"grrl-test"}, (char[]){"--o0x"}, last, NULL};
    assert_int_equal(grrl_options_parse(&program, rows, GRRL_OPTIONS_MAX, 3, argv, NULL),
                     GRRL_OPTIONS_RUN);
    for (int i = 0; i < GRRL_OPTIONS_MAX; i++)
        assert_int_equal(flags[i], i == 0 || i == GRRL_OPTIONS_MAX - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_takes_its_value),    cmocka_unit_test(wrong_values_are_refused),
        cmocka_unit_test(numbers_fit_a_float),           cmocka_unit_test(an_option_is_given_once),
        cmocka_unit_test(unknown_options_point_to_help), cmocka_unit_test(arguments_are_counted),
        cmocka_unit_test(help_lists_the_table),          cmocka_unit_test(a_full_table_parses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
