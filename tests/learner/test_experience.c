/* Experiences: updates, recall against trying every mapping, eviction. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/base/random.h"
#include "grrl/learner/relational_q/experience.h"
#include "store_check.h"

#define SEED UINT64_C(20080627)

enum { STATES = 40, EXPERIENCES = 120 };

static struct grrl_experience_state states[STATES];
static struct grrl_experience experiences[EXPERIENCES];

static const struct grrl_recall_config everything = {
    .deepest = GRRL_RECALL_SUBSTRUCTURE, .budget = GRRL_MATCH_BUDGET, .states = GRRL_RECALL_STATES};

static void init(struct grrl_experience_store *store, uint32_t n_states, uint32_t n_experiences)
{
    grrl_experience_init(store, states, n_states, experiences, n_experiences);
}

/* "RPR" is the chain of four links with these joints, all with the label of `labels`. */
static struct grrl_graph chain(const char *joints, grrl_label label)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    assert_int_equal(grrl_graph_add_link(&graph, label, NULL), GRRL_OK);
    for (uint8_t i = 0; joints[i] != '\0'; i++) {
        assert_int_equal(grrl_graph_add_link(&graph, label, NULL), GRRL_OK);
        assert_int_equal(grrl_graph_add_joint(&graph, i, (uint8_t)(i + 1),
                                              joints[i] == 'R' ? GRRL_REVOLUTE : GRRL_PRISMATIC),
                         GRRL_OK);
    }
    return graph;
}

static uint32_t teach(struct grrl_experience_store *store, const struct grrl_graph *state,
                      uint8_t link, uint8_t direction, float target)
{
    uint32_t index;
    assert_int_equal(grrl_experience_update(store, state, link, direction, target, 0.5f, &index),
                     GRRL_OK);
    check_store(store);
    return index;
}

static void statistics_follow_the_targets(void **state)
{
    (void)state;
    struct grrl_experience_store store;
    init(&store, STATES, EXPERIENCES);
    struct grrl_graph graph = chain("RP", 0);
    const float target[] = {1.0f, 3.0f, 2.0f, -1.0f};
    uint32_t index = 0;
    for (int i = 0; i < 4; i++)
        index = teach(&store, &graph, 0, 2, target[i]);
    const struct grrl_q *q = &store.experiences[index].q;
    assert_int_equal(store.n_experiences, 1);
    assert_int_equal(q->n, 4);
    assert_true(fabsf(q->mean - 1.25f) < 1e-6f);
    assert_true(fabsf(q->deviations - 8.75f) < 1e-5f);
    assert_true(fabsf(q->value - 0.5f) < 1e-6f); /* 1, 2, 2, 0.5 with alpha 0.5 */
}

static void isomorphic_states_and_symmetric_actions_share_an_entry(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 1);
    for (int round = 0; round < 300; round++) {
        struct grrl_experience_store store;
        init(&store, STATES, EXPERIENCES);
        struct grrl_graph graph = chain("RPPR", GRRL_PROPERTY_SMALL); /* a palindrome */
        uint8_t order[GRRL_MAX_LINKS];
        struct grrl_graph shuffled;
        shuffle(&random, graph.n, order);
        grrl_graph_permute(&graph, order, &shuffled);
        uint8_t place[GRRL_MAX_LINKS];
        for (uint8_t i = 0; i < graph.n; i++)
            place[order[i]] = i;
        uint32_t first = teach(&store, &graph, 1, 3, 1.0f);
        assert_int_equal(teach(&store, &graph, 3, 3, 1.0f), first);
        assert_int_equal(teach(&store, &shuffled, place[1], 3, 1.0f), first);
        assert_int_equal(teach(&store, &shuffled, place[3], 3, 1.0f), first);
        assert_int_not_equal(teach(&store, &shuffled, place[2], 3, 1.0f), first);
        assert_int_not_equal(teach(&store, &graph, 1, 2, 1.0f), first);
        assert_int_equal(store.n_states, 1);
        assert_int_equal(store.n_experiences, 3);
        struct grrl_recall recall;
        grrl_experience_recall(&store, &shuffled, &everything, &recall);
        assert_int_equal(recall.entry[place[1]][3].experience, first);
        assert_int_equal(recall.entry[place[3]][3].experience, first);
        assert_int_equal(recall.entry[place[3]][3].level, GRRL_RECALL_EXACT);
        assert_int_equal(recall.entry[place[0]][3].experience, GRRL_NO_EXPERIENCE);
    }
}

