/* The learner on a simulated chain: rewards, targets, decisions, files. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/learner/learner.h"
#include "grrl/structure/term.h"
#include "hidden_chain.h"
#include "memory_file.h"
#include "store_check.h"

#define SEED UINT64_C(20080630)

enum { CASES = 100, STATES = 60, EXPERIENCES = 150, MOST_PUSHES = 300 };

struct fixture {
    struct grrl_learner learner;
    struct grrl_learner_config config;
    struct grrl_learner_memory memory;
    struct grrl_case cases[CASES];
    struct grrl_experience_state states[STATES];
    struct grrl_experience experiences[EXPERIENCES];
};

static struct fixture one, two;

static void init(struct fixture *fixture, enum grrl_policy_kind kind, uint64_t seed)
{
    grrl_learner_config_default(&fixture->config);
    fixture->config.policy.kind = kind;
    fixture->config.seed = seed;
    fixture->memory = (struct grrl_learner_memory){
        .cases = fixture->cases,
        .cases_capacity = CASES,
        .states = fixture->states,
        .states_capacity = STATES,
        .experiences = fixture->experiences,
        .experiences_capacity = EXPERIENCES,
    };
    assert_int_equal(grrl_learner_init(&fixture->learner, &fixture->config, &fixture->memory),
                     GRRL_OK);
}

static int set_up(void **state)
{
    (void)state;
    init(&one, GRRL_POLICY_LEARN, SEED);
    world_start("RPR");
    return 0;
}

/* One trial to its end; *hash collects every choice. */
static unsigned run_trial(struct fixture *fixture, const char *joints, uint32_t trial,
                          uint32_t *hash)
{
    struct grrl_learner *learner = &fixture->learner;
    world_start(joints);
    grrl_learner_begin_trial(learner, trial);
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
    float sum = 0.0f;
    for (unsigned pushes = 1; pushes <= MOST_PUSHES; pushes++) {
        struct grrl_decision decision;
        struct grrl_update update;
        assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
        *hash = *hash * 31u + decision.choice.link * 6u + decision.choice.direction;
        bool ended = world_push(&decision.choice);
        assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
        assert_int_equal(grrl_learner_learn(learner, ended, &update), GRRL_OK);
        check_store(&learner->store);
        sum += update.reward;
        if (ended) { /* every link but the first, every joint, the trial */
            assert_true(sum == 2.0f * (float)strlen(joints) + 1.0f);
            return pushes;
        }
    }
    return MOST_PUSHES;
}

static unsigned run_trials(struct fixture *fixture, const char *joints, uint32_t from, uint32_t n,
                           uint32_t *hash)
{
    unsigned pushes = 0;
    for (uint32_t trial = from; trial < from + n; trial++)
        pushes += run_trial(fixture, joints, trial, hash);
    return pushes;
}

static const enum grrl_policy_kind learners[] = {GRRL_POLICY_LEARN, GRRL_POLICY_PAPER};
enum { LEARNERS = 2 };

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
        init(&two, GRRL_POLICY_RANDOM, seed);
        chance += run_trials(&two, "RPRPR", 1, 20, &hash);
        assert_int_equal(two.learner.store.n_experiences, 0);
        assert_int_equal(two.learner.cases.n, 0);
    }
    print_message("learn %u, paper %u, random %u pushes\n", learned[0], learned[1], chance);
    assert_true(2 * learned[0] < chance && 2 * learned[1] < chance);
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

static struct memory_file file = {.calls_left = -1};

static void what_was_learned_can_be_saved(void **state)
{
    (void)state;
    const struct grrl_io io = memory_file_io(&file);
    for (int i = 0; i < LEARNERS; i++) {
        uint32_t hash = 0;
        uint32_t a = 0;
        uint32_t b = 0;
        init(&one, learners[i], SEED);
        (void)run_trials(&one, "RPRP", 1, 10, &hash);
        file.size = file.at = 0;
        assert_int_equal(grrl_learner_save(&one.learner, &io), GRRL_OK);
        init(&two, learners[i], SEED);
        assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_OK);
        assert_int_equal(file.at, file.size);
        assert_int_equal(grrl_learner_usage_of(&two.learner).n,
                         grrl_learner_usage_of(&one.learner).n);
        unsigned pushes = run_trials(&one, "RPRP", 11, 10, &a);
        assert_int_equal(run_trials(&two, "RPRP", 11, 10, &b), pushes);
        assert_int_equal(a, b);
        for (size_t cut = 0; cut < file.size; cut += cut < 200 ? 1 : 37) {
            size_t whole = file.size;
            file.size = cut;
            file.at = 0;
            assert_int_equal(grrl_learner_load(&two.learner, &io), GRRL_ERR_IO);
            assert_int_equal(two.learner.cases.n, 0);
            assert_int_equal(two.learner.store.n_experiences, 0);
            file.size = whole;
        }
    }
}

