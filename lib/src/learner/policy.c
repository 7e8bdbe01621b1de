#include "grrl/learner/policy.h"

#include "grrl/base/geometry.h"

void grrl_policy_config_default(struct grrl_policy_config *config)
{
    *config = (struct grrl_policy_config){.kind = GRRL_POLICY_LEARN,
                                          .alpha = 0.3f,
                                          .gamma = 0.1f,
                                          .beta = 2.0f,
                                          .z = 0.25f,
                                          .prior_sd = 1.0f,
                                          .trial_reward = 1.0f,
                                          .recall = {.deepest = GRRL_RECALL_SUBSTRUCTURE,
                                                     .budget = GRRL_MATCH_BUDGET,
                                                     .states = GRRL_RECALL_STATES}};
    grrl_case_config_default(&config->cases);
}

/* Written so that a NaN is in no range. */
static bool is_within(float x, float low, float high)
{
    return x >= low && x <= high;
}

enum grrl_status grrl_policy_config_check(const struct grrl_policy_config *config,
                                          const char **field)
{
    const struct {
        const char *name;
        bool fine;
    } checks[] = {
        {"kind", config->kind == GRRL_POLICY_LEARN || config->kind == GRRL_POLICY_PAPER ||
                     config->kind == GRRL_POLICY_RANDOM},
        {"alpha", config->alpha > 0.0f && config->alpha <= 1.0f},
        {"gamma", config->gamma >= 0.0f && config->gamma < 1.0f},
        {"beta", is_within(config->beta, 0.0f, GRRL_POLICY_MOST)},
        {"z", is_within(config->z, 0.0f, GRRL_POLICY_MOST)},
        {"prior_sd", is_within(config->prior_sd, 0.0f, GRRL_POLICY_MOST)},
        {"trial_reward", is_within(config->trial_reward, 0.0f, GRRL_POLICY_MOST)},
        {"recall.deepest", config->recall.deepest == GRRL_RECALL_EXACT ||
                               config->recall.deepest == GRRL_RECALL_RELAXED ||
                               config->recall.deepest == GRRL_RECALL_SUBSTRUCTURE},
        {"recall.budget", config->recall.budget >= 1},
        {"recall.states",
         config->recall.states >= 1 && config->recall.states <= GRRL_RECALL_STATES},
    };
    for (unsigned i = 0; i < sizeof checks / sizeof checks[0]; i++) {
        if (!checks[i].fine) {
            if (field != NULL)
                *field = checks[i].name;
            return GRRL_ERR_ARGUMENT;
        }
    }
    return grrl_case_config_check(&config->cases, field);
}

void grrl_policy_bounds(const struct grrl_policy_config *config, const struct grrl_q *q,
                        float *lower, float *upper)
{
    /* n targets leave n - 1 degrees of freedom; the prior sample is one more. */
    float n = (float)q->n;
    float variance = (q->deviations + config->prior_sd * config->prior_sd) / n;
    float reach = config->z * grrl_sqrt(variance / n);
    *lower = q->value - reach;
    *upper = q->value + reach;
}

static const struct grrl_q *q_of(const struct grrl_experience_store *store,
                                 const struct grrl_recall_entry *entry)
{
    return entry->experience == GRRL_NO_EXPERIENCE ? NULL
                                                   : &store->experiences[entry->experience].q;
}

static unsigned count_known(const struct grrl_recall *recall)
{
    unsigned known = 0;
    for (uint8_t link = 0; link < recall->n_links; link++)
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++)
            known += recall->entry[link][direction].experience != GRRL_NO_EXPERIENCE;
    return known;
}

void grrl_policy_explain(const struct grrl_policy_config *config,
                         const struct grrl_experience_store *store,
                         const struct grrl_recall *recall, struct grrl_choice *choice)
{
    choice->closest_case = GRRL_NO_CASE;
    choice->from = recall->entry[choice->link][choice->direction];
    choice->phi = (float)count_known(recall) / (float)(recall->n_links * GRRL_DIRECTIONS);
    choice->value = 0.0f;
    choice->lower = 0.0f;
    choice->upper = 0.0f;
    const struct grrl_q *q = q_of(store, &choice->from);
    if (q != NULL) {
        choice->value = q->value;
        grrl_policy_bounds(config, q, &choice->lower, &choice->upper);
    }
}

/* The nth action without experience. */
static void pick_unknown(const struct grrl_recall *recall, uint32_t nth, struct grrl_choice *choice)
{
    for (uint8_t link = 0; link < recall->n_links; link++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            if (recall->entry[link][direction].experience == GRRL_NO_EXPERIENCE && nth-- == 0) {
                choice->link = link;
                choice->direction = direction;
                return;
            }
        }
    }
}

