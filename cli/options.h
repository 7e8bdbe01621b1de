/*
 * options.h: the command line of a program, from one table.
 *
 * Each row of the table is an option: its name, its help text, and where its value goes. The module
 * adds --help (-h) and --version. It reports an unknown option, a wrong value, an option given
 * twice and a surplus argument.
 *
 * Order of calls: make the rows with the functions below, in an array to which more may be added at
 * run time; then call grrl_options_parse once; then grrl_options_wrong for errors that only the
 * program can detect, such as options that exclude each other.
 */
#ifndef GRRL_CLI_OPTIONS_H
#define GRRL_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Maximum number of rows. */
enum { GRRL_OPTIONS_MAX = 48 };

/* What main should do next. The last two are exit statuses. */
enum grrl_options_result { GRRL_OPTIONS_RUN = -1, GRRL_OPTIONS_DONE = 0, GRRL_OPTIONS_BAD = 2 };

struct grrl_program {
    const char *name;      /* grrl-sim */
    const char *usage;     /* follows "Usage: " in --help, without the final line break */
    const char *intro;     /* text of --help before and after the options */
    const char *outro;     /* NULL: none */
    int max_arguments;     /* arguments that are not options; usually 0 */
    const char *arguments; /* the error text for a surplus argument; NULL: there are none */
};

/* Processes a value; text is NULL for a flag. Returns NULL, or what the value must be ("a number
 * above 0"). That text must stay valid until the message is printed. */
typedef const char *(*grrl_option_take)(void *context, const char *text);

enum grrl_option_kind {
    GRRL_OPTION_FLAG,
    GRRL_OPTION_TEXT,
    GRRL_OPTION_INT,
    GRRL_OPTION_U32,
    GRRL_OPTION_U64,
    GRRL_OPTION_NUMBER,
    GRRL_OPTION_CALL,
    GRRL_OPTION_EACH
};

/* A row, filled in by the functions below. Strings and target must outlive grrl_options_parse. */
struct grrl_option {
    const char *name;
    const char *argument; /* its name in --help, such as FILE; NULL: none */
    const char *help;     /* a line break continues in the same column */
    enum grrl_option_kind kind;
    void *target;
    uint64_t low; /* of an integer */
    uint64_t high;
    double low_number;
    double high_number;
    double scale; /* target value per unit of the command line */
    grrl_option_take take;
};

struct grrl_option grrl_option_flag(const char *name, const char *help, bool *target);
struct grrl_option grrl_option_text(const char *name, const char *argument, const char *help,
                                    const char **target);
/* An option whose value is a whole number from low to high; 0 <= low. */
struct grrl_option grrl_option_int(const char *name, const char *argument, const char *help,
                                   int low, int high, int *target);
struct grrl_option grrl_option_u32(const char *name, const char *argument, const char *help,
                                   uint32_t low, uint32_t high, uint32_t *target);
struct grrl_option grrl_option_u64(const char *name, const char *argument, const char *help,
                                   uint64_t low, uint64_t high, uint64_t *target);
/* An option whose value is a number from low to high; the target is set to scale times it. */
struct grrl_option grrl_option_number(const char *name, const char *argument, const char *help,
                                      double low, double high, double scale, double *target);
/* An option handled by a callback; argument NULL: a flag. */
struct grrl_option grrl_option_call(const char *name, const char *argument, const char *help,
                                    grrl_option_take take, void *context);
/* The same for an option that may be given several times. */
struct grrl_option grrl_option_each(const char *name, const char *argument, const char *help,
                                    grrl_option_take take, void *context);

/* Parse the whole text as a whole number from low to high, or as a number that fits a float. False
 * if it is neither. */
bool grrl_option_integer_of(const char *text, uint64_t low, uint64_t high, uint64_t *value);
bool grrl_option_number_of(const char *text, double *value);

/*
 * Processes the options in argv and moves the other arguments to argv[*first] .. argv[argc - 1];
 * first may be NULL. Prints help or version to stdout (DONE), or the error to stderr (BAD). The
 * target of an option that is not given keeps its value.
 */
enum grrl_options_result grrl_options_parse(const struct grrl_program *program,
                                            const struct grrl_option *options, size_t n, int argc,
                                            char **argv, int *first);

/* Prints an error in the command line and how to get help. Returns BAD. */
enum grrl_options_result grrl_options_wrong(const struct grrl_program *program, const char *what);

#ifdef __cplusplus
}
#endif

#endif