static void closer_matches_come_first(void **state)
{
    (void)state;
    struct grrl_experience_store store;
    init(&store, STATES, EXPERIENCES);
    struct grrl_graph small = chain("RP", GRRL_PROPERTY_SMALL);
    struct grrl_graph large = chain("RP", GRRL_PROPERTY_LARGE);
    struct grrl_graph longer = chain("RPR", GRRL_PROPERTY_SMALL);
    struct grrl_graph longest = chain("RPRR", GRRL_PROPERTY_SMALL);
    struct grrl_recall recall;
    uint32_t a = teach(&store, &longest, 0, 0, 1.0f);
    grrl_experience_recall(&store, &small, &everything, &recall);
    assert_int_equal(recall.n_links, 3);
    assert_int_equal(recall.entry[0][0].experience, a);
    assert_int_equal(recall.entry[0][0].level, GRRL_RECALL_SUBSTRUCTURE);
    assert_int_equal(recall.entry[0][0].distance, 4);
    assert_int_equal(recall.entry[0][0].dropped, 0);
    assert_int_equal(recall.entry[2][0].experience, GRRL_NO_EXPERIENCE);
    uint32_t b = teach(&store, &longer, 0, 0, 1.0f);
    grrl_experience_recall(&store, &small, &everything, &recall);
    assert_int_equal(recall.entry[0][0].experience, b);
    assert_int_equal(recall.entry[0][0].distance, 2);
    grrl_experience_recall(&store, &large, &everything, &recall);
    assert_int_equal(recall.entry[0][0].dropped, 1);
    uint32_t c = teach(&store, &large, 0, 0, 1.0f);
    grrl_experience_recall(&store, &small, &everything, &recall);
    assert_int_equal(recall.entry[0][0].experience, c);
    assert_int_equal(recall.entry[0][0].level, GRRL_RECALL_RELAXED);
    assert_int_equal(recall.entry[0][0].distance, 0);
    assert_int_equal(recall.entry[0][0].dropped, 1);
    uint32_t d = teach(&store, &small, 0, 0, 1.0f);
    grrl_experience_recall(&store, &small, &everything, &recall);
    assert_int_equal(recall.entry[0][0].experience, d);
    assert_int_equal(recall.entry[0][0].level, GRRL_RECALL_EXACT);
}

static void retrieval_reaches_as_far_as_it_may(void **state)
{
    (void)state;
    struct grrl_experience_store store;
    init(&store, STATES, EXPERIENCES);
    struct grrl_graph small = chain("RP", GRRL_PROPERTY_SMALL);
    struct grrl_graph large = chain("RP", GRRL_PROPERTY_LARGE);
    struct grrl_graph longer = chain("RPR", GRRL_PROPERTY_SMALL);
    (void)teach(&store, &small, 0, 0, 1.0f);
    (void)teach(&store, &large, 0, 1, 1.0f);
    (void)teach(&store, &longer, 0, 2, 1.0f);
    for (int deepest = GRRL_RECALL_EXACT; deepest <= GRRL_RECALL_SUBSTRUCTURE; deepest++) {
        struct grrl_recall_config config = everything;
        config.deepest = (enum grrl_recall_level)deepest;
        struct grrl_recall recall;
        grrl_experience_recall(&store, &small, &config, &recall);
        for (int level = GRRL_RECALL_EXACT; level <= GRRL_RECALL_SUBSTRUCTURE; level++) {
            bool known = recall.entry[0][level].experience != GRRL_NO_EXPERIENCE;
            assert_int_equal(known, level <= deepest);
        }
    }
    struct grrl_graph longer_large = chain("RPR", GRRL_PROPERTY_LARGE);
    (void)teach(&store, &longer_large, 0, 3, 1.0f);
    struct grrl_recall_config strict = everything; /* no property is dropped */
    strict.strict = true;
    struct grrl_recall recall;
    grrl_experience_recall(&store, &small, &strict, &recall);
    for (int direction = 0; direction < 4; direction++) {
        bool known = recall.entry[0][direction].experience != GRRL_NO_EXPERIENCE;
        assert_int_equal(known, direction % 2 == 0);
    }
}

