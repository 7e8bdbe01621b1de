/* shipped_store.c: finds the store from /proc/self/exe. */
#define _POSIX_C_SOURCE 200809L

#include "shipped_store.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#ifndef GRRL_STORES_FROM_PROGRAM
#error "GRRL_STORES_FROM_PROGRAM comes from the build"
#endif

enum { PATH_BYTES = 4096 };

void grrl_shipped_store_path(const char *name, size_t capacity, char *path)
{
    char program[PATH_BYTES];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(program, '/');
    if (strcmp(name, "mixed") == 0 && slash != NULL) {
        *slash = '\0';
        (void)snprintf(path, capacity, "%s/" GRRL_STORES_FROM_PROGRAM "/mixed.store", program);
    } else {
        (void)snprintf(path, capacity, "%s", name);
    }
}
