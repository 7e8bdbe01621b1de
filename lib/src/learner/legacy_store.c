/* legacy_store.c: skips the other learner's section in a store of version 0.1.0. */
#include "learner/legacy_store.h"

#include <string.h>

static const uint8_t experiences_magic[8] = {'G', 'R', 'R', 'L', 'e', 'x', 'p', 0};
static const uint8_t cases_magic[8] = {'G', 'R', 'R', 'L', 'c', 'a', 's', 0};

enum { OLD_VERSION = 2, EXPERIENCES_HEADER = 24, CASES_HEADER = 20, CASES_LOG_ODDS = 4 };

bool grrl_legacy_is_cases(const uint8_t magic[8])
{
    return memcmp(magic, cases_magic, sizeof cases_magic) == 0;
}

enum grrl_status grrl_legacy_skip_experiences(struct grrl_record *record, size_t taken)
{
    if (memcmp(record->bytes, experiences_magic, sizeof experiences_magic) != 0)
        return GRRL_ERR_FORMAT;
    record->n = sizeof experiences_magic;
    uint64_t version = grrl_record_take(record, 2);
    (void)grrl_record_take(record, 2); /* properties, directions */
    uint64_t states = grrl_record_take(record, 4);
    if (version != OLD_VERSION || states != 0)
        return GRRL_ERR_POLICY;
    record->n = taken;
    if (grrl_record_read(record, EXPERIENCES_HEADER + GRRL_RECORD_CRC_BYTES - taken) != GRRL_OK)
        return GRRL_ERR_IO;
    if (grrl_record_check(record, EXPERIENCES_HEADER) != GRRL_OK)
        return GRRL_ERR_CORRUPT;
    *record = (struct grrl_record){.io = record->io};
    return GRRL_OK;
}

enum grrl_status grrl_legacy_skip_cases(const struct grrl_io *io)
{
    struct grrl_record record = {.io = io};
    if (grrl_record_read(&record, CASES_HEADER + GRRL_RECORD_CRC_BYTES) != GRRL_OK)
        return GRRL_ERR_IO;
    if (!grrl_legacy_is_cases(record.bytes))
        return GRRL_ERR_CORRUPT;
    record.n = 12; /* magic, version, parts, zero */
    uint64_t cases = grrl_record_take(&record, 4);
    if (grrl_record_check(&record, CASES_HEADER) != GRRL_OK)
        return GRRL_ERR_CORRUPT;
    if (cases != 0)
        return GRRL_ERR_POLICY;
    if (grrl_record_read(&record, CASES_LOG_ODDS + GRRL_RECORD_CRC_BYTES) != GRRL_OK)
        return GRRL_ERR_IO;
    return grrl_record_check(&record, CASES_LOG_ODDS);
}
