/*
 * store_file.h: experiences in a file.
 *
 * Saving is atomic: whenever the power goes, the file holds the old experiences or the new ones. A
 * file that cannot be read is never overwritten: loading fails and says what to do.
 */
#ifndef GRRL_STORE_FILE_H
#define GRRL_STORE_FILE_H

#include <stdbool.h>

#include "grrl/learner.h"

struct grrl_store_error {
    char text[512];
};

/* A file that does not exist yet is a learner without experience. */
bool grrl_store_file_load(const char *path, struct grrl_learner *learner,
                          struct grrl_store_error *error);

bool grrl_store_file_save(const char *path, const struct grrl_learner *learner,
                          struct grrl_store_error *error);

#endif