/* A centre with `leaves` equal links around it. */
static struct grrl_graph star(uint8_t leaves)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
    for (uint8_t i = 1; i <= leaves; i++) {
        assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
        assert_int_equal(grrl_graph_add_joint(&graph, 0, i, GRRL_REVOLUTE), GRRL_OK);
    }
    return graph;
}

static void many_mappings_still_bind_every_link(void **state)
{
    (void)state;
    struct grrl_experience_store store;
    init(&store, STATES, EXPERIENCES);
    struct grrl_graph small = star(5);
    struct grrl_graph big = star(7);
    uint32_t leaf = teach(&store, &small, 5, 0, 1.0f);
    struct grrl_recall recall;
    grrl_experience_recall(&store, &big, &everything, &recall);
    assert_int_equal(recall.entry[0][0].experience, GRRL_NO_EXPERIENCE);
    for (int i = 1; i <= 7; i++)
        assert_int_equal(recall.entry[i][0].experience, leaf);
    init(&store, STATES, EXPERIENCES);
    leaf = teach(&store, &big, 2, 0, 1.0f);
    grrl_experience_recall(&store, &small, &everything, &recall);
    for (int i = 1; i <= 5; i++)
        assert_int_equal(recall.entry[i][0].experience, leaf);
}

static void an_undecided_search_is_no_match(void **state)
{
    (void)state;
    struct grrl_experience_store store;
    init(&store, STATES, EXPERIENCES);
    struct grrl_graph small = chain("RRR", 0);
    struct grrl_graph big = chain("RRRR", 0);
    (void)teach(&store, &small, 0, 0, 1.0f);
    struct grrl_recall_config config = everything;
    struct grrl_recall recall;
    config.budget = 1;
    grrl_experience_recall(&store, &big, &config, &recall);
    for (int i = 0; i < 5; i++)
        assert_int_equal(recall.entry[i][0].experience, GRRL_NO_EXPERIENCE);
    config.budget = 100;
    grrl_experience_recall(&store, &big, &config, &recall);
    assert_int_not_equal(recall.entry[0][0].experience, GRRL_NO_EXPERIENCE);
}

/* A random graph of 1 to 5 links with up to two properties, joined at random. */
static struct grrl_graph random_graph(struct grrl_random *random)
{
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    uint8_t n = (uint8_t)(1 + grrl_random_below(random, 5));
    unsigned density = 1 + grrl_random_below(random, 3);
    for (uint8_t i = 0; i < n; i++) {
        grrl_label label = grrl_random_below(random, 3);
        if (GRRL_MAX_PROPERTIES > 1)
            label |= (grrl_label)grrl_random_below(random, 2) << 8;
        assert_int_equal(grrl_graph_add_link(&graph, label, NULL), GRRL_OK);
        for (uint8_t j = 0; j < i; j++) {
            if (grrl_random_below(random, 4) < density) {
                assert_int_equal(
                    grrl_graph_add_joint(&graph, i, j,
                                         (enum grrl_joint_type)grrl_random_below(random, 2)),
                    GRRL_OK);
            }
        }
    }
    return graph;
}

