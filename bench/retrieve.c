/* grrl-bench retrieve: the experience store at two sizes. */
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"
#include "grrl/learner/relational_q/experience.h"

enum { N_QUERIES = 500, N_CONTAINED = 100, MAX_LINKS = 16, MIN_LINKS = 4 };

enum query {
    QUERY_STORED, /* a stored state, its links in a different order */
    QUERY_PART,   /* a stored state without one link */
    QUERY_WHOLE,  /* a stored state with one more link */
    QUERY_FRESH,  /* a new one of the same kind as the stored ones */
    QUERIES
};

static const char *const query_names[QUERIES] = {"stored", "stored less a link",
                                                 "stored and a link", "unrelated"};

struct setup {
    struct grrl_experience_store store;
    struct grrl_experience_index index;
    struct grrl_random random;
    bool json;
    bool first;
};

static void *allocate(size_t n, size_t size)
{
    void *memory = calloc(n, size);
    if (memory == NULL)
        abort();
    return memory;
}

static void random_state(struct grrl_random *random, struct grrl_graph *graph)
{
    uint8_t n = (uint8_t)(MIN_LINKS + grrl_random_below(random, MAX_LINKS - MIN_LINKS + 1));
    bench_graph(random, (enum bench_shape)grrl_random_below(random, BENCH_SHAPES), n, graph);
}

/* Fills a store with n different states, with one to six actions each. */
static void fill(struct setup *setup, uint32_t n, bool with_index)
{
    grrl_random_init(&setup->random, 20080625u, n);
    grrl_experience_init(&setup->store, allocate(n, sizeof(struct grrl_experience_state)), n,
                         allocate(6 * (size_t)n, sizeof(struct grrl_experience)), 6 * n);
    if (with_index)
        grrl_experience_use_index(&setup->store, &setup->index,
                                  allocate(n, sizeof(struct grrl_experience_row)));
    while (setup->store.n_states < n) {
        struct grrl_graph graph;
        random_state(&setup->random, &graph);
        for (uint32_t k = 1 + grrl_random_below(&setup->random, 6); k > 0; k--)
            if (grrl_experience_update(&setup->store, &graph,
                                       (uint8_t)grrl_random_below(&setup->random, graph.n),
                                       (uint8_t)grrl_random_below(&setup->random, GRRL_DIRECTIONS),
                                       1.0f, 0.5f, NULL) != GRRL_OK)
                abort();
    }
}

static void empty(struct setup *setup)
{
    free(setup->store.states);
    free(setup->store.experiences);
    if (setup->store.index != NULL)
        free(setup->index.rows);
}

static void make_query(struct setup *setup, enum query kind, struct grrl_graph *graph)
{
    uint32_t state = grrl_random_below(&setup->random, setup->store.n_states);
    if (kind == QUERY_FRESH) {
        random_state(&setup->random, graph);
        return;
    }
    grrl_experience_graph(&setup->store.states[state], graph);
    uint8_t order[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < graph->n; i++) {
        uint8_t j = (uint8_t)grrl_random_below(&setup->random, i + 1u);
        order[i] = order[j];
        order[j] = i;
    }
    struct grrl_graph shuffled;
    grrl_graph_permute(graph, order, &shuffled);
    *graph = shuffled;
    if (kind == QUERY_PART) {
        uint8_t last = --graph->n;
        graph->label[last] = 0;
        for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
            graph->joined[type][last] = 0;
            for (uint8_t i = 0; i < last; i++)
                graph->joined[type][i] &= ~(UINT32_C(1) << last);
        }
    } else if (kind == QUERY_WHOLE) {
        uint8_t added;
        uint8_t to = (uint8_t)grrl_random_below(&setup->random, graph->n);
        if (grrl_graph_add_link(graph, 1, &added) != GRRL_OK ||
            grrl_graph_add_joint(graph, added, to, GRRL_REVOLUTE) != GRRL_OK)
            abort();
    }
}

static void report(struct setup *setup, const char *level, enum query kind, double *spent,
                   double known)
{
    bench_sort(spent, N_QUERIES);
    double median = bench_quantile(spent, N_QUERIES, 0.5);
    double p99 = bench_quantile(spent, N_QUERIES, 0.99);
    double worst = spent[N_QUERIES - 1];
    const char *index = setup->store.index != NULL ? "yes" : "no";
    if (setup->json)
        (void)printf("%s\n{\"states\": %u, \"index\": \"%s\", \"level\": \"%s\", \"query\": "
                     "\"%s\", \"median_ns\": %.0f, \"p99_ns\": %.0f, \"worst_ns\": %.0f, "
                     "\"actions_known\": %.3f}",
                     setup->first ? "" : ",", setup->store.n_states, index, level,
                     query_names[kind], median, p99, worst, known);
    else
        (void)printf("| %u | %s | %s | %s | %.1f | %.1f | %.1f | %.1f%% |\n", setup->store.n_states,
                     index, level, query_names[kind], median / 1e3, p99 / 1e3, worst / 1e3,
                     100 * known);
    setup->first = false;
}

static void run_queries(struct setup *setup, enum grrl_recall_level deepest, uint32_t states,
                        const char *level, enum query kind)
{
    static double spent[N_QUERIES];
    const struct grrl_recall_config config = {
        .deepest = deepest, .budget = GRRL_MATCH_BUDGET, .states = states};
    double known = 0;
    for (int i = 0; i < N_QUERIES; i++) {
        struct grrl_graph graph;
        struct grrl_recall recall;
        make_query(setup, kind, &graph);
        double start = bench_now_ns();
        grrl_experience_recall(&setup->store, &graph, &config, &recall);
        spent[i] = bench_now_ns() - start;
        unsigned entries = 0;
        for (uint8_t link = 0; link < graph.n; link++)
            for (int d = 0; d < GRRL_DIRECTIONS; d++)
                entries += recall.entry[link][d].experience != GRRL_NO_EXPERIENCE;
        known += (double)entries / (graph.n * GRRL_DIRECTIONS);
    }
    report(setup, level, kind, spent, known / N_QUERIES);
}

