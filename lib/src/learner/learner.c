#include "grrl/learner/learner.h"

#include <assert.h>
#include <string.h>

/* An agent of 100 experiences fits a quarter of a megabyte (checked for the default capacities). */
#if GRRL_MAX_LINKS <= 16 && GRRL_MAX_FEATURES <= 192 && GRRL_MAX_KEYFRAMES <= 48
_Static_assert(sizeof(struct grrl_learner) +
                       100 * (sizeof(struct grrl_case) + sizeof(struct grrl_experience_state) +
                              sizeof(struct grrl_experience)) <=
                   256 * 1024,
               "an agent of 100 experiences in 256 KiB");
#endif

enum phase {
    PHASE_IDLE,   /* no trial */
    PHASE_BEGUN,  /* nothing perceived yet */
    PHASE_READY,  /* to choose */
    PHASE_ACTING, /* chosen, what came of it not yet perceived */
    PHASE_DONE    /* perceived, to learn */
};

void grrl_learner_config_default(struct grrl_learner_config *config)
{
    memset(config, 0, sizeof *config);
    grrl_perception_config_default(&config->perception);
    grrl_grounding_config_default(&config->grounding);
    grrl_policy_config_default(&config->policy);
    config->large_m = 0.15f;
    config->seed = 1;
}

static bool is_enough(const struct grrl_learner_memory *memory, enum grrl_policy_kind kind)
{
    switch (kind) {
    case GRRL_POLICY_LEARN:
        return memory->cases_capacity > 0;
    case GRRL_POLICY_PAPER:
        return memory->states_capacity > 0 && memory->experiences_capacity > 0;
    default:
        return true;
    }
}

enum grrl_status grrl_learner_init(struct grrl_learner *learner,
                                   const struct grrl_learner_config *config,
                                   const struct grrl_learner_memory *memory)
{
    bool is_size = grrl_is_finite(config->large_m) && config->large_m > 0.0f;
    if (!is_size || !is_enough(memory, config->policy.kind) ||
        grrl_grounding_config_check(&config->grounding) != GRRL_OK ||
        grrl_policy_config_check(&config->policy, NULL) != GRRL_OK ||
        grrl_perception_init(&learner->perception, &config->perception) != GRRL_OK)
        return GRRL_ERR_ARGUMENT;
    learner->config = *config;
    grrl_experience_init(&learner->store, memory->states, memory->states_capacity,
                         memory->experiences, memory->experiences_capacity);
    grrl_cases_init(&learner->cases, memory->cases, memory->cases_capacity);
    learner->trial = 0;
    grrl_learner_abandon_trial(learner);
    return GRRL_OK;
}

void grrl_learner_abandon_trial(struct grrl_learner *learner)
{
    grrl_perception_reset(&learner->perception);
    grrl_random_init(&learner->random, learner->config.seed, learner->trial);
    grrl_graph_clear(&learner->state);
    grrl_graph_clear(&learner->acted_on);
    memset(&learner->recall, 0, sizeof learner->recall);
    memset(&learner->attempts, 0, sizeof learner->attempts);
    memset(&learner->contexts, 0, sizeof learner->contexts);
    grrl_cases_begin_trial(&learner->cases, &learner->config.policy.cases);
    memset(&learner->last_choice, 0, sizeof learner->last_choice);
    learner->pushes = 0;
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

/* Links and joints of the state beyond the most believed before in this trial, which become known.
 */
static unsigned reveal(struct grrl_learner *learner)
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
    grrl_attempts_look(&learner->attempts, model, learner->config.large_m);
    if (learner->phase == PHASE_BEGUN || learner->phase == PHASE_READY) {
        (void)reveal(learner); /* what shows without a push is not paid */
        learner->phase = PHASE_READY;
    } else {
        learner->phase = PHASE_DONE;
    }
    return GRRL_OK;
}

static void recall_state(struct grrl_learner *learner)
{
    grrl_experience_recall(&learner->store, &learner->state, &learner->config.policy.recall,
                           &learner->recall);
}

static void describe_actions(struct grrl_learner *learner)
{
    const struct grrl_model *model = grrl_perception_model(&learner->perception);
    learner->contexts.n_links = model->n_bodies;
    for (uint8_t i = 0; i < model->n_bodies; i++) {
        enum grrl_status status = grrl_context_of(
            &learner->attempts, model, learner->config.large_m, i, learner->contexts.action[i]);
        assert(status == GRRL_OK); /* there is such a body */
        (void)status;
    }
}

/* Turns a choice into a push and remembers what it was made on. */
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
    learner->acted_on = learner->state;
    grrl_attempts_add(&learner->attempts, model, choice->link, choice->direction);
    learner->phase = PHASE_ACTING;
    learner->pushes++;
    return GRRL_OK;
}

enum grrl_status grrl_learner_choose(struct grrl_learner *learner, struct grrl_decision *decision)
{
    if (learner->phase != PHASE_READY)
        return GRRL_ERR_ORDER;
    if (learner->state.n == 0)
        return GRRL_ERR_NONE;
    const struct grrl_policy_config *policy = &learner->config.policy;
    struct grrl_choice choice;
    if (policy->kind == GRRL_POLICY_LEARN) {
        describe_actions(learner);
        grrl_policy_choose_by_cases(policy, &learner->cases, &learner->contexts, &learner->random,
                                    &choice);
    } else {
        recall_state(learner);
        grrl_policy_choose(policy, &learner->store, &learner->recall, &learner->random, &choice);
    }
    enum grrl_status status = decide(learner, &choice, decision);
    if (status == GRRL_OK && choice.from.experience != GRRL_NO_EXPERIENCE)
        grrl_experience_touch(&learner->store, choice.from.experience);
    return status;
}

