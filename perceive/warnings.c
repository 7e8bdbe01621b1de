/* warnings.c: a list of texts. */
#include "warnings.h"

#include <stdarg.h>

void grrl_warn(struct grrl_warnings *warnings, const char *format, ...)
{
    if (warnings->n == GRRL_WARNINGS_MAX)
        return;
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(warnings->text[warnings->n], sizeof warnings->text[0], format, arguments);
    va_end(arguments);
    warnings->n++;
}

void grrl_warnings_print(FILE *file, const struct grrl_warnings *warnings)
{
    for (unsigned i = 0; i < warnings->n; i++)
        (void)fprintf(file, "grrl-perceive: warning: %s\n", warnings->text[i]);
}
