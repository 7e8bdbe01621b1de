/*
 * fuzz.h: shared by the fuzz targets. A target is fuzz_<name>.c, which defines
 * LLVMFuzzerTestOneInput. It returns for any input, and its requirements hold.
 *
 * The same file is built twice: with libFuzzer (preset fuzz, run by tools/fuzz), and with replay.c,
 * which runs the stored corpus as a test in the other presets.
 */
#ifndef GRRL_FUZZ_H
#define GRRL_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef __cplusplus
extern "C" {
#endif
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
#ifdef __cplusplus
}
#endif

static inline void fuzz_require(bool holds, const char *what, const char *file, int line)
{
    if (holds)
        return;
    (void)fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, what);
    abort();
}

#define REQUIRE(condition) fuzz_require(condition, #condition, __FILE__, __LINE__)

/* Reads an input from the front; zeros beyond the end. */
struct fuzz_input {
    const uint8_t *data;
    size_t left;
};

static inline uint8_t fuzz_byte(struct fuzz_input *input)
{
    if (input->left == 0)
        return 0;
    input->left--;
    return *input->data++;
}

#endif
