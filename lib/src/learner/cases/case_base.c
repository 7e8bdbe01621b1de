/* case_base.c: kernel regression over rewards, by context. */
#include "grrl/learner/cases/case_base.h"

#include <string.h>

#include "base/range.h"
#include "grrl/base/geometry.h"

/* Keeps likelihoods away from zero: no outcome is impossible. */
#define MIN_EXPECTED 0.05f

/* Limits the doubt, so that a few pushes that go as expected remove it. */
#define MIN_LOG_ODDS (-4.0f)

void grrl_case_config_default(struct grrl_case_config *config)
{
    *config = (struct grrl_case_config){.prior = 0.5f,
                                        .prior_weight = 1.0f,
                                        .mismatch = 0.2f,
                                        .bound = 0.4f,
                                        .confidence = 0.5f,
                                        .present = 3.0f,
                                        .memory = 5,
                                        .parts = GRRL_ALL_CONTEXT_PARTS};
}

enum grrl_status grrl_case_config_check(const struct grrl_case_config *config, const char **field)
{
    const struct grrl_range_check checks[] = {
        {"prior", grrl_is_within(config->prior, -GRRL_MAX_REWARD, GRRL_MAX_REWARD)},
        {"prior_weight", grrl_is_within(config->prior_weight, 0.001f, GRRL_MAX_REWARD)},
        {"mismatch", grrl_is_within(config->mismatch, 0.0f, 1.0f)},
        {"bound", grrl_is_within(config->bound, 0.0f, GRRL_MAX_REWARD)},
        {"confidence", grrl_is_within(config->confidence, 0.0f, GRRL_MAX_REWARD)},
        {"present", grrl_is_within(config->present, 0.0f, GRRL_MAX_REWARD)},
        {"memory", config->memory >= 1},
        {"parts", config->parts <= GRRL_ALL_CONTEXT_PARTS},
    };
    return grrl_range_first(checks, sizeof checks / sizeof checks[0], field);
}

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

static uint8_t count_mismatches(const struct grrl_context *a, const struct grrl_context *b,
                                uint16_t parts)
{
    uint8_t n = 0;
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        if (((uint32_t)parts >> i & 1u) != 0 && a->part[i] != b->part[i])
            n++;
    return n;
}

/* The rewards, weighted by their relevance to one context. */
struct evidence {
    float older; /* total weight */
    float newer;
    float older_sum; /* sum of weighted rewards */
    float newer_sum;
};

/* Sums the evidence for one context, and finds the closest case for the estimate. */
static void gather_evidence(const struct grrl_case_base *base,
                            const struct grrl_case_config *config,
                            const struct grrl_context *context, struct evidence *evidence,
                            struct grrl_estimate *estimate)
{
    float weight_of[GRRL_CONTEXT_PARTS + 1] = {1.0f};
    for (unsigned i = 1; i <= GRRL_CONTEXT_PARTS; i++)
        weight_of[i] = weight_of[i - 1] * config->mismatch;
    float p_known = probability_as_known(base);
    float closest_weight = 0.0f;
    *evidence = (struct evidence){.older = 0.0f};
    *estimate = (struct grrl_estimate){.closest = GRRL_NO_CASE, .mismatches = UINT8_MAX};
    for (uint32_t i = 0; i < base->n; i++) {
        const struct grrl_case *met = &base->cases[i];
        uint8_t mismatches = count_mismatches(&met->context, context, config->parts);
        float older = (float)at_most(met->n, config->memory);
        float newer = (1.0f + config->present) * (float)met->n_new;
        evidence->older += weight_of[mismatches] * older;
        evidence->newer += weight_of[mismatches] * newer;
        evidence->older_sum += weight_of[mismatches] * older * met->value;
        evidence->newer_sum += weight_of[mismatches] * newer * met->value_new;
        float weight = p_known * older + newer;
        if (mismatches < estimate->mismatches ||
            (mismatches == estimate->mismatches && weight > closest_weight)) {
            estimate->mismatches = mismatches;
            estimate->closest = i;
            closest_weight = weight;
        }
    }
}

/* The mean over the prior and the rewards; older ones are weighted by P(object as known). */
static float mean(const struct grrl_case_config *config, const struct evidence *evidence,
                  float p_known)
{
    float sum = config->prior_weight * config->prior + p_known * evidence->older_sum;
    float weight = config->prior_weight + p_known * evidence->older;
    return (sum + evidence->newer_sum) / (weight + evidence->newer);
}

void grrl_cases_estimate(const struct grrl_case_base *base, const struct grrl_case_config *config,
                         const struct grrl_context *context, struct grrl_estimate *estimate)
{
    struct evidence evidence;
    gather_evidence(base, config, context, &evidence, estimate);
    float p_known = probability_as_known(base);
    float weight = config->prior_weight + p_known * evidence.older + evidence.newer;
    float margin = config->bound / grrl_sqrt(weight);
    estimate->value = mean(config, &evidence, p_known);
    estimate->lower = estimate->value - margin;
    estimate->upper = estimate->value + margin;
    estimate->weight = weight;
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
                            const struct grrl_context *context, float reward)
{
    struct evidence evidence;
    struct grrl_estimate estimate;
    gather_evidence(base, config, context, &evidence, &estimate);
    bool found = reward > 0.0f;
    float log_odds = base->log_odds + log_likelihood(mean(config, &evidence, 1.0f), found) -
                     log_likelihood(mean(config, &evidence, 0.0f), found);
    log_odds = log_odds > config->confidence ? config->confidence : log_odds;
    base->log_odds = log_odds < MIN_LOG_ODDS ? MIN_LOG_ODDS : log_odds;
}

/* Finds the case with exactly this context, or adds one without rewards. */
static uint32_t find_or_add(struct grrl_case_base *base, const struct grrl_context *context)
{
    uint32_t oldest = 0;
    for (uint32_t i = 0; i < base->n; i++) {
        if (memcmp(&base->cases[i].context, context, sizeof *context) == 0)
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
    base->cases[oldest] = (struct grrl_case){.context = *context};
    return oldest;
}

uint32_t grrl_cases_learn(struct grrl_case_base *base, const struct grrl_case_config *config,
                          const struct grrl_context *context, float reward)
{
    update_log_odds(base, config, context, reward);
    if (base->capacity == 0)
        return GRRL_NO_CASE;
    uint32_t index = find_or_add(base, context);
    struct grrl_case *met = &base->cases[index];
    met->n_new = (uint8_t)at_most(met->n_new + 1u, config->memory);
    met->value_new += (reward - met->value_new) / (float)met->n_new;
    met->used_at = ++base->clock;
    return index;
}
