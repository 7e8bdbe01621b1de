/*
 * disk.h: a simulated disk that can lose power, behind the calls of store_file.h.
 *
 * Written data is volatile until its file is synced. A name that was made, moved or removed is
 * volatile until the folder is synced. Power fails at a chosen call. disk_reboot then chooses which
 * of the volatile changes had reached the disk: any subset of the changes of names, and for a
 * file's bytes a prefix, a prefix followed by zeros, or all but one block. Include after cmocka.h.
 */
#ifndef GRRL_TESTS_DISK_H
#define GRRL_TESTS_DISK_H

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>

#include "store_file.h"

enum {
    DISK_FILES = 8,
    DISK_BYTES = 8192,
    DISK_NAMES = 8,
    DISK_PATH = 64,
    DISK_CHANGES = 8,
    DISK_WRITE = 200, /* the most that one write accepts, so that the writer must continue */
    DISK_BLOCK = 64,
    DISK_FOLDER = DISK_FILES /* stands for a file when a descriptor refers to the folder */
};

struct disk_content {
    size_t size;
    uint8_t bytes[DISK_BYTES];
};

struct disk_names {
    struct {
        char path[DISK_PATH];
        int file; /* -1: free */
    } entry[DISK_NAMES];
};

/* A change of names, made durable by syncing the folder. */
struct disk_change {
    char from[DISK_PATH]; /* empty: made */
    char to[DISK_PATH];   /* empty: removed */
    int file;
};

struct disk {
    struct disk_content now[DISK_FILES];
    struct disk_content durable[DISK_FILES];
    int n_files;
    struct disk_names names;
    struct disk_names durable_names;
    struct disk_change change[DISK_CHANGES];
    int n_changes;
    struct {
        int file; /* -1: closed */
        size_t at;
    } open[4];
    long calls;   /* so far */
    long cut_at;  /* the call at which power fails, from 0 */
    size_t torn;  /* if that call is a write: the bytes still written */
    long fail_at; /* the only call that fails with ENOSPC */
    bool off;
    bool cut_write; /* the failing call was a write of more than `torn` bytes */
    bool syncs_lie; /* for files: shows that the test detects it */
    bool folder_syncs_lie;
};

/* The state in which the disk comes back. */
struct disk_fate {
    unsigned changes; /* bit i: change i of names reached the disk */
    size_t prefix;    /* bytes of a volatile file that reached the disk */
    bool zeros;       /* the rest of its length reads as zeros */
    size_t hole;      /* offset of a block of zeros; SIZE_MAX: none */
};

static inline void disk_copy_path(char to[DISK_PATH], const char *path)
{
    size_t length = strlen(path);
    assert_true(length < DISK_PATH);
    memmove(to, path, length + 1);
}

static inline int *disk_find(struct disk_names *names, const char *path)
{
    for (int i = 0; i < DISK_NAMES; i++)
        if (names->entry[i].file >= 0 && strcmp(names->entry[i].path, path) == 0)
            return &names->entry[i].file;
    return NULL;
}

static inline void disk_set_name(struct disk_names *names, const char *path, int file)
{
    int *known = disk_find(names, path);
    for (int i = 0; known == NULL && file >= 0 && i < DISK_NAMES; i++) {
        if (names->entry[i].file < 0) {
            disk_copy_path(names->entry[i].path, path);
            known = &names->entry[i].file;
        }
    }
    if (known != NULL)
        *known = file;
}

static inline void disk_apply(struct disk_names *names, const struct disk_change *change)
{
    if (change->from[0] != '\0')
        disk_set_name(names, change->from, -1);
    if (change->to[0] != '\0')
        disk_set_name(names, change->to, change->file);
}

static inline void disk_record(struct disk *disk, const char *from, const char *to, int file)
{
    struct disk_change *change = &disk->change[disk->n_changes++];
    disk_copy_path(change->from, from);
    disk_copy_path(change->to, to);
    change->file = file;
    disk_apply(&disk->names, change);
}

/* Whether the call succeeds: power may fail at it, or the call may fail. */
static inline bool disk_works(struct disk *disk)
{
    long call = disk->calls++;
    if (call == disk->cut_at)
        disk->off = true;
    errno = call == disk->fail_at ? ENOSPC : EIO;
    return !disk->off && call != disk->fail_at;
}

static inline int disk_open(void *context, const char *path, int flags)
{
    struct disk *disk = context;
    if (!disk_works(disk))
        return -1;
    int *known = disk_find(&disk->names, path);
    int file = known != NULL ? *known : -1;
    if ((flags & O_DIRECTORY) != 0) {
        file = DISK_FOLDER;
    } else if (known != NULL && (flags & O_EXCL) != 0) {
        errno = EEXIST;
        return -1;
    } else if (known == NULL && (flags & O_CREAT) == 0) {
        errno = ENOENT;
        return -1;
    } else if (known == NULL) {
        file = disk->n_files++;
        disk_record(disk, "", path, file);
    } else if ((flags & O_TRUNC) != 0) {
        disk->now[file].size = 0;
    }
    int fd = 0;
    while (disk->open[fd].file >= 0)
        fd++;
    disk->open[fd].file = file;
    disk->open[fd].at = 0;
    return fd;
}

