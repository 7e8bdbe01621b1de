/* case_base.c: kernel regression over rewards, by context. */
#include "grrl/learner/cases/case_base.h"

#include <string.h>

#include "grrl/base/geometry.h"

/* Keeps likelihoods away from zero: no outcome is impossible. */
#define MIN_EXPECTED 0.05f

/* Limits the doubt: a learner in deep doubt trusts this trial's few rewards alone. */
#define MIN_LOG_ODDS (-1.0f)

void grrl_cases_init(struct grrl_case_base *base, struct grrl_case *cases, uint32_t capacity)
{
    *base = (struct grrl_case_base){.capacity = capacity, .cases = cases};
}

void grrl_cases_clear(struct grrl_case_base *base)
{
    grrl_cases_init(base, base->cases, base->capacity);
}

static unsigned at_most(unsigned x, unsigned most)
{
    return x < most ? x : most;
}

/* P(object as known). */
static float probability_as_known(const struct grrl_case_base *base)
{
    return 1.0f / (1.0f + grrl_exp(-base->log_odds));
}

static unsigned nearest(float x)
{
    return (unsigned)(x + 0.5f);
}

/* Merges the rewards of the last trial into the older ones and keeps the latest `memory`. Of the
 * older ones the share `kept` continues to count, but at least one. The newer ones keep their extra
 * weight to the extent that older ones are dropped. */
static void merge_rewards(const struct grrl_case_config *config, float kept, struct grrl_case *met)
{
    float times = 1.0f + config->present * (1.0f - kept);
    unsigned newer = at_most(nearest((float)met->n_new * times), config->memory);
    unsigned older = met->n > 0 ? 1u + nearest((float)(met->n - 1) * kept) : 0u;
    older = at_most(older, config->memory - newer);
    if (newer > 0) {
        float sum = (float)older * met->value + (float)newer * met->value_new;
        met->value = sum / (float)(older + newer);
    }
    met->n = (uint8_t)(older + newer);
    met->n_new = 0;
    met->value_new = 0.0f;
}

void grrl_cases_begin_trial(struct grrl_case_base *base, const struct grrl_case_config *config)
{
    if (base->n == 0)
        return;
    float kept = base->log_odds < 0.0f ? 2.0f * probability_as_known(base) : 1.0f;
    for (uint32_t i = 0; i < base->n; i++)
        merge_rewards(config, kept, &base->cases[i]);
    base->log_odds = config->confidence;
}

/* The rewards, weighted by their relevance to one context. */
struct evidence {
    float all; /* total weight */
    float older;
    float newer;
    float all_sum; /* sum of weighted rewards */
    float older_sum;
    float newer_sum;
};

static void set_weights(float mismatch, float weight_of[GRRL_CONTEXT_PARTS + 1])
{
    weight_of[0] = 1.0f;
    for (unsigned i = 1; i <= GRRL_CONTEXT_PARTS; i++)
        weight_of[i] = weight_of[i - 1] * mismatch;
}

/* How many of a case's rewards ever are of other objects than the one at hand: this one has as
 * large a share in them as in those remembered. */
static unsigned rewards_of_others(const struct grrl_case_config *config,
                                  const struct grrl_case *met)
{
    unsigned remembered = at_most(met->n_all, config->memory);
    unsigned own = (unsigned)met->n + met->n_new;
    return own < remembered ? met->n_all * (remembered - own) / remembered : 0u;
}

/* Sums the evidence for one context, and finds the closest case for the estimate. */
static void gather_evidence(const struct grrl_case_base *base,
                            const struct grrl_case_config *config, uint32_t key,
                            struct evidence *evidence, struct grrl_estimate *estimate)
{
    float weight_of[GRRL_CONTEXT_PARTS + 1];
    float general_of[GRRL_CONTEXT_PARTS + 1];
    set_weights(config->mismatch, weight_of);
    set_weights(config->general_mismatch, general_of);
    uint32_t bits = grrl_context_key_bits(config->parts);
    uint8_t closest_rewards = 0;
    *evidence = (struct evidence){.all = 0.0f};
    *estimate = (struct grrl_estimate){.closest = GRRL_NO_CASE, .mismatches = UINT8_MAX};
    for (uint32_t i = 0; i < base->n; i++) {
        const struct grrl_case *met = &base->cases[i];
        unsigned mismatches = grrl_context_differences(met->key, key, bits);
        float all = general_of[mismatches] * (float)rewards_of_others(config, met);
        float older = weight_of[mismatches] * (float)at_most(met->n, config->memory);
        evidence->all += all;
        evidence->all_sum += all * met->value_all;
        evidence->older += older;
        evidence->older_sum += older * met->value;
        if (met->n_new > 0) {
            float newer = weight_of[mismatches] * (1.0f + config->present) * (float)met->n_new;
            evidence->newer += newer;
            evidence->newer_sum += newer * met->value_new;
        }
        if (mismatches < estimate->mismatches ||
            (mismatches == estimate->mismatches && met->n_all > closest_rewards)) {
            estimate->mismatches = (uint8_t)mismatches;
            estimate->closest = i;
            closest_rewards = met->n_all;
        }
    }
}

