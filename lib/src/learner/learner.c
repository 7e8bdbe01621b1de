/* learner.c: enforces the order of calls, computes rewards, and connects perception, policy and
 * grounding. */
#include "grrl/learner/learner.h"

#include <string.h>

#include "base/range.h"

enum phase {
    PHASE_IDLE,   /* no trial */
    PHASE_BEGUN,  /* nothing perceived yet */
    PHASE_READY,  /* ready to choose */
    PHASE_ACTING, /* pushed; the outcome is not perceived yet */
    PHASE_DONE    /* perceived; ready to learn */
};

void grrl_learner_config_default(struct grrl_learner_config *config)
{
    memset(config, 0, sizeof *config);
    grrl_perception_config_default(&config->perception);
    grrl_grounding_config_default(&config->grounding);
    config->large_m = 0.15f;
    config->trial_reward = 1.0f;
    config->seed = 1;
}

enum grrl_status grrl_learner_init(struct grrl_learner *learner,
                                   const struct grrl_learner_config *config,
                                   struct grrl_policy policy)
{
    if (!(grrl_is_finite(config->large_m) && config->large_m > 0.0f) ||
        !grrl_is_within(config->trial_reward, 0.0f, GRRL_MAX_TRIAL_REWARD) ||
        grrl_grounding_config_check(&config->grounding) != GRRL_OK ||
        grrl_perception_init(&learner->perception, &config->perception) != GRRL_OK)
        return GRRL_ERR_ARGUMENT;
    learner->config = *config;
    learner->policy = policy;
    learner->trial = 0;
    grrl_learner_abandon_trial(learner);
    return GRRL_OK;
}

void grrl_learner_abandon_trial(struct grrl_learner *learner)
{
    grrl_perception_reset(&learner->perception);
    grrl_random_init(&learner->random, learner->config.seed, learner->trial);
    grrl_graph_clear(&learner->state);
    if (learner->policy.type->begin_trial != NULL)
        learner->policy.type->begin_trial(learner->policy.self);
    memset(&learner->last_choice, 0, sizeof learner->last_choice);
    learner->last_number = 0;
    learner->most_links = 0;
    learner->most_joints = 0;
    learner->phase = PHASE_IDLE;
}

void grrl_learner_begin_trial(struct grrl_learner *learner, uint32_t trial)
{
    learner->trial = trial;
    grrl_learner_abandon_trial(learner);
    learner->phase = PHASE_BEGUN;
}

void grrl_learner_observe(struct grrl_learner *learner, const struct grrl_frame *frame,
                          bool pushing)
{
    if (learner->phase != PHASE_IDLE)
        grrl_perception_observe(&learner->perception, frame, pushing);
}

/* Counts the links and joints beyond the most seen so far in this trial, and records the new
 * maximum. */
static unsigned count_revealed(struct grrl_learner *learner)
{
    unsigned revealed = 0;
    uint8_t joints = (uint8_t)grrl_graph_joint_count(&learner->state);
    if (learner->state.n > learner->most_links) {
        revealed += (unsigned)(learner->state.n - learner->most_links);
        learner->most_links = learner->state.n;
    }
    if (joints > learner->most_joints) {
        revealed += (unsigned)(joints - learner->most_joints);
        learner->most_joints = joints;
    }
    return revealed;
}

enum grrl_status grrl_learner_perceive(struct grrl_learner *learner)
{
    if (learner->phase == PHASE_IDLE)
        return GRRL_ERR_ORDER;
    enum grrl_status status = grrl_perception_update(&learner->perception);
    if (status != GRRL_OK)
        return status;
    const struct grrl_model *model = grrl_perception_model(&learner->perception);
    grrl_relational_state_of(model, learner->config.large_m, &learner->state, NULL, NULL);
    if (learner->phase == PHASE_BEGUN || learner->phase == PHASE_READY) {
        (void)count_revealed(learner); /* no reward before the first push */
        learner->phase = PHASE_READY;
    } else {
        learner->phase = PHASE_DONE;
    }
    return GRRL_OK;
}

static struct grrl_view view_of(const struct grrl_learner *learner)
{
    return (struct grrl_view){&learner->perception, grrl_perception_model(&learner->perception),
                              &learner->state, learner->config.large_m};
}

/* Turns a choice into a push and stores it. */
static enum grrl_status decide(struct grrl_learner *learner, const struct grrl_choice *choice,
                               struct grrl_decision *decision)
{
    const struct grrl_model *model = grrl_perception_model(&learner->perception);
    struct grrl_push push;
    enum grrl_status status = grrl_grounding_push(model, &learner->config.grounding, choice->link,
                                                  choice->direction, &push);
    if (status != GRRL_OK)
        return status;
    *decision = (struct grrl_decision){
        .choice = *choice, .body_number = model->body[choice->link].number, .push = push};
    learner->last_choice = *choice;
    learner->last_number = decision->body_number;
    learner->phase = PHASE_ACTING;
    return GRRL_OK;
}

