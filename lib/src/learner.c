#include "grrl/learner.h"

#include <string.h>

/* An agent of 100 experiences fits a quarter of a megabyte (checked for the default capacities). */
#if GRRL_MAX_LINKS <= 16 && GRRL_MAX_FEATURES <= 192 && GRRL_MAX_KEYFRAMES <= 48
_Static_assert(sizeof(struct grrl_learner) + 100 * (sizeof(struct grrl_experience_state) +
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
    config->seed = 1;
}

enum grrl_status grrl_learner_init(struct grrl_learner *learner,
                                   const struct grrl_learner_config *config,
                                   struct grrl_experience_state *states, uint32_t states_capacity,
                                   struct grrl_experience *experiences,
                                   uint32_t experiences_capacity)
{
    if (states_capacity == 0 || experiences_capacity == 0 ||
        grrl_grounding_config_check(&config->grounding) != GRRL_OK ||
        grrl_policy_config_check(&config->policy, NULL) != GRRL_OK ||
        grrl_perception_init(&learner->perception, &config->perception) != GRRL_OK) {
        return GRRL_ERR_ARGUMENT;
    }
    learner->config = *config;
    grrl_experience_init(&learner->store, states, states_capacity, experiences,
                         experiences_capacity);
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
    if (learner->phase != PHASE_IDLE) {
        grrl_perception_observe(&learner->perception, frame, pushing);
    }
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
    if (learner->phase == PHASE_IDLE) {
        return GRRL_ERR_ORDER;
    }
    enum grrl_status status = grrl_perception_update(&learner->perception);
    if (status != GRRL_OK) {
        return status;
    }
    grrl_model_graph(grrl_perception_model(&learner->perception), &learner->state, NULL, NULL);
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

/* Turns a choice into a push and remembers what it was made on. */
static enum grrl_status decide(struct grrl_learner *learner, const struct grrl_choice *choice,
                               struct grrl_decision *decision)
{
    const struct grrl_model *model = grrl_perception_model(&learner->perception);
    struct grrl_push push;
    enum grrl_status status = grrl_grounding_push(model, &learner->config.grounding, choice->link,
                                                  choice->direction, &push);
    if (status != GRRL_OK) {
        return status;
    }
    *decision = (struct grrl_decision){
        .choice = *choice, .body_number = model->body[choice->link].number, .push = push};
    learner->last_choice = *choice;
    learner->acted_on = learner->state;
    learner->phase = PHASE_ACTING;
    ++learner->pushes;
    return GRRL_OK;
}

enum grrl_status grrl_learner_choose(struct grrl_learner *learner, struct grrl_decision *decision)
{
    if (learner->phase != PHASE_READY) {
        return GRRL_ERR_ORDER;
    }
    if (learner->state.n == 0) {
        return GRRL_ERR_NONE;
    }
    recall_state(learner);
    struct grrl_choice choice;
    grrl_policy_choose(&learner->config.policy, &learner->store, &learner->recall, &learner->random,
                       &choice);
    enum grrl_status status = decide(learner, &choice, decision);
    if (status == GRRL_OK && choice.reason == GRRL_CHOICE_EXPLOIT) {
        grrl_experience_touch(&learner->store, choice.from.experience);
    }
    return status;
}

enum grrl_status grrl_learner_adopt(struct grrl_learner *learner, uint16_t body_number,
                                    uint8_t direction, struct grrl_decision *decision)
{
    if (learner->phase != PHASE_READY) {
        return GRRL_ERR_ORDER;
    }
    if (direction >= GRRL_DIRECTIONS) {
        return GRRL_ERR_ARGUMENT;
    }
    const struct grrl_model *model = grrl_perception_model(&learner->perception);
    uint8_t link = 0;
    while (link < learner->state.n && model->body[link].number != body_number) {
        ++link;
    }
    if (link == learner->state.n) {
        return GRRL_ERR_NONE;
    }
    recall_state(learner);
    struct grrl_choice choice = {
        .link = link, .direction = direction, .reason = GRRL_CHOICE_FOREIGN};
    grrl_policy_explain(&learner->config.policy, &learner->store, &learner->recall, &choice);
    return decide(learner, &choice, decision);
}

static float limit(float x)
{
    return x > GRRL_MAX_TARGET ? GRRL_MAX_TARGET : x;
}

enum grrl_status grrl_learner_learn(struct grrl_learner *learner, bool ended,
                                    struct grrl_lesson *lesson)
{
    if (learner->phase != PHASE_DONE) {
        return GRRL_ERR_ORDER;
    }
    const struct grrl_policy_config *policy = &learner->config.policy;
    *lesson = (struct grrl_lesson){.experience = GRRL_NO_EXPERIENCE};
    lesson->reward = (float)reveal(learner) + (ended ? policy->trial_reward : 0.0f);
    lesson->target = lesson->reward;
    if (!ended) {
        recall_state(learner);
        lesson->target += policy->gamma * grrl_policy_best_value(&learner->store, &learner->recall);
    }
    lesson->target = limit(lesson->target); /* a discount next to 1 adds up without end */
    if (policy->kind != GRRL_POLICY_RANDOM) {
        const struct grrl_choice *choice = &learner->last_choice;
        uint32_t index;
        if (grrl_experience_update(&learner->store, &learner->acted_on, choice->link,
                                   choice->direction, lesson->target, policy->alpha,
                                   &index) == GRRL_OK) {
            lesson->experience = index;
        }
    }
    learner->phase = ended ? PHASE_IDLE : PHASE_READY;
    return GRRL_OK;
}

enum grrl_status grrl_learner_term(const struct grrl_learner *learner,
                                   struct grrl_term_store *store, grrl_term *term)
{
    const struct grrl_model *model = grrl_perception_model(&learner->perception);
    struct grrl_graph graph;
    struct grrl_name names[GRRL_MAX_LINKS];
    struct grrl_edge edges[GRRL_MAX_JOINTS];
    grrl_model_graph(model, &graph, names, edges);
    return grrl_graph_to_term(store, &graph, names, edges, model->n_joints, true, term);
}
