/*
 * log_check.h: before an LCM log is given to LCM's own reader.
 *
 * That reader believes the lengths in the file: with LCM 1.3.1, one that no memory can hold ends
 * the process. Here every event is looked at that the reader could come upon; nothing is allocated
 * and no message is read.
 */
#ifndef GRRL_LOG_CHECK_H
#define GRRL_LOG_CHECK_H

#include <stdbool.h>
#include <stddef.h>

#include "grrl/base/api.h"

GRRL_API_BEGIN

enum { GRRL_LOG_MAX_EVENT = 64 * 1024 * 1024 /* bytes of a message */ };

struct grrl_log_why {
    char text[512];
};

/*
 * Whether no event of the log is longer than GRRL_LOG_MAX_EVENT; else a reason. A log that is cut
 * off is fine, and so is a file that is no log at all: the reader finds no event in it. Cost: a
 * read of each event's header; a byte at a time where there is none.
 */
bool grrl_log_check(const char *path, struct grrl_log_why *why);

/* The path in a URL file://PATH?.. of LCM, cut to the capacity; false: it is another provider's. */
bool grrl_log_path(const char *url, size_t capacity, char *path);

GRRL_API_END

#endif
