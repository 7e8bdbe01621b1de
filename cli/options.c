/* options.c: builds getopt's table from the rows, prints --help and reports errors. */
#define _POSIX_C_SOURCE 200809L

#include "cli/options.h"

#include <assert.h>
#include <errno.h>
#include <float.h>
#include <getopt.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef GRRL_VERSION
#error "GRRL_VERSION comes from the build"
#endif

enum { RIGHT_BYTES = 100 };

/* getopt's value for row i is FIRST_ID + i, above all characters. */
enum { ID_HELP = 'h', ID_VERSION = 'v', FIRST_ID = 256 };

/* --- rows ------------------------------------------------------------------------------------- */

struct grrl_option grrl_option_flag(const char *name, const char *help, bool *target)
{
    return (struct grrl_option){
        .name = name, .help = help, .kind = GRRL_OPTION_FLAG, .target = target};
}

struct grrl_option grrl_option_text(const char *name, const char *argument, const char *help,
                                    const char **target)
{
    return (struct grrl_option){.name = name,
                                .argument = argument,
                                .help = help,
                                .kind = GRRL_OPTION_TEXT,
                                .target = target};
}

static struct grrl_option integer(enum grrl_option_kind kind, const char *name,
                                  const char *argument, const char *help, uint64_t low,
                                  uint64_t high, void *target)
{
    return (struct grrl_option){.name = name,
                                .argument = argument,
                                .help = help,
                                .kind = kind,
                                .target = target,
                                .low = low,
                                .high = high};
}

struct grrl_option grrl_option_int(const char *name, const char *argument, const char *help,
                                   int low, int high, int *target)
{
    assert(low >= 0 && low <= high);
    return integer(GRRL_OPTION_INT, name, argument, help, (uint64_t)low, (uint64_t)high, target);
}

struct grrl_option grrl_option_u32(const char *name, const char *argument, const char *help,
                                   uint32_t low, uint32_t high, uint32_t *target)
{
    return integer(GRRL_OPTION_U32, name, argument, help, low, high, target);
}

struct grrl_option grrl_option_u64(const char *name, const char *argument, const char *help,
                                   uint64_t low, uint64_t high, uint64_t *target)
{
    return integer(GRRL_OPTION_U64, name, argument, help, low, high, target);
}

struct grrl_option grrl_option_number(const char *name, const char *argument, const char *help,
                                      double low, double high, double scale, double *target)
{
    return (struct grrl_option){.name = name,
                                .argument = argument,
                                .help = help,
                                .kind = GRRL_OPTION_NUMBER,
                                .target = target,
                                .low_number = low,
                                .high_number = high,
                                .scale = scale};
}

struct grrl_option grrl_option_call(const char *name, const char *argument, const char *help,
                                    grrl_option_take take, void *context)
{
    return (struct grrl_option){.name = name,
                                .argument = argument,
                                .help = help,
                                .kind = GRRL_OPTION_CALL,
                                .target = context,
                                .take = take};
}

struct grrl_option grrl_option_each(const char *name, const char *argument, const char *help,
                                    grrl_option_take take, void *context)
{
    struct grrl_option option = grrl_option_call(name, argument, help, take, context);
    option.kind = GRRL_OPTION_EACH;
    return option;
}

/* --- values ----------------------------------------------------------------------------------- */

bool grrl_option_integer_of(const char *text, uint64_t low, uint64_t high, uint64_t *value)
{
    char *end;
    errno = 0;
    unsigned long long parsed = strtoull(text, &end, 10);
    bool digits = text[0] >= '0' && text[0] <= '9'; /* strtoull would accept " -1" */
    if (!digits || *end != '\0' || errno != 0 || parsed < low || parsed > high)
        return false;
    *value = parsed;
    return true;
}

bool grrl_option_number_of(const char *text, double *value)
{
    char *end;
    double parsed = strtod(text, &end);
    if (end == text || *end != '\0' || !(fabs(parsed) <= (double)FLT_MAX))
        return false;
    *value = parsed;
    return true;
}

static const char *take_integer(const struct grrl_option *option, const char *text, char *right)
{
    uint64_t value;
    if (!grrl_option_integer_of(text, option->low, option->high, &value)) {
        int n = snprintf(right, RIGHT_BYTES, "a whole number from %" PRIu64, option->low);
        if (option->high != UINT64_MAX)
            (void)snprintf(right + n, (size_t)(RIGHT_BYTES - n), " to %" PRIu64, option->high);
        return right;
    }
    if (option->kind == GRRL_OPTION_INT)
        *(int *)option->target = (int)value;
    else if (option->kind == GRRL_OPTION_U32)
        *(uint32_t *)option->target = (uint32_t)value;
    else
        *(uint64_t *)option->target = value;
    return NULL;
}

static const char *take_number(const struct grrl_option *option, const char *text, char *right)
{
    double value;
    if (!grrl_option_number_of(text, &value) || value < option->low_number ||
        value > option->high_number) {
        (void)snprintf(right, RIGHT_BYTES, "a number from %g to %g", option->low_number,
                       option->high_number);
        return right;
    }
    *(double *)option->target = value * option->scale;
    return NULL;
}

