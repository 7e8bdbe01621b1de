/* Saves experiences atomically, and sets damaged files aside. */
#define _POSIX_C_SOURCE 200809L

#include "store_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PATH_BYTES = 4096, BUFFER_BYTES = 4096, MAX_ASIDE = 99 };

/* --- the system's calls ----------------------------------------------------------------------- */

static int posix_open(void *context, const char *path, int flags)
{
    (void)context;
    return open(path, flags | O_CLOEXEC, 0666);
}

static ssize_t posix_read(void *context, int fd, void *bytes, size_t size)
{
    (void)context;
    return read(fd, bytes, size);
}

static ssize_t posix_write(void *context, int fd, const void *bytes, size_t size)
{
    (void)context;
    return write(fd, bytes, size);
}

static int posix_sync(void *context, int fd)
{
    (void)context;
    return fsync(fd);
}

static int posix_close(void *context, int fd)
{
    (void)context;
    return close(fd);
}

static int posix_rename(void *context, const char *from, const char *to)
{
    (void)context;
    return rename(from, to);
}

static int posix_remove(void *context, const char *path)
{
    (void)context;
    return unlink(path);
}

const struct grrl_file_calls grrl_file_calls_posix = {
    .open = posix_open,
    .read = posix_read,
    .write = posix_write,
    .sync = posix_sync,
    .close = posix_close,
    .rename = posix_rename,
    .remove = posix_remove,
};

/* --- an open file, buffered ------------------------------------------------------------------- */

struct stream {
    const struct grrl_file_calls *calls;
    int fd;
    int error; /* errno of the first failure */
    size_t n;  /* bytes in the buffer */
    size_t at; /* reading: of them, used */
    uint8_t bytes[BUFFER_BYTES];
};

static bool open_stream(struct stream *stream, const struct grrl_file_calls *calls,
                        const char *path, int flags)
{
    stream->calls = calls;
    stream->error = 0;
    stream->n = 0;
    stream->at = 0;
    do {
        stream->fd = calls->open(calls->context, path, flags);
    } while (stream->fd < 0 && errno == EINTR);
    if (stream->fd < 0)
        stream->error = errno;
    return stream->fd >= 0;
}

static bool flush(struct stream *stream)
{
    const struct grrl_file_calls *calls = stream->calls;
    for (size_t at = 0; at < stream->n && stream->error == 0;) {
        ssize_t n = calls->write(calls->context, stream->fd, stream->bytes + at, stream->n - at);
        if (n >= 0)
            at += (size_t)n;
        else if (errno != EINTR)
            stream->error = errno;
    }
    stream->n = 0;
    return stream->error == 0;
}

/* Also false at the end of the file. */
static bool fill(struct stream *stream)
{
    const struct grrl_file_calls *calls = stream->calls;
    ssize_t n;
    do {
        n = calls->read(calls->context, stream->fd, stream->bytes, sizeof stream->bytes);
    } while (n < 0 && errno == EINTR);
    if (n < 0)
        stream->error = errno;
    stream->at = 0;
    stream->n = n > 0 ? (size_t)n : 0;
    return n > 0;
}

static bool close_stream(struct stream *stream)
{
    const struct grrl_file_calls *calls = stream->calls;
    if (calls->close(calls->context, stream->fd) != 0 && stream->error == 0)
        stream->error = errno;
    return stream->error == 0;
}

static int write_bytes(void *context, const void *bytes, size_t size)
{
    struct stream *stream = context;
    if (size > sizeof stream->bytes - stream->n && !flush(stream))
        return -1;
    memcpy(stream->bytes + stream->n, bytes, size); /* a record is far smaller than the buffer */
    stream->n += size;
    return 0;
}

static int read_bytes(void *context, void *bytes, size_t size)
{
    struct stream *stream = context;
    uint8_t *to = bytes;
    while (size > 0) {
        if (stream->at == stream->n && !fill(stream))
            return -1;
        size_t n = stream->n - stream->at < size ? stream->n - stream->at : size;
        memcpy(to, stream->bytes + stream->at, n);
        stream->at += n;
        to += n;
        size -= n;
    }
    return 0;
}

