/* case_file.c: the case base as bytes. */
#include <string.h>

#include "base/record.h"
#include "grrl/base/geometry.h"
#include "grrl/learner/cases/case_base.h"
#include "learner/legacy_store.h"

/* The layout is described in case_base.h. */
enum { FILE_VERSION = 3, HEADER_BYTES = 20, LOG_ODDS_BYTES = 4, CASE_BYTES = 24 };

_Static_assert((int)GRRL_RECORD_BYTES >= (int)HEADER_BYTES &&
                   (int)GRRL_RECORD_BYTES >= (int)CASE_BYTES,
               "every record fits");

static const uint8_t magic[8] = {'G', 'R', 'R', 'L', 'c', 'a', 's', 0};

enum grrl_status grrl_cases_save(const struct grrl_case_base *base, const struct grrl_io *io)
{
    struct grrl_record record = {.io = io};
    memcpy(record.bytes, magic, sizeof magic);
    record.n = sizeof magic;
    grrl_record_put(&record, FILE_VERSION, 2);
    grrl_record_put(&record, GRRL_CONTEXT_PARTS, 1);
    grrl_record_put(&record, 0, 1);
    grrl_record_put(&record, base->n, 4);
    grrl_record_put(&record, base->clock, 4);
    enum grrl_status status = grrl_record_write(&record);
    if (status == GRRL_OK) {
        grrl_record_put_float(&record, base->log_odds);
        status = grrl_record_write(&record);
    }
    for (uint32_t i = 0; i < base->n && status == GRRL_OK; i++) {
        const struct grrl_case *met = &base->cases[i];
        grrl_record_put(&record, met->key, 4);
        grrl_record_put(&record, met->n_all, 1);
        grrl_record_put(&record, met->n_found, 1);
        grrl_record_put(&record, met->n, 1);
        grrl_record_put(&record, met->n_new, 1);
        grrl_record_put(&record, met->used_at, 4);
        grrl_record_put_float(&record, met->value_all);
        grrl_record_put_float(&record, met->value);
        grrl_record_put_float(&record, met->value_new);
        status = grrl_record_write(&record);
    }
    return status;
}

static enum grrl_status read_header(const struct grrl_case_base *base, struct grrl_record *record,
                                    uint32_t *n, uint32_t *clock)
{
    if (grrl_record_read(record, HEADER_BYTES + GRRL_RECORD_CRC_BYTES) != GRRL_OK)
        return GRRL_ERR_IO;
    if (memcmp(record->bytes, magic, sizeof magic) != 0) {
        enum grrl_status status =
            grrl_legacy_skip_experiences(record, HEADER_BYTES + GRRL_RECORD_CRC_BYTES);
        if (status != GRRL_OK)
            return status;
        if (grrl_record_read(record, HEADER_BYTES + GRRL_RECORD_CRC_BYTES) != GRRL_OK)
            return GRRL_ERR_IO;
        if (memcmp(record->bytes, magic, sizeof magic) != 0)
            return GRRL_ERR_CORRUPT;
    }
    record->n = sizeof magic;
    bool known = grrl_record_take(record, 2) == FILE_VERSION;
    known = grrl_record_take(record, 1) == GRRL_CONTEXT_PARTS && known;
    bool fine = grrl_record_take(record, 1) == 0;
    *n = (uint32_t)grrl_record_take(record, 4);
    *clock = (uint32_t)grrl_record_take(record, 4);
    if (grrl_record_check(record, HEADER_BYTES) != GRRL_OK)
        return GRRL_ERR_CORRUPT;
    if (!known)
        return GRRL_ERR_VERSION;
    if (*n > base->capacity)
        return GRRL_ERR_FULL;
    return fine ? GRRL_OK : GRRL_ERR_CORRUPT;
}

/* Written so that NaN is never in range. */
static bool is_within_max(float x)
{
    return x >= -GRRL_MAX_REWARD && x <= GRRL_MAX_REWARD;
}

static enum grrl_status read_log_odds(struct grrl_record *record, float *log_odds)
{
    if (grrl_record_read(record, LOG_ODDS_BYTES + GRRL_RECORD_CRC_BYTES) != GRRL_OK)
        return GRRL_ERR_IO;
    *log_odds = grrl_record_take_float(record);
    bool fine = grrl_record_check(record, LOG_ODDS_BYTES) == GRRL_OK && is_within_max(*log_odds);
    return fine ? GRRL_OK : GRRL_ERR_CORRUPT;
}

static bool is_key(uint32_t key)
{
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        if (grrl_context_part(key, i) > grrl_context_max[i])
            return false;
    return (key & ~grrl_context_key_bits(GRRL_ALL_CONTEXT_PARTS)) == 0;
}

/* Whether a case is consistent with those read so far: contexts and times must be unique. */
static bool is_new(const struct grrl_case_base *base, const struct grrl_case *met)
{
    for (uint32_t i = 0; i < base->n; i++)
        if (base->cases[i].key == met->key || base->cases[i].used_at == met->used_at)
            return false;
    return true;
}

static enum grrl_status read_case(struct grrl_case_base *base, struct grrl_record *record,
                                  uint32_t clock)
{
    if (grrl_record_read(record, CASE_BYTES + GRRL_RECORD_CRC_BYTES) != GRRL_OK)
        return GRRL_ERR_IO;
    struct grrl_case met = {.n = 0};
    met.key = (uint32_t)grrl_record_take(record, 4);
    met.n_all = (uint8_t)grrl_record_take(record, 1);
    met.n_found = (uint8_t)grrl_record_take(record, 1);
    met.n = (uint8_t)grrl_record_take(record, 1);
    met.n_new = (uint8_t)grrl_record_take(record, 1);
    met.used_at = (uint32_t)grrl_record_take(record, 4);
    met.value_all = grrl_record_take_float(record);
    met.value = grrl_record_take_float(record);
    met.value_new = grrl_record_take_float(record);
    bool fine = grrl_record_check(record, CASE_BYTES) == GRRL_OK && is_key(met.key) &&
                met.n_all > 0 && met.n_all <= GRRL_CASE_REWARDS && met.n_found <= met.n_all &&
                met.used_at <= clock && is_within_max(met.value_all) && is_within_max(met.value) &&
                is_within_max(met.value_new) && is_new(base, &met);
    if (!fine)
        return GRRL_ERR_CORRUPT;
    base->cases[base->n++] = met;
    return GRRL_OK;
}

enum grrl_status grrl_cases_load(struct grrl_case_base *base, const struct grrl_io *io,
                                 uint32_t *lost)
{
    struct grrl_record record = {.io = io};
    uint32_t n = 0;
    uint32_t clock = 0;
    grrl_cases_clear(base);
    enum grrl_status status = read_header(base, &record, &n, &clock);
    float log_odds = 0.0f;
    if (status == GRRL_OK)
        status = read_log_odds(&record, &log_odds);
    for (uint32_t i = 0; i < n && status == GRRL_OK; i++)
        status = read_case(base, &record, clock);
    *lost = 0;
    if (status != GRRL_OK && status != GRRL_ERR_IO) {
        grrl_cases_clear(base);
        return status;
    }
    *lost = n - base->n;
    base->high_water = base->n;
    base->clock = clock;
    base->log_odds = log_odds;
    return status;
}
