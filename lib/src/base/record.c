/* Little-endian numbers, and records with a running CRC-32. */
#include "base/record.h"

#include <stdbool.h>
#include <string.h>

/* CRC-32 (IEEE 802.3), bit by bit: files are small, and a table would take a kilobyte. */
static uint32_t crc_of(uint32_t crc, const uint8_t *bytes, size_t n)
{
    crc = ~crc;
    for (size_t i = 0; i < n; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = (crc >> 1) ^ (UINT32_C(0xedb88320) & (0u - (crc & 1u)));
    }
    return ~crc;
}

void grrl_record_put(struct grrl_record *record, uint64_t value, unsigned bytes)
{
    for (unsigned i = 0; i < bytes; i++)
        record->bytes[record->n++] = (uint8_t)(value >> (8 * i));
}

void grrl_record_put_float(struct grrl_record *record, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    grrl_record_put(record, bits, 4);
}

enum grrl_status grrl_record_write(struct grrl_record *record)
{
    record->crc = crc_of(record->crc, record->bytes, record->n);
    grrl_record_put(record, record->crc, GRRL_RECORD_CRC_BYTES);
    int failed = record->io->write(record->io->context, record->bytes, record->n);
    record->n = 0;
    return failed != 0 ? GRRL_ERR_IO : GRRL_OK;
}

enum grrl_status grrl_record_read(struct grrl_record *record, size_t bytes)
{
    int failed = record->io->read(record->io->context, record->bytes + record->n, bytes);
    return failed != 0 ? GRRL_ERR_IO : GRRL_OK;
}

uint64_t grrl_record_take(struct grrl_record *record, unsigned bytes)
{
    uint64_t value = 0;
    for (unsigned i = 0; i < bytes; i++)
        value |= (uint64_t)record->bytes[record->n++] << (8 * i);
    return value;
}

float grrl_record_take_float(struct grrl_record *record)
{
    uint32_t bits = (uint32_t)grrl_record_take(record, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

enum grrl_status grrl_record_check(struct grrl_record *record, size_t bytes)
{
    record->crc = crc_of(record->crc, record->bytes, bytes);
    record->n = bytes;
    bool fine = grrl_record_take(record, GRRL_RECORD_CRC_BYTES) == record->crc;
    record->n = 0;
    return fine ? GRRL_OK : GRRL_ERR_CORRUPT;
}
