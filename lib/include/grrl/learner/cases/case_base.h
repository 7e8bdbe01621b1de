/*
 * case_base.h: what was earned in which context, and what that lets expect in another.
 *
 * A case is a context with the mean of the latest rewards met in it: the experience of many states
 * and objects, generalised to what they have in common around the link pushed. An estimate is the
 * mean over all cases, each weighing less for every part in which it differs (kernel regression:
 * Nadaraya, Theory Probab. Appl. 9, 1964; instance-based: Aha, Kibler & Albert, Machine Learning 6,
 * 1991), and over a prior.
 *
 * The object of a trial may be of another kind than those before, and nobody says so. Rewards of
 * the running trial are therefore kept apart: what a push finds is compared with what all rewards
 * let expect and with what those of this trial alone do (a Bayes factor of "as known" against
 * "another"), and older rewards count as much as it is likely that the object is as known. The next
 * trial begins with both joined; where the last one ended in doubt, in the measure of the doubt,
 * older rewards then count less for good, and those of that trial more. Old cases keep one reward,
 * so that they still speak where nothing else does.
 *
 * The memory is the caller's and fixed; when it is full, the case not met for the longest time
 * makes room.
 *
 * Order of calls: grrl_cases_init; grrl_cases_begin_trial for each trial; then grrl_cases_estimate
 * as often as wanted and grrl_cases_learn once for each push.
 */
#ifndef GRRL_CASE_BASE_H
#define GRRL_CASE_BASE_H

#include "grrl/base/api.h"
#include "grrl/base/io.h"
#include "grrl/learner/cases/context.h"

GRRL_API_BEGIN

/* Fill with grrl_case_config_default, then change what differs. */
struct grrl_case_config {
    float prior;        /* reward expected of what was never met; 0.5 */
    float prior_weight; /* in rewards met, > 0; 1 */
    float mismatch;     /* weight of a case for each part that differs, [0, 1]; 0.2 */
    float bound;        /* upper bound = estimate + bound / sqrt(weight), >= 0; 0.4 */
    float confidence;   /* log odds, at first and at most, that the object is as known, >= 0; 0.5 */
    float present;      /* further times that a reward of the running trial counts, >= 0; 3 */
    uint8_t memory;     /* rewards that a case remembers, old or new, >= 1; 5 */
    uint16_t parts;     /* bit i: part i of a context counts; all */
};

#define GRRL_ALL_CONTEXT_PARTS ((1u << GRRL_CONTEXT_PARTS) - 1u)

struct grrl_case {
    struct grrl_context context;
    uint8_t n;        /* rewards of earlier trials, up to the memory */
    uint8_t n_new;    /* those of this trial, likewise */
    float value;      /* mean of the former, of the latest `memory` by decay */
    float value_new;  /* of the latter */
    uint32_t used_at; /* clock */
};

struct grrl_case_base {
    /* readable */
    uint32_t n;
    uint32_t capacity;
    uint32_t high_water; /* most cases at a time */
    uint32_t evictions;
    float log_odds; /* that the object is as known: -4 to confidence; 0 before any is */
    /* private */
    uint32_t clock;
    struct grrl_case *cases;
};

#define GRRL_NO_CASE UINT32_MAX

/* What is expected of an action, and what it rests on. */
struct grrl_estimate {
    float value;
    float lower; /* value -+ bound / sqrt(weight) */
    float upper;
    float weight;       /* of all cases and the prior, in rewards met */
    uint32_t closest;   /* the case with the fewest differing parts, of these the one that weighs
                           most, of these the first; GRRL_NO_CASE without any */
    uint8_t mismatches; /* parts in which it differs */
};

void grrl_case_config_default(struct grrl_case_config *config);

/* GRRL_ERR_ARGUMENT for a parameter outside its range; *field, if not NULL, names it. */
GRRL_MUST_USE enum grrl_status grrl_case_config_check(const struct grrl_case_config *config,
                                                      const char **field);

/* An empty base in the caller's memory, which it keeps. With a capacity of 0 (cases may be NULL)
 * nothing is remembered. */
void grrl_cases_init(struct grrl_case_base *base, struct grrl_case *cases, uint32_t capacity);

/* Forgets everything; the memory stays. */
void grrl_cases_clear(struct grrl_case_base *base);

/* What is met from now on belongs to another trial. A second call without a reward between changes
 * nothing. */
void grrl_cases_begin_trial(struct grrl_case_base *base, const struct grrl_case_config *config);

/* Cost: linear in cases, some 40 instructions each. */
void grrl_cases_estimate(const struct grrl_case_base *base, const struct grrl_case_config *config,
                         const struct grrl_context *context, struct grrl_estimate *estimate);

/* Adds a reward, finite and within +-GRRL_MAX_REWARD. Returns the index of its case, which may be
 * that of one evicted, or GRRL_NO_CASE with a capacity of 0. */
uint32_t grrl_cases_learn(struct grrl_case_base *base, const struct grrl_case_config *config,
                          const struct grrl_context *context, float reward);

#define GRRL_MAX_REWARD 1.0e6f

/*
 * The cases as bytes, as in experience.h. A header: magic "GRRLcas" and zero, version (2 bytes),
 * parts of a context (1), zero (1), cases (4), clock (4). Then log odds (4). A case: its context, n
 * (1), n_new (1), used at (4), value (4), value_new (4). A CRC-32 (4) follows each of these and
 * runs on. GRRL_ERR_IO.
 */
GRRL_MUST_USE enum grrl_status grrl_cases_save(const struct grrl_case_base *base,
                                               const struct grrl_io *io);

/* Replaces the cases; statuses as of grrl_experience_load, and empty after a failure. */
GRRL_MUST_USE enum grrl_status grrl_cases_load(struct grrl_case_base *base,
                                               const struct grrl_io *io);

/* As grrl_experience_load_torn. */
GRRL_MUST_USE enum grrl_status grrl_cases_load_torn(struct grrl_case_base *base,
                                                    const struct grrl_io *io, uint32_t *lost);

GRRL_API_END

#endif
