/*
 * grrl-bench evict: compares what a full store still knows under several eviction rules.
 *
 * The stream consists of trials. Each has an object: usually the previous one, else one of many,
 * some of them much more frequent. Its structure is discovered link by link, and in each state some
 * actions are tried, most often the two that have worked there. The measure is how often an update
 * finds its experience instead of making a new one. The library's store runs itself; the other
 * rules are simulated on the sequence of experiences, taken from a store that never forgets.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "grrl/learner/relational_q/experience.h"

enum { N_OBJECTS = 60, N_UPDATES = 60000, NEVER = N_UPDATES };

struct stream {
    struct grrl_graph objects[N_OBJECTS];
    struct grrl_random random;
    struct grrl_graph object; /* its links are in order of discovery */
    unsigned known;           /* links discovered */
    unsigned which;
};

static void next_trial(struct stream *stream)
{
    if (grrl_random_below(&stream->random, 10) < 2) {
        unsigned a = grrl_random_below(&stream->random, N_OBJECTS);
        unsigned b = grrl_random_below(&stream->random, a + 1);
        stream->which = grrl_random_below(&stream->random, b + 1);
    }
    stream->object = stream->objects[stream->which];
    stream->known = 1;
}

/* Draws the next update: a state, and an action on one of its links. */
static void next_update(struct stream *stream, struct grrl_graph *state, uint8_t *link,
                        uint8_t *direction)
{
    if (grrl_random_below(&stream->random, 3) == 0 && ++stream->known > stream->object.n)
        next_trial(stream);
    const uint8_t n = (uint8_t)stream->known;
    *state = stream->object;
    state->n = n;
    for (uint8_t i = 0; i < stream->object.n; i++)
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            state->joined[type][i] = i < n ? state->joined[type][i] & (UINT32_MAX >> (32 - n)) : 0;
    if (grrl_random_below(&stream->random, 10) < 7) {
        uint32_t works = stream->which * 7 + n * 3 + grrl_random_below(&stream->random, 2);
        *link = (uint8_t)(works % n);
        *direction = (uint8_t)(works % GRRL_DIRECTIONS);
    } else {
        *link = (uint8_t)grrl_random_below(&stream->random, n);
        *direction = (uint8_t)grrl_random_below(&stream->random, GRRL_DIRECTIONS);
    }
}

static void start_stream(struct stream *stream)
{
    grrl_random_init(&stream->random, 20080625u, 6);
    for (int i = 0; i < N_OBJECTS; i++)
        bench_graph(&stream->random, (enum bench_shape)grrl_random_below(&stream->random, 3),
                    (uint8_t)(4 + grrl_random_below(&stream->random, 6)), &stream->objects[i]);
    stream->which = 0;
    next_trial(stream);
}

/* Runs a store; experience[i] is set to that of update i. Returns the share of updates that found
 * theirs. */
static double run_store(uint32_t capacity, uint32_t *experience)
{
    static struct stream stream;
    struct grrl_experience_store store;
    struct grrl_experience_state *states = calloc(capacity, sizeof *states);
    struct grrl_experience *experiences = calloc(capacity, sizeof *experiences);
    unsigned found = 0;
    if (states == NULL || experiences == NULL)
        abort();
    grrl_experience_init(&store, states, capacity, experiences, capacity);
    start_stream(&stream);
    for (int i = 0; i < N_UPDATES; i++) {
        struct grrl_graph state;
        uint8_t link;
        uint8_t direction;
        next_update(&stream, &state, &link, &direction);
        if (grrl_experience_update(&store, &state, link, direction, 1.0f, 0.5f, &experience[i]) !=
            GRRL_OK)
            abort();
        found += store.experiences[experience[i]].q.n > 1;
    }
    free(states);
    free(experiences);
    return (double)found / N_UPDATES;
}

enum rule { RULE_RANDOM, RULE_FIRST_IN, RULE_FARTHEST, RULES };

static const char *const rule_names[RULES] = {"random", "first in, first out",
                                              "the future known (bound)"};

/* Which of the kept experiences is evicted. */
static unsigned choose(enum rule rule, const uint32_t *kept, const uint32_t *next_use,
                       unsigned capacity, unsigned *oldest, struct grrl_random *random)
{
    if (rule == RULE_RANDOM)
        return grrl_random_below(random, capacity);
    if (rule == RULE_FIRST_IN)
        return (*oldest)++ % capacity;
    unsigned farthest = 0;
    for (unsigned k = 1; k < capacity; k++)
        farthest = next_use[kept[k]] > next_use[kept[farthest]] ? k : farthest;
    return farthest;
}

static double run_rule(enum rule rule, uint32_t capacity, const uint32_t *experience)
{
    static uint32_t next_of[N_UPDATES];  /* per update: the next of the same experience */
    static uint32_t next_use[N_UPDATES]; /* per experience */
    static uint32_t kept[N_UPDATES];
    static bool is_kept[N_UPDATES];
    struct grrl_random random;
    unsigned n = 0;
    unsigned oldest = 0;
    unsigned found = 0;
    grrl_random_init(&random, 20080625u, 7);
    memset(is_kept, 0, sizeof is_kept);
    for (int i = 0; i < N_UPDATES; i++)
        next_use[i] = NEVER;
    for (int i = N_UPDATES; i-- > 0;) {
        next_of[i] = next_use[experience[i]];
        next_use[experience[i]] = (uint32_t)i;
    }
    for (int i = 0; i < N_UPDATES; i++) {
        uint32_t wanted = experience[i];
        next_use[wanted] = next_of[i];
        found += is_kept[wanted];
        if (is_kept[wanted])
            continue;
        unsigned place = n;
        if (n < capacity) {
            n++;
        } else {
            place = choose(rule, kept, next_use, capacity, &oldest, &random);
            is_kept[kept[place]] = false;
        }
        kept[place] = wanted;
        is_kept[wanted] = true;
    }
    return (double)found / N_UPDATES;
}

static void report(bool json, bool *first, uint32_t capacity, const char *rule, double share)
{
    if (json)
        (void)printf("%s\n{\"experiences\": %u, \"rule\": \"%s\", \"known\": %.4f}",
                     *first ? "" : ",", capacity, rule, share);
    else
        (void)printf("| %6u | %-24s | %5.1f |\n", capacity, rule, 100 * share);
    *first = false;
}

int bench_evict(bool json)
{
    static uint32_t experience[N_UPDATES];
    static uint32_t unused[N_UPDATES];
    static const uint32_t capacities[] = {64, 256, 1024};
    bool first = true;
    double most = run_store(N_UPDATES, experience);
    (void)printf(json ? "[" : "| experiences | makes room | updates known, %% |\n|---|---|---|\n");
    for (size_t c = 0; c < sizeof capacities / sizeof capacities[0]; c++) {
        report(json, &first, capacities[c], "grrl: least recently used",
               run_store(capacities[c], unused));
        for (int rule = 0; rule < RULES; rule++)
            report(json, &first, capacities[c], rule_names[rule],
                   run_rule((enum rule)rule, capacities[c], experience));
    }
    report(json, &first, N_UPDATES, "nothing is forgotten", most);
    if (json)
        (void)printf("\n]\n");
    return 0;
}
