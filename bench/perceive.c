/*
 * grrl-bench perceive: the cost of perception. Chains of links are moved joint by joint at random,
 * with at least ten or twenty features per link, until the keyframe memory is full and for two
 * rounds more.
 */
#include <stdio.h>
#include <string.h>

#include "bench.h"
#include "kinematic_world.h"

enum { SEEDS = 5, PUSHES = 40, MARKS = 3, PUSH_FRAMES = 130 };

struct size {
    int links;
    int features_a_link; /* minimum */
};

/* Sums over pushes that left this number of keyframes, or up to a quarter fewer. */
struct sum {
    double update_ns;
    double push_ns; /* all frames and the update */
    double features;
    double n;
};

static const struct size sizes[] = {{2, 0}, {4, 0}, {8, 0}, {12, 0}, {4, 20}, {8, 20}};
static const int marks[MARKS] = {GRRL_MAX_KEYFRAMES / 3, 2 * GRRL_MAX_KEYFRAMES / 3,
                                 GRRL_MAX_KEYFRAMES};

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

static void take(struct sum *sums, double update_ns, double push_ns)
{
    int keyframes = (int)perception.counts.keyframes_high;
    for (int m = 0; m < MARKS; m++) {
        if (keyframes <= marks[m] && 4 * keyframes > 3 * marks[m]) {
            sums[m].update_ns += update_ns;
            sums[m].push_ns += push_ns;
            sums[m].features += world.n_points;
            sums[m].n += 1.0;
        }
    }
}

static bool measure(const struct size *size, uint64_t seed, struct sum *sums)
{
    struct grrl_perception_config config;
    const struct grrl_vec2 shift = {0.01f, -0.005f};
    grrl_perception_config_default(&config);
    make_world(size, seed);
    bool good = grrl_perception_init(&perception, &config) == GRRL_OK;
    world_rest(&world, &perception, GRRL_SETTLING_FRAMES);
    for (int i = 0; good && i < PUSHES; i++) {
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
        take(sums, end_ns - moved_ns, end_ns - start_ns - made_ns);
    }
    return good;
}

static void print(const struct size *size, const struct sum *sums, bool json, bool *first)
{
    for (int m = 0; m < MARKS; m++) {
        double n = sums[m].n;
        if (!(n > 0.0))
            continue;
        (void)printf(json ? "%s{\"links\": %d, \"features\": %.0f, \"keyframes\": %d, "
                            "\"update_ms\": %.3f, \"push_ms\": %.3f}"
                          : "%s| %d | %.0f | %d | %.2f | %.2f |",
                     json ? (*first ? "[\n " : ",\n ") : "", size->links, sums[m].features / n,
                     marks[m], sums[m].update_ns / n * 1e-6, sums[m].push_ns / n * 1e-6);
        *first = false;
        if (!json)
            (void)putchar('\n');
    }
}

int bench_perceive(bool json)
{
    if (!json)
        (void)puts("| links | features | keyframes | update, ms | a push with its frames, ms |\n"
                   "|---|---|---|---|---|");
    bool first = true;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct sum sums[MARKS] = {{0}};
        for (uint64_t seed = 1; seed <= SEEDS; seed++)
            if (!measure(&sizes[i], seed, sums))
                return 1;
        print(&sizes[i], sums, json, &first);
    }
    if (json)
        (void)puts("\n]");
    return 0;
}
