/*
 * paper_policy.h: the policy `paper`: relational Q-learning as in the paper (sections V-C to V-E).
 *
 * phi is the share of the state's actions with experience. With probability exp(-beta phi) a new
 * action is tried, uniformly; otherwise Interval Estimation (Kaelbling, "Learning in Embedded
 * Systems", 1993) takes the known one with the highest upper bound of its mean.
 */
#ifndef GRRL_PAPER_POLICY_H
#define GRRL_PAPER_POLICY_H

#include "grrl/base/api.h"
#include "grrl/learner/policy.h"
#include "grrl/learner/relational_q/experience.h"

GRRL_API_BEGIN

struct grrl_paper_config {
    float alpha;    /* learning rate, (0, 1]; 0.3 */
    float gamma;    /* discount, [0, 1); 0.1 */
    float beta;     /* exploration, 0 to GRRL_PAPER_MOST; the paper's 2 */
    float z;        /* Interval Estimation: bound = value + z sd / sqrt(n), likewise; 0.25 */
    float prior_sd; /* sd assumed for one target, weighs as one sample, likewise; 1 */
    struct grrl_recall_config recall;
};

/* The most that beta, z and prior_sd may be: far beyond use, far from overflow. */
#define GRRL_PAPER_MOST 1000.0f

/* Its memory; states and experiences follow, as many of each. */
struct grrl_paper_policy {
    struct grrl_paper_config config;
    struct grrl_experience_store store;
    /* private */
    struct grrl_recall recall;  /* of the state, for the last choice or update */
    struct grrl_graph acted_on; /* the state of the last choice */
};

/* What grrl_policy_make takes for it: a constant expression. */
#define GRRL_PAPER_POLICY_BYTES(capacity)                                                          \
    (sizeof(struct grrl_paper_policy) +                                                            \
     (capacity) * (sizeof(struct grrl_experience_state) + sizeof(struct grrl_experience)))

void grrl_paper_config_default(struct grrl_paper_config *config);

/* GRRL_ERR_ARGUMENT for a parameter outside its range; *field, if not NULL, names it. */
GRRL_MUST_USE enum grrl_status grrl_paper_config_check(const struct grrl_paper_config *config,
                                                       const char **field);

/* The bounds of an entry: value +- z sd / sqrt(n), sd with one prior sample of prior_sd. */
void grrl_paper_bounds(const struct grrl_paper_config *config, const struct grrl_q *q, float *lower,
                       float *upper);

/* Chooses among the actions of a state of recall->n_links >= 1 links. Ties are broken at random. */
void grrl_paper_choose(const struct grrl_paper_config *config,
                       const struct grrl_experience_store *store, const struct grrl_recall *recall,
                       struct grrl_random *random, struct grrl_choice *choice);

/* Fills in what is known of choice->link and choice->direction: source, value, bounds, phi. */
void grrl_paper_explain(const struct grrl_paper_config *config,
                        const struct grrl_experience_store *store, const struct grrl_recall *recall,
                        struct grrl_choice *choice);

/* max_a Q(s, a) over the known actions, 0 when none is known. */
float grrl_paper_best_value(const struct grrl_experience_store *store,
                            const struct grrl_recall *recall);

GRRL_API_END

#endif
