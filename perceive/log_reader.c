/* log_reader.c: finds events by their lengths; after damage, by the sync word. */
#define _POSIX_C_SOURCE 200809L

#include "log_reader.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "log_check.h"

/* The sync word, then the number and the time of the event (8 bytes each), then two lengths (4
 * bytes each). */
enum { SYNC_BYTES = 4, NUMBER_AT = 4, CHANNEL_AT = 20, DATA_AT = 24, HEADER_BYTES = 28 };
enum { BLOCK_BYTES = 65536 };

struct header {
    uint64_t number;
    size_t channel_length;
    size_t data_length;
};

static bool fail(const struct grrl_log_reader *reader, struct grrl_tracks_error *error,
                 const char *what)
{
    (void)snprintf(error->text, sizeof error->text, "%.300s: %s", reader->path, what);
    return false;
}

bool grrl_log_open(struct grrl_log_reader *reader, const char *path,
                   struct grrl_tracks_error *error)
{
    struct stat status;
    *reader =
        (struct grrl_log_reader){.fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK), .path = path};
    if (reader->fd < 0 || fstat(reader->fd, &status) != 0)
        (void)fail(reader, error, strerror(errno));
    else if (!S_ISREG(status.st_mode))
        (void)fail(reader, error, "a log must be a regular file, since it is read twice");
    else
        reader->size = status.st_size;
    if (reader->fd >= 0 && S_ISREG(status.st_mode))
        return true;
    grrl_log_close(reader);
    return false;
}

void grrl_log_close(struct grrl_log_reader *reader)
{
    if (reader->fd >= 0)
        (void)close(reader->fd);
    free(reader->bytes);
    *reader = (struct grrl_log_reader){.fd = -1};
}

/* Reads n bytes from `at`; false: they do not exist or cannot be read. */
static bool read_at(const struct grrl_log_reader *reader, int64_t at, size_t n, uint8_t *bytes)
{
    while (n > 0) {
        ssize_t got = pread(reader->fd, bytes, n, (off_t)at);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        bytes += got;
        at += got;
        n -= (size_t)got;
    }
    return true;
}

/* Whether a sync word is at `at`, or the log ends there or within one. */
static bool is_sync(const struct grrl_log_reader *reader, int64_t at)
{
    uint8_t bytes[SYNC_BYTES] = {0xed, 0xa1, 0xda, 0x01};
    size_t n = reader->size - at < SYNC_BYTES ? (size_t)(reader->size - at) : SYNC_BYTES;
    return read_at(reader, at, n, bytes) && grrl_log_number(bytes) == GRRL_LOG_SYNC;
}

/* Whether an intact event begins at `at`: another one, or the end of the log, must follow it. */
static bool event_at(const struct grrl_log_reader *reader, int64_t at, struct header *header)
{
    uint8_t bytes[HEADER_BYTES];
    if (reader->size - at < HEADER_BYTES || !read_at(reader, at, HEADER_BYTES, bytes))
        return false;
    uint32_t channel = grrl_log_number(bytes + CHANNEL_AT);
    uint32_t data = grrl_log_number(bytes + DATA_AT);
    int64_t end = at + HEADER_BYTES + (int64_t)channel + (int64_t)data;
    if (grrl_log_number(bytes) != GRRL_LOG_SYNC || channel == 0 ||
        channel >= GRRL_LOG_MAX_CHANNEL || data > GRRL_LOG_MAX_EVENT || end > reader->size)
        return false;
    *header = (struct header){(uint64_t)grrl_log_number(bytes + NUMBER_AT) << 32 |
                                  grrl_log_number(bytes + NUMBER_AT + 4),
                              channel, data};
    return is_sync(reader, end);
}

/* Where the next intact event begins, at `from` or later; the size of the log: there is none. */
static int64_t find_event(const struct grrl_log_reader *reader, int64_t from)
{
    uint8_t block[BLOCK_BYTES];
    struct header header;
    while (reader->size - from >= HEADER_BYTES) {
        size_t n = reader->size - from < BLOCK_BYTES ? (size_t)(reader->size - from) : BLOCK_BYTES;
        if (!read_at(reader, from, n, block))
            break;
        for (size_t i = 0; i + SYNC_BYTES <= n; i++)
            if (grrl_log_number(block + i) == GRRL_LOG_SYNC &&
                event_at(reader, from + (int64_t)i, &header))
                return from + (int64_t)i;
        from += (int64_t)(n - SYNC_BYTES + 1); /* a sync word may straddle two blocks */
    }
    return reader->size;
}

static bool read_event(struct grrl_log_reader *reader, const struct header *header,
                       struct grrl_log_event *event, struct grrl_tracks_error *error)
{
    size_t n = header->channel_length + header->data_length;
    if (n > reader->capacity) {
        uint8_t *grown = realloc(reader->bytes, n);
        if (grown == NULL)
            return fail(reader, error, "out of memory");
        reader->bytes = grown;
        reader->capacity = n;
    }
    if (!read_at(reader, reader->at + HEADER_BYTES, n, reader->bytes))
        return fail(reader, error, "the log became shorter while it was read");
    *event = (struct grrl_log_event){.at = reader->at,
                                     .number = header->number,
                                     .channel = (const char *)reader->bytes,
                                     .channel_length = header->channel_length,
                                     .data = reader->bytes + header->channel_length,
                                     .data_length = header->data_length};
    reader->at += HEADER_BYTES + (int64_t)n;
    reader->number = header->number + 1;
    return true;
}

enum grrl_log_step grrl_log_next(struct grrl_log_reader *reader, struct grrl_log_event *event,
                                 struct grrl_log_damage *damage, struct grrl_tracks_error *error)
{
    struct header header;
    if (reader->at >= reader->size)
        return GRRL_LOG_END;
    if (!event_at(reader, reader->at, &header)) {
        *damage = (struct grrl_log_damage){reader->at, find_event(reader, reader->at + 1)};
        reader->at = damage->to;
        reader->number = 0;
        return GRRL_LOG_DAMAGE;
    }
    if (reader->number > 0 && header.number > reader->number) {
        *damage = (struct grrl_log_damage){reader->at, reader->at};
        reader->number = 0;
        return GRRL_LOG_DAMAGE;
    }
    return read_event(reader, &header, event, error) ? GRRL_LOG_EVENT : GRRL_LOG_FAILED;
}