/* Whether some mapping of part into whole sends p to w, all injections tried one after another. */
static bool naive_maps(const struct grrl_graph *part, const struct grrl_graph *whole, bool exact,
                       grrl_label mask, uint8_t p, uint8_t w)
{
    uint32_t combinations = 1;
    for (uint8_t i = 0; i < part->n; i++)
        combinations *= whole->n;
    for (uint32_t combination = 0; combination < combinations; combination++) {
        uint8_t map[8] = {0};
        uint32_t rest = combination;
        for (uint8_t i = 0; i < part->n; i++) {
            map[i] = (uint8_t)(rest % whole->n);
            rest /= whole->n;
        }
        bool fits = map[p] == w;
        for (uint8_t i = 0; i < part->n && fits; i++) {
            fits = grrl_label_masked(part->label[i], mask) ==
                   grrl_label_masked(whole->label[map[i]], mask);
            for (uint8_t j = 0; j < i && fits; j++) {
                int joint = grrl_graph_joint(part, i, j);
                fits = map[i] != map[j] && ((!exact && joint == GRRL_NO_JOINT) ||
                                            grrl_graph_joint(whole, map[i], map[j]) == joint);
            }
        }
        if (fits)
            return true;
    }
    return false;
}

/* Level, distance and dropped properties as one number, smaller is closer; or UINT32_MAX. */
static uint32_t naive_closeness(const struct grrl_graph *stored, uint8_t v,
                                const struct grrl_graph *current, uint8_t c)
{
    grrl_label used = 0;
    for (uint8_t i = 0; i < stored->n; i++)
        used |= stored->label[i];
    for (uint8_t i = 0; i < current->n; i++)
        used |= current->label[i];
    uint32_t places = (uint32_t)((used & 0xff) != 0) + (uint32_t)((used & 0xff00) != 0);
    if (stored->n == current->n) {
        grrl_label mask = GRRL_ALL_PROPERTIES;
        for (uint32_t dropped = 0; dropped <= places; dropped++) {
            if (naive_maps(stored, current, true, mask, v, c))
                return (dropped == 0 ? 0u : 0x10000u) + dropped;
            bool second = dropped == 0 && (used & 0xff00) != 0;
            mask = second ? UINT64_C(0xff) : GRRL_NO_PROPERTIES;
        }
    }
    uint32_t distance = (uint32_t)(abs_difference(stored->n, current->n) +
                                   abs_difference((int)grrl_graph_joint_count(stored),
                                                  (int)grrl_graph_joint_count(current)));
    for (int bare = 0; bare < 2; bare++) {
        grrl_label mask = bare ? GRRL_NO_PROPERTIES : GRRL_ALL_PROPERTIES;
        bool forth = stored->n <= current->n && naive_maps(stored, current, false, mask, v, c);
        bool back = current->n <= stored->n && naive_maps(current, stored, false, mask, c, v);
        if (forth || back)
            return 0x20000u + distance * 16u + (bare ? places : 0u);
    }
    return UINT32_MAX;
}

static void check_against_naive(const struct grrl_experience_store *store,
                                const struct grrl_graph *current)
{
    struct grrl_recall recall;
    grrl_experience_recall(store, current, &everything, &recall);
    assert_int_equal(recall.n_links, current->n);
    for (uint8_t c = 0; c < current->n; c++) {
        uint32_t best[GRRL_DIRECTIONS];
        uint32_t closest[GRRL_DIRECTIONS];
        memset(best, 0xff, sizeof best);
        memset(closest, 0xff, sizeof closest);
        for (uint32_t i = 0; i < store->n_experiences; i++) {
            const struct grrl_experience *e = &store->experiences[i];
            struct grrl_graph stored;
            grrl_experience_graph(&store->states[e->state], &stored);
            uint32_t closeness = naive_closeness(&stored, e->link, current, c);
            bool tie = best[e->direction] != GRRL_NO_EXPERIENCE &&
                       closeness == closest[e->direction] && closeness != UINT32_MAX;
            if (closeness < closest[e->direction] ||
                (tie && e->q.n > store->experiences[best[e->direction]].q.n)) {
                best[e->direction] = i;
                closest[e->direction] = closeness;
            }
        }
        for (int direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            const struct grrl_recall_entry *entry = &recall.entry[c][direction];
            assert_int_equal(entry->experience, best[direction]);
            if (entry->experience != GRRL_NO_EXPERIENCE) {
                uint32_t closeness =
                    entry->level * 0x10000u + entry->distance * 16u + entry->dropped;
                assert_int_equal(closeness, closest[direction]);
                assert_int_equal(entry->stored_link, store->experiences[entry->experience].link);
            }
        }
    }
}

