/*
 * policy.h: which action to take (paper, section V-E).
 *
 * phi is the share of the state's actions with experience. With probability exp(-beta phi) a new
 * action is tried, uniformly; otherwise Interval Estimation (Kaelbling, "Learning in Embedded
 * Systems", 1993) takes the known one with the highest upper bound of its mean.
 */
#ifndef GRRL_POLICY_H
#define GRRL_POLICY_H

#include "grrl/experience.h"
#include "grrl/random.h"

enum grrl_policy_kind { GRRL_POLICY_LEARN, GRRL_POLICY_RANDOM };

/* Every parameter of learning. Fill with grrl_policy_config_default, then change what differs. */
struct grrl_policy_config {
    enum grrl_policy_kind kind; /* GRRL_POLICY_LEARN */
    float alpha;                /* learning rate, (0, 1]; 0.3 */
    float gamma;                /* discount, [0, 1); 0.3 */
    float beta;                 /* exploration, >= 0; the paper's 2 */
    float z;                    /* Interval Estimation: bound = value + z sd / sqrt(n); 0.5 */
    float prior_sd;             /* sd assumed for one target, weighs as one sample; 1 */
    float trial_reward;         /* what the end of a trial adds to the reward, >= 0; 1 */
    struct grrl_recall_config recall;
};

enum grrl_choice_reason {
    GRRL_CHOICE_RANDOM,  /* the random policy */
    GRRL_CHOICE_EXPLORE, /* an action without experience */
    GRRL_CHOICE_EXPLOIT, /* the highest upper bound */
    GRRL_CHOICE_FOREIGN  /* somebody else's choice, adopted */
};

/* A choice and why. */
struct grrl_choice {
    uint8_t link; /* vertex of the state's graph */
    uint8_t direction;
    uint8_t reason;                /* enum grrl_choice_reason */
    struct grrl_recall_entry from; /* the experience behind it, if any */
    float value; /* its estimate, and the bounds of Interval Estimation; 0 without experience */
    float lower;
    float upper;
    float phi; /* share of the state's actions with experience */
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

/* Chooses among the actions of a state of recall->n_links >= 1 links. Ties are broken at random. */
void grrl_policy_choose(const struct grrl_policy_config *config,
                        const struct grrl_experience_store *store, const struct grrl_recall *recall,
                        struct grrl_random *random, struct grrl_choice *choice);

/* Fills in what is known of choice->link and choice->direction: from, value, lower, upper, phi. */
void grrl_policy_explain(const struct grrl_policy_config *config,
                         const struct grrl_experience_store *store,
                         const struct grrl_recall *recall, struct grrl_choice *choice);

/* max_a Q(s, a) over the known actions, 0 when none is known. */
float grrl_policy_best_value(const struct grrl_experience_store *store,
                             const struct grrl_recall *recall);

#endif
