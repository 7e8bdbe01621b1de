/* learn_policy.c: the policy `learn`: kernel regression over cases, upper confidence bound. */
#include "grrl/learner/cases/learn_policy.h"

#include <assert.h>
#include <string.h>

#include "learner/cases/learn_operations.h"

_Static_assert(sizeof(struct grrl_case_config) <= GRRL_POLICY_CONFIG_BYTES, "a configuration");
_Static_assert(sizeof(struct grrl_learn_policy) % _Alignof(struct grrl_case) == 0,
               "the cases follow");

void grrl_learn_config_default(void *config)
{
    grrl_case_config_default(config);
}

enum grrl_status grrl_learn_config_check(const void *config, const char **field)
{
    return grrl_case_config_check(config, field);
}

size_t grrl_learn_bytes(uint32_t capacity)
{
    return GRRL_LEARN_POLICY_BYTES((size_t)capacity);
}

enum grrl_status grrl_learn_init(void *self, uint32_t capacity, const void *config)
{
    struct grrl_learn_policy *policy = self;
    memset(policy, 0, sizeof *policy);
    if (config != NULL)
        policy->config = *(const struct grrl_case_config *)config;
    else
        grrl_case_config_default(&policy->config);
    grrl_cases_init(&policy->cases, (struct grrl_case *)(void *)(policy + 1), capacity);
    return grrl_case_config_check(&policy->config, NULL);
}

void grrl_learn_begin_trial(void *self)
{
    struct grrl_learn_policy *policy = self;
    memset(&policy->attempts, 0, sizeof policy->attempts);
    memset(&policy->contexts, 0, sizeof policy->contexts);
    grrl_cases_begin_trial(&policy->cases, &policy->config);
}

static void describe_actions(struct grrl_learn_policy *policy, const struct grrl_view *view)
{
    grrl_attempts_update(&policy->attempts, view->model, view->large_m);
    policy->contexts.n_links = view->model->n_bodies;
    for (uint8_t i = 0; i < view->model->n_bodies; i++) {
        struct grrl_context contexts[GRRL_DIRECTIONS];
        enum grrl_status status =
            grrl_context_of(&policy->attempts, view->model, view->large_m, i, contexts);
        assert(status == GRRL_OK); /* the body exists */
        (void)status;
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++)
            policy->contexts.action[i][direction] = grrl_context_key(&contexts[direction]);
    }
}

static void set_estimate(struct grrl_choice *choice, const struct grrl_estimate *estimate)
{
    choice->source = grrl_no_source();
    if (estimate->closest != GRRL_NO_CASE)
        choice->source = (struct grrl_source){.kind = GRRL_SOURCE_CASES,
                                              .distance = estimate->mismatches,
                                              .index = estimate->closest};
    choice->value = estimate->value;
    choice->lower = estimate->lower;
    choice->upper = estimate->upper;
}

/* Whether a case has exactly this context. */
static bool is_known(const struct grrl_estimate *estimate)
{
    return estimate->closest != GRRL_NO_CASE && estimate->mismatches == 0;
}

/* What a choice compares. Only a push not yet made on the link as it is gets the bonus for what is
 * unknown; made once, it tells little new, and is repeated where repeating has paid. */
static float score_of(const struct grrl_estimate *estimate, uint32_t key)
{
    return grrl_context_part(key, GRRL_CONTEXT_TRIED) == 0 ? estimate->upper : estimate->value;
}

/* The estimates of all pushes of a link; equal contexts are looked up once. Returns how many are
 * known. */
static unsigned estimate_link(const struct grrl_learn_policy *policy, uint8_t link,
                              struct grrl_estimate estimates[GRRL_DIRECTIONS])
{
    const uint32_t *keys = policy->contexts.action[link];
    unsigned met = 0;
    for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
        uint8_t same = 0;
        while (keys[same] != keys[direction])
            same++;
        if (same < direction)
            estimates[direction] = estimates[same];
        else
            grrl_cases_estimate(&policy->cases, &policy->config, keys[direction],
                                &estimates[direction]);
        met += is_known(&estimates[direction]);
    }
    return met;
}

void grrl_learn_choose(void *self, const struct grrl_view *view, struct grrl_random *random,
                       struct grrl_choice *choice)
{
    struct grrl_learn_policy *policy = self;
    describe_actions(policy, view);
    *choice = (struct grrl_choice){.reason = GRRL_CHOICE_EXPLORE};
    uint32_t ties = 0;
    unsigned met = 0;
    float best = 0.0f;
    for (uint8_t link = 0; link < policy->contexts.n_links; link++) {
        struct grrl_estimate estimates[GRRL_DIRECTIONS];
        met += estimate_link(policy, link, estimates);
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            const struct grrl_estimate *estimate = &estimates[direction];
            float score = score_of(estimate, policy->contexts.action[link][direction]);
            if (ties == 0 || score > best) {
                ties = 0;
                best = score;
            }
            /* the kth of equal actions replaces the choice with probability 1 / k */
            if (score == best && grrl_random_below(random, ++ties) == 0) {
                choice->link = link;
                choice->direction = direction;
                choice->reason = is_known(estimate) ? GRRL_CHOICE_EXPLOIT : GRRL_CHOICE_EXPLORE;
                set_estimate(choice, estimate);
            }
        }
    }
    choice->phi = (float)met / (float)(policy->contexts.n_links * GRRL_DIRECTIONS);
}

void grrl_learn_explain(void *self, const struct grrl_view *view, struct grrl_choice *choice)
{
    struct grrl_learn_policy *policy = self;
    describe_actions(policy, view);
    unsigned met = 0;
    for (uint8_t link = 0; link < policy->contexts.n_links; link++) {
        struct grrl_estimate estimates[GRRL_DIRECTIONS];
        met += estimate_link(policy, link, estimates);
        if (link == choice->link)
            set_estimate(choice, &estimates[choice->direction]);
    }
    choice->phi = (float)met / (float)(policy->contexts.n_links * GRRL_DIRECTIONS);
}

void grrl_learn_learn(void *self, const struct grrl_outcome *outcome, struct grrl_update *update)
{
    struct grrl_learn_policy *policy = self;
    const struct grrl_choice *choice = &outcome->choice;
    grrl_attempts_add(&policy->attempts, outcome->body_number, choice->direction);
    update->index =
        grrl_cases_learn(&policy->cases, &policy->config,
                         policy->contexts.action[choice->link][choice->direction], outcome->reward);
}

struct grrl_usage grrl_learn_usage(const void *self)
{
    const struct grrl_case_base *cases = &((const struct grrl_learn_policy *)self)->cases;
    return (struct grrl_usage){cases->n, cases->capacity, cases->evictions};
}

void grrl_learn_clear(void *self)
{
    grrl_cases_clear(&((struct grrl_learn_policy *)self)->cases);
}

enum grrl_status grrl_learn_save(const void *self, const struct grrl_io *io)
{
    return grrl_cases_save(&((const struct grrl_learn_policy *)self)->cases, io);
}

enum grrl_status grrl_learn_load(void *self, const struct grrl_io *io, uint32_t *lost)
{
    return grrl_cases_load(&((struct grrl_learn_policy *)self)->cases, io, lost);
}

GRRL_POLICY_TYPE grrl_policy_learn = {
    .name = "learn",
    .text = "a contextual bandit over cases: the highest upper confidence bound",
    .config_default = grrl_learn_config_default,
    .init = grrl_learn_init,
    GRRL_LEARN_OPERATIONS,
};
