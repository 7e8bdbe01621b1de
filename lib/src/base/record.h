/*
 * record.h (private): the library's files are sequences of records, little-endian on every machine.
 * A CRC-32 follows each record and continues from the previous one, so records cannot be swapped.
 */
#ifndef GRRL_RECORD_H
#define GRRL_RECORD_H

#include <stddef.h>
#include <stdint.h>

#include "grrl/base/config.h"
#include "grrl/base/io.h"
#include "grrl/base/status.h"

enum { GRRL_RECORD_BYTES = 32 + 16 * GRRL_MAX_LINKS, GRRL_RECORD_CRC_BYTES = 4 };

/* One record being written or read, and the CRC so far. */
struct grrl_record {
    const struct grrl_io *io;
    uint32_t crc;
    size_t n; /* bytes put or taken */
    uint8_t bytes[GRRL_RECORD_BYTES + GRRL_RECORD_CRC_BYTES];
};

/* Appends the lowest `bytes` bytes of a number. */
void grrl_record_put(struct grrl_record *record, uint64_t value, unsigned bytes);
void grrl_record_put_float(struct grrl_record *record, float value);

/* Writes the bytes put so far and the CRC, then starts the next record. GRRL_ERR_IO. */
GRRL_MUST_USE enum grrl_status grrl_record_write(struct grrl_record *record);

/* Reads `bytes` more bytes, behind those already taken. GRRL_ERR_IO. */
GRRL_MUST_USE enum grrl_status grrl_record_read(struct grrl_record *record, size_t bytes);

uint64_t grrl_record_take(struct grrl_record *record, unsigned bytes);
float grrl_record_take_float(struct grrl_record *record);

/* Checks the CRC behind a record of `bytes` bytes, then starts the next record.
 * GRRL_ERR_CORRUPT. */
GRRL_MUST_USE enum grrl_status grrl_record_check(struct grrl_record *record, size_t bytes);

#endif
