/* The learner with each policy, on a chain that shows itself as it is pushed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "chain_learner.h"
#include "grrl/structure/term.h"

static void learning_needs_fewer_pushes_than_chance(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    unsigned learned[LEARNERS] = {0};
    unsigned chance = 0;
    uint32_t hash = 0;
    for (uint64_t seed = SEED; seed < SEED + 5; seed++) {
        for (int i = 0; i < LEARNERS; i++) {
            init(&one, learners[i], seed);
            (void)run_trials(&one, "RPRPR", 1, 20, &hash);
            learned[i] += run_trials(&one, "RPRPR", 21, 20, &hash);
        }
        init(&two, &grrl_policy_random, seed);
        chance += run_trials(&two, "RPRPR", 1, 20, &hash);
        assert_int_equal(grrl_learner_usage(&two.learner).n, 0);
    }
    print_message("learn %u, paper %u, greedy %u, random %u pushes\n", learned[0], learned[1],
                  learned[2], chance);
    for (int i = 0; i < LEARNERS; i++)
        assert_true(2 * learned[i] < chance);
}

static void experience_of_one_object_helps_with_another(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    uint32_t hash = 0;
    for (int i = 0; i < LEARNERS; i++) {
        unsigned with = 0;
        unsigned without = 0;
        for (uint64_t seed = SEED; seed < SEED + 40; seed++) {
            init(&one, learners[i], seed);
            (void)run_trials(&one, "RPR", 1, 20, &hash);
            with += run_trials(&one, "RPRPR", 21, 5, &hash);
            init(&two, learners[i], seed);
            without += run_trials(&two, "RPRPR", 21, 5, &hash);
        }
        print_message("with %u, without %u pushes\n", with, without);
        assert_true(with < without);
    }
}

static void start(struct grrl_learner *learner)
{
    grrl_learner_begin_trial(learner, 1);
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
}

static struct grrl_update adopt(struct grrl_learner *learner, uint16_t number, uint8_t direction,
                                bool ended)
{
    struct grrl_decision decision;
    struct grrl_update update;
    assert_int_equal(grrl_learner_adopt(learner, number, direction, false, &decision), GRRL_OK);
    (void)world_push(&decision.choice);
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
    assert_int_equal(grrl_learner_learn(learner, ended, &update), GRRL_OK);
    return update;
}

/* On a stiff chain the second push across pays. Trying all others first would take 70 pushes. */
static void a_push_is_repeated_where_that_pays(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    uint32_t hash = 0;
    stiff = true;
    for (uint64_t seed = SEED; seed < SEED + 5; seed++) {
        init(&one, &grrl_policy_learn, seed);
        (void)run_trials(&one, "R", 1, 30, &hash);
        unsigned pushes = run_trials(&one, "R", 31, 10, &hash);
        print_message("%u pushes in 10 trials\n", pushes);
        assert_true(pushes < 50);
    }
}

/* Known just as little, a new push comes before one that was in vain. */
static void a_push_made_in_vain_is_not_the_next_one(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    for (uint64_t seed = SEED; seed < SEED + 20; seed++) {
        struct grrl_decision decision;
        init(&one, &grrl_policy_learn, seed);
        world_start("R");
        start(&one.learner);
        (void)adopt(&one.learner, 1, 0, false);
        assert_int_equal(grrl_learner_choose(&one.learner, &decision), GRRL_OK);
        assert_int_not_equal(decision.choice.direction, 0);
    }
}

static void the_same_outcomes_give_the_same_choices(void **state)
{
    (void)state;
    for (int i = 0; i < LEARNERS; i++) {
        uint32_t a = 0;
        uint32_t b = 0;
        uint32_t c = 0;
        init(&one, learners[i], SEED);
        init(&two, learners[i], SEED);
        unsigned pushes = run_trials(&one, "RPRP", 1, 15, &a);
        assert_int_equal(run_trials(&two, "RPRP", 1, 15, &b), pushes);
        assert_int_equal(a, b);
        init(&two, learners[i], SEED + 1);
        (void)run_trials(&two, "RPRP", 1, 15, &c);
        assert_int_not_equal(a, c);
    }
}

