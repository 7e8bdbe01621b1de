/*
 * case_base.h: stores rewards by context and predicts rewards in similar contexts.
 *
 * A case is a context with the mean of the latest rewards met in it. It covers many states and
 * objects, generalised to what they share around the pushed link. The estimate is a weighted mean
 * over all cases and a prior; every part in which a case differs lowers its weight (kernel
 * regression: Nadaraya, Theory Probab. Appl. 9, 1964; instance-based learning: Aha, Kibler &
 * Albert, Machine Learning 6, 1991).
 *
 * A trial may bring an object of another kind, and nobody announces it. So rewards of the running
 * trial are kept apart. Each outcome is compared under two predictions, one from all rewards and
 * one from this trial's rewards alone. Their likelihood ratio (a Bayes factor of "object as known"
 * against "object changed") updates P(object as known), the weight of older rewards. At the
 * next trial both kinds are merged. If the last trial ended in doubt, the merge permanently lowers
 * the weight of older rewards and raises that trial's, in proportion to P(object changed). Old
 * cases keep one reward, so that they still count where nothing else is known.
 *
 * What all other objects so far have in common outlives doubt. Each case also keeps the mean of all
 * its rewards, and the mean of these over all cases, with a narrower kernel, is the prior of the
 * object at hand. A case counts there by the share of its rewards that are of other objects. The
 * weight of the prior is limited, so a few rewards of this object outweigh it.
 *
 * The memory is fixed and belongs to the caller. When it is full, the case that was met least
 * recently is evicted.
 *
 * Order of calls: grrl_cases_init; grrl_cases_begin_trial for each trial; then grrl_cases_estimate
 * as often as needed and grrl_cases_learn once for each push.
 */
#ifndef GRRL_CASE_BASE_H
#define GRRL_CASE_BASE_H

#include "grrl/base/api.h"
#include "grrl/base/io.h"
#include "grrl/learner/cases/context.h"

GRRL_API_BEGIN

/* Fill with grrl_case_config_default, then change what should differ. */
struct grrl_case_config {
    float prior;            /* expected reward where nothing was met; 0.5 */
    float prior_weight;     /* weight of the prior, in rewards, > 0; 1 */
    float mismatch;         /* factor on a case's weight for each part that differs, [0, 1]; 0.2 */
    float general;          /* highest weight of other objects as the prior, >= 0; 3 */
    float general_mismatch; /* as mismatch, in that prior, [0, 1]; 0.1 */
    float bound;            /* upper bound = estimate + bound / sqrt(weight), >= 0; 0.4 */
    float confidence; /* initial and highest log odds that the object is as known, >= 0; 0.5 */
    float present;    /* extra weight of a reward from the running trial, >= 0; 3 */
    uint8_t memory;   /* rewards a case remembers, old or new, >= 1; 5 */
    uint16_t parts;   /* bit i: part i of a context counts; default all */
};

#define GRRL_ALL_CONTEXT_PARTS ((1u << GRRL_CONTEXT_PARTS) - 1u)

enum { GRRL_CASE_REWARDS = 50 };

struct grrl_case {
    uint32_t key;     /* of the context */
    uint8_t n_all;    /* rewards ever; halved at GRRL_CASE_REWARDS */
    uint8_t n_found;  /* of these, the pushes that revealed something */
    uint8_t n;        /* rewards from earlier trials, at most `memory` */
    uint8_t n_new;    /* rewards from this trial, at most `memory` */
    float value_all;  /* running mean of rewards ever */
    float value;      /* of rewards from earlier trials, over about the latest `memory` */
    float value_new;  /* of rewards from this trial */
    uint32_t used_at; /* value of the clock when last met */
};

struct grrl_case_base {
    /* readable */
    uint32_t n;
    uint32_t capacity;
    uint32_t high_water; /* largest number of cases so far */
    uint32_t evictions;
    float log_odds; /* that the object is as known: -1 to confidence; 0 at first */
    /* private */
    uint32_t clock;
    struct grrl_case *cases;
};

#define GRRL_NO_CASE UINT32_MAX

/* The expected reward of an action, and its basis. */
struct grrl_estimate {
    float value;
    float lower; /* value - bound / sqrt(weight) */
    float upper;
    float weight;       /* total weight of the cases and the prior, in rewards */
    uint32_t closest;   /* the case with the fewest differing parts; ties go to the larger weight,
                           then to the lower index; GRRL_NO_CASE if there are no cases */
    uint8_t mismatches; /* parts in which the closest case differs */
};

void grrl_case_config_default(struct grrl_case_config *config);

/* GRRL_ERR_ARGUMENT for a parameter outside its range; *field, if not NULL, names it. */
GRRL_MUST_USE enum grrl_status grrl_case_config_check(const struct grrl_case_config *config,
                                                      const char **field);

/* Makes an empty case base in the caller's memory, which must outlive it. With capacity 0 (cases
 * may be NULL) it remembers nothing. */
void grrl_cases_init(struct grrl_case_base *base, struct grrl_case *cases, uint32_t capacity);

/* Forgets all cases; keeps the memory. */
void grrl_cases_clear(struct grrl_case_base *base);

/* Starts a trial: later rewards belong to it. A second call without a reward in between has no
 * effect. */
void grrl_cases_begin_trial(struct grrl_case_base *base, const struct grrl_case_config *config);

/* The estimate for the context with this key. Cost: linear in cases, about 50 instructions each. */
void grrl_cases_estimate(const struct grrl_case_base *base, const struct grrl_case_config *config,
                         uint32_t key, struct grrl_estimate *estimate);

/* Adds a reward, finite and within +-GRRL_MAX_REWARD, in the context with this key. Returns the
 * index of its case, which may be the slot of an evicted one, or GRRL_NO_CASE with capacity 0. */
uint32_t grrl_cases_learn(struct grrl_case_base *base, const struct grrl_case_config *config,
                          uint32_t key, float reward);

#define GRRL_MAX_REWARD 1.0e6f

/*
 * Writes the cases as bytes, in the manner of experience.h. Header: magic "GRRLcas" and zero,
 * version (2 bytes), parts of a context (1), zero (1), cases (4), clock (4). Then log odds (4).
 * Each case: its key (4), n_all (1), n_found (1), n (1), n_new (1), used at (4), value_all (4),
 * value (4), value_new (4). A running CRC-32 (4) follows each of these. GRRL_ERR_IO.
 */
GRRL_MUST_USE enum grrl_status grrl_cases_save(const struct grrl_case_base *base,
                                               const struct grrl_io *io);

/* Replaces the cases. Statuses, *lost and what remains after a failure are as for
 * grrl_experience_load. */
GRRL_MUST_USE enum grrl_status grrl_cases_load(struct grrl_case_base *base,
                                               const struct grrl_io *io, uint32_t *lost);

/*
 * Adds the cases of another base, so that two lives become one; which is added to which makes no
 * difference. Rewards in the same context are pooled, and both lives end now: a case is as old as
 * in the life that met it last. What remains is what all objects have in common: rewards of the
 * latest objects are dropped from both, because the next object is like neither life's last.
 * Keeps the `most` cases with the most rewards; of as many, those that were met last.
 * GRRL_ERR_FULL: the first has no room for the cases of both. Cost: quadratic in cases.
 */
GRRL_MUST_USE enum grrl_status grrl_cases_merge(struct grrl_case_base *base,
                                                struct grrl_case_base *from,
                                                const struct grrl_case_config *config,
                                                uint32_t most);

GRRL_API_END

#endif
