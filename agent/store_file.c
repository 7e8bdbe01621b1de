#define _POSIX_C_SOURCE 200809L

#include "store_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PATH_BYTES = 4096 };

static int write_bytes(void *context, const void *bytes, size_t size)
{
    return fwrite(bytes, 1, size, context) == size ? 0 : -1;
}

static int read_bytes(void *context, void *bytes, size_t size)
{
    return fread(bytes, 1, size, context) == size ? 0 : -1;
}

static bool fail(struct grrl_store_error *error, const char *path, const char *what)
{
    (void)snprintf(error->text, sizeof error->text, "%.300s: %s", path, what);
    return false;
}

static const char *advice(enum grrl_status status)
{
    switch (status) {
    case GRRL_ERR_FULL:
        return "it holds more experiences than fit: raise --experiences";
    case GRRL_ERR_FORMAT:
        return "this is no store of experiences; name another file with --store";
    case GRRL_ERR_VERSION:
        return "written by another version or with other limits; use the program that wrote it, or "
               "name another file with --store";
    case GRRL_ERR_IO:
        return "the file ends early; put a copy back, or move it away to start without experience";
    default:
        return "the file is damaged; put a copy back, or move it away to start without experience";
    }
}

bool grrl_store_file_load(const char *path, struct grrl_learner *learner,
                          struct grrl_store_error *error)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return errno == ENOENT || fail(error, path, strerror(errno));
    struct grrl_experience_io io = {.context = file, .read = read_bytes};
    enum grrl_status status = grrl_learner_load(learner, &io);
    bool more = status == GRRL_OK && fgetc(file) != EOF;
    bool unreadable = ferror(file) != 0;
    int reason = errno;
    (void)fclose(file);
    if (unreadable)
        return fail(error, path, strerror(reason));
    if (more)
        status = GRRL_ERR_CORRUPT;
    return status == GRRL_OK || fail(error, path, advice(status));
}

/* Makes the rename itself survive a power failure. */
static bool sync_folder(const char *path)
{
    char folder[PATH_BYTES];
    const char *slash = strrchr(path, '/');
    size_t length = slash == NULL ? 0 : (size_t)(slash - path);
    if (slash == NULL)
        (void)snprintf(folder, sizeof folder, ".");
    else
        (void)snprintf(folder, sizeof folder, "%.*s", length == 0 ? 1 : (int)length, path);
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0)
        return false;
    bool good = fsync(fd) == 0;
    return close(fd) == 0 && good;
}

static bool write_file(const char *path, const struct grrl_learner *learner)
{
    FILE *file = fopen(path, "wb");
    if (file == NULL)
        return false;
    struct grrl_experience_io io = {.context = file, .write = write_bytes};
    bool good =
        grrl_learner_save(learner, &io) == GRRL_OK && fflush(file) == 0 && fsync(fileno(file)) == 0;
    int reason = errno;
    good = fclose(file) == 0 && good;
    if (!good && reason != 0)
        errno = reason;
    return good;
}

bool grrl_store_file_save(const char *path, const struct grrl_learner *learner,
                          struct grrl_store_error *error)
{
    char temporary[PATH_BYTES];
    int length = snprintf(temporary, sizeof temporary, "%s.new", path);
    if (length < 0 || (size_t)length >= sizeof temporary)
        return fail(error, path, "the name is too long");
    errno = 0;
    if (write_file(temporary, learner) && rename(temporary, path) == 0 && sync_folder(path))
        return true;
    int reason = errno;
    (void)unlink(temporary);
    return fail(error, path, strerror(reason));
}
