/* range.h (private): checks parameter ranges and finds the first violation. */
#ifndef GRRL_BASE_RANGE_H
#define GRRL_BASE_RANGE_H

#include <stdbool.h>
#include <stddef.h>

#include "grrl/base/status.h"

/* Written so that NaN is never in range. */
static inline bool grrl_is_within(float x, float low, float high)
{
    return x >= low && x <= high;
}

struct grrl_range_check {
    const char *name;
    bool fine;
};

/* Returns GRRL_ERR_ARGUMENT for the first failed check, and its name in *field if that
 * is not NULL. */
static inline enum grrl_status grrl_range_first(const struct grrl_range_check *checks, size_t n,
                                                const char **field)
{
    for (size_t i = 0; i < n; i++) {
        if (!checks[i].fine) {
            if (field != NULL)
                *field = checks[i].name;
            return GRRL_ERR_ARGUMENT;
        }
    }
    return GRRL_OK;
}

#endif
