/*
 * paper_policy.h: the policy `paper`: relational Q-learning as in the paper (sections V-C to V-E).
 *
 * phi is the share of the state's actions with an experience. With probability exp(-beta phi) the
 * policy tries a new action, chosen uniformly. Otherwise Interval Estimation (Kaelbling, "Learning
 * in Embedded Systems", 1993) takes the known action with the highest upper bound of its mean.
 */
#ifndef GRRL_PAPER_POLICY_H
#define GRRL_PAPER_POLICY_H

#include "grrl/base/api.h"
#include "grrl/learner/policy.h"
#include "grrl/learner/relational_q/experience.h"

GRRL_API_BEGIN

struct grrl_paper_config {
    float alpha; /* learning rate, (0, 1]; 0.3 */
    float gamma; /* discount, [0, 1); 0.1 */
    float beta;  /* exploration, 0 to GRRL_PAPER_MAX; the paper's 2 */
    float z; /* Interval Estimation: bound = value + z sd / sqrt(n), 0 to GRRL_PAPER_MAX; 0.25 */
    float prior_sd; /* prior sd, with the weight of one sample, 0 to GRRL_PAPER_MAX; 1 */
    struct grrl_recall_config recall;
};

/* Upper limit of beta, z and prior_sd: far above useful values, and far from overflow. */
#define GRRL_PAPER_MAX 1000.0f

/* The policy's memory; states and experiences follow, as many of each. */
struct grrl_paper_policy {
    struct grrl_paper_config config;
    struct grrl_experience_store store;
    /* private */
    struct grrl_recall recall;  /* of the current state, for the last choice or update */
    struct grrl_graph acted_on; /* the state of the last choice */
};

/* Bytes to pass to grrl_policy_make for this policy; a constant expression. */
#define GRRL_PAPER_POLICY_BYTES(capacity)                                                          \
    (sizeof(struct grrl_paper_policy) +                                                            \
     (capacity) * (sizeof(struct grrl_experience_state) + sizeof(struct grrl_experience)))

void grrl_paper_config_default(struct grrl_paper_config *config);

/* GRRL_ERR_ARGUMENT for a parameter outside its range; *field, if not NULL, is set to its name. */
GRRL_MUST_USE enum grrl_status grrl_paper_config_check(const struct grrl_paper_config *config,
                                                       const char **field);

/* The bounds of an experience: value +- z sd / sqrt(n), where sd includes one prior sample of
 * prior_sd. */
void grrl_paper_bounds(const struct grrl_paper_config *config, const struct grrl_q *q, float *lower,
                       float *upper);

/* Chooses among the actions of a state of recall->n_links >= 1 links. Ties are broken at random. */
void grrl_paper_choose(const struct grrl_paper_config *config,
                       const struct grrl_experience_store *store, const struct grrl_recall *recall,
                       struct grrl_random *random, struct grrl_choice *choice);

/* Fills in what is known about choice->link and choice->direction: source, value, bounds, phi. */
void grrl_paper_explain(const struct grrl_paper_config *config,
                        const struct grrl_experience_store *store, const struct grrl_recall *recall,
                        struct grrl_choice *choice);

/* max_a Q(s, a) over the known actions; 0 if none is known. */
float grrl_paper_best_value(const struct grrl_experience_store *store,
                            const struct grrl_recall *recall);

GRRL_API_END

#endif
