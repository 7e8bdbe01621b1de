/* random_policy.c: chooses every push with equal probability; learns nothing. */
#include "grrl/learner/policy.h"
#include "grrl/structure/term.h"

static size_t bytes(uint32_t capacity)
{
    (void)capacity;
    return 0;
}

static enum grrl_status init(void *self, uint32_t capacity, const void *config)
{
    (void)self, (void)capacity, (void)config;
    return GRRL_OK;
}

static void choose(void *self, const struct grrl_view *view, struct grrl_random *random,
                   struct grrl_choice *choice)
{
    (void)self;
    uint32_t action = grrl_random_below(random, (uint32_t)view->state->n * GRRL_DIRECTIONS);
    *choice = (struct grrl_choice){.link = (uint8_t)(action / GRRL_DIRECTIONS),
                                   .direction = (uint8_t)(action % GRRL_DIRECTIONS),
                                   .reason = GRRL_CHOICE_RANDOM,
                                   .source = grrl_no_source()};
}

GRRL_POLICY_TYPE grrl_policy_random = {
    .name = "random",
    .text = "every push with equal probability",
    .bytes = bytes,
    .init = init,
    .choose = choose,
};
