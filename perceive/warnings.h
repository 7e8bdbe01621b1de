/* warnings.h: warnings about a doubtful answer, for standard error and the JSON. */
#ifndef GRRL_PERCEIVE_WARNINGS_H
#define GRRL_PERCEIVE_WARNINGS_H

#include <stdio.h>

enum { GRRL_WARNINGS_MAX = 16 };

/* Initialise with zeros. The texts need no escaping in JSON. */
struct grrl_warnings {
    unsigned n;
    char text[GRRL_WARNINGS_MAX][320];
};

/* Adds a warning; those beyond GRRL_WARNINGS_MAX are dropped. */
__attribute__((format(printf, 2, 3))) void grrl_warn(struct grrl_warnings *warnings,
                                                     const char *format, ...);

/* One line each: grrl-perceive: warning: TEXT */
void grrl_warnings_print(FILE *file, const struct grrl_warnings *warnings);

#endif