/* A trial begun, and abandoned after some draws, leaves no trace but experience. */
static void nothing_but_experience_outlives_a_trial(void **state)
{
    (void)state;
    uint32_t a = 0;
    uint32_t b = 0;
    init(&one, &grrl_policy_random, SEED);
    init(&two, &grrl_policy_random, SEED);
    (void)run_trial(&one, "RP", 3, &a);
    a = 0;
    world_start("RPR");
    grrl_learner_begin_trial(&one.learner, 4);
    assert_int_equal(grrl_learner_perceive(&one.learner), GRRL_OK);
    struct grrl_decision decision;
    assert_int_equal(grrl_learner_choose(&one.learner, &decision), GRRL_OK);
    grrl_learner_abandon_trial(&one.learner);
    (void)run_trial(&one, "RPRR", 9, &a);
    (void)run_trial(&two, "RPRR", 9, &b);
    assert_int_equal(a, b);
}

static void a_discovery_is_paid_once(void **state)
{
    (void)state;
    struct grrl_learner *learner = &one.learner;
    start(learner);
    struct grrl_update update = adopt(learner, 1, 0, false);
    assert_true(update.reward == 0.0f);
    update = adopt(learner, 1, 2, false);
    assert_true(update.reward == 2.0f); /* a link and a joint */
    world.n_bodies = 1;                 /* a belief may be given up .. */
    world.n_revealed = 0;
    world.last[0] = 3;
    update = adopt(learner, 1, 0, false);
    assert_true(update.reward == 0.0f);
    update = adopt(learner, 1, 2, false); /* .. and come back */
    assert_true(update.reward == 0.0f);
    world_reveal(0); /* what shows at rest is nobody's merit */
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
    update = adopt(learner, 1, 0, false);
    assert_true(update.reward == 0.0f);
    update = adopt(learner, 1, 2, true);
    assert_true(update.reward == 3.0f); /* and the trial's own */
}

static void targets_look_one_push_ahead(void **state)
{
    (void)state;
    struct grrl_learner *learner = &one.learner;
    init(&one, &grrl_policy_paper, SEED);
    start(learner);
    struct grrl_update update = adopt(learner, 1, 2, false);
    assert_true(update.target == 2.0f);
    assert_int_equal(update.index, 0);
    start(learner);
    world_start("RPR");
    start(learner);
    update = adopt(learner, 1, 0, false); /* in vain, but the next state is worth 2 */
    assert_true(update.reward == 0.0f);
    assert_true(update.target == 0.1f * 2.0f);
    update = adopt(learner, 1, 2, true); /* nothing follows the end */
    assert_true(update.target == 3.0f);
    const struct grrl_q *q = &one.policy.paper.store.experiences[update.index].q;
    assert_int_equal(q->n, 2);
    assert_true(q->value > 2.29f && q->value < 2.31f);
}

static void a_decision_by_experience_tells_why(void **state)
{
    (void)state;
    struct grrl_learner *learner = &one.learner;
    struct grrl_decision decision;
    init(&one, &grrl_policy_paper, SEED);
    start(learner);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_EXPLORE);
    assert_int_equal(decision.choice.source.kind, GRRL_SOURCE_NONE);
    assert_true(decision.choice.phi == 0.0f && decision.push.force_n == 10.0f);
    assert_int_equal(decision.body_number, 1);
    start(learner);
    for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++)
        (void)adopt(learner, 1, direction == 2 ? 3 : direction, false);
    (void)adopt(learner, 1, 2, false);
    world_start("RPR");
    start(learner);
    (void)adopt(learner, 1, 3, false); /* now used later than the best */
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_EXPLOIT);
    assert_int_equal(decision.choice.direction, 2);
    assert_int_equal(decision.choice.source.kind, GRRL_SOURCE_EXACT);
    assert_true(decision.choice.phi == 1.0f && decision.choice.value == 2.0f);
    assert_true(decision.choice.lower < 2.0f && decision.choice.upper > 2.0f);
    const struct grrl_experience_store *store = &one.policy.paper.store;
    const struct grrl_experience *best = &store->experiences[decision.choice.source.index];
    assert_int_equal(best->used_at, store->clock);
    start(learner);
    (void)adopt(learner, 1, 3, false);
    assert_true(best->used_at < store->clock);
    assert_int_equal(grrl_learner_adopt(learner, 1, 2, true, &decision), GRRL_OK);
    assert_int_equal(best->used_at, store->clock); /* as when it was chosen here */
    start(learner);
    assert_int_equal(grrl_learner_adopt(learner, 1, 2, false, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_ADOPTED);
    assert_true(decision.choice.value == 2.0f);
}

