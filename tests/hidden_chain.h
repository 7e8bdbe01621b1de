/*
 * hidden_chain.h: a fake world that replaces perception. It defines perception's functions, so that
 * the library's own are not linked. Include it in one file, after cmocka.h.
 */
#ifndef GRRL_HIDDEN_CHAIN_H
#define GRRL_HIDDEN_CHAIN_H

#include <string.h>

#include "grrl/perception/perception.h"

/*
 * A chain of links whose joints are hidden at first. A push across a body with hidden joints
 * (direction 2) reveals its last joint; any other push reveals nothing. A stiff chain gives way at
 * every second push only.
 */
static struct {
    const char *joints; /* of the whole chain */
    uint8_t n_bodies;
    uint8_t first[GRRL_MAX_LINKS]; /* first link of a body, in order of discovery */
    uint8_t last[GRRL_MAX_LINKS];
    uint8_t revealed[GRRL_MAX_JOINTS]; /* joint i lies between links i and i + 1 */
    uint8_t n_revealed;
    unsigned frames;
    bool nothing_seen;
    bool stiff;
    unsigned pushes_across;
    struct grrl_model model;
} world;

void grrl_perception_config_default(struct grrl_perception_config *config)
{
    memset(config, 0, sizeof *config);
    config->noise_m = 0.001f;
}

enum grrl_status grrl_perception_init(struct grrl_perception *perception,
                                      const struct grrl_perception_config *config)
{
    perception->config = *config;
    return config->noise_m > 0.0f ? GRRL_OK : GRRL_ERR_ARGUMENT;
}

void grrl_perception_reset(struct grrl_perception *perception)
{
    (void)perception;
    memset(&world.model, 0, sizeof world.model);
}

void grrl_perception_observe(struct grrl_perception *perception, const struct grrl_frame *frame,
                             bool pushing)
{
    (void)perception;
    (void)frame;
    (void)pushing;
    world.frames++;
}

static uint8_t body_with(uint8_t link)
{
    uint8_t body = 0;
    while (link < world.first[body] || link > world.last[body])
        body++;
    return body;
}

enum grrl_status grrl_perception_update(struct grrl_perception *perception)
{
    (void)perception;
    if (world.nothing_seen)
        return GRRL_ERR_NONE;
    struct grrl_model *model = &world.model;
    memset(model, 0, sizeof *model);
    model->n_bodies = world.n_bodies;
    for (uint8_t i = 0; i < world.n_bodies; i++) {
        float middle = 0.05f * (float)(world.first[i] + world.last[i]);
        model->body[i] =
            (struct grrl_body){.number = (uint16_t)(world.first[i] + 1),
                               .n_features = 1,
                               .centroid_m = {middle, 0.0f},
                               .axis = {1.0f, 0.0f},
                               .length_m = 0.1f * (float)(world.last[i] - world.first[i] + 1)};
        model->feature_m[i] = model->body[i].centroid_m;
        model->feature_body[i] = i;
    }
    model->n_features = model->n_bodies;
    for (uint8_t j = 0; j < world.n_revealed; j++) {
        uint8_t link = world.revealed[j];
        uint8_t a = body_with(link);
        uint8_t b = body_with((uint8_t)(link + 1));
        model->joint[j] =
            (struct grrl_joint){.a = a < b ? a : b,
                                .b = a < b ? b : a,
                                .type = world.joints[link] == 'R' ? GRRL_REVOLUTE : GRRL_PRISMATIC,
                                .probability = 1.0f,
                                .point_m = {0.1f * (float)link + 0.05f, 0.0f}};
    }
    model->n_joints = world.n_revealed;
    return GRRL_OK;
}

const struct grrl_model *grrl_perception_model(const struct grrl_perception *perception)
{
    (void)perception;
    return &world.model;
}

static void world_start(const char *joints)
{
    memset(&world, 0, sizeof world);
    world.joints = joints;
    world.n_bodies = 1;
    world.last[0] = (uint8_t)strlen(joints);
}

static void world_reveal(uint8_t body)
{
    if (world.first[body] < world.last[body]) {
        uint8_t joint = (uint8_t)(world.last[body] - 1);
        world.revealed[world.n_revealed++] = joint;
        world.first[world.n_bodies] = world.last[body];
        world.last[world.n_bodies] = world.last[body];
        world.n_bodies++;
        world.last[body] = joint;
    }
}

static bool world_push(const struct grrl_choice *choice)
{
    if (choice->direction == 2 && (!world.stiff || ++world.pushes_across % 2 == 0))
        world_reveal(choice->link);
    return world.n_revealed == strlen(world.joints);
}

#endif
