/* Walks over a log's events and checks their lengths. */
#define _POSIX_C_SOURCE 200809L

#include "log_check.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>

/* After the magic: number and time of the event, 8 bytes each, then the two lengths. */
enum { HEADER_BYTES = 24, CHANNEL_LENGTH_AT = 16, DATA_LENGTH_AT = 20 };

static bool fail(struct grrl_log_why *why, const char *path, const char *what)
{
    (void)snprintf(why->text, sizeof why->text, "%.300s: %s", path, what);
    return false;
}

/* Skips past the next magic, as the reader does; false if there is none. */
static bool find_event(FILE *file)
{
    uint32_t last = 0;
    int byte;
    while ((byte = getc(file)) != EOF) {
        last = last << 8 | (uint32_t)byte;
        if (last == GRRL_LOG_SYNC)
            return true;
    }
    return false;
}

static bool check_events(FILE *file, const char *path, struct grrl_log_why *why)
{
    uint8_t header[HEADER_BYTES];
    while (find_event(file)) {
        off_t at = ftello(file);
        if (fread(header, 1, sizeof header, file) != sizeof header)
            break;
        uint32_t channel = grrl_log_number(header + CHANNEL_LENGTH_AT);
        uint32_t data = grrl_log_number(header + DATA_LENGTH_AT);
        if (channel == 0 || channel >= GRRL_LOG_MAX_CHANNEL || data > INT32_MAX) {
            /* The reader rejects it and resumes its search after the magic, so this
             * does the same. */
            if (fseeko(file, at, SEEK_SET) != 0)
                return fail(why, path, strerror(errno));
            continue;
        }
        if (data > GRRL_LOG_MAX_EVENT) {
            char what[120];
            (void)snprintf(
                what, sizeof what,
                "byte %lld: a message of %lu bytes exceeds the limit of %d: the log is damaged",
                (long long)at, (unsigned long)data, GRRL_LOG_MAX_EVENT);
            return fail(why, path, what);
        }
        if (fseeko(file, (off_t)channel + (off_t)data, SEEK_CUR) != 0)
            return fail(why, path, strerror(errno));
    }
    return ferror(file) == 0 || fail(why, path, strerror(errno));
}

bool grrl_log_check(const char *path, struct grrl_log_why *why)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return fail(why, path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return fail(why, path, "a log must be a file that can be read twice");
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return fail(why, path, strerror(errno));
    bool good = check_events(file, path, why);
    (void)fclose(file);
    return good;
}

bool grrl_log_path(const char *url, size_t capacity, char *path)
{
    static const char provider[] = "file://";
    if (strncmp(url, provider, sizeof provider - 1) != 0)
        return false;
    const char *begin = url + sizeof provider - 1;
    (void)snprintf(path, capacity, "%.*s", (int)strcspn(begin, "?"), begin);
    return true;
}