/* Returns NULL, or what the value must be; the text may lie in right[RIGHT_BYTES]. */
static const char *take(const struct grrl_option *option, const char *text, char *right)
{
    switch (option->kind) {
    case GRRL_OPTION_FLAG:
        *(bool *)option->target = true;
        return NULL;
    case GRRL_OPTION_TEXT:
        *(const char **)option->target = text;
        return NULL;
    case GRRL_OPTION_NUMBER:
        return take_number(option, text, right);
    case GRRL_OPTION_CALL:
    case GRRL_OPTION_EACH:
        return option->take(option->target, text);
    default:
        return take_integer(option, text, right);
    }
}

/* --- texts ------------------------------------------------------------------------------------ */

static int width_of(const struct grrl_option *option)
{
    size_t argument = option->argument != NULL ? 1 + strlen(option->argument) : 0;
    return (int)(strlen("--") + strlen(option->name) + argument);
}

static void print_row(const struct grrl_option *option, int width)
{
    (void)printf("  --%s%s%s%*s", option->name, option->argument != NULL ? " " : "",
                 option->argument != NULL ? option->argument : "", width - width_of(option) + 2,
                 "");
    for (const char *at = option->help; *at != '\0'; at++)
        (void)(*at == '\n' ? printf("\n%*s", width + 4, "") : putchar(*at));
    (void)putchar('\n');
}

static void print_help(const struct grrl_program *program, const struct grrl_option *options,
                       size_t n)
{
    const struct grrl_option own[] = {grrl_option_flag("help", "print this help", NULL),
                                      grrl_option_flag("version", "print the version", NULL)};
    int width = width_of(&own[1]);
    for (size_t i = 0; i < n; i++)
        width = width_of(&options[i]) > width ? width_of(&options[i]) : width;
    (void)printf("Usage: %s\n%s\n", program->usage, program->intro);
    for (size_t i = 0; i < n; i++)
        print_row(&options[i], width);
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
        print_row(&own[i], width);
    if (program->outro != NULL)
        (void)printf("\n%s", program->outro);
}

static enum grrl_options_result try_help(const struct grrl_program *program)
{
    (void)fprintf(stderr, "Try %s --help\n", program->name);
    return GRRL_OPTIONS_BAD;
}

enum grrl_options_result grrl_options_wrong(const struct grrl_program *program, const char *what)
{
    (void)fprintf(stderr, "%s: %s\n", program->name, what);
    return try_help(program);
}

/* --- parsing ---------------------------------------------------------------------------------- */

static void make_getopt_table(const struct grrl_option *options, size_t n, struct option *table)
{
    for (size_t i = 0; i < n; i++)
        table[i] = (struct option){options[i].name,
                                   options[i].argument != NULL ? required_argument : no_argument,
                                   NULL, (int)(FIRST_ID + i)};
    table[n] = (struct option){"help", no_argument, NULL, ID_HELP};
    table[n + 1] = (struct option){"version", no_argument, NULL, ID_VERSION};
    table[n + 2] = (struct option){NULL, 0, NULL, 0};
}

static enum grrl_options_result take_option(const struct grrl_program *program,
                                            const struct grrl_option *option, const char *text,
                                            bool again)
{
    char buffer[RIGHT_BYTES];
    if (again) {
        (void)fprintf(stderr, "%s: --%s: given twice\n", program->name, option->name);
        return try_help(program);
    }
    const char *right = take(option, text, buffer);
    if (right == NULL)
        return GRRL_OPTIONS_RUN;
    (void)fprintf(stderr, "%s: --%s %s: must be %s\n", program->name, option->name,
                  text != NULL ? text : "", right);
    return GRRL_OPTIONS_BAD;
}

enum grrl_options_result grrl_options_parse(const struct grrl_program *program,
                                            const struct grrl_option *options, size_t n, int argc,
                                            char **argv, int *first)
{
    struct option table[GRRL_OPTIONS_MAX + 3];
    bool given[GRRL_OPTIONS_MAX] = {false};
    assert(n <= GRRL_OPTIONS_MAX);
    make_getopt_table(options, n, table);
    optind = 0; /* restarts getopt */
    int id;
    while ((id = getopt_long(argc, argv, "h", table, NULL)) != -1) {
        if (id == '?')
            return try_help(program);
        if (id == ID_HELP) {
            print_help(program, options, n);
            return GRRL_OPTIONS_DONE;
        }
        if (id == ID_VERSION) {
            (void)printf("%s %s\n", program->name, GRRL_VERSION);
            return GRRL_OPTIONS_DONE;
        }
        size_t i = (size_t)(id - FIRST_ID);
        enum grrl_options_result result = take_option(program, &options[i], optarg, given[i]);
        if (result != GRRL_OPTIONS_RUN)
            return result;
        given[i] = options[i].kind != GRRL_OPTION_EACH;
    }
    if (argc - optind > program->max_arguments) {
        (void)fprintf(stderr, "%s: %s: %s\n", program->name, argv[optind + program->max_arguments],
                      program->arguments != NULL ? program->arguments
                                                 : "there are no arguments, only options");
        return try_help(program);
    }
    if (first != NULL)
        *first = optind;
    return GRRL_OPTIONS_RUN;
}