static inline ssize_t disk_read(void *context, int fd, void *bytes, size_t size)
{
    struct disk *disk = context;
    if (!disk_works(disk))
        return -1;
    const struct disk_content *content = &disk->now[disk->open[fd].file];
    size_t n = content->size - disk->open[fd].at;
    n = n < size ? n : size;
    memcpy(bytes, content->bytes + disk->open[fd].at, n);
    disk->open[fd].at += n;
    return (ssize_t)n;
}

static inline ssize_t disk_write(void *context, int fd, const void *bytes, size_t size)
{
    struct disk *disk = context;
    struct disk_content *content = &disk->now[disk->open[fd].file];
    size_t n = size < DISK_WRITE ? size : DISK_WRITE;
    bool was_off = disk->off;
    if (!disk_works(disk)) {
        if (was_off || !disk->off)
            return -1;
        disk->cut_write = disk->torn < n;
        n = disk->torn < n ? disk->torn : n;
    }
    memcpy(content->bytes + disk->open[fd].at, bytes, n);
    disk->open[fd].at += n;
    content->size = disk->open[fd].at;
    return disk->off ? -1 : (ssize_t)n;
}

static inline int disk_sync(void *context, int fd)
{
    struct disk *disk = context;
    if (!disk_works(disk))
        return -1;
    int file = disk->open[fd].file;
    if (file == DISK_FOLDER && !disk->folder_syncs_lie) {
        disk->durable_names = disk->names;
        disk->n_changes = 0;
    } else if (file != DISK_FOLDER && !disk->syncs_lie) {
        disk->durable[file] = disk->now[file];
    }
    return 0;
}

static inline int disk_close(void *context, int fd)
{
    struct disk *disk = context;
    disk->open[fd].file = -1;
    return disk_works(disk) ? 0 : -1;
}

static inline int disk_rename(void *context, const char *from, const char *to)
{
    struct disk *disk = context;
    if (!disk_works(disk))
        return -1;
    disk_record(disk, from, to, *disk_find(&disk->names, from));
    return 0;
}

static inline int disk_remove(void *context, const char *path)
{
    struct disk *disk = context;
    if (!disk_works(disk))
        return -1;
    disk_record(disk, path, "", -1);
    return 0;
}

static inline struct grrl_file_calls disk_calls(struct disk *disk)
{
    return (struct grrl_file_calls){disk,      disk_open,  disk_read,   disk_write,
                                    disk_sync, disk_close, disk_rename, disk_remove};
}

static inline void disk_power_on(struct disk *disk)
{
    disk->calls = 0;
    disk->cut_at = -1;
    disk->fail_at = -1;
    disk->off = false;
    for (int i = 0; i < 4; i++)
        disk->open[i].file = -1;
}

static inline void disk_init(struct disk *disk)
{
    memset(disk, 0, sizeof *disk);
    for (int i = 0; i < DISK_NAMES; i++)
        disk->names.entry[i].file = disk->durable_names.entry[i].file = -1;
    disk_power_on(disk);
}

/* Puts a durable file on the disk. */
static inline void disk_put(struct disk *disk, const char *path, const struct disk_content *content)
{
    int file = disk->n_files++;
    disk->now[file] = disk->durable[file] = *content;
    disk_set_name(&disk->names, path, file);
    disk_set_name(&disk->durable_names, path, file);
}

static inline bool disk_is_volatile(const struct disk *disk, int file)
{
    return disk->now[file].size != disk->durable[file].size ||
           memcmp(disk->now[file].bytes, disk->durable[file].bytes, disk->now[file].size) != 0;
}

static inline const struct disk_content *disk_content(struct disk *disk, const char *path)
{
    const int *file = disk_find(&disk->names, path);
    return file == NULL ? NULL : &disk->now[*file];
}

/* Makes the disk as it is after power returns, according to *fate; leaves the old
 * disk unchanged. */
static inline void disk_reboot(const struct disk *disk, const struct disk_fate *fate,
                               struct disk *after)
{
    *after = *disk;
    after->names = disk->durable_names;
    for (int i = 0; i < disk->n_changes; i++)
        if ((fate->changes >> i & 1u) != 0)
            disk_apply(&after->names, &disk->change[i]);
    for (int file = 0; file < disk->n_files; file++) {
        struct disk_content *content = &after->now[file];
        if (!disk_is_volatile(disk, file))
            continue;
        size_t kept = fate->prefix < content->size ? fate->prefix : content->size;
        memset(content->bytes + kept, 0, content->size - kept);
        if (fate->hole < content->size)
            memset(content->bytes + fate->hole, 0,
                   content->size - fate->hole < DISK_BLOCK ? content->size - fate->hole
                                                           : (size_t)DISK_BLOCK);
        if (!fate->zeros)
            content->size = kept;
        after->durable[file] = *content;
    }
    after->durable_names = after->names;
    after->n_changes = 0;
    disk_power_on(after);
}

#endif