static void a_decision_by_cases_tells_why(void **state)
{
    (void)state;
    struct grrl_learner *learner = &one.learner;
    struct grrl_decision decision;
    start(learner);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_EXPLORE);
    assert_int_equal(decision.choice.source.kind, GRRL_SOURCE_NONE);
    assert_int_equal(decision.choice.source.index, GRRL_NO_ENTRY);
    assert_true(decision.choice.phi == 0.0f && decision.choice.value == 0.5f);
    start(learner);
    struct grrl_update update = adopt(learner, 1, 2, false);
    assert_true(update.reward == 2.0f && update.target == 2.0f);
    assert_int_equal(update.index, 0);
    world_start("RPR");
    start(learner);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_EXPLOIT);
    assert_int_equal(decision.choice.direction % 3, 2); /* across, to either side */
    assert_int_equal(decision.choice.source.kind, GRRL_SOURCE_CASES);
    assert_int_equal(decision.choice.source.index, 0);
    assert_int_equal(decision.choice.source.distance, 0);
    /* one reward of 2, of another trial, over a prior of 0.5 of weight 1; no other object is known
     */
    float trust = 1.0f / (1.0f + grrl_exp(-one.policy.learn.config.confidence));
    float value = (0.5f + trust * 2.0f) / (1.0f + trust);
    assert_true(fabsf(decision.choice.value - value) < 1e-5f);
    assert_true(decision.choice.lower < value && decision.choice.upper > value);
    start(learner);
    assert_int_equal(grrl_learner_adopt(learner, 1, 0, false, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_ADOPTED);
    assert_int_equal(decision.choice.source.index, 0);
    assert_int_equal(decision.choice.source.distance, 1);
    assert_true(decision.choice.value > 0.5f && decision.choice.value < value);
}

static void calls_out_of_order_are_refused(void **state)
{
    (void)state;
    struct grrl_learner *learner = &one.learner;
    struct grrl_decision decision;
    struct grrl_update update;
    assert_int_equal(grrl_learner_perceive(learner), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_ORDER);
    grrl_learner_observe(learner, NULL, false);
    assert_int_equal(world.frames, 0);
    grrl_learner_begin_trial(learner, 1);
    grrl_learner_observe(learner, NULL, false);
    assert_int_equal(world.frames, 1);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_ORDER);
    world.nothing_seen = true;
    assert_int_equal(grrl_learner_perceive(learner), GRRL_ERR_NONE);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_ORDER);
    world.nothing_seen = false;
    world.n_bodies = 0;
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_NONE);
    world.n_bodies = 1;
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
    assert_int_equal(grrl_learner_learn(learner, false, &update), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_adopt(learner, 99, 0, false, &decision), GRRL_ERR_NONE);
    assert_int_equal(grrl_learner_adopt(learner, 1, 6, false, &decision), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_adopt(learner, 1, 0, false, &decision), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_learn(learner, false, &update), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_learn(learner, true, &update), GRRL_OK);
    assert_int_equal(grrl_learner_learn(learner, true, &update), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_ORDER);
}

