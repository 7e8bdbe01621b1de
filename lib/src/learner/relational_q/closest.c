/* closest.c: the closest stored states, in order, in fixed memory. */
#include "learner/relational_q/closest.h"

void grrl_closest_clear(struct grrl_closest *closest, unsigned most)
{
    closest->n = 0;
    closest->most = most;
}

static bool is_farther(const struct grrl_closest *closest, unsigned a, unsigned b)
{
    return closest->distance[a] != closest->distance[b]
               ? closest->distance[a] > closest->distance[b]
               : closest->state[a] > closest->state[b];
}

static void exchange(struct grrl_closest *closest, unsigned a, unsigned b)
{
    uint32_t state = closest->state[a];
    uint8_t distance = closest->distance[a];
    closest->state[a] = closest->state[b];
    closest->distance[a] = closest->distance[b];
    closest->state[b] = state;
    closest->distance[b] = distance;
}

/* Restores the heap of n below one place. */
static void sift_down(struct grrl_closest *closest, unsigned n, unsigned at)
{
    for (unsigned child = 2 * at + 1; child < n; child = 2 * at + 1) {
        child += child + 1 < n && is_farther(closest, child + 1, child);
        if (!is_farther(closest, child, at))
            return;
        exchange(closest, at, child);
        at = child;
    }
}

static void make_heap(struct grrl_closest *closest)
{
    for (unsigned at = closest->n / 2; at-- > 0;)
        sift_down(closest, closest->n, at);
}

void grrl_closest_add(struct grrl_closest *closest, unsigned distance, uint32_t state)
{
    const bool full = closest->n == closest->most;
    const unsigned at = full ? 0 : closest->n++;
    closest->state[at] = state;
    closest->distance[at] = (uint8_t)distance;
    if (full)
        sift_down(closest, closest->n, 0);
    else if (closest->n == closest->most)
        make_heap(closest);
}

void grrl_closest_sort(struct grrl_closest *closest)
{
    make_heap(closest);
    for (unsigned end = closest->n; end-- > 1;) {
        exchange(closest, 0, end);
        sift_down(closest, end, 0);
    }
}