static void recall_agrees_with_trying_every_mapping(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 2);
    for (int round = 0; round < 60; round++) {
        struct grrl_experience_store store;
        init(&store, STATES, EXPERIENCES);
        for (int i = 0; i < 30; i++) {
            struct grrl_graph graph = random_graph(&random);
            uint8_t link = (uint8_t)grrl_random_below(&random, graph.n);
            uint8_t direction = (uint8_t)grrl_random_below(&random, GRRL_DIRECTIONS);
            (void)teach(&store, &graph, link, direction, 1.0f);
        }
        for (int i = 0; i < 6; i++) {
            struct grrl_graph graph = random_graph(&random);
            check_against_naive(&store, &graph);
        }
    }
}

static void the_experience_used_longest_ago_makes_room(void **state)
{
    (void)state;
    struct grrl_experience_store store;
    init(&store, STATES, 3);
    struct grrl_graph graph = chain("RP", 0);
    struct grrl_graph other = chain("RRP", 0);
    uint32_t first = teach(&store, &graph, 0, 0, 1.0f);
    (void)teach(&store, &other, 0, 1, 2.0f);
    (void)teach(&store, &graph, 0, 2, 3.0f);
    grrl_experience_touch(&store, first);
    (void)teach(&store, &graph, 0, 3, 4.0f); /* for the one of `other`, which goes with it */
    assert_int_equal(store.n_states, 1);
    assert_int_equal(store.n_experiences, 3);
    assert_int_equal(store.evictions, 1);
    assert_int_equal(store.high_water, 3);
    struct grrl_recall recall;
    grrl_experience_recall(&store, &graph, &everything, &recall);
    assert_int_not_equal(recall.entry[0][0].experience, GRRL_NO_EXPERIENCE);
    assert_int_equal(recall.entry[0][1].experience, GRRL_NO_EXPERIENCE);
    assert_int_not_equal(recall.entry[0][2].experience, GRRL_NO_EXPERIENCE);
    assert_int_not_equal(recall.entry[0][3].experience, GRRL_NO_EXPERIENCE);
}

static void the_state_used_longest_ago_makes_room(void **state)
{
    (void)state;
    struct grrl_experience_store store;
    init(&store, 2, EXPERIENCES);
    struct grrl_graph a = chain("RP", 0);
    struct grrl_graph b = chain("RRP", 0);
    struct grrl_graph c = chain("RRR", 0);
    (void)teach(&store, &a, 0, 0, 1.0f); /* the oldest experience, but not the oldest state */
    (void)teach(&store, &b, 0, 1, 2.0f);
    (void)teach(&store, &b, 0, 2, 2.0f);
    (void)teach(&store, &a, 0, 3, 3.0f);
    (void)teach(&store, &c, 0, 4, 4.0f);
    assert_int_equal(store.n_states, 2);
    assert_int_equal(store.n_experiences, 3);
    assert_int_equal(store.evictions, 2);
    struct grrl_recall_config exact = {.deepest = GRRL_RECALL_EXACT, .budget = 100, .states = 1};
    struct grrl_recall recall;
    grrl_experience_recall(&store, &b, &exact, &recall);
    assert_int_equal(recall.entry[0][1].experience, GRRL_NO_EXPERIENCE);
    grrl_experience_recall(&store, &a, &exact, &recall);
    assert_int_not_equal(recall.entry[0][0].experience, GRRL_NO_EXPERIENCE);
}