/* --- saving ----------------------------------------------------------------------------------- */

static bool fail(struct grrl_store_report *report, const char *path, const char *what)
{
    (void)snprintf(report->text, sizeof report->text, "%.300s: %s", path, what);
    return false;
}

/* Makes a rename survive a power failure. */
static bool sync_folder(const struct grrl_file_calls *calls, const char *path)
{
    char folder[PATH_BYTES];
    const char *slash = strrchr(path, '/');
    size_t length = slash == NULL ? 0 : (size_t)(slash - path);
    if (slash == NULL)
        (void)snprintf(folder, sizeof folder, ".");
    else
        (void)snprintf(folder, sizeof folder, "%.*s", length == 0 ? 1 : (int)length, path);
    int fd = calls->open(calls->context, folder, O_RDONLY | O_DIRECTORY);
    if (fd < 0)
        return false;
    bool good = calls->sync(calls->context, fd) == 0;
    return calls->close(calls->context, fd) == 0 && good;
}

static bool write_file(const struct grrl_file_calls *calls, const char *path,
                       const struct grrl_learner *learner)
{
    struct stream stream;
    if (!open_stream(&stream, calls, path, O_WRONLY | O_CREAT | O_TRUNC))
        return false;
    struct grrl_io io = {.context = &stream, .write = write_bytes};
    if (grrl_learner_save(learner, &io) == GRRL_OK && flush(&stream) &&
        calls->sync(calls->context, stream.fd) != 0)
        stream.error = errno;
    bool good = close_stream(&stream);
    errno = stream.error;
    return good;
}

bool grrl_store_file_save(const struct grrl_file_calls *calls, const char *path,
                          const struct grrl_learner *learner, struct grrl_store_report *report)
{
    char temporary[PATH_BYTES];
    report->text[0] = '\0';
    int length = snprintf(temporary, sizeof temporary, "%s.new", path);
    if (length < 0 || (size_t)length >= sizeof temporary)
        return fail(report, path, "the name is too long");
    /* The new file is on disk before it replaces the old one. */
    if (!write_file(calls, temporary, learner) ||
        calls->rename(calls->context, temporary, path) != 0) {
        int reason = errno;
        (void)calls->remove(calls->context, temporary);
        return fail(report, path, strerror(reason));
    }
    if (sync_folder(calls, path))
        return true;
    return fail(report, path, strerror(errno));
}

/* --- loading ---------------------------------------------------------------------------------- */

/* Advice about a file that is left alone. */
static const char *advice(enum grrl_status status)
{
    switch (status) {
    case GRRL_ERR_FULL:
        return "it holds more than fits: raise --experiences";
    case GRRL_ERR_FORMAT:
        return "this is not a store; name another file";
    case GRRL_ERR_POLICY:
        return "it belongs to another policy; choose that one with --policy, or name another file";
    default:
        return "written by another version or with other limits; use the program that wrote it, or "
               "name another file";
    }
}

/* Finds an unused name by creating an empty file with it. */
static bool reserve_name(const struct grrl_file_calls *calls, const char *path, char *aside)
{
    for (int i = 1; i <= MAX_ASIDE; i++) {
        int length = i == 1 ? snprintf(aside, PATH_BYTES, "%s.damaged", path)
                            : snprintf(aside, PATH_BYTES, "%s.damaged.%d", path, i);
        if (length < 0 || length >= PATH_BYTES) {
            errno = ENAMETOOLONG;
            return false;
        }
        int fd = calls->open(calls->context, aside, O_WRONLY | O_CREAT | O_EXCL);
        if (fd >= 0)
            return calls->close(calls->context, fd) == 0;
        if (errno != EEXIST)
            return false;
    }
    return false;
}