static void a_learner_of_one_entry_works(void **state)
{
    (void)state;
    for (int i = 0; i < LEARNERS; i++) {
        uint32_t hash = 0;
        init_with(&one, learners[i], 1, SEED);
        (void)run_trials(&one, "RPR", 1, 10, &hash);
        assert_int_equal(grrl_learner_usage(&one.learner).n, 1);
        assert_int_equal(grrl_learner_usage(&one.learner).capacity, 1);
        assert_true(grrl_learner_usage(&one.learner).evictions > 0);
    }
}

static void a_policy_needs_its_memory(void **state)
{
    (void)state;
    struct grrl_policy policy;
    for (int i = 0; i < LEARNERS; i++) {
        size_t bytes = learners[i]->bytes(10);
        assert_int_equal(grrl_policy_make(learners[i], one.policy.bytes, bytes, 0, NULL, &policy),
                         GRRL_ERR_ARGUMENT);
        assert_int_equal(
            grrl_policy_make(learners[i], one.policy.bytes, bytes - 1, 10, NULL, &policy),
            GRRL_ERR_FULL);
        assert_int_equal(grrl_policy_make(learners[i], one.policy.bytes, bytes, 10, NULL, &policy),
                         GRRL_OK);
        assert_ptr_equal(policy.type, learners[i]);
    }
    assert_int_equal(grrl_policy_make(&grrl_policy_random, NULL, 0, 0, NULL, &policy), GRRL_OK);
    assert_int_equal(grrl_learner_init(&one.learner, &one.config, policy), GRRL_OK);
    uint32_t hash = 0;
    (void)run_trials(&one, "RPR", 1, 3, &hash);
}

static void every_policy_is_found_by_its_name(void **state)
{
    (void)state;
    unsigned n = 0;
    for (const struct grrl_policy_type *const *type = grrl_policies; *type != NULL; type++, n++) {
        assert_ptr_equal(grrl_policy_find((*type)->name), *type);
        assert_true(strlen((*type)->name) < GRRL_POLICY_NAME_BYTES);
        assert_true((*type)->config_bytes <= GRRL_POLICY_CONFIG_BYTES);
    }
    assert_true(n >= 4);
    assert_ptr_equal(grrl_policies[0], &grrl_policy_learn);
    assert_null(grrl_policy_find("nobody"));
    assert_null(grrl_policy_find(""));
}

static void a_wrong_configuration_is_refused(void **state)
{
    (void)state;
    struct grrl_policy policy;
    struct grrl_paper_config paper;
    grrl_paper_config_default(&paper);
    paper.alpha = 2.0f;
    assert_int_equal(grrl_policy_make(&grrl_policy_paper, two.policy.bytes, sizeof two.policy.bytes,
                                      10, &paper, &policy),
                     GRRL_ERR_ARGUMENT);
    struct grrl_case_config cases;
    grrl_case_config_default(&cases);
    cases.memory = 0;
    assert_int_equal(grrl_policy_make(&grrl_policy_learn, two.policy.bytes, sizeof two.policy.bytes,
                                      10, &cases, &policy),
                     GRRL_ERR_ARGUMENT);
    policy = one.learner.policy;
    struct grrl_learner_config config = one.config;
    config.grounding.force_n = 0.0f;
    assert_int_equal(grrl_learner_init(&one.learner, &config, policy), GRRL_ERR_ARGUMENT);
    config = one.config;
    config.perception.noise_m = 0.0f;
    assert_int_equal(grrl_learner_init(&one.learner, &config, policy), GRRL_ERR_ARGUMENT);
    const float wrong[] = {-0.1f, 1e9f, INFINITY, NAN};
    for (int i = 0; i < 4; i++) {
        config = one.config;
        config.trial_reward = wrong[i];
        assert_int_equal(grrl_learner_init(&one.learner, &config, policy), GRRL_ERR_ARGUMENT);
        config = one.config;
        config.large_m = i == 1 ? 0.0f : wrong[i];
        assert_int_equal(grrl_learner_init(&one.learner, &config, policy), GRRL_ERR_ARGUMENT);
    }
}