static void mark_used(struct grrl_learner *learner, const struct grrl_choice *choice)
{
    if (learner->policy.type->used != NULL && choice->source.kind != GRRL_SOURCE_NONE)
        learner->policy.type->used(learner->policy.self, choice);
}

enum grrl_status grrl_learner_choose(struct grrl_learner *learner, struct grrl_decision *decision)
{
    if (learner->phase != PHASE_READY)
        return GRRL_ERR_ORDER;
    if (learner->state.n == 0)
        return GRRL_ERR_NONE;
    struct grrl_view view = view_of(learner);
    struct grrl_choice choice;
    learner->policy.type->choose(learner->policy.self, &view, &learner->random, &choice);
    enum grrl_status status = decide(learner, &choice, decision);
    if (status == GRRL_OK)
        mark_used(learner, &choice);
    return status;
}

enum grrl_status grrl_learner_adopt(struct grrl_learner *learner, uint16_t body_number,
                                    uint8_t direction, bool exploited,
                                    struct grrl_decision *decision)
{
    if (learner->phase != PHASE_READY)
        return GRRL_ERR_ORDER;
    if (direction >= GRRL_DIRECTIONS)
        return GRRL_ERR_ARGUMENT;
    struct grrl_view view = view_of(learner);
    uint8_t link = 0;
    while (link < learner->state.n && view.model->body[link].number != body_number)
        link++;
    if (link == learner->state.n)
        return GRRL_ERR_NONE;
    struct grrl_choice choice = {.link = link,
                                 .direction = direction,
                                 .reason = GRRL_CHOICE_ADOPTED,
                                 .source = grrl_no_source()};
    if (learner->policy.type->explain != NULL)
        learner->policy.type->explain(learner->policy.self, &view, &choice);
    enum grrl_status status = decide(learner, &choice, decision);
    if (status == GRRL_OK && exploited)
        mark_used(learner, &choice);
    return status;
}

enum grrl_status grrl_learner_learn(struct grrl_learner *learner, bool ended,
                                    struct grrl_update *update)
{
    if (learner->phase != PHASE_DONE)
        return GRRL_ERR_ORDER;
    float reward = (float)count_revealed(learner) + (ended ? learner->config.trial_reward : 0.0f);
    *update = (struct grrl_update){.reward = reward, .target = reward, .index = GRRL_NO_ENTRY};
    if (learner->policy.type->learn != NULL) {
        const struct grrl_outcome outcome = {.view = view_of(learner),
                                             .choice = learner->last_choice,
                                             .body_number = learner->last_number,
                                             .reward = reward,
                                             .ended = ended};
        learner->policy.type->learn(learner->policy.self, &outcome, update);
    }
    learner->phase = ended ? PHASE_IDLE : PHASE_READY;
    return GRRL_OK;
}

struct grrl_usage grrl_learner_usage(const struct grrl_learner *learner)
{
    const struct grrl_policy *policy = &learner->policy;
    return policy->type->usage != NULL ? policy->type->usage(policy->self)
                                       : (struct grrl_usage){0, 0, 0};
}

enum grrl_status grrl_learner_save(const struct grrl_learner *learner, const struct grrl_io *io)
{
    const struct grrl_policy *policy = &learner->policy;
    return policy->type->save != NULL ? policy->type->save(policy->self, io) : GRRL_ERR_NONE;
}

void grrl_learner_clear(struct grrl_learner *learner)
{
    if (learner->policy.type->clear != NULL)
        learner->policy.type->clear(learner->policy.self);
}

enum grrl_status grrl_learner_load_torn(struct grrl_learner *learner, const struct grrl_io *io,
                                        uint32_t *lost)
{
    const struct grrl_policy *policy = &learner->policy;
    *lost = 0;
    return policy->type->load != NULL ? policy->type->load(policy->self, io, lost) : GRRL_ERR_NONE;
}

enum grrl_status grrl_learner_load(struct grrl_learner *learner, const struct grrl_io *io)
{
    uint32_t lost;
    enum grrl_status status = grrl_learner_load_torn(learner, io, &lost);
    if (status == GRRL_ERR_IO)
        grrl_learner_clear(learner);
    return status;
}

enum grrl_status grrl_learner_term(const struct grrl_learner *learner,
                                   struct grrl_term_store *store, grrl_term *term)
{
    return grrl_relational_term_of(grrl_perception_model(&learner->perception),
                                   learner->config.large_m, store, term);
}
