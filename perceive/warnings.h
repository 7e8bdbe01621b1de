/* warnings.h: what makes an answer doubtful, for standard error and for the JSON. */
#ifndef GRRL_PERCEIVE_WARNINGS_H
#define GRRL_PERCEIVE_WARNINGS_H

#include <stdio.h>

enum { GRRL_WARNINGS_MAX = 16 };

/* Begin with all zero. The texts need no escaping in JSON. */
struct grrl_warnings {
    unsigned n;
    char text[GRRL_WARNINGS_MAX][320];
};

/* Adds one; beyond GRRL_WARNINGS_MAX it is not kept. */
__attribute__((format(printf, 2, 3))) void grrl_warn(struct grrl_warnings *warnings,
                                                     const char *format, ...);

/* One line each: grrl-perceive: warning: TEXT */
void grrl_warnings_print(FILE *file, const struct grrl_warnings *warnings);

#endif
