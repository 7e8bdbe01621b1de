/* grrl-bench match: the library and its peers on the same pairs. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench.h"
#include "grrl/structure/canonical.h"

enum { MAX_PAIRS = 256, MAX_PEERS = 16, SWEEPS = 7, N_SIZES = 4, PATIENCE_S = 4 };

/* A sweep over the pairs is repeated until it lasts at least this long. */
#define SWEEP_NS 2e5

static const uint8_t sizes[N_SIZES] = {4, 8, 16, 32};
static const char *const shape_names[BENCH_SHAPES] = {"chain", "tree", "loop", "loops"};
static const char *const question_names[BENCH_QUESTIONS] = {"isomorphic", "not isomorphic",
                                                            "sub-structure", "no sub-structure"};

/* --- the library as a peer -------------------------------------------------------------------- */

static void destroy(void *built)
{
    free(built);
}

static void *allocate(size_t size)
{
    void *memory = malloc(size);
    if (memory == NULL)
        abort();
    return memory;
}

/* A copy: a parsed term is already in the library's form (see the time for a term). */
static void *build_graph(const struct grrl_graph *graph)
{
    struct grrl_graph *built = allocate(sizeof *built);
    *built = *graph;
    return built;
}

static int match_graphs(enum grrl_match_kind kind, const void *pattern, const void *target)
{
    uint8_t map[GRRL_MAX_LINKS];
    enum grrl_status status =
        grrl_match_find(kind, pattern, target, GRRL_ALL_PROPERTIES, GRRL_MATCH_BUDGET, map);
    return status == GRRL_OK ? 1 : status == GRRL_ERR_NONE ? 0 : -1;
}

struct planned {
    struct grrl_match_plan plan;
    struct grrl_graph graph;
};

static void *build_plan(const struct grrl_graph *graph)
{
    struct planned *built = allocate(sizeof *built);
    built->graph = *graph;
    grrl_match_plan_of(&built->plan, &built->graph, GRRL_ALL_PROPERTIES);
    return built;
}

static int match_planned(enum grrl_match_kind kind, const void *pattern, const void *target)
{
    const struct planned *a = pattern;
    const struct planned *b = target;
    uint8_t map[GRRL_MAX_LINKS];
    enum grrl_status status =
        grrl_match_find_planned(kind, &a->plan, &b->plan, GRRL_MATCH_BUDGET, map);
    return status == GRRL_OK ? 1 : status == GRRL_ERR_NONE ? 0 : -1;
}

/* Canonical forms, made once: for isomorphism nothing is left but to compare them. */
static void *build_kept(const struct grrl_graph *graph)
{
    struct grrl_canonical *kept = allocate(sizeof *kept);
    if (grrl_canonical_of(graph, GRRL_ALL_PROPERTIES, GRRL_CANONICAL_BUDGET, kept) != GRRL_OK)
        abort();
    return kept;
}

static int match_kept(enum grrl_match_kind kind, const void *pattern, const void *target)
{
    const struct grrl_canonical *a = pattern;
    const struct grrl_canonical *b = target;
    if (kind != GRRL_MATCH_ISOMORPHISM)
        return -1;
    return a->hash == b->hash && grrl_graph_equal(&a->graph, &b->graph, GRRL_ALL_PROPERTIES);
}

static const struct bench_peer grrl = {"grrl", build_graph, destroy, match_graphs};
static const struct bench_peer grrl_planned = {"grrl planned", build_plan, destroy, match_planned};
static const struct bench_peer grrl_kept = {"grrl kept", build_kept, destroy, match_kept};

static unsigned list_peers(const struct bench_peer **peers)
{
    unsigned n = 0;
    peers[n++] = &grrl;
    peers[n++] = &grrl_planned;
#ifdef GRRL_BENCH_BOOST
    peers[n++] = &bench_boost;
#endif
#ifdef GRRL_BENCH_IGRAPH
    peers[n++] = &bench_igraph;
    peers[n++] = &bench_lad;
    peers[n++] = &bench_bliss;
#endif
#ifdef GRRL_BENCH_NAUTY
    peers[n++] = &bench_nauty;
    peers[n++] = &bench_nauty_kept;
#endif
    peers[n++] = &grrl_kept;
    return n;
}

static void print_absent(void)
{
    const char *absent = ""
#ifndef GRRL_BENCH_BOOST
                         " boost"
#endif
#ifndef GRRL_BENCH_IGRAPH
                         " igraph"
#endif
#ifndef GRRL_BENCH_NAUTY
                         " nauty"
#endif
#ifndef GRRL_BENCH_NETWORKX
                         " networkx"
#endif
#ifndef GRRL_BENCH_RDKIT
                         " rdkit (retrieve)"
#endif
        ;
    if (absent[0] != '\0')
        (void)printf("Not installed:%s\n\n", absent);
}

