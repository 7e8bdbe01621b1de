/* chain_learner.h: two learners with any policy, and their trials on hidden chains. Include it in
 * one file, after cmocka.h. */
#ifndef GRRL_CHAIN_LEARNER_H
#define GRRL_CHAIN_LEARNER_H

#include <string.h>

#include "grrl/learner/learner.h"
#include "hidden_chain.h"
#include "policy_memory.h"
#include "store_check.h"

#define SEED UINT64_C(20080630)

enum { ENTRIES = 150, MAX_PUSHES = 300 };

struct fixture {
    struct grrl_learner learner;
    struct grrl_learner_config config;
    POLICY_MEMORY(ENTRIES) policy;
};

static struct fixture one, two;
static bool stiff; /* the chains of run_trial */

static void init_with(struct fixture *fixture, const struct grrl_policy_type *type,
                      uint32_t capacity, uint64_t seed)
{
    struct grrl_policy policy;
    grrl_learner_config_default(&fixture->config);
    fixture->config.seed = seed;
    assert_int_equal(grrl_policy_make(type, fixture->policy.bytes, sizeof fixture->policy.bytes,
                                      capacity, NULL, &policy),
                     GRRL_OK);
    assert_int_equal(grrl_learner_init(&fixture->learner, &fixture->config, policy), GRRL_OK);
}

static void init(struct fixture *fixture, const struct grrl_policy_type *type, uint64_t seed)
{
    init_with(fixture, type, ENTRIES, seed);
}

static int set_up(void **state)
{
    (void)state;
    init(&one, &grrl_policy_learn, SEED);
    stiff = false;
    world_start("RPR");
    return 0;
}

/* One trial to its end; *hash collects every choice. */
static unsigned run_trial(struct fixture *fixture, const char *joints, uint32_t trial,
                          uint32_t *hash)
{
    struct grrl_learner *learner = &fixture->learner;
    world_start(joints);
    world.stiff = stiff;
    grrl_learner_begin_trial(learner, trial);
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
    float sum = 0.0f;
    for (unsigned pushes = 1; pushes <= MAX_PUSHES; pushes++) {
        struct grrl_decision decision;
        struct grrl_update update;
        assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
        *hash = *hash * 31u + decision.choice.link * 6u + decision.choice.direction;
        bool ended = world_push(&decision.choice);
        assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
        assert_int_equal(grrl_learner_learn(learner, ended, &update), GRRL_OK);
        if (learner->policy.type == &grrl_policy_paper)
            check_store(&fixture->policy.paper.store);
        sum += update.reward;
        if (ended) { /* every link but the first, every joint, the trial */
            assert_true(sum == 2.0f * (float)strlen(joints) + 1.0f);
            return pushes;
        }
    }
    return MAX_PUSHES;
}

static unsigned run_trials(struct fixture *fixture, const char *joints, uint32_t from, uint32_t n,
                           uint32_t *hash)
{
    unsigned pushes = 0;
    for (uint32_t trial = from; trial < from + n; trial++)
        pushes += run_trial(fixture, joints, trial, hash);
    return pushes;
}

static const struct grrl_policy_type *const learners[] = {&grrl_policy_learn, &grrl_policy_paper,
                                                          &grrl_policy_greedy};
enum { LEARNERS = 3 };

#endif