/* A trial begun, and abandoned after some draws, leaves no trace but experience. */
static void nothing_but_experience_outlives_a_trial(void **state)
{
    (void)state;
    uint32_t a = 0;
    uint32_t b = 0;
    init(&one, GRRL_POLICY_RANDOM, SEED);
    init(&two, GRRL_POLICY_RANDOM, SEED);
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
    assert_int_equal(grrl_learner_adopt(learner, number, direction, &decision), GRRL_OK);
    (void)world_push(&decision.choice);
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
    assert_int_equal(grrl_learner_learn(learner, ended, &update), GRRL_OK);
    return update;
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
    init(&one, GRRL_POLICY_PAPER, SEED);
    start(learner);
    struct grrl_update update = adopt(learner, 1, 2, false);
    assert_true(update.target == 2.0f);
    assert_int_equal(update.experience, 0);
    assert_int_equal(update.updated_case, GRRL_NO_CASE);
    start(learner);
    world_start("RPR");
    start(learner);
    update = adopt(learner, 1, 0, false); /* in vain, but the next state is worth 2 */
    assert_true(update.reward == 0.0f);
    assert_true(update.target == 0.1f * 2.0f);
    update = adopt(learner, 1, 2, true); /* nothing follows the end */
    assert_true(update.target == 3.0f);
    const struct grrl_q *q = &learner->store.experiences[update.experience].q;
    assert_int_equal(q->n, 2);
    assert_true(q->value > 2.29f && q->value < 2.31f);
}

static void a_decision_by_experience_tells_why(void **state)
{
    (void)state;
    struct grrl_learner *learner = &one.learner;
    struct grrl_decision decision;
    init(&one, GRRL_POLICY_PAPER, SEED);
    start(learner);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_EXPLORE);
    assert_int_equal(decision.choice.from.experience, GRRL_NO_EXPERIENCE);
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
    assert_int_equal(decision.choice.from.level, GRRL_RECALL_EXACT);
    assert_true(decision.choice.phi == 1.0f && decision.choice.value == 2.0f);
    assert_true(decision.choice.lower < 2.0f && decision.choice.upper > 2.0f);
    assert_int_equal(learner->store.experiences[decision.choice.from.experience].used_at,
                     learner->store.clock);
    start(learner);
    assert_int_equal(grrl_learner_adopt(learner, 1, 2, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_FOREIGN);
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
    assert_int_equal(decision.choice.closest_case, GRRL_NO_CASE);
    assert_int_equal(decision.choice.from.experience, GRRL_NO_EXPERIENCE);
    assert_true(decision.choice.phi == 0.0f && decision.choice.value == 0.5f);
    start(learner);
    struct grrl_update update = adopt(learner, 1, 2, false);
    assert_true(update.reward == 2.0f && update.target == 2.0f);
    assert_int_equal(update.updated_case, 0);
    assert_int_equal(update.experience, GRRL_NO_EXPERIENCE);
    world_start("RPR");
    start(learner);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_EXPLOIT);
    assert_int_equal(decision.choice.direction % 3, 2); /* across, to either side */
    assert_int_equal(decision.choice.closest_case, 0);
    assert_int_equal(decision.choice.mismatches, 0);
    /* one reward of 2, of another trial, over a prior of weight 1 and 0.5 */
    float trust = 1.0f / (1.0f + grrl_exp(-one.learner.config.policy.cases.confidence));
    float value = (0.5f + trust * 2.0f) / (1.0f + trust);
    assert_true(fabsf(decision.choice.value - value) < 1e-5f);
    assert_true(decision.choice.lower < value && decision.choice.upper > value);
    start(learner);
    assert_int_equal(grrl_learner_adopt(learner, 1, 0, &decision), GRRL_OK);
    assert_int_equal(decision.choice.reason, GRRL_CHOICE_FOREIGN);
    assert_int_equal(decision.choice.closest_case, 0);
    assert_int_equal(decision.choice.mismatches, 1);
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
    assert_int_equal(grrl_learner_adopt(learner, 99, 0, &decision), GRRL_ERR_NONE);
    assert_int_equal(grrl_learner_adopt(learner, 1, 6, &decision), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_OK);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_adopt(learner, 1, 0, &decision), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_learn(learner, false, &update), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_perceive(learner), GRRL_OK);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_learn(learner, true, &update), GRRL_OK);
    assert_int_equal(grrl_learner_learn(learner, true, &update), GRRL_ERR_ORDER);
    assert_int_equal(grrl_learner_choose(learner, &decision), GRRL_ERR_ORDER);
}

