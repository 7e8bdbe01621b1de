/*
 * grrl-bench perceive: the cost of perception, as it grows with links, features and pushes. Chains
 * of links are moved joint by joint at random; the keyframe memory is full after the first ten
 * pushes or soon after.
 */
#include <stdio.h>
#include <string.h>

#include "bench.h"
#include "kinematic_world.h"

enum { SEEDS = 5, SPANS = 4, SPAN_PUSHES = 10, PUSH_FRAMES = 130 };

struct size {
    int links;
    int features_a_link; /* minimum; there are 8 to 13 anyway */
};

struct cost {
    double update_ns[SPANS]; /* sums over a span of ten pushes each */
    double push_ns;          /* and all frames with their updates */
    double worst_ns;         /* of one update */
    double features;
    double keyframes; /* at the end */
};

static const struct size sizes[] = {{4, 0},  {8, 0},  {16, 0}, {32, 0},
                                    {8, 20}, {8, 40}, {8, 64}, {32, 16}};

static struct kinematic_world world;
static struct grrl_perception perception;

static void make_world(const struct size *size, uint64_t seed)
{
    char joints[WORLD_LINKS] = "";
    for (int i = 0; i + 1 < size->links; i++)
        joints[i] = i % 2 == 0 ? 'R' : 'P';
    world_init(&world, seed);
    world_add_chain(&world, joints, 0.0f, 0.0f);
    for (int link = 0; link < world.n_links; link++) {
        int n = 0;
        for (int i = 0; i < world.n_points; i++)
            n += world.body[i] == link;
        for (; n < size->features_a_link; n++)
            (void)world_add_point(&world, link, world_uniform(&world, -0.065f, 0.065f),
                                  world_uniform(&world, -0.0175f, 0.0175f));
    }
}

static bool measure(const struct size *size, uint64_t seed, struct cost *cost)
{
    struct grrl_perception_config config;
    const struct grrl_vec2 shift = {0.01f, -0.005f};
    grrl_perception_config_default(&config);
    make_world(size, seed);
    bool good = grrl_perception_init(&perception, &config) == GRRL_OK;
    world_rest(&world, &perception, GRRL_SETTLING_FRAMES);
    for (int i = 0; good && i < SPANS * SPAN_PUSHES; i++) {
        float dq[WORLD_LINKS] = {0.0f};
        int link = 1 + (int)grrl_random_below(&world.random, (uint32_t)world.n_links - 1);
        float step = world.joint[link] == 'R' ? world_uniform(&world, 0.1f, 0.4f)
                                              : world_uniform(&world, 0.004f, 0.015f);
        dq[link] = world.q[link] > 0.0f ? -step : step;
        double made_ns = bench_now_ns();
        for (int f = 0; f < PUSH_FRAMES; f++)
            (void)world_frame(&world);
        made_ns = bench_now_ns() - made_ns; /* time of the test world itself */
        double start_ns = bench_now_ns();
        world_move(&world, &perception, dq, shift, 0.05f);
        double moved_ns = bench_now_ns();
        good = grrl_perception_update(&perception) == GRRL_OK;
        double end_ns = bench_now_ns();
        double update_ns = end_ns - moved_ns;
        cost->update_ns[i / SPAN_PUSHES] += update_ns;
        cost->push_ns += end_ns - start_ns - made_ns;
        cost->worst_ns = update_ns > cost->worst_ns ? update_ns : cost->worst_ns;
    }
    cost->features += world.n_points;
    cost->keyframes += perception.n_keyframes;
    return good;
}

static void print(const struct size *size, const struct cost *cost, bool json, bool first)
{
    const double runs = SEEDS;
    const double span_ms = 1e-6 / (runs * SPAN_PUSHES);
    (void)printf(json ? "%s{\"links\": %d, \"features\": %.0f, \"keyframes\": %.0f"
                      : "%s| %d | %.0f | %.0f",
                 json ? (first ? "[\n " : ",\n ") : "", size->links, cost->features / runs,
                 cost->keyframes / runs);
    for (int s = 0; s < SPANS; s++)
        if (json)
            (void)printf(", \"update_ms_from_push_%d\": %.3f", s * SPAN_PUSHES + 1,
                         cost->update_ns[s] * span_ms);
        else
            (void)printf(" | %.2f", cost->update_ns[s] * span_ms);
    (void)printf(json ? ", \"worst_ms\": %.3f, \"push_ms\": %.3f}" : " | %.2f | %.2f |\n",
                 cost->worst_ns * 1e-6, cost->push_ns * span_ms / SPANS);
}

int bench_perceive(bool json)
{
    if (!json)
        (void)puts(
            "| links | features | keyframes | update, ms: push 1 to 10 | 11 to 20 | 21 to 30 "
            "| 31 to 40 | worst | a push with its frames |\n"
            "|---|---|---|---|---|---|---|---|---|");
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct cost cost = {.features = 0.0};
        for (uint64_t seed = 1; seed <= SEEDS; seed++)
            if (!measure(&sizes[i], seed, &cost))
                return 1;
        print(&sizes[i], &cost, json, i == 0);
    }
    if (json)
        (void)puts("\n]");
    return 0;
}
