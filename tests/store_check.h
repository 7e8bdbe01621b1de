/* store_check.h: the invariants of every experience store. Include after cmocka.h. */
#ifndef GRRL_STORE_CHECK_H
#define GRRL_STORE_CHECK_H

#include "grrl/base/random.h"
#include "grrl/learner/relational_q/experience.h"

static inline int abs_difference(int a, int b)
{
    return a > b ? a - b : b - a;
}

/* A random order of 0 .. n - 1. */
static inline void shuffle(struct grrl_random *random, uint8_t n, uint8_t *order)
{
    for (uint8_t i = 0; i < n; i++) {
        uint8_t j = (uint8_t)grrl_random_below(random, i + 1u);
        order[i] = order[j];
        order[j] = i;
    }
}

static inline void check_store(const struct grrl_experience_store *store)
{
    assert_true(store->n_states <= store->states_capacity);
    assert_true(store->n_experiences <= store->experiences_capacity);
    assert_true(store->high_water >= store->n_experiences);
    unsigned listed = 0;
    for (uint32_t s = 0; s < store->n_states; s++) {
        const struct grrl_experience_state *state = &store->states[s];
        unsigned count = 0;
        for (uint32_t i = state->first; i != GRRL_NO_EXPERIENCE; i = store->experiences[i].next) {
            assert_true(i < store->n_experiences);
            assert_int_equal(store->experiences[i].state, s);
            assert_true(store->experiences[i].link < state->n);
            assert_true(store->experiences[i].used_at <= store->clock);
            assert_true(++count <= store->n_experiences);
        }
        assert_int_equal(state->experiences, count);
        assert_true(count > 0);
        listed += count;
        for (uint32_t other = 0; other < s; other++) {
            struct grrl_graph graphs[2];
            grrl_experience_graph(state, &graphs[0]);
            grrl_experience_graph(&store->states[other], &graphs[1]);
            assert_false(grrl_graph_equal(&graphs[0], &graphs[1], GRRL_ALL_PROPERTIES));
        }
    }
    assert_int_equal(listed, store->n_experiences);
}

#endif
