/* io.h: two caller-supplied functions through which the library reads and writes its files. */
#ifndef GRRL_BASE_IO_H
#define GRRL_BASE_IO_H

#include <stddef.h>

#include "grrl/base/api.h"

GRRL_API_BEGIN

/* Each function returns 0 when it transferred all `size` bytes. The one a call does not need may be
 * NULL. */
struct grrl_io {
    void *context;
    int (*write)(void *context, const void *bytes, size_t size);
    int (*read)(void *context, void *bytes, size_t size);
};

GRRL_API_END

#endif
