/*
 * store_file.h: experiences in a file.
 *
 * Saving is atomic: whenever the power goes, the file holds the old experiences or the new ones,
 * whole. A file that is damaged all the same is set aside under another name, FILE.damaged, never
 * overwritten: nothing is lost that was still there. A file that is something else, of another
 * version or too large for the memory is left alone.
 *
 * All system calls go through a table, so that a test can cut the power at each of them.
 */
#ifndef GRRL_STORE_FILE_H
#define GRRL_STORE_FILE_H

#include <stdbool.h>
#include <sys/types.h>

#include "grrl/learner/learner.h"

GRRL_API_BEGIN

/* As POSIX has them, with -1 and errno for a failure. */
struct grrl_file_calls {
    void *context;
    int (*open)(void *context, const char *path, int flags);
    ssize_t (*read)(void *context, int fd, void *bytes, size_t size);
    ssize_t (*write)(void *context, int fd, const void *bytes, size_t size);
    int (*sync)(void *context, int fd);
    int (*close)(void *context, int fd);
    int (*rename)(void *context, const char *from, const char *to);
    int (*remove)(void *context, const char *path);
};

/* The system's own. */
extern const struct grrl_file_calls grrl_file_calls_posix;

enum grrl_store_result {
    GRRL_STORE_LOADED,    /* also where there is no file yet: a learner without experience */
    GRRL_STORE_SET_ASIDE, /* damaged: the learner knows what was whole before a torn end, or
                             nothing; the report says what was kept and where the file is now */
    GRRL_STORE_REFUSED    /* the file is as it was, the learner knows nothing */
};

/* What happened, for the user, in English; empty when all is well. */
struct grrl_store_report {
    char text[1024];
};

GRRL_MUST_USE enum grrl_store_result grrl_store_file_load(const struct grrl_file_calls *calls,
                                                          const char *path,
                                                          struct grrl_learner *learner,
                                                          struct grrl_store_report *report);

/* After a failure the file holds what it held before; or what was to be saved, when all but the
 * last sync, of the folder, went well. */
GRRL_MUST_USE bool grrl_store_file_save(const struct grrl_file_calls *calls, const char *path,
                                        const struct grrl_learner *learner,
                                        struct grrl_store_report *report);

GRRL_API_END

#endif
