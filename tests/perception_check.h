/*
 * perception_check.h: a world, perception's model of it, and checks of that model. Include it after
 * cmocka.h in the tests of perception.
 */
#ifndef GRRL_TEST_PERCEPTION_CHECK_H
#define GRRL_TEST_PERCEPTION_CHECK_H

#include "kinematic_world.h"

static struct grrl_perception perception;
static struct kinematic_world world;

static inline void start(uint64_t seed, const char *chain)
{
    struct grrl_perception_config config;
    grrl_perception_config_default(&config);
    assert_int_equal(grrl_perception_init(&perception, &config), GRRL_OK);
    world_init(&world, seed);
    world_add_chain(&world, chain, -0.4f, 0.0f);
    world_add_background(&world, 25);
    world_shuffle_ids(&world);
    world_rest(&world, &perception, GRRL_SETTLING_FRAMES);
    assert_int_equal(grrl_perception_update(&perception), GRRL_OK);
}

/* The true link of a tracked feature, -1 for the background. */
static inline int true_link(int32_t id)
{
    for (int i = 0; i < world.n_points; i++)
        if (world.id[i] == id)
            return world.body[i];
    return -2;
}

/* The true link that most of a body's features are on. */
static inline int link_of_body(const struct grrl_model *model, int body)
{
    int votes[WORLD_LINKS] = {0};
    int best = 0;
    for (int i = 0; i < model->n_features; i++) {
        int link = true_link(model->feature_id[i]);
        if (model->feature_body[i] == body && link >= 0)
            votes[link]++;
    }
    for (int i = 0; i < world.n_links; i++)
        best = votes[i] > votes[best] ? i : best;
    return best;
}

/* The body that holds most of a link's features; links that have not moved apart share one. */
static inline int body_of_link(const struct grrl_model *model, int link)
{
    int votes[GRRL_MAX_LINKS] = {0};
    int best = 0;
    for (int i = 0; i < model->n_features; i++)
        if (true_link(model->feature_id[i]) == link && model->feature_body[i] < model->n_bodies)
            votes[model->feature_body[i]]++;
    for (int i = 0; i < model->n_bodies; i++)
        best = votes[i] > votes[best] ? i : best;
    return best;
}

/* Counts features in a body of another link than their own. */
static inline int misplaced(const struct grrl_model *model)
{
    int n = 0;
    for (int i = 0; i < model->n_features; i++)
        if (model->feature_body[i] < model->n_bodies)
            n += link_of_body(model, model->feature_body[i]) != true_link(model->feature_id[i]);
    return n;
}

/* Counts features outside the body that holds most of their link's features. Links that have not
 * moved relative to one another may share a body. */
static inline int torn_off(const struct grrl_model *model)
{
    int count[WORLD_LINKS][GRRL_MAX_LINKS] = {{0}};
    int n = 0;
    for (int i = 0; i < model->n_features; i++) {
        int link = true_link(model->feature_id[i]);
        if (link >= 0 && model->feature_body[i] < model->n_bodies)
            count[link][model->feature_body[i]]++;
    }
    for (int link = 0; link < world.n_links; link++) {
        int most = 0;
        for (int body = 0; body < model->n_bodies; body++) {
            n += count[link][body];
            most = count[link][body] > most ? count[link][body] : most;
        }
        n -= most;
    }
    return n;
}

/* Whether every body is another link, and every joint is between neighbours in the chain and of the
 * right type. */
static inline bool is_the_chain(const struct grrl_model *model)
{
    if (model->n_bodies != world.n_links || model->n_joints != world.n_links - 1)
        return false;
    bool found[WORLD_LINKS] = {false};
    for (int i = 0; i < model->n_joints; i++) {
        int a = link_of_body(model, model->joint[i].a);
        int b = link_of_body(model, model->joint[i].b);
        int child = a > b ? a : b;
        char type = model->joint[i].type == GRRL_REVOLUTE ? 'R' : 'P';
        if ((a > b ? a - b : b - a) != 1 || world.joint[child] != type || found[child])
            return false;
        found[child] = true;
    }
    return true;
}

static inline void push(const float *dq)
{
    struct grrl_vec2 shift = {0.01f, -0.005f};
    assert_int_equal(world_push(&world, &perception, dq, shift, 0.05f), GRRL_OK);
}

static inline void move_one(int link, float by)
{
    float dq[WORLD_LINKS] = {0.0f};
    dq[link] = by;
    push(dq);
}

#endif
