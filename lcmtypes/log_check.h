/*
 * log_check.h: checks an LCM log before LCM's own reader opens it.
 *
 * That reader trusts the lengths in the file: with LCM 1.3.1, a length that exceeds memory ends the
 * process. This check visits every event that the reader could find. It allocates nothing and
 * decodes no message.
 */
#ifndef GRRL_LOG_CHECK_H
#define GRRL_LOG_CHECK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "grrl/base/api.h"

GRRL_API_BEGIN

/* Begins each event. */
#define GRRL_LOG_SYNC UINT32_C(0xeda1da01)

enum { GRRL_LOG_MAX_EVENT = 64 * 1024 * 1024 /* bytes per message */, GRRL_LOG_MAX_CHANNEL = 1000 };

/* A number of 4 bytes in a log, most significant first. */
static inline uint32_t grrl_log_number(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

struct grrl_log_why {
    char text[512];
};

/*
 * Whether every event of the log is at most GRRL_LOG_MAX_EVENT long; else gives a reason. A
 * truncated log passes, and so does a file that is not a log: the reader finds no event in it.
 * Cost: one read per event header; byte by byte where there is none.
 */
bool grrl_log_check(const char *path, struct grrl_log_why *why);

/* Extracts the path from an LCM URL file://PATH?.., truncated to the capacity; false if the URL
 * belongs to another provider. */
bool grrl_log_path(const char *url, size_t capacity, char *path);

GRRL_API_END

#endif