/* Moves a damaged file out of the way and says so. */
static enum grrl_store_result set_aside(const struct grrl_file_calls *calls, const char *path,
                                        const char *what, struct grrl_store_report *report)
{
    char aside[PATH_BYTES];
    if (!reserve_name(calls, path, aside) || calls->rename(calls->context, path, aside) != 0 ||
        !sync_folder(calls, path)) {
        (void)snprintf(report->text, sizeof report->text,
                       "%.300s: %s; it cannot be renamed (%s): move it away to start without it",
                       path, what, strerror(errno));
        return GRRL_STORE_REFUSED;
    }
    (void)snprintf(report->text, sizeof report->text,
                   "%.300s: %s; it is now %.300s. To use a backup instead, stop, copy it to the "
                   "old name and start again",
                   path, what, aside);
    return GRRL_STORE_SET_ASIDE;
}

/* Describes a torn end or damage elsewhere. */
static void describe_damage(enum grrl_status status, uint32_t kept, uint32_t lost, char *what,
                            size_t capacity)
{
    if (status == GRRL_ERR_IO)
        (void)snprintf(
            what, capacity,
            "the file ends early; %lu entries before the end are kept, at least %lu are lost",
            (unsigned long)kept, (unsigned long)lost);
    else
        (void)snprintf(what, capacity, "the file is damaged; nothing of it is used");
}

static enum grrl_status read_file(struct stream *stream, struct grrl_learner *learner,
                                  uint32_t *lost)
{
    uint8_t more;
    struct grrl_io io = {.context = stream, .read = read_bytes};
    enum grrl_status status = grrl_learner_load_torn(learner, &io, lost);
    if (status == GRRL_OK && read_bytes(stream, &more, 1) == 0)
        return GRRL_ERR_CORRUPT; /* save writes nothing after the last record */
    return status;
}

enum grrl_store_result grrl_store_file_load(const struct grrl_file_calls *calls, const char *path,
                                            struct grrl_learner *learner,
                                            struct grrl_store_report *report)
{
    struct stream stream;
    char what[160];
    uint32_t lost = 0;
    report->text[0] = '\0';
    if (!open_stream(&stream, calls, path, O_RDONLY)) {
        grrl_learner_clear(learner);
        if (stream.error == ENOENT)
            return GRRL_STORE_NEW;
        (void)fail(report, path, strerror(stream.error));
        return GRRL_STORE_REFUSED;
    }
    enum grrl_status status = read_file(&stream, learner, &lost);
    bool readable = close_stream(&stream);
    if (readable && status == GRRL_OK)
        return GRRL_STORE_LOADED;
    uint32_t kept = grrl_learner_usage(learner).n;
    bool damaged = status == GRRL_ERR_IO || status == GRRL_ERR_CORRUPT;
    enum grrl_store_result result = GRRL_STORE_REFUSED;
    if (!readable) {
        (void)fail(report, path, strerror(stream.error));
    } else if (damaged) {
        describe_damage(status, kept, lost, what, sizeof what);
        result = set_aside(calls, path, what, report);
    } else {
        (void)fail(report, path, advice(status));
    }
    if (result == GRRL_STORE_REFUSED || status == GRRL_ERR_CORRUPT)
        grrl_learner_clear(learner);
    return result;
}

bool grrl_store_file_copy(const struct grrl_file_calls *calls, const char *path,
                          struct grrl_learner *learner, struct grrl_store_report *report)
{
    struct stream stream;
    uint32_t lost = 0;
    report->text[0] = '\0';
    if (!open_stream(&stream, calls, path, O_RDONLY))
        return fail(report, path, strerror(stream.error));
    enum grrl_status status = read_file(&stream, learner, &lost);
    bool readable = close_stream(&stream);
    if (readable && status == GRRL_OK)
        return true;
    grrl_learner_clear(learner);
    if (!readable)
        return fail(report, path, strerror(stream.error));
    bool damaged = status == GRRL_ERR_IO || status == GRRL_ERR_CORRUPT;
    return fail(report, path, damaged ? "the file is damaged" : advice(status));
}