/* What counts in an estimate: the rewards of all objects with a limited weight, older rewards by
 * P(object as known), and newer ones. */
struct mean {
    float value;
    float weight;
};

static struct mean mean_of(const struct grrl_case_config *config, const struct evidence *evidence,
                           float p_known)
{
    float general = evidence->all < config->general ? evidence->all : config->general;
    float prior = config->prior;
    if (general > 0.0f)
        prior = (config->prior_weight * prior + evidence->all_sum) /
                (config->prior_weight + evidence->all);
    float prior_weight = config->prior_weight + general;
    float weight = prior_weight + p_known * evidence->older + evidence->newer;
    float sum = prior_weight * prior + p_known * evidence->older_sum + evidence->newer_sum;
    return (struct mean){sum / weight, weight};
}

void grrl_cases_estimate(const struct grrl_case_base *base, const struct grrl_case_config *config,
                         uint32_t key, struct grrl_estimate *estimate)
{
    struct evidence evidence;
    gather_evidence(base, config, key, &evidence, estimate);
    struct mean mean = mean_of(config, &evidence, probability_as_known(base));
    float margin = config->bound / grrl_sqrt(mean.weight);
    estimate->value = mean.value;
    estimate->lower = mean.value - margin;
    estimate->upper = mean.value + margin;
    estimate->weight = mean.weight;
}

/* The log likelihood that a push finds something (or nothing), given the expected reward. The
 * reward is a count of links and joints, modelled as Poisson. */
static float log_likelihood(float expected, bool found)
{
    float rate = expected > MIN_EXPECTED ? expected : MIN_EXPECTED;
    return found ? grrl_log(1.0f - grrl_exp(-rate)) : -rate;
}

/* Bayes update of "object as known" against "object changed" by a push's outcome. Only whether it
 * found something counts, not how much: a first push that reveals four links instead of two does
 * not indicate another object. */
static void update_log_odds(struct grrl_case_base *base, const struct grrl_case_config *config,
                            uint32_t key, float reward)
{
    struct evidence evidence;
    struct grrl_estimate estimate;
    gather_evidence(base, config, key, &evidence, &estimate);
    bool found = reward > 0.0f;
    float log_odds = base->log_odds +
                     log_likelihood(mean_of(config, &evidence, 1.0f).value, found) -
                     log_likelihood(mean_of(config, &evidence, 0.0f).value, found);
    log_odds = log_odds > config->confidence ? config->confidence : log_odds;
    base->log_odds = log_odds < MIN_LOG_ODDS ? MIN_LOG_ODDS : log_odds;
}

/* Finds the case with exactly this context, or adds one without rewards. */
static uint32_t find_or_add(struct grrl_case_base *base, uint32_t key)
{
    uint32_t oldest = 0;
    for (uint32_t i = 0; i < base->n; i++) {
        if (base->cases[i].key == key)
            return i;
        if (base->cases[i].used_at < base->cases[oldest].used_at)
            oldest = i;
    }
    if (base->n < base->capacity) {
        oldest = base->n++;
        base->high_water = base->n > base->high_water ? base->n : base->high_water;
    } else {
        base->evictions++;
    }
    base->cases[oldest] = (struct grrl_case){.key = key};
    return oldest;
}

/* Adds a reward to those ever met. A full case halves its counts, so that later rewards count. */
static void add_to_all(struct grrl_case *met, float reward)
{
    if (met->n_all == GRRL_CASE_REWARDS) {
        met->n_all /= 2;
        met->n_found /= 2;
    }
    met->n_all++;
    met->n_found = (uint8_t)(met->n_found + (reward > 0.0f));
    met->value_all += (reward - met->value_all) / (float)met->n_all;
}

uint32_t grrl_cases_learn(struct grrl_case_base *base, const struct grrl_case_config *config,
                          uint32_t key, float reward)
{
    update_log_odds(base, config, key, reward);
    if (base->capacity == 0)
        return GRRL_NO_CASE;
    uint32_t index = find_or_add(base, key);
    struct grrl_case *met = &base->cases[index];
    add_to_all(met, reward);
    met->n_new = (uint8_t)at_most(met->n_new + 1u, config->memory);
    met->value_new += (reward - met->value_new) / (float)met->n_new;
    met->used_at = ++base->clock;
    return index;
}
