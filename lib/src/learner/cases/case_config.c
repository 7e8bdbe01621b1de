/* case_config.c: the parameters of the case base and their ranges. */
#include <stddef.h>
#include <string.h>

#include "base/range.h"
#include "grrl/learner/cases/case_base.h"

void grrl_case_config_default(struct grrl_case_config *config)
{
    *config = (struct grrl_case_config){.prior = 0.5f,
                                        .prior_weight = 1.0f,
                                        .mismatch = 0.2f,
                                        .general = 3.0f,
                                        .general_mismatch = 0.1f,
                                        .bound = 0.4f,
                                        .confidence = 0.5f,
                                        .present = 3.0f,
                                        .memory = 5,
                                        .parts = GRRL_ALL_CONTEXT_PARTS};
}

#define BOUNDS(field, low, high)                                                                   \
    {                                                                                              \
#field, offsetof(struct grrl_case_config, field), low, high                                \
    }

static const struct {
    const char *name;
    size_t offset;
    float low;
    float high;
} bounds[] = {
    BOUNDS(prior, -GRRL_MAX_REWARD, GRRL_MAX_REWARD),
    BOUNDS(prior_weight, 0.001f, GRRL_MAX_REWARD),
    BOUNDS(mismatch, 0.0f, 1.0f),
    BOUNDS(general, 0.0f, GRRL_MAX_REWARD),
    BOUNDS(general_mismatch, 0.0f, 1.0f),
    BOUNDS(bound, 0.0f, GRRL_MAX_REWARD),
    BOUNDS(confidence, 0.0f, GRRL_MAX_REWARD),
    BOUNDS(present, 0.0f, GRRL_MAX_REWARD),
};

enum grrl_status grrl_case_config_check(const struct grrl_case_config *config, const char **field)
{
    const char *wrong = NULL;
    if (config->parts > GRRL_ALL_CONTEXT_PARTS)
        wrong = "parts";
    if (config->memory < 1)
        wrong = "memory";
    for (size_t i = sizeof bounds / sizeof bounds[0]; i-- > 0;) {
        float value;
        memcpy(&value, (const char *)config + bounds[i].offset, sizeof value);
        if (!grrl_is_within(value, bounds[i].low, bounds[i].high))
            wrong = bounds[i].name;
    }
    if (wrong != NULL && field != NULL)
        *field = wrong;
    return wrong == NULL ? GRRL_OK : GRRL_ERR_ARGUMENT;
}