/* --- measuring -------------------------------------------------------------------------------- */

/* Nanoseconds per query. */
struct times {
    double mean; /* median over sweeps of the mean over pairs, against learned branches */
    double median;
    double p99;
    double worst; /* over the pairs, each the best of a few runs */
    double build; /* of both graphs */
};

static double clock_cost(void)
{
    double cost[101];
    for (int i = 0; i < 101; i++) {
        double start = bench_now_ns();
        cost[i] = bench_now_ns() - start;
    }
    bench_sort(cost, 101);
    return cost[50];
}

static void check(const struct bench_peer *peer, const struct bench_pair *pair, int answer)
{
    if (answer != (int)pair->matches) {
        (void)fprintf(stderr, "grrl-bench: %s answers %d instead of %d\n", peer->name, answer,
                      (int)pair->matches);
        exit(1);
    }
}

/* Answers every pair `rounds` times; nanoseconds in all. */
static double spend(const struct bench_peer *peer, const struct bench_pair *pairs, void *built[][2],
                    unsigned n, unsigned rounds)
{
    double start = bench_now_ns();
    for (; rounds > 0; rounds--)
        for (unsigned i = 0; i < n; i++)
            check(peer, &pairs[i], peer->match(pairs[i].kind, built[i][0], built[i][1]));
    return bench_now_ns() - start;
}

/* Nanoseconds a query. Reads the clock, which costs as much as some queries, twice for all rounds.
 */
static double sweep(const struct bench_peer *peer, const struct bench_pair *pairs, void *built[][2],
                    unsigned n)
{
    double overhead = clock_cost();
    double spent = 0;
    unsigned rounds = 1;
    while ((spent = spend(peer, pairs, built, n, rounds)) < SWEEP_NS)
        rounds *= 2;
    return (spent - overhead) / rounds / n;
}

static void measure_singly(const struct bench_peer *peer, const struct bench_pair *pairs,
                           void *built[][2], unsigned n, struct times *times)
{
    double best[MAX_PAIRS];
    double overhead = clock_cost();
    for (int round = 0; round < 5; round++) {
        for (unsigned i = 0; i < n; i++) {
            double start = bench_now_ns();
            check(peer, &pairs[i], peer->match(pairs[i].kind, built[i][0], built[i][1]));
            double spent = bench_now_ns() - start - overhead;
            best[i] = round == 0 || spent < best[i] ? spent : best[i];
        }
    }
    bench_sort(best, n);
    times->median = bench_quantile(best, n, 0.5);
    times->p99 = bench_quantile(best, n, 0.99);
    times->worst = best[n - 1];
}

static bool measure_here(const struct bench_peer *peer, const struct bench_pair *pairs, unsigned n,
                         struct times *times)
{
    static void *built[MAX_PAIRS][2];
    double build[SWEEPS];
    double match[SWEEPS];
    for (unsigned i = 0; i < n; i++) {
        built[i][0] = peer->build(&pairs[i].pattern);
        built[i][1] = peer->build(&pairs[i].target);
    }
    bool able = peer->match(pairs[0].kind, built[0][0], built[0][1]) >= 0;
    for (int s = 0; s < SWEEPS && able; s++)
        match[s] = sweep(peer, pairs, built, n);
    if (able)
        measure_singly(peer, pairs, built, n, times);
    for (int s = 0; s < SWEEPS; s++) {
        double start = bench_now_ns();
        for (unsigned i = 0; i < n; i++) {
            peer->destroy(built[i][0]);
            peer->destroy(built[i][1]);
            built[i][0] = peer->build(&pairs[i].pattern);
            built[i][1] = peer->build(&pairs[i].target);
        }
        build[s] = (bench_now_ns() - start) / n;
    }
    for (unsigned i = 0; i < n; i++) {
        peer->destroy(built[i][0]);
        peer->destroy(built[i][1]);
    }
    bench_sort(build, SWEEPS);
    bench_sort(match, able ? SWEEPS : 0);
    times->build = build[SWEEPS / 2];
    times->mean = match[SWEEPS / 2];
    return able;
}

/* Measures in a child process with a time limit, because a peer may never finish. False: not
 * supported, or did not finish. */
static bool measure(const struct bench_peer *peer, const struct bench_pair *pairs, unsigned n,
                    struct times *times)
{
    int ends[2];
    (void)fflush(stdout);
    if (pipe(ends) != 0)
        abort();
    pid_t child = fork();
    if (child == 0) {
        (void)alarm(PATIENCE_S);
        if (!measure_here(peer, pairs, n, times))
            _exit(1);
        _exit(write(ends[1], times, sizeof *times) != (ssize_t)sizeof *times);
    }
    (void)close(ends[1]);
    bool good = child > 0 && read(ends[0], times, sizeof *times) == (ssize_t)sizeof *times;
    (void)close(ends[0]);
    (void)waitpid(child, NULL, 0);
    return good;
}