/* --- states that contain a query -------------------------------------------------------------- */

/* Counts the stored states that contain the query, at most `max`: screens by counts, then searches.
 */
static unsigned count_containing(const struct grrl_experience_store *store,
                                 const struct grrl_graph *query, unsigned max)
{
    struct grrl_signature signature;
    struct grrl_paths paths;
    unsigned n = 0;
    grrl_signature_of(query, GRRL_ALL_PROPERTIES, &signature);
    grrl_paths_of(query, &paths);
    for (uint32_t i = 0; i < store->n_states && n < max; i++) {
        const struct grrl_experience_state *state = &store->states[i];
        if (!grrl_signature_within(&signature, &state->signature, false) ||
            !grrl_paths_within(&paths, &state->paths))
            continue;
        struct grrl_graph graph;
        uint8_t map[GRRL_MAX_LINKS];
        grrl_experience_graph(state, &graph);
        n += grrl_match_find(GRRL_MATCH_MONOMORPHISM, query, &graph, GRRL_ALL_PROPERTIES,
                             GRRL_MATCH_BUDGET, map) == GRRL_OK;
    }
    return n;
}

static void report_containing(struct setup *setup, const char *peer, enum query kind, double *spent,
                              unsigned found)
{
    bench_sort(spent, N_CONTAINED);
    double median = bench_quantile(spent, N_CONTAINED, 0.5);
    double worst = spent[N_CONTAINED - 1];
    if (setup->json)
        (void)printf(",\n{\"states\": %u, \"peer\": \"%s\", \"level\": \"containing\", \"query\": "
                     "\"%s\", \"median_ns\": %.0f, \"worst_ns\": %.0f, \"found\": %u}",
                     setup->store.n_states, peer, query_names[kind], median, worst, found);
    else
        (void)printf("| %u | %s | %s | %.1f | %.1f | %u |\n", setup->store.n_states, peer,
                     query_names[kind], median / 1e3, worst / 1e3, found);
}

/* Which states contain the query, asked of the library and of RDKit. */
static void run_containing(struct setup *setup, void *molecules, enum query kind)
{
    double spent[2][N_CONTAINED];
    unsigned found[2] = {0, 0};
    for (int i = 0; i < N_CONTAINED; i++) {
        struct grrl_graph graph;
        make_query(setup, kind, &graph);
        double start = bench_now_ns();
        found[0] += count_containing(&setup->store, &graph, GRRL_RECALL_STATES);
        spent[0][i] = bench_now_ns() - start;
#ifdef GRRL_BENCH_RDKIT
        void *query = bench_rdkit_query(&graph);
        start = bench_now_ns();
        found[1] += bench_rdkit_count(molecules, query, GRRL_RECALL_STATES);
        spent[1][i] = bench_now_ns() - start;
        bench_rdkit_close_query(query);
#endif
    }
    report_containing(setup, "grrl", kind, spent[0], found[0]);
    if (molecules != NULL)
        report_containing(setup, "RDKit", kind, spent[1], found[1]);
}

static void compare_containing(struct setup *setup)
{
    void *molecules = NULL;
#ifdef GRRL_BENCH_RDKIT
    molecules = bench_rdkit_open();
    for (uint32_t i = 0; i < setup->store.n_states; i++) {
        struct grrl_graph graph;
        grrl_experience_graph(&setup->store.states[i], &graph);
        bench_rdkit_add(molecules, &graph);
    }
#endif
    for (int kind = 0; kind < QUERIES; kind++)
        run_containing(setup, molecules, (enum query)kind);
#ifdef GRRL_BENCH_RDKIT
    bench_rdkit_close(molecules);
#endif
}

static void run_recalls(struct setup *setup)
{
    static const uint32_t sizes[] = {1000, 100000};
    static const unsigned closest[] = {32, 64, GRRL_RECALL_STATES};
    if (!setup->json)
        (void)printf("| states | index | what | query | median | p99 | worst | known |\n"
                     "|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < 4; i++) {
        fill(setup, sizes[i / 2], i % 2 == 1);
        run_queries(setup, GRRL_RECALL_EXACT, 1, "exact", QUERY_STORED);
        run_queries(setup, GRRL_RECALL_RELAXED, 1, "relaxed", QUERY_STORED);
        for (int kind = 0; kind < QUERIES; kind++) {
            for (int c = 0; c < 3; c++) {
                char level[20];
                (void)snprintf(level, sizeof level, "%u closest", closest[c]);
                run_queries(setup, GRRL_RECALL_SUBSTRUCTURE, closest[c], level, (enum query)kind);
            }
        }
        empty(setup);
    }
}

/* Among fewer states, because RDKit takes more than a millisecond to add one. */
static void run_contained(struct setup *setup)
{
    static const uint32_t sizes[] = {1000, 10000};
    if (!setup->json)
        (void)printf(
            "\n| states | | query | median | worst | found |\n|---|---|---|---|---|---|\n");
    for (int i = 0; i < 2; i++) {
        fill(setup, sizes[i], false);
        compare_containing(setup);
        empty(setup);
    }
}

int bench_retrieve(bool json)
{
    struct setup setup = {.json = json, .first = true};
    if (json)
        (void)printf("[");
    run_recalls(&setup);
    run_contained(&setup);
    if (json)
        (void)printf("\n]\n");
    return 0;
}