static void small_stores_stay_sound(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 3);
    const uint32_t capacity[][2] = {{1, 1}, {1, 9}, {9, 1}, {2, 5}, {5, 5}, {5, 2}};
    for (unsigned k = 0; k < sizeof capacity / sizeof capacity[0]; k++) {
        struct grrl_experience_store store;
        init(&store, capacity[k][0], capacity[k][1]);
        for (int i = 0; i < 400; i++) {
            struct grrl_graph graph = random_graph(&random);
            uint8_t link = (uint8_t)grrl_random_below(&random, graph.n);
            uint8_t direction = (uint8_t)grrl_random_below(&random, GRRL_DIRECTIONS);
            uint32_t index = teach(&store, &graph, link, direction, (float)i);
            assert_true(store.experiences[index].used_at == store.clock);
            struct grrl_recall recall;
            grrl_experience_recall(&store, &graph, &everything, &recall);
            assert_int_equal(recall.entry[link][direction].experience, index);
        }
        assert_true(store.evictions > 0);
        if (capacity[k][1] <= capacity[k][0])
            assert_int_equal(store.high_water, capacity[k][1]);
    }
}

/* The same updates in a store with an index, in one without, and in one indexed at the end. */
static void an_index_changes_nothing_that_is_recalled(void **state)
{
    (void)state;
    print_message("seed %llu\n", (unsigned long long)SEED);
    static struct grrl_experience_state more_states[2][STATES];
    static struct grrl_experience more_experiences[2][EXPERIENCES];
    static struct grrl_experience_index index[2];
    static struct grrl_experience_row rows[2][STATES];
    struct grrl_experience_store plain;
    struct grrl_experience_store indexed[2];
    init(&plain, STATES, EXPERIENCES);
    for (int k = 0; k < 2; k++)
        grrl_experience_init(&indexed[k], more_states[k], STATES, more_experiences[k], EXPERIENCES);
    grrl_experience_use_index(&indexed[0], &index[0], rows[0]);
    struct grrl_random random;
    grrl_random_init(&random, SEED, 4);
    for (int i = 0; i < 1000; i++) {
        struct grrl_graph graph = random_graph(&random);
        struct grrl_recall_config config = everything;
        if (i % 4 != 0) /* so few that some of a distance are left out */
            config.states = 1 + grrl_random_below(&random, 12);
        struct grrl_recall expected;
        grrl_experience_recall(&plain, &graph, &config, &expected);
        for (int k = 0; k < 2; k++) {
            struct grrl_recall recall;
            grrl_experience_recall(&indexed[k], &graph, &config, &recall);
            assert_memory_equal(recall.entry, expected.entry, sizeof recall.entry);
        }
        uint8_t link = (uint8_t)grrl_random_below(&random, graph.n);
        uint8_t direction = (uint8_t)grrl_random_below(&random, GRRL_DIRECTIONS);
        uint32_t entry = teach(&plain, &graph, link, direction, 1.0f);
        for (int k = 0; k < 2; k++)
            assert_int_equal(teach(&indexed[k], &graph, link, direction, 1.0f), entry);
        if (i == 600)
            grrl_experience_use_index(&indexed[1], &index[1], rows[1]);
    }
    assert_true(plain.evictions > 100);
}