/* --- reports ---------------------------------------------------------------------------------- */

/* One peer's results on the cases of a row, as sums of logarithms, for geometric means. */
struct row {
    double mean;
    double built;
    unsigned n;
};

static void add_case(bool json, bool *first, const char *peer, const char *what, uint8_t n,
                     const struct times *times)
{
    if (json)
        (void)printf("%s\n{\"peer\": \"%s\", \"case\": \"%s\", \"links\": %u, \"mean_ns\": %.1f, "
                     "\"median_ns\": %.1f, \"p99_ns\": %.1f, \"worst_ns\": %.1f, "
                     "\"build_both_ns\": %.1f}",
                     *first ? "" : ",", peer, what, (unsigned)n, times->mean, times->median,
                     times->p99, times->worst, times->build);
    *first = false;
}

/* A time as in a table: tenths only where they count. */
static void print_ns(double ns)
{
    (void)printf(" %.*f", ns < 10, ns);
}

static double mean_of(const struct row *row)
{
    return row->n == BENCH_SHAPES ? exp(row->mean / row->n) : 0;
}

/* How many times as long one peer takes as another, per question. */
static void print_ratio(struct row rows[BENCH_QUESTIONS][MAX_PEERS], uint8_t n, const char *slow,
                        unsigned slow_at, const char *fast, unsigned fast_at)
{
    (void)printf("| %u | %s / %s |", (unsigned)n, slow, fast);
    for (int question = 0; question < BENCH_QUESTIONS; question++) {
        double a = mean_of(&rows[question][slow_at]);
        double b = mean_of(&rows[question][fast_at]);
        if (a > 0 && b > 0)
            (void)printf(" %.1f", a / b);
        (void)printf(" |");
    }
    (void)printf("\n");
}

static void print_rows(const struct bench_peer **peers, unsigned n_peers,
                       struct row rows[BENCH_QUESTIONS][MAX_PEERS], uint8_t n)
{
    for (unsigned p = 0; p < n_peers; p++) {
        (void)printf("| %u | %s |", (unsigned)n, peers[p]->name);
        for (int question = 0; question < BENCH_QUESTIONS; question++) {
            const struct row *row = &rows[question][p];
            if (row->n == BENCH_SHAPES) {
                print_ns(mean_of(row));
                (void)printf(" (%.0f)", exp(row->built / row->n));
            } else if (row->n > 0) {
                (void)printf(" no end on %u of %d shapes", BENCH_SHAPES - row->n, BENCH_SHAPES);
            }
            (void)printf(" |");
        }
        (void)printf("\n");
    }
    for (unsigned p = 2; p < n_peers; p++) {
        if (strcmp(peers[p]->name, "boost") == 0) {
            print_ratio(rows, n, "boost", p, "grrl", 0);
            print_ratio(rows, n, "boost", p, "grrl planned", 1);
        } else if (strcmp(peers[p]->name, "igraph") == 0) {
            print_ratio(rows, n, "igraph", p, "grrl", 0);
        }
    }
}

#ifdef GRRL_BENCH_NETWORKX
static const struct bench_peer networkx = {"networkx", NULL, NULL, NULL};

static bool measure_networkx(const struct bench_pair *pairs, unsigned n, struct times *times)
{
    if (!bench_networkx(pairs, n, &times->mean, &times->build))
        return false;
    times->median = times->p99 = times->worst = times->mean; /* one run has no distribution */
    return true;
}
#endif

static void run_question(bool json, bool *first, const struct bench_peer **peers, unsigned n_peers,
                         unsigned n_pairs, uint8_t n, enum bench_question question,
                         struct row *rows)
{
    static struct bench_pair pairs[MAX_PAIRS];
    for (int shape = 0; shape < BENCH_SHAPES; shape++) {
        struct grrl_random random;
        grrl_random_init(&random, 20080625u,
                         (uint64_t)n * 64 + (uint64_t)question * 8 + (uint64_t)shape);
        for (unsigned i = 0; i < n_pairs; i++)
            bench_pair(&random, (enum bench_shape)shape, question, n, &pairs[i]);
        for (unsigned p = 0; p < n_peers; p++) {
            struct times times = {0, 0, 0, 0, 0};
            bool measured;
#ifdef GRRL_BENCH_NETWORKX
            if (peers[p] == &networkx)
                measured = measure_networkx(pairs, n_pairs, &times);
            else
#endif
                measured = measure(peers[p], pairs, n_pairs, &times);
            if (!measured)
                continue;
            char what[40];
            (void)snprintf(what, sizeof what, "%s, %s", shape_names[shape],
                           question_names[question]);
            add_case(json, first, peers[p]->name, what, n, &times);
            rows[p].mean += log(times.mean);
            rows[p].built += log(times.mean + times.build);
            rows[p].n++;
        }
    }
}

