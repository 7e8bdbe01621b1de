/*
 * legacy_store.h (private): stores of version 0.1.0 held the data of both learners: experiences in
 * a section of version 2, then cases. Now each policy has its own file. An old file still loads if
 * the other learner's section is empty.
 */
#ifndef GRRL_LEGACY_STORE_H
#define GRRL_LEGACY_STORE_H

#include <stdbool.h>

#include "base/record.h"

/*
 * The record holds the first `taken` bytes of a file that does not begin with cases. Skips an empty
 * section of experiences and starts the next record. GRRL_ERR_POLICY: the section holds
 * experiences, of the policy paper. GRRL_ERR_FORMAT, GRRL_ERR_IO, GRRL_ERR_CORRUPT.
 */
GRRL_MUST_USE enum grrl_status grrl_legacy_skip_experiences(struct grrl_record *record,
                                                            size_t taken);

/* Reads the section of cases that follows experiences of version 2. GRRL_ERR_POLICY: it is not
 * empty. */
GRRL_MUST_USE enum grrl_status grrl_legacy_skip_cases(const struct grrl_io *io);

/* Whether a file with this magic holds cases. */
bool grrl_legacy_is_cases(const uint8_t magic[8]);

#endif
