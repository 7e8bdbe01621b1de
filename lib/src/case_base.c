#include "grrl/case_base.h"

#include <string.h>

#include "grrl/geometry.h"

void grrl_case_config_default(struct grrl_case_config *config)
{
    *config = (struct grrl_case_config){.prior = 0.5f,
                                        .prior_weight = 1.0f,
                                        .mismatch = 0.1f,
                                        .bound = 0.4f,
                                        .doubt = 1.0f,
                                        .patience = 1.0f,
                                        .give_up = 7.0f,
                                        .present = 3.0f,
                                        .memory = 5,
                                        .parts = GRRL_ALL_CONTEXT_PARTS};
}

/* Written so that a NaN is in no range. */
static bool is_within(float x, float low, float high)
{
    return x >= low && x <= high;
}

enum grrl_status grrl_case_config_check(const struct grrl_case_config *config, const char **field)
{
    const struct {
        const char *name;
        bool fine;
    } checks[] = {
        {"cases.prior", is_within(config->prior, -GRRL_MAX_REWARD, GRRL_MAX_REWARD)},
        {"cases.prior_weight", is_within(config->prior_weight, 0.001f, GRRL_MAX_REWARD)},
        {"cases.mismatch", is_within(config->mismatch, 0.0f, 1.0f)},
        {"cases.bound", is_within(config->bound, 0.0f, GRRL_MAX_REWARD)},
        {"cases.doubt", is_within(config->doubt, 0.0f, GRRL_MAX_REWARD)},
        {"cases.patience", is_within(config->patience, 0.0f, GRRL_MAX_REWARD)},
        {"cases.give_up", is_within(config->give_up, 0.001f, GRRL_MAX_REWARD)},
        {"cases.present", is_within(config->present, 0.0f, GRRL_MAX_REWARD)},
        {"cases.memory", config->memory >= 1},
        {"cases.parts", config->parts <= GRRL_ALL_CONTEXT_PARTS},
    };
    for (unsigned i = 0; i < sizeof checks / sizeof checks[0]; ++i) {
        if (!checks[i].fine) {
            if (field != NULL) {
                *field = checks[i].name;
            }
            return GRRL_ERR_ARGUMENT;
        }
    }
    return GRRL_OK;
}

void grrl_cases_init(struct grrl_case_base *base, struct grrl_case *cases, uint32_t capacity)
{
    *base = (struct grrl_case_base){.capacity = capacity, .cases = cases};
}

void grrl_cases_clear(struct grrl_case_base *base)
{
    grrl_cases_init(base, base->cases, base->capacity);
}

void grrl_cases_begin_trial(struct grrl_case_base *base)
{
    base->refuted = 0.0f;
    for (uint32_t i = 0; i < base->n; ++i) {
        base->cases[i].n_now = 0;
        base->cases[i].value_now = 0.0f;
    }
}

static uint8_t count_mismatches(const struct grrl_context *a, const struct grrl_context *b,
                                uint16_t parts)
{
    uint8_t n = 0;
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; ++i) {
        if (((uint32_t)parts >> i & 1u) != 0 && a->part[i] != b->part[i]) {
            ++n;
        }
    }
    return n;
}

/* How much the rewards of earlier trials count in this one. */
static float trust(const struct grrl_case_base *base, const struct grrl_case_config *config)
{
    float excess = base->refuted - config->patience;
    return excess > 0.0f ? grrl_exp(-config->doubt * excess) : 1.0f;
}

void grrl_cases_estimate(const struct grrl_case_base *base, const struct grrl_case_config *config,
                         const struct grrl_context *context, struct grrl_estimate *estimate)
{
    float weight_of[GRRL_CONTEXT_PARTS + 1] = {1.0f};
    for (unsigned i = 1; i <= GRRL_CONTEXT_PARTS; ++i) {
        weight_of[i] = weight_of[i - 1] * config->mismatch;
    }
    float older = trust(base, config);
    float weight = config->prior_weight;
    float sum = config->prior_weight * config->prior;
    float closest_weight = 0.0f;
    *estimate = (struct grrl_estimate){.closest = GRRL_NO_CASE, .mismatches = UINT8_MAX};
    for (uint32_t i = 0; i < base->n; ++i) {
        const struct grrl_case *met = &base->cases[i];
        uint8_t mismatches = count_mismatches(&met->context, context, config->parts);
        uint8_t n = met->n < config->memory ? met->n : config->memory;
        float before = older * (float)n;
        float now = config->present * (float)met->n_now;
        weight += weight_of[mismatches] * (before + now);
        sum += weight_of[mismatches] * (before * met->value + now * met->value_now);
        if (mismatches < estimate->mismatches ||
            (mismatches == estimate->mismatches && before + now > closest_weight)) {
            estimate->mismatches = mismatches;
            estimate->closest = i;
            closest_weight = before + now;
        }
    }
    float reach = config->bound / grrl_sqrt(weight);
    estimate->value = sum / weight;
    estimate->lower = estimate->value - reach;
    estimate->upper = estimate->value + reach;
    estimate->weight = weight;
}

/* The case of exactly this context, or a new one without rewards. */
static uint32_t find_or_add(struct grrl_case_base *base, const struct grrl_context *context)
{
    uint32_t oldest = 0;
    for (uint32_t i = 0; i < base->n; ++i) {
        if (memcmp(&base->cases[i].context, context, sizeof *context) == 0) {
            return i;
        }
        if (base->cases[i].used_at < base->cases[oldest].used_at) {
            oldest = i;
        }
    }
    if (base->n < base->capacity) {
        oldest = base->n++;
        base->high_water = base->n > base->high_water ? base->n : base->high_water;
    } else {
        ++base->evictions;
    }
    base->cases[oldest] = (struct grrl_case){.context = *context};
    return oldest;
}

uint32_t grrl_cases_learn(struct grrl_case_base *base, const struct grrl_case_config *config,
                          const struct grrl_context *context, float reward)
{
    struct grrl_estimate expected;
    grrl_cases_estimate(base, config, context, &expected);
    base->refuted += expected.value - reward;
    if (base->refuted < 0.0f || base->refuted > config->give_up) {
        base->refuted = 0.0f;
    }

    if (base->capacity == 0) {
        return GRRL_NO_CASE;
    }
    uint32_t index = find_or_add(base, context);
    struct grrl_case *met = &base->cases[index];
    met->n = met->n < config->memory ? (uint8_t)(met->n + 1) : config->memory;
    met->n_now = met->n_now < UINT8_MAX ? (uint8_t)(met->n_now + 1) : UINT8_MAX;
    met->value += (reward - met->value) / (float)met->n;
    met->value_now += (reward - met->value_now) / (float)met->n_now;
    met->used_at = ++base->clock;
    return index;
}
