/* case_merge.c: two case bases become one, whatever the order. */
#include "grrl/learner/cases/case_base.h"

/* What is left of a life on other objects: what all of them have in common. */
static void forget_objects(struct grrl_case_base *base)
{
    for (uint32_t i = 0; i < base->n; i++) {
        base->cases[i].n = base->cases[i].n_new = 0;
        base->cases[i].value = base->cases[i].value_new = 0.0f;
    }
}

/* The rewards of one context from two lives; each sum is the same in either order. */
static void pool(struct grrl_case *into, const struct grrl_case *from)
{
    unsigned n_all = (unsigned)into->n_all + from->n_all;
    unsigned n_found = (unsigned)into->n_found + from->n_found;
    float sum = (float)into->n_all * into->value_all + (float)from->n_all * from->value_all;
    into->value_all = n_all > 0 ? sum / (float)n_all : 0.0f;
    for (; n_all > GRRL_CASE_REWARDS; n_all /= 2)
        n_found /= 2;
    into->n_all = (uint8_t)n_all;
    into->n_found = (uint8_t)n_found;
    if (from->used_at > into->used_at)
        into->used_at = from->used_at;
}

static struct grrl_case *find(struct grrl_case_base *base, uint32_t key, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        if (base->cases[i].key == key)
            return &base->cases[i];
    return NULL;
}

enum order { BY_AGE, BY_REWARDS };

/* The older of two cases comes first, or the one with fewer rewards; of two as old, the one with
 * the lower key. */
static bool comes_before(const struct grrl_case *a, const struct grrl_case *b, enum order order)
{
    if (order == BY_REWARDS && a->n_all != b->n_all)
        return a->n_all < b->n_all;
    return a->used_at != b->used_at ? a->used_at < b->used_at : a->key < b->key;
}

static void sort(struct grrl_case_base *base, enum order order)
{
    for (uint32_t i = 1; i < base->n; i++) {
        struct grrl_case moved = base->cases[i];
        uint32_t at = i;
        for (; at > 0 && comes_before(&moved, &base->cases[at - 1], order); at--)
            base->cases[at] = base->cases[at - 1];
        base->cases[at] = moved;
    }
}

/* Drops the first cases, so that `most` are left. */
static void drop_first(struct grrl_case_base *base, uint32_t most)
{
    uint32_t excess = base->n > most ? base->n - most : 0;
    base->n -= excess;
    for (uint32_t i = 0; i < base->n && excess > 0; i++)
        base->cases[i] = base->cases[i + excess];
}

/* Moves the end of a life to `clock`. */
static void shift(struct grrl_case_base *base, uint32_t clock)
{
    for (uint32_t i = 0; i < base->n; i++)
        base->cases[i].used_at += clock - base->clock;
    base->clock = clock;
}

enum grrl_status grrl_cases_merge(struct grrl_case_base *base, struct grrl_case_base *from,
                                  const struct grrl_case_config *config, uint32_t most)
{
    if (base->capacity < base->n || base->capacity - base->n < from->n)
        return GRRL_ERR_FULL;
    forget_objects(base);
    forget_objects(from);
    uint32_t clock = base->clock > from->clock ? base->clock : from->clock;
    shift(base, clock);
    shift(from, clock);
    uint32_t n = base->n;
    for (uint32_t i = 0; i < from->n; i++) {
        struct grrl_case *met = find(base, from->cases[i].key, n);
        if (met != NULL)
            pool(met, &from->cases[i]);
        else
            base->cases[base->n++] = from->cases[i];
    }
    sort(base, BY_REWARDS);
    drop_first(base, most);
    sort(base, BY_AGE);
    for (uint32_t i = 1; i < base->n; i++) /* no two cases were met at the same time */
        if (base->cases[i].used_at <= base->cases[i - 1].used_at)
            base->cases[i].used_at = base->cases[i - 1].used_at + 1;
    if (base->n > 0 && base->cases[base->n - 1].used_at > base->clock)
        base->clock = base->cases[base->n - 1].used_at;
    base->log_odds = config->confidence;
    base->high_water = base->n > base->high_water ? base->n : base->high_water;
    return GRRL_OK;
}
