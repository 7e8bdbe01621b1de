/* memory_file.h: a file in memory, for code that saves and loads through grrl_io. */
#ifndef GRRL_MEMORY_FILE_H
#define GRRL_MEMORY_FILE_H

#include <stdint.h>
#include <string.h>

#include "grrl/base/io.h"

enum { MEMORY_FILE_BYTES = 1 << 16 };

struct memory_file {
    uint8_t bytes[MEMORY_FILE_BYTES];
    size_t size;
    size_t at;      /* position of the next read */
    int calls_left; /* calls left before one fails; negative: none fails */
};

static inline int memory_file_fails(struct memory_file *file)
{
    return file->calls_left >= 0 && file->calls_left-- == 0;
}

static inline int memory_file_write(void *context, const void *bytes, size_t size)
{
    struct memory_file *file = (struct memory_file *)context;
    if (memory_file_fails(file) || size > MEMORY_FILE_BYTES - file->size)
        return -1;
    memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
    return 0;
}

static inline int memory_file_read(void *context, void *bytes, size_t size)
{
    struct memory_file *file = (struct memory_file *)context;
    if (memory_file_fails(file) || size > file->size - file->at)
        return -1;
    memcpy(bytes, file->bytes + file->at, size);
    file->at += size;
    return 0;
}

static inline struct grrl_io memory_file_io(struct memory_file *file)
{
    return (struct grrl_io){.context = file, .write = memory_file_write, .read = memory_file_read};
}

#endif