/* The highest upper bound; the kth of equals takes over with probability 1 / k. */
static void pick_best(const struct grrl_policy_config *config,
                      const struct grrl_experience_store *store, const struct grrl_recall *recall,
                      struct grrl_random *random, struct grrl_choice *choice)
{
    uint32_t equals = 0;
    float best = 0.0f;
    for (uint8_t link = 0; link < recall->n_links; link++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            const struct grrl_q *q = q_of(store, &recall->entry[link][direction]);
            if (q == NULL)
                continue;
            float lower, upper;
            grrl_policy_bounds(config, q, &lower, &upper);
            if (equals == 0 || upper > best) {
                equals = 0;
                best = upper;
            }
            if (upper == best && grrl_random_below(random, ++equals) == 0) {
                choice->link = link;
                choice->direction = direction;
            }
        }
    }
}

void grrl_policy_choose(const struct grrl_policy_config *config,
                        const struct grrl_experience_store *store, const struct grrl_recall *recall,
                        struct grrl_random *random, struct grrl_choice *choice)
{
    uint32_t all = (uint32_t)recall->n_links * GRRL_DIRECTIONS;
    uint32_t known = count_known(recall);
    *choice = (struct grrl_choice){.reason = GRRL_CHOICE_EXPLOIT};
    if (config->kind == GRRL_POLICY_RANDOM) {
        uint32_t action = grrl_random_below(random, all);
        choice->link = (uint8_t)(action / GRRL_DIRECTIONS);
        choice->direction = (uint8_t)(action % GRRL_DIRECTIONS);
        choice->reason = GRRL_CHOICE_RANDOM;
    } else {
        float phi = (float)known / (float)all;
        bool explore = grrl_random_uniform(random) < grrl_exp(-config->beta * phi);
        if (known == 0 || (explore && known < all)) {
            pick_unknown(recall, grrl_random_below(random, all - known), choice);
            choice->reason = GRRL_CHOICE_EXPLORE;
        } else {
            pick_best(config, store, recall, random, choice);
        }
    }
    grrl_policy_explain(config, store, recall, choice);
}

float grrl_policy_best_value(const struct grrl_experience_store *store,
                             const struct grrl_recall *recall)
{
    bool any = false;
    float best = 0.0f;
    for (uint8_t link = 0; link < recall->n_links; link++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            const struct grrl_q *q = q_of(store, &recall->entry[link][direction]);
            if (q != NULL && (!any || q->value > best)) {
                best = q->value;
                any = true;
            }
        }
    }
    return best;
}

static void set_estimate(struct grrl_choice *choice, const struct grrl_estimate *estimate)
{
    choice->from = (struct grrl_recall_entry){.experience = GRRL_NO_EXPERIENCE};
    choice->closest_case = estimate->closest;
    choice->mismatches = estimate->mismatches;
    choice->value = estimate->value;
    choice->lower = estimate->lower;
    choice->upper = estimate->upper;
}

static bool is_met(const struct grrl_estimate *estimate)
{
    return estimate->closest != GRRL_NO_CASE && estimate->mismatches == 0;
}

void grrl_policy_choose_by_cases(const struct grrl_policy_config *config,
                                 const struct grrl_case_base *base,
                                 const struct grrl_contexts *contexts, struct grrl_random *random,
                                 struct grrl_choice *choice)
{
    *choice = (struct grrl_choice){.reason = GRRL_CHOICE_EXPLORE};
    uint32_t equals = 0;
    unsigned met = 0;
    float best = 0.0f;
    for (uint8_t link = 0; link < contexts->n_links; link++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            struct grrl_estimate estimate;
            grrl_cases_estimate(base, &config->cases, &contexts->action[link][direction],
                                &estimate);
            met += is_met(&estimate);
            if (equals == 0 || estimate.upper > best) {
                equals = 0;
                best = estimate.upper;
            }
            /* the kth of equals takes over with probability 1 / k */
            if (estimate.upper == best && grrl_random_below(random, ++equals) == 0) {
                choice->link = link;
                choice->direction = direction;
                choice->reason = is_met(&estimate) ? GRRL_CHOICE_EXPLOIT : GRRL_CHOICE_EXPLORE;
                set_estimate(choice, &estimate);
            }
        }
    }
    choice->phi = (float)met / (float)(contexts->n_links * GRRL_DIRECTIONS);
}

void grrl_policy_explain_by_cases(const struct grrl_policy_config *config,
                                  const struct grrl_case_base *base,
                                  const struct grrl_contexts *contexts, struct grrl_choice *choice)
{
    unsigned met = 0;
    for (uint8_t link = 0; link < contexts->n_links; link++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            struct grrl_estimate estimate;
            grrl_cases_estimate(base, &config->cases, &contexts->action[link][direction],
                                &estimate);
            met += is_met(&estimate);
            if (link == choice->link && direction == choice->direction)
                set_estimate(choice, &estimate);
        }
    }
    choice->phi = (float)met / (float)(contexts->n_links * GRRL_DIRECTIONS);
}
