/*
 * store_file.h: loads and saves what was learned.
 *
 * Saving is atomic: whenever the power fails, the file is entirely old or entirely new. If a file
 * is damaged anyway, it is renamed to FILE.damaged and never overwritten, so nothing more is lost.
 * A file of another kind or version, or too large for the memory, is left alone.
 *
 * All system calls go through a table, so that a test can simulate a power failure at each of them.
 */
#ifndef GRRL_STORE_FILE_H
#define GRRL_STORE_FILE_H

#include <stdbool.h>
#include <sys/types.h>

#include "grrl/learner/learner.h"

GRRL_API_BEGIN

/* As in POSIX, with -1 and errno on failure. */
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

/* The real system calls. */
extern const struct grrl_file_calls grrl_file_calls_posix;

enum grrl_store_result {
    GRRL_STORE_LOADED,
    GRRL_STORE_NEW,       /* there is no file yet: the learner is empty */
    GRRL_STORE_SET_ASIDE, /* damaged: the learner has the complete entries before a torn end, or
                             nothing; the report says what was kept and where the file is now */
    GRRL_STORE_REFUSED    /* the file is unchanged and the learner is empty */
};

/* A message for the user in English; empty on success. */
struct grrl_store_report {
    char text[1024];
};

GRRL_MUST_USE enum grrl_store_result grrl_store_file_load(const struct grrl_file_calls *calls,
                                                          const char *path,
                                                          struct grrl_learner *learner,
                                                          struct grrl_store_report *report);

/* Loads a file that stays as it is, to start a new store with. False if it is missing, damaged or
 * of another kind: then the learner is empty. */
GRRL_MUST_USE bool grrl_store_file_copy(const struct grrl_file_calls *calls, const char *path,
                                        struct grrl_learner *learner,
                                        struct grrl_store_report *report);

/* After a failure the file is unchanged; or it has the new content, if only the final sync of the
 * folder failed. */
GRRL_MUST_USE bool grrl_store_file_save(const struct grrl_file_calls *calls, const char *path,
                                        const struct grrl_learner *learner,
                                        struct grrl_store_report *report);

GRRL_API_END

#endif