/* More states than a recall searches, the far ones first: the closest are searched all the same. */
static void the_closest_of_very_many_are_found(void **state)
{
    (void)state;
    enum { MANY = 8 * GRRL_RECALL_STATES };
    static struct grrl_experience_state many_states[MANY];
    static struct grrl_experience many_experiences[MANY];
    struct grrl_experience_store store;
    grrl_experience_init(&store, many_states, MANY, many_experiences, MANY);
    struct grrl_graph query = chain("RR", 0);
    for (uint8_t length = 8; length >= 3; --length) { /* ever closer, all with the query in them */
        for (grrl_label mark = 1; mark <= GRRL_RECALL_STATES + 8; mark++) {
            struct grrl_graph graph = chain("RR", 0);
            while (graph.n <= length) {
                grrl_label label = graph.n == length ? mark : 0;
                assert_int_equal(grrl_graph_add_link(&graph, label, NULL), GRRL_OK);
                assert_int_equal(grrl_graph_add_joint(&graph, (uint8_t)(graph.n - 1),
                                                      (uint8_t)(graph.n - 2), GRRL_REVOLUTE),
                                 GRRL_OK);
            }
            assert_int_equal(grrl_experience_update(&store, &graph, 0, 0, 1.0f, 0.5f, NULL),
                             GRRL_OK);
        }
    }
    assert_true(store.n_states > 2 * GRRL_RECALL_STATES);
    struct grrl_recall recall;
    grrl_experience_recall(&store, &query, &everything, &recall);
    assert_int_equal(recall.entry[0][0].level, GRRL_RECALL_SUBSTRUCTURE);
    assert_int_equal(recall.entry[0][0].distance, 2);
    assert_int_equal(recall.entry[0][0].dropped, 0);
}

static void what_cannot_be_stored_is_refused(void **state)
{
    (void)state;
    struct grrl_experience_store store;
    init(&store, 1, 1);
    struct grrl_graph graph = chain("R", 0);
    uint32_t i = 7;
    assert_int_equal(grrl_experience_update(&store, &graph, 2, 0, 1.0f, 0.5f, &i),
                     GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_experience_update(&store, &graph, 0, 6, 1.0f, 0.5f, &i),
                     GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_experience_update(&store, &graph, 0, 0, 1.0f, 0.0f, &i),
                     GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_experience_update(&store, &graph, 0, 0, 1.0f, NAN, &i),
                     GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_experience_update(&store, &graph, 0, 0, NAN, 0.5f, &i), GRRL_ERR_NUMBER);
    assert_int_equal(grrl_experience_update(&store, &graph, 0, 0, INFINITY, 0.5f, &i),
                     GRRL_ERR_NUMBER);
    assert_int_equal(grrl_experience_update(&store, &graph, 0, 0, 2e6f, 0.5f, &i), GRRL_ERR_NUMBER);
    assert_int_equal(i, 7);
    assert_int_equal(store.n_states, 0);
    assert_int_equal(store.n_experiences, 0);
    assert_int_equal(store.clock, 0);
}

static void an_empty_store_knows_nothing(void **state)
{
    (void)state;
    struct grrl_experience_store store;
    init(&store, 1, 1);
    struct grrl_graph graph = chain("R", 0);
    struct grrl_recall recall;
    memset(&recall, 0, sizeof recall);
    grrl_experience_recall(&store, &graph, &everything, &recall);
    assert_int_equal(recall.n_links, 2);
    for (int link = 0; link < GRRL_MAX_LINKS; link++)
        for (int direction = 0; direction < GRRL_DIRECTIONS; direction++)
            assert_int_equal(recall.entry[link][direction].experience, GRRL_NO_EXPERIENCE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statistics_follow_the_targets),
        cmocka_unit_test(isomorphic_states_and_symmetric_actions_share_an_entry),
        cmocka_unit_test(closer_matches_come_first),
        cmocka_unit_test(retrieval_reaches_as_far_as_it_may),
        cmocka_unit_test(many_mappings_still_bind_every_link),
        cmocka_unit_test(an_undecided_search_is_no_match),
        cmocka_unit_test(recall_agrees_with_trying_every_mapping),
        cmocka_unit_test(the_experience_used_longest_ago_makes_room),
        cmocka_unit_test(the_state_used_longest_ago_makes_room),
        cmocka_unit_test(small_stores_stay_sound),
        cmocka_unit_test(an_index_changes_nothing_that_is_recalled),
        cmocka_unit_test(the_closest_of_very_many_are_found),
        cmocka_unit_test(what_cannot_be_stored_is_refused),
        cmocka_unit_test(an_empty_store_knows_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
