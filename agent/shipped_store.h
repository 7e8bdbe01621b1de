/* shipped_store.h: the store that comes with grrl, by name. */
#ifndef GRRL_SHIPPED_STORE_H
#define GRRL_SHIPPED_STORE_H

#include <stddef.h>

#include "grrl/base/api.h"

GRRL_API_BEGIN

/*
 * The path of a store to start from: for "mixed" that of the one that comes with grrl, which is
 * found from where the running program lies, so that an installed copy may be moved; else `name`
 * itself. Writes to `path`, at most `capacity` bytes; a path that does not fit is cut.
 */
void grrl_shipped_store_path(const char *name, size_t capacity, char *path);

GRRL_API_END

#endif