static void random_pushes_are_uniform(void **state)
{
    (void)state;
    enum { LINKS = 2, ACTIONS = LINKS * GRRL_DIRECTIONS, DRAWS = 20000 };
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_graph graph;
    struct grrl_random random;
    unsigned count[ACTIONS] = {0};
    grrl_graph_clear(&graph);
    graph.n = LINKS;
    grrl_random_init(&random, SEED, 1);
    const struct grrl_view view = {.state = &graph};
    for (int i = 0; i < DRAWS; i++) {
        struct grrl_choice choice;
        grrl_policy_random.choose(NULL, &view, &random, &choice);
        assert_int_equal(choice.reason, GRRL_CHOICE_RANDOM);
        assert_int_equal(choice.source.kind, GRRL_SOURCE_NONE);
        assert_true(choice.link < LINKS && choice.direction < GRRL_DIRECTIONS);
        count[choice.link * GRRL_DIRECTIONS + choice.direction]++;
    }
    for (int i = 0; i < ACTIONS; i++)
        assert_true(fabs(count[i] - (double)DRAWS / ACTIONS) < 6.0 * sqrt((double)DRAWS / ACTIONS));
}

static void the_belief_is_a_term(void **state)
{
    (void)state;
    struct grrl_learner *learner = &one.learner;
    start(learner);
    (void)adopt(learner, 1, 2, false);
    (void)adopt(learner, 1, 2, false);
    struct grrl_term_node nodes[64];
    struct grrl_term_store store;
    grrl_term_store_init(&store, nodes, 64);
    grrl_term term, again;
    assert_int_equal(grrl_learner_term(learner, &store, &term), GRRL_OK);
    char text[200];
    size_t length;
    assert_int_equal(grrl_term_print(&store, term, sizeof text, text, &length), GRRL_OK);
    print_message("%s\n", text);
    assert_int_equal(grrl_term_parse(&store, text, length, &again, NULL), GRRL_OK);
    struct grrl_graph graph;
    struct grrl_name names[GRRL_MAX_LINKS];
    assert_int_equal(grrl_graph_from_term(&store, again, &graph, names, NULL, NULL, NULL), GRRL_OK);
    struct grrl_match match;
    uint8_t map[GRRL_MAX_LINKS];
    grrl_match_begin(&match, GRRL_MATCH_ISOMORPHISM, &graph, &learner->state, GRRL_ALL_PROPERTIES,
                     GRRL_MATCH_BUDGET);
    assert_int_equal(grrl_match_next(&match, map), GRRL_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(learning_needs_fewer_pushes_than_chance, set_up),
        cmocka_unit_test_setup(experience_of_one_object_helps_with_another, set_up),
        cmocka_unit_test_setup(a_push_is_repeated_where_that_pays, set_up),
        cmocka_unit_test_setup(a_push_made_in_vain_is_not_the_next_one, set_up),
        cmocka_unit_test_setup(the_same_outcomes_give_the_same_choices, set_up),
        cmocka_unit_test_setup(nothing_but_experience_outlives_a_trial, set_up),
        cmocka_unit_test_setup(a_discovery_is_paid_once, set_up),
        cmocka_unit_test_setup(targets_look_one_push_ahead, set_up),
        cmocka_unit_test_setup(a_decision_by_experience_tells_why, set_up),
        cmocka_unit_test_setup(a_decision_by_cases_tells_why, set_up),
        cmocka_unit_test_setup(calls_out_of_order_are_refused, set_up),
        cmocka_unit_test_setup(a_learner_of_one_entry_works, set_up),
        cmocka_unit_test_setup(a_policy_needs_its_memory, set_up),
        cmocka_unit_test_setup(a_wrong_configuration_is_refused, set_up),
        cmocka_unit_test_setup(every_policy_is_found_by_its_name, set_up),
        cmocka_unit_test_setup(random_pushes_are_uniform, set_up),
        cmocka_unit_test_setup(the_belief_is_a_term, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
