/* worst.c: measures decisions on structures that are hard for a policy. */
#include "worst.h"

#include <string.h>

enum { SEED = 1, ROUNDS = 100, MAX_FILLING = 20000 };

static struct grrl_random random;
static struct grrl_model model;
static struct grrl_graph state;

/*
 * Makes a tree with up to two loops, whose links and joints are all alike. Only its shape
 * distinguishes them, which makes searches longest. Positions and lengths vary, for contexts.
 */
static void make_state(uint8_t links)
{
    memset(&model, 0, sizeof model);
    model.n_bodies = links;
    for (uint8_t i = 0; i < links; i++) {
        struct grrl_body *body = &model.body[i];
        body->number = (uint16_t)(i + 1);
        body->axis = (struct grrl_vec2){1.0f, 0.0f};
        body->length_m = 0.05f + 0.09f * grrl_random_uniform(&random);
        body->centroid_m =
            (struct grrl_vec2){grrl_random_uniform(&random), grrl_random_uniform(&random)};
    }
    uint32_t loops = grrl_random_below(&random, 3);
    for (uint32_t j = 1; j < links + loops && j <= GRRL_MAX_JOINTS; j++) {
        uint8_t b = (uint8_t)(j < links ? j : 1 + grrl_random_below(&random, links - 1u));
        uint8_t a = (uint8_t)grrl_random_below(&random, b);
        struct grrl_joint *joint = &model.joint[model.n_joints++];
        *joint = (struct grrl_joint){.a = a, .b = b, .type = GRRL_REVOLUTE, .probability = 1.0f};
    }
    grrl_relational_state_of(&model, 0.15f, &state, NULL, NULL);
}

static uint8_t any_links(void)
{
    return (uint8_t)(GRRL_MAX_LINKS / 2 + grrl_random_below(&random, GRRL_MAX_LINKS / 2 + 1));
}

/* Decides in the current state and learns the outcome, which is another state with
 * as many links. */
static uint32_t decide(const struct grrl_policy *policy, uint8_t links, uint32_t (*count)(void))
{
    const struct grrl_view view = {NULL, &model, &state, 0.15f};
    struct grrl_outcome outcome = {.view = view, .reward = 1.0f};
    struct grrl_update update = {1.0f, 1.0f, GRRL_NO_ENTRY};
    uint32_t start = count();
    policy->type->choose(policy->self, &view, &random, &outcome.choice);
    uint32_t spent = count() - start;
    outcome.body_number = model.body[outcome.choice.link].number;
    make_state(links);
    start = count();
    if (policy->type->learn != NULL)
        policy->type->learn(policy->self, &outcome, &update);
    return spent + (count() - start);
}

uint32_t worst_decision(struct onboard_controller *controller, const struct grrl_policy_type *type,
                        uint32_t (*count)(void))
{
    struct grrl_policy policy;
    grrl_random_init(&random, SEED, 0);
    if (grrl_policy_make(type, controller->policy.bytes, sizeof controller->policy.bytes,
                         ONBOARD_ENTRIES, NULL, &policy) != GRRL_OK)
        return 0;
    make_state(any_links());
    for (int i = 0; type->usage != NULL && type->usage(policy.self).evictions < 1; i++) {
        if (i == MAX_FILLING)
            return 0; /* its memory does not fill up, so this measures nothing */
        (void)decide(&policy, any_links(), count);
    }
    uint32_t most = 0;
    make_state(GRRL_MAX_LINKS);
    for (int i = 0; i < ROUNDS; i++) {
        uint32_t spent = decide(&policy, GRRL_MAX_LINKS, count);
        most = spent > most ? spent : most;
    }
    return most;
}
