/*
 * policy.h: which action to take.
 *
 * GRRL_POLICY_LEARN expects of each action what the cases of contexts like its own let expect
 * (case_base.h) and takes the one with the highest upper bound.
 *
 * GRRL_POLICY_PAPER is the paper's rule (section V-E). phi is the share of the state's actions with
 * experience. With probability exp(-beta phi) a new action is tried, uniformly; otherwise Interval
 * Estimation (Kaelbling, "Learning in Embedded Systems", 1993) takes the known one with the highest
 * upper bound of its mean.
 */
#ifndef GRRL_POLICY_H
#define GRRL_POLICY_H

#include "grrl/base/api.h"
#include "grrl/base/random.h"
#include "grrl/learner/cases/case_base.h"
#include "grrl/learner/relational_q/experience.h"

GRRL_API_BEGIN

enum grrl_policy_kind { GRRL_POLICY_LEARN, GRRL_POLICY_PAPER, GRRL_POLICY_RANDOM };

/* Every parameter of learning. Fill with grrl_policy_config_default, then change what differs. */
struct grrl_policy_config {
    enum grrl_policy_kind kind;    /* GRRL_POLICY_LEARN */
    struct grrl_case_config cases; /* of GRRL_POLICY_LEARN; what follows is the paper's */
    float alpha;                   /* learning rate, (0, 1]; 0.3 */
    float gamma;                   /* discount, [0, 1); 0.1 */
    float beta;                    /* exploration, >= 0; the paper's 2 */
    float z;                       /* Interval Estimation: bound = value + z sd / sqrt(n); 0.25 */
    float prior_sd;                /* sd assumed for one target, weighs as one sample; 1 */
    struct grrl_recall_config recall;
    float trial_reward; /* with any policy: what the end of a trial adds to the reward, >= 0; 1 */
};

enum grrl_choice_reason {
    GRRL_CHOICE_RANDOM,  /* the random policy */
    GRRL_CHOICE_EXPLORE, /* an action without experience (of its very context) */
    GRRL_CHOICE_EXPLOIT, /* the highest upper bound, with experience */
    GRRL_CHOICE_FOREIGN  /* somebody else's choice, adopted */
};

/* A choice and why. */
struct grrl_choice {
    uint8_t link; /* vertex of the state's graph */
    uint8_t direction;
    uint8_t reason;                /* enum grrl_choice_reason */
    struct grrl_recall_entry from; /* the experience behind it, if any */
    uint32_t closest_case;         /* the case most like it, or GRRL_NO_CASE; LEARN */
    uint8_t mismatches;            /* parts of the context in which that case differs */
    float value;                   /* its estimate and bounds; PAPER: 0 without experience */
    float lower;
    float upper;
    float phi; /* share of the state's actions with experience (LEARN: of their very context) */
};

/* The contexts of all actions of a state: action[link][direction]. */
struct grrl_contexts {
    uint8_t n_links;
    struct grrl_context action[GRRL_MAX_LINKS][GRRL_DIRECTIONS];
};

void grrl_policy_config_default(struct grrl_policy_config *config);

/* The most that beta, z, prior_sd and trial_reward may be: far beyond use, far from overflow. */
#define GRRL_POLICY_MOST 1000.0f

/* GRRL_ERR_ARGUMENT for a parameter outside its range; *field, if not NULL, names it. */
GRRL_MUST_USE enum grrl_status grrl_policy_config_check(const struct grrl_policy_config *config,
                                                        const char **field);

/* The bounds of an entry: value +- z sd / sqrt(n), sd with one prior sample of prior_sd. */
void grrl_policy_bounds(const struct grrl_policy_config *config, const struct grrl_q *q,
                        float *lower, float *upper);

/* LEARN: chooses among the actions of a state of contexts->n_links >= 1 links. Ties are broken at
 * random. Cost: an estimate for each action. */
void grrl_policy_choose_by_cases(const struct grrl_policy_config *config,
                                 const struct grrl_case_base *base,
                                 const struct grrl_contexts *contexts, struct grrl_random *random,
                                 struct grrl_choice *choice);

/* LEARN: fills in what is expected of choice->link and choice->direction. */
void grrl_policy_explain_by_cases(const struct grrl_policy_config *config,
                                  const struct grrl_case_base *base,
                                  const struct grrl_contexts *contexts, struct grrl_choice *choice);

/* PAPER and RANDOM: chooses among the actions of a state of recall->n_links >= 1 links. Ties are
 * broken at random. */
void grrl_policy_choose(const struct grrl_policy_config *config,
                        const struct grrl_experience_store *store, const struct grrl_recall *recall,
                        struct grrl_random *random, struct grrl_choice *choice);

/* PAPER and RANDOM: fills in what is known of choice->link and choice->direction: from, value,
 * lower, upper, phi. */
void grrl_policy_explain(const struct grrl_policy_config *config,
                         const struct grrl_experience_store *store,
                         const struct grrl_recall *recall, struct grrl_choice *choice);

/* max_a Q(s, a) over the known actions, 0 when none is known. */
float grrl_policy_best_value(const struct grrl_experience_store *store,
                             const struct grrl_recall *recall);

GRRL_API_END

#endif
