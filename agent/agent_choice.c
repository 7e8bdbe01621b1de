/* agent_choice.c: chooses the next push, keeps it on the table, and tells how certain the model is.
 */
#include <stdio.h>

#include "agent_internal.h"

bool agent_has_table(const struct grrl_agent *agent)
{
    const struct grrl_agent_table *table = &agent->config.table;
    return table->x0_m < table->x1_m && table->y0_m < table->y1_m;
}

static bool on_table(const struct grrl_agent_table *table, struct grrl_vec2 point)
{
    return point.x >= table->x0_m && point.x <= table->x1_m && point.y >= table->y0_m &&
           point.y <= table->y1_m;
}

/* The tool moves on the line from start to end: it is on the table if both are. */
static bool stays(const struct grrl_agent *agent, const struct grrl_push *push)
{
    return on_table(&agent->config.table, push->start_m) &&
           on_table(&agent->config.table, push->end_m);
}

/*
 * The first push that stays on the table, in the order of links and directions after the refused
 * one. Each time the search starts one farther on, so the replacement is not always the same.
 */
static enum grrl_status replace(struct grrl_agent *agent, const struct grrl_decision *refused,
                                struct grrl_decision *decision)
{
    const struct grrl_model *model = grrl_perception_model(&agent->learner.perception);
    uint32_t n = (uint32_t)model->n_bodies * GRRL_DIRECTIONS;
    uint32_t first = (uint32_t)refused->choice.link * GRRL_DIRECTIONS + refused->choice.direction +
                     1u + (uint32_t)agent->replaced;
    agent->replaced++;
    for (uint32_t i = 0; i < n; i++) {
        uint8_t body = (uint8_t)((first + i) % n / GRRL_DIRECTIONS);
        uint8_t direction = (uint8_t)((first + i) % GRRL_DIRECTIONS);
        struct grrl_push push;
        if (agent->config.ground(model, &agent->config.learner.grounding, body, direction, &push) ==
                GRRL_OK &&
            stays(agent, &push))
            return grrl_learner_adopt(&agent->learner, model->body[body].number, direction, false,
                                      decision);
    }
    return GRRL_ERR_NONE;
}

/*
 * A choice cannot be undone, so with a table the learner is copied first. One thing is not
 * restored: the policy counts the refused choice as a use of its source, which only affects what a
 * full store evicts.
 */
enum grrl_status agent_choose(struct grrl_agent *agent, struct grrl_decision *decision)
{
    if (!agent_has_table(agent))
        return grrl_learner_choose(&agent->learner, decision);
    agent->before = agent->learner;
    enum grrl_status status = grrl_learner_choose(&agent->learner, decision);
    if (status != GRRL_OK || stays(agent, &decision->push))
        return status;
    struct grrl_decision refused = *decision;
    agent->learner = agent->before;
    status = replace(agent, &refused, decision);
    if (agent_mistake(agent, GRRL_MISTAKE_PUSH_OFF_TABLE, 1)) {
        (void)snprintf(agent->note, sizeof agent->note,
                       "the push chosen, f%u from (%.3f, %.3f) to (%.3f, %.3f) m, would leave "
                       "--table and is not sent: another one replaces it",
                       (unsigned)refused.body_number, (double)refused.push.start_m.x,
                       (double)refused.push.start_m.y, (double)refused.push.end_m.x,
                       (double)refused.push.end_m.y);
        agent_note(agent, agent->note);
    }
    return status;
}

/* The probability with which a pair is decided; 0 if it is not. */
static float decided(const struct grrl_pair *pair)
{
    switch (pair->relation) {
    case GRRL_RELATION_JOINED:
        return pair->p_revolute > pair->p_prismatic ? pair->p_revolute : pair->p_prismatic;
    case GRRL_RELATION_DISCONNECTED:
        return pair->p_disconnected;
    default:
        return 0.0f;
    }
}

float grrl_agent_sureness(const struct grrl_agent *agent, uint8_t *a, uint8_t *b)
{
    const struct grrl_perception *perception = &agent->learner.perception;
    uint8_t n = grrl_perception_model(perception)->n_bodies;
    float least = 2.0f; /* above any probability */
    *a = 0;
    *b = 0;
    if (n < 2 || agent->config.pair == NULL)
        return 0.0f;
    for (uint8_t i = 0; i < n; i++) {
        for (uint8_t j = (uint8_t)(i + 1u); j < n; j++) {
            struct grrl_pair pair;
            float sure =
                agent->config.pair(perception, i, j, &pair) == GRRL_OK ? decided(&pair) : 0.0f;
            if (sure < least) {
                least = sure;
                *a = i;
                *b = j;
            }
        }
    }
    return least;
}