static void a_learner_of_one_experience_works(void **state)
{
    (void)state;
    for (int i = 0; i < LEARNERS; i++) {
        uint32_t hash = 0;
        one.config.policy.kind = learners[i];
        one.memory.cases_capacity = one.memory.states_capacity = 1;
        one.memory.experiences_capacity = 1;
        assert_int_equal(grrl_learner_init(&one.learner, &one.config, &one.memory), GRRL_OK);
        (void)run_trials(&one, "RPR", 1, 10, &hash);
        assert_int_equal(grrl_learner_usage_of(&one.learner).n, 1);
        assert_int_equal(grrl_learner_usage_of(&one.learner).capacity, 1);
        assert_true(grrl_learner_usage_of(&one.learner).evictions > 0);
    }
}

static void a_policy_needs_its_memory(void **state)
{
    (void)state;
    const struct grrl_learner_memory all = one.memory;
    const struct {
        enum grrl_policy_kind kind;
        uint32_t cases, states, experiences;
        enum grrl_status status;
    } given[] = {
        {GRRL_POLICY_LEARN, 0, STATES, EXPERIENCES, GRRL_ERR_ARGUMENT},
        {GRRL_POLICY_LEARN, CASES, 0, 0, GRRL_OK},
        {GRRL_POLICY_PAPER, CASES, 0, EXPERIENCES, GRRL_ERR_ARGUMENT},
        {GRRL_POLICY_PAPER, CASES, STATES, 0, GRRL_ERR_ARGUMENT},
        {GRRL_POLICY_PAPER, 0, STATES, EXPERIENCES, GRRL_OK},
        {GRRL_POLICY_RANDOM, 0, 0, 0, GRRL_OK},
    };
    for (size_t i = 0; i < sizeof given / sizeof given[0]; i++) {
        one.config.policy.kind = given[i].kind;
        one.memory.cases = given[i].cases > 0 ? all.cases : NULL;
        one.memory.cases_capacity = given[i].cases;
        one.memory.states = given[i].states > 0 ? all.states : NULL;
        one.memory.states_capacity = given[i].states;
        one.memory.experiences = given[i].experiences > 0 ? all.experiences : NULL;
        one.memory.experiences_capacity = given[i].experiences;
        assert_int_equal(grrl_learner_init(&one.learner, &one.config, &one.memory),
                         given[i].status);
        if (given[i].status == GRRL_OK) {
            uint32_t hash = 0;
            (void)run_trials(&one, "RPR", 1, 3, &hash);
        }
    }
}

static void a_wrong_configuration_is_refused(void **state)
{
    (void)state;
    struct grrl_learner_config config = one.config;
    config.policy.alpha = 2.0f;
    assert_int_equal(grrl_learner_init(&one.learner, &config, &one.memory), GRRL_ERR_ARGUMENT);
    config = one.config;
    config.policy.cases.memory = 0;
    assert_int_equal(grrl_learner_init(&one.learner, &config, &one.memory), GRRL_ERR_ARGUMENT);
    config = one.config;
    config.grounding.force_n = 0.0f;
    assert_int_equal(grrl_learner_init(&one.learner, &config, &one.memory), GRRL_ERR_ARGUMENT);
    config = one.config;
    config.perception.noise_m = 0.0f;
    assert_int_equal(grrl_learner_init(&one.learner, &config, &one.memory), GRRL_ERR_ARGUMENT);
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
        cmocka_unit_test_setup(the_same_outcomes_give_the_same_choices, set_up),
        cmocka_unit_test_setup(what_was_learned_can_be_saved, set_up),
        cmocka_unit_test_setup(nothing_but_experience_outlives_a_trial, set_up),
        cmocka_unit_test_setup(a_discovery_is_paid_once, set_up),
        cmocka_unit_test_setup(targets_look_one_push_ahead, set_up),
        cmocka_unit_test_setup(a_decision_by_experience_tells_why, set_up),
        cmocka_unit_test_setup(a_decision_by_cases_tells_why, set_up),
        cmocka_unit_test_setup(calls_out_of_order_are_refused, set_up),
        cmocka_unit_test_setup(a_learner_of_one_experience_works, set_up),
        cmocka_unit_test_setup(a_policy_needs_its_memory, set_up),
        cmocka_unit_test_setup(a_wrong_configuration_is_refused, set_up),
        cmocka_unit_test_setup(the_belief_is_a_term, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
