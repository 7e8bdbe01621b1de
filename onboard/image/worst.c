/* Fills the stores to capacity and measures the slowest decisions. */
#include "worst.h"

enum { SEED = 1, ROUNDS = 100 };

static struct grrl_random random;
static struct grrl_contexts contexts;
static struct grrl_recall recall;
static struct grrl_graph state;

static void make_context(struct grrl_context *context)
{
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        context->part[i] = (uint8_t)grrl_random_below(&random, grrl_context_most[i] + 1u);
}

uint32_t worst_of_cases(struct onboard_controller *controller, uint32_t (*count)(void))
{
    struct grrl_case_base *base = &controller->learner.cases;
    struct grrl_policy_config config;
    struct grrl_choice choice;
    uint32_t most = 0;
    grrl_policy_config_default(&config);
    grrl_cases_init(base, controller->cases, ONBOARD_EXPERIENCES);
    grrl_random_init(&random, SEED, 0);
    while (base->evictions < 1) { /* until it is full */
        make_context(&contexts.action[0][0]);
        (void)grrl_cases_learn(base, &config.cases, &contexts.action[0][0], 1.0f);
    }
    contexts.n_links = GRRL_MAX_LINKS;
    for (int i = 0; i < ROUNDS; i++) {
        for (unsigned action = 0; action < GRRL_MAX_LINKS * GRRL_DIRECTIONS; action++)
            make_context(&contexts.action[action / GRRL_DIRECTIONS][action % GRRL_DIRECTIONS]);
        uint32_t start = count();
        grrl_policy_choose_by_cases(&config, base, &contexts, &random, &choice);
        (void)grrl_cases_learn(base, &config.cases, &contexts.action[choice.link][choice.direction],
                               0.0f);
        uint32_t spent = count() - start;
        most = spent > most ? spent : most;
    }
    return most;
}

/* A tree with up to two loops, of links and joints that are all alike: nothing but its shape tells
 * one from another, which makes the longest searches. */
static void make_state(uint8_t links)
{
    grrl_graph_clear(&state);
    for (uint8_t i = 0; i < links; i++) {
        (void)!grrl_graph_add_link(&state, GRRL_PROPERTY_SMALL, NULL);
        if (i > 0) {
            (void)!grrl_graph_add_joint(&state, i, (uint8_t)grrl_random_below(&random, i),
                                        GRRL_REVOLUTE);
        }
    }
    for (uint32_t loops = grrl_random_below(&random, 3); loops > 0; loops--) {
        (void)!grrl_graph_add_joint(&state, (uint8_t)grrl_random_below(&random, links),
                                    (uint8_t)grrl_random_below(&random, links), GRRL_REVOLUTE);
    }
}

uint32_t worst_of_experiences(struct onboard_controller *controller, uint32_t (*count)(void))
{
    struct grrl_experience_store *store = &controller->learner.store;
    struct grrl_policy_config config;
    struct grrl_choice choice;
    uint32_t most = 0;
    grrl_policy_config_default(&config);
    config.kind = GRRL_POLICY_PAPER;
    grrl_experience_init(store, controller->states, ONBOARD_STATES, controller->experiences,
                         ONBOARD_EXPERIENCES);
    grrl_random_init(&random, SEED, 1);
    while (store->evictions < 1) {
        make_state(
            (uint8_t)(GRRL_MAX_LINKS / 2 + grrl_random_below(&random, GRRL_MAX_LINKS / 2 + 1)));
        (void)!grrl_experience_update(store, &state, (uint8_t)grrl_random_below(&random, state.n),
                                      (uint8_t)grrl_random_below(&random, GRRL_DIRECTIONS), 1.0f,
                                      config.alpha, NULL);
    }
    for (int i = 0; i < ROUNDS; i++) {
        make_state(GRRL_MAX_LINKS);
        uint32_t start = count();
        grrl_experience_recall(store, &state, &config.recall, &recall);
        grrl_policy_choose(&config, store, &recall, &random, &choice);
        grrl_experience_recall(store, &state, &config.recall, &recall); /* of the state after it */
        (void)!grrl_experience_update(store, &state, choice.link, choice.direction, 1.0f,
                                      config.alpha, NULL);
        uint32_t spent = count() - start;
        most = spent > most ? spent : most;
    }
    return most;
}