static void run_size(bool json, bool *first, unsigned n_pairs, uint8_t n)
{
    const struct bench_peer *peers[MAX_PEERS];
    struct row rows[BENCH_QUESTIONS][MAX_PEERS] = {{{0}}};
    unsigned n_peers = list_peers(peers);
#ifdef GRRL_BENCH_NETWORKX
    peers[n_peers++] = &networkx;
#endif
    for (int question = 0; question < BENCH_QUESTIONS; question++)
        run_question(json, first, peers, n_peers, n_pairs, n, (enum bench_question)question,
                     rows[question]);
    if (!json)
        print_rows(peers, n_peers, rows, n);
}

/* The head of a table with a column per peer. */
static void print_head(const char *first, const struct bench_peer **peers, unsigned n_peers)
{
    (void)printf("| %s |", first);
    for (unsigned p = 0; p < n_peers; p++)
        (void)printf(" %s |", peers[p]->name);
    (void)printf("\n|");
    for (unsigned p = 0; p <= n_peers; p++)
        (void)printf("---|");
    (void)printf("\n");
}

/* Symmetric worst cases, each repeated until the clock's own cost does not count. */
static void run_symmetric(bool json, bool *first)
{
    static const struct {
        const char *name;
        uint8_t legs;
        bool part;
    } cases[] = {{"6x3 near miss", 6, false},
                 {"10x3 near miss", 10, false},
                 {"6x3 no part", 6, true},
                 {"10x3 no part", 10, true}};
    const struct bench_peer *peers[MAX_PEERS];
    unsigned n_peers = list_peers(peers);
    if (!json)
        print_head("", peers, n_peers);
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        struct bench_pair pair;
        if (cases[c].part)
            bench_near_part(cases[c].legs, &pair);
        else
            bench_near_miss(cases[c].legs, &pair);
        if (!json)
            (void)printf("| %s |", cases[c].name);
        for (unsigned p = 0; p < n_peers; p++) {
            void *a = peers[p]->build(&pair.pattern);
            void *b = peers[p]->build(&pair.target);
            bool slow = cases[c].legs > 6 && (strcmp(peers[p]->name, "boost") == 0 ||
                                              strcmp(peers[p]->name, "igraph") == 0);
            void *built[1][2] = {{a, b}};
            bool able = !slow && peers[p]->match(pair.kind, a, b) >= 0;
            double best = (double)INFINITY;
            for (int i = 0; i < SWEEPS && able; i++) {
                double once = sweep(peers[p], &pair, built, 1);
                best = once < best ? once : best;
            }
            struct times times = {best, best, best, best, 0};
            if (able && json)
                add_case(json, first, peers[p]->name, cases[c].name, pair.target.n, &times);
            else if (able)
                print_ns(best);
            if (!json)
                (void)printf(" |");
            peers[p]->destroy(a);
            peers[p]->destroy(b);
        }
        if (!json)
            (void)printf("\n");
    }
}

/* The library builds from a term. Its plans are not measured here. */
static void run_building(bool json, bool *first)
{
    const struct bench_peer *peers[MAX_PEERS];
    unsigned n_peers = list_peers(peers);
    for (unsigned p = 2; p < n_peers; p++)
        peers[p - 1] = peers[p];
    n_peers--;
    if (!json)
        print_head("links", peers, n_peers);
    for (int s = 0; s < N_SIZES; s++) {
        if (!json)
            (void)printf("| %u |", (unsigned)sizes[s]);
        for (unsigned p = 0; p < n_peers; p++) {
            double spent = bench_build(p == 0 ? NULL : peers[p], sizes[s]);
            struct times times = {spent, spent, spent, spent, 2 * spent};
            add_case(json, first, peers[p]->name, "building one", sizes[s], &times);
            if (!json)
                (void)printf(" %.0f |", spent);
        }
        if (!json)
            (void)printf("\n");
    }
}

int bench_match(bool json, unsigned n_pairs)
{
    bool first = true;
    if (n_pairs > MAX_PAIRS)
        n_pairs = MAX_PAIRS;
    if (json) {
        (void)printf("[");
    } else {
        print_absent();
        (void)printf("| links | |");
        for (int question = 0; question < BENCH_QUESTIONS; question++)
            (void)printf(" %s |", question_names[question]);
        (void)printf("\n|---|---|---|---|---|---|\n");
    }
    for (int s = 0; s < N_SIZES; s++)
        run_size(json, &first, n_pairs, sizes[s]);
    if (!json)
        (void)printf("\n");
    run_symmetric(json, &first);
    if (!json)
        (void)printf("\n");
    run_building(json, &first);
    if (json)
        (void)printf("\n]\n");
    return 0;
}
