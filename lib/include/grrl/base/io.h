/*
 * io.h: how the library reads and writes what it keeps: through two functions of the caller.
 */
#ifndef GRRL_BASE_IO_H
#define GRRL_BASE_IO_H

#include <stddef.h>

#include "grrl/base/api.h"

GRRL_API_BEGIN

/* Each returns 0 when all `size` bytes were transferred. The one that a call does not need may be
 * NULL. */
struct grrl_io {
    void *context;
    int (*write)(void *context, const void *bytes, size_t size);
    int (*read)(void *context, void *bytes, size_t size);
};

GRRL_API_END

#endif