enum grrl_status grrl_learner_adopt(struct grrl_learner *learner, uint16_t body_number,
                                    uint8_t direction, struct grrl_decision *decision)
{
    if (learner->phase != PHASE_READY)
        return GRRL_ERR_ORDER;
    if (direction >= GRRL_DIRECTIONS)
        return GRRL_ERR_ARGUMENT;
    const struct grrl_model *model = grrl_perception_model(&learner->perception);
    uint8_t link = 0;
    while (link < learner->state.n && model->body[link].number != body_number)
        link++;
    if (link == learner->state.n)
        return GRRL_ERR_NONE;
    const struct grrl_policy_config *policy = &learner->config.policy;
    struct grrl_choice choice = {
        .link = link, .direction = direction, .reason = GRRL_CHOICE_FOREIGN};
    if (policy->kind == GRRL_POLICY_LEARN) {
        describe_actions(learner);
        grrl_policy_explain_by_cases(policy, &learner->cases, &learner->contexts, &choice);
    } else {
        recall_state(learner);
        grrl_policy_explain(policy, &learner->store, &learner->recall, &choice);
    }
    return decide(learner, &choice, decision);
}

static float limit(float x)
{
    return x > GRRL_MAX_TARGET ? GRRL_MAX_TARGET : x;
}

/* The paper's update: Q-learning with the instance-based Q function; sections V-C and V-D. */
static void learn_q(struct grrl_learner *learner, bool ended, struct grrl_update *update)
{
    const struct grrl_policy_config *policy = &learner->config.policy;
    if (!ended) {
        recall_state(learner);
        update->target += policy->gamma * grrl_policy_best_value(&learner->store, &learner->recall);
    }
    update->target = limit(update->target); /* a discount next to 1 adds up without end */
    const struct grrl_choice *choice = &learner->last_choice;
    uint32_t index;
    if (policy->kind == GRRL_POLICY_PAPER &&
        grrl_experience_update(&learner->store, &learner->acted_on, choice->link, choice->direction,
                               update->target, policy->alpha, &index) == GRRL_OK)
        update->experience = index;
}

enum grrl_status grrl_learner_learn(struct grrl_learner *learner, bool ended,
                                    struct grrl_update *update)
{
    if (learner->phase != PHASE_DONE)
        return GRRL_ERR_ORDER;
    const struct grrl_policy_config *policy = &learner->config.policy;
    *update = (struct grrl_update){.experience = GRRL_NO_EXPERIENCE, .updated_case = GRRL_NO_CASE};
    update->reward = (float)reveal(learner) + (ended ? policy->trial_reward : 0.0f);
    update->target = update->reward;
    if (policy->kind == GRRL_POLICY_LEARN) {
        const struct grrl_choice *choice = &learner->last_choice;
        update->updated_case = grrl_cases_learn(
            &learner->cases, &policy->cases,
            &learner->contexts.action[choice->link][choice->direction], update->reward);
    } else {
        learn_q(learner, ended, update);
    }
    learner->phase = ended ? PHASE_IDLE : PHASE_READY;
    return GRRL_OK;
}

struct grrl_learner_usage grrl_learner_usage_of(const struct grrl_learner *learner)
{
    if (learner->config.policy.kind == GRRL_POLICY_LEARN) {
        return (struct grrl_learner_usage){learner->cases.n, learner->cases.capacity,
                                           learner->cases.evictions};
    }
    return (struct grrl_learner_usage){learner->store.n_experiences,
                                       learner->store.experiences_capacity,
                                       learner->store.evictions};
}

enum grrl_status grrl_learner_save(const struct grrl_learner *learner, const struct grrl_io *io)
{
    enum grrl_status status = grrl_experience_save(&learner->store, io);
    return status == GRRL_OK ? grrl_cases_save(&learner->cases, io) : status;
}

static void forget(struct grrl_learner *learner)
{
    grrl_experience_clear(&learner->store);
    grrl_cases_clear(&learner->cases);
}

enum grrl_status grrl_learner_load_torn(struct grrl_learner *learner, const struct grrl_io *io,
                                        uint32_t *lost)
{
    uint32_t lost_cases = 0;
    grrl_cases_clear(&learner->cases);
    enum grrl_status status = grrl_experience_load_torn(&learner->store, io, lost);
    if (status == GRRL_OK)
        status = grrl_cases_load_torn(&learner->cases, io, &lost_cases);
    *lost += lost_cases;
    if (status != GRRL_OK && status != GRRL_ERR_IO)
        forget(learner);
    return status;
}

enum grrl_status grrl_learner_load(struct grrl_learner *learner, const struct grrl_io *io)
{
    uint32_t lost;
    enum grrl_status status = grrl_learner_load_torn(learner, io, &lost);
    if (status == GRRL_ERR_IO)
        forget(learner);
    return status;
}

enum grrl_status grrl_learner_term(const struct grrl_learner *learner,
                                   struct grrl_term_store *store, grrl_term *term)
{
    const struct grrl_model *model = grrl_perception_model(&learner->perception);
    struct grrl_graph graph;
    struct grrl_name names[GRRL_MAX_LINKS];
    struct grrl_edge edges[GRRL_MAX_JOINTS];
    grrl_relational_state_of(model, learner->config.large_m, &graph, names, edges);
    return grrl_graph_to_term(store, &graph, names, edges, model->n_joints, true, term);
}
