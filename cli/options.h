/*
 * options.h: the command line of a program, from one table.
 *
 * A row of the table is an option: its name, what --help says of it, and where its value goes. The
 * module adds --help (-h) and --version, and reports an unknown option, a wrong value, an option
 * given twice and an argument too many.
 *
 * Order of calls: make the rows with the functions below, in an array that may take more of them at
 * run time; then grrl_options_parse, once; then grrl_options_wrong for what only the program can
 * tell, such as options that exclude each other.
 */
#ifndef GRRL_CLI_OPTIONS_H
#define GRRL_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The most rows of a table. */
enum { GRRL_OPTIONS_MOST = 48 };

/* What main is to do. The last two are the exit status. */
enum grrl_options_result { GRRL_OPTIONS_RUN = -1, GRRL_OPTIONS_DONE = 0, GRRL_OPTIONS_BAD = 2 };

struct grrl_program {
    const char *name;      /* grrl-sim */
    const char *usage;     /* what follows "Usage: " in --help, without the last line's end */
    const char *intro;     /* text of --help before the options, and after them */
    const char *outro;     /* NULL: none */
    int most_arguments;    /* that are no options; usually 0 */
    const char *arguments; /* said of one too many; NULL: there are none */
};

/* Takes a value, text is NULL for a flag. Returns NULL, or what the value must be ("a number above
 * 0"), which has to stay valid until the message is printed. */
typedef const char *(*grrl_option_take)(void *context, const char *text);

enum grrl_option_kind {
    GRRL_OPTION_FLAG,
    GRRL_OPTION_TEXT,
    GRRL_OPTION_INT,
    GRRL_OPTION_U32,
    GRRL_OPTION_U64,
    GRRL_OPTION_NUMBER,
    GRRL_OPTION_CALL
};

/* A row; the functions below fill it. Strings and target must outlive grrl_options_parse. */
struct grrl_option {
    const char *name;
    const char *argument; /* its name in --help; NULL: none */
    const char *help;     /* a line break goes on in the same column */
    enum grrl_option_kind kind;
    void *target;
    uint64_t low; /* of an integer */
    uint64_t high;
    double low_number;
    double high_number;
    double scale; /* of the target's unit to that on the command line */
    grrl_option_take take;
};

struct grrl_option grrl_option_flag(const char *name, const char *help, bool *target);
struct grrl_option grrl_option_text(const char *name, const char *argument, const char *help,
                                    const char **target);
/* Whole numbers from low to high; 0 <= low. */
struct grrl_option grrl_option_int(const char *name, const char *argument, const char *help,
                                   int low, int high, int *target);
struct grrl_option grrl_option_u32(const char *name, const char *argument, const char *help,
                                   uint32_t low, uint32_t high, uint32_t *target);
struct grrl_option grrl_option_u64(const char *name, const char *argument, const char *help,
                                   uint64_t low, uint64_t high, uint64_t *target);
/* A number from low to high; the target gets scale times it. */
struct grrl_option grrl_option_number(const char *name, const char *argument, const char *help,
                                      double low, double high, double scale, double *target);
/* Anything else; argument NULL: a flag. */
struct grrl_option grrl_option_call(const char *name, const char *argument, const char *help,
                                    grrl_option_take take, void *context);

/* All of text as a whole number from low to high, or as a number that a float can hold; false: it
 * is none. */
bool grrl_option_integer_of(const char *text, uint64_t low, uint64_t high, uint64_t *value);
bool grrl_option_number_of(const char *text, double *value);

/*
 * Takes the options in argv and moves what is none to argv[*first] .. argv[argc - 1]; first may be
 * NULL. Prints help or version to stdout (DONE), or what is wrong to stderr (BAD). A target whose
 * option is not given keeps its value.
 */
enum grrl_options_result grrl_options_parse(const struct grrl_program *program,
                                            const struct grrl_option *options, size_t n, int argc,
                                            char **argv, int *first);

/* Prints what is wrong with the command line, and how to get help. Returns BAD. */
enum grrl_options_result grrl_options_wrong(const struct grrl_program *program, const char *what);

#ifdef __cplusplus
}
#endif

#endif
