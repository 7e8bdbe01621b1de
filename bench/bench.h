/*
 * bench.h: shared by the parts of grrl-bench.
 *
 * A peer is another program's matcher behind three functions. It receives the same pairs as the
 * library in the same run, so that ratios are independent of the machine's load.
 */
#ifndef GRRL_BENCH_H
#define GRRL_BENCH_H

#include <stddef.h>

#include "grrl/base/random.h"
#include "grrl/structure/match.h"

#ifdef __cplusplus
extern "C" {
#endif

enum bench_shape { BENCH_CHAIN, BENCH_TREE, BENCH_LOOP, BENCH_LOOPS, BENCH_SHAPES };

enum bench_question {
    BENCH_ISO_YES,
    BENCH_ISO_NO, /* one joint or label differs, all counts are equal */
    BENCH_MONO_YES,
    BENCH_MONO_NO,
    BENCH_QUESTIONS
};

struct bench_pair {
    struct grrl_graph pattern;
    struct grrl_graph target;
    enum grrl_match_kind kind;
    bool matches;
};

/* A matcher with its own representation of a graph; NULL pointers: not built in. */
struct bench_peer {
    const char *name;
    void *(*build)(const struct grrl_graph *graph);
    void (*destroy)(void *graph);
    /* 1: a mapping exists; 0: none; -1: not supported. */
    int (*match)(enum grrl_match_kind kind, const void *pattern, const void *target);
};

#ifdef GRRL_BENCH_BOOST
extern const struct bench_peer bench_boost;
#endif
#ifdef GRRL_BENCH_IGRAPH
extern const struct bench_peer bench_igraph;
extern const struct bench_peer bench_lad;
extern const struct bench_peer bench_bliss; /* isomorphism only */
#endif
#ifdef GRRL_BENCH_NAUTY
extern const struct bench_peer bench_nauty;
extern const struct bench_peer bench_nauty_kept; /* canonical forms made when building */
#endif

#ifdef GRRL_BENCH_NETWORKX
/* Nanoseconds per query and to build both graphs, measured in Python; false on failure. */
bool bench_networkx(const struct bench_pair *pairs, unsigned n, double *match_ns, double *build_ns);
#endif

#ifdef GRRL_BENCH_RDKIT
/* A library of molecules that stand for states. count: how many contain the query, at most `max`.
 */
void *bench_rdkit_open(void);
void bench_rdkit_close(void *library);
void bench_rdkit_add(void *library, const struct grrl_graph *graph);
void *bench_rdkit_query(const struct grrl_graph *graph);
void bench_rdkit_close_query(void *query);
unsigned bench_rdkit_count(void *library, const void *query, unsigned max);
#endif

/* CPU time of this thread in nanoseconds, so that other processes do not count. */
double bench_now_ns(void);

/* The quantile of a sorted sample, in nanoseconds. */
double bench_quantile(const double *sorted, size_t n, double share);
void bench_sort(double *values, size_t n);

/* Makes a random graph of n links and a given shape: joints of both types, two labels. */
void bench_graph(struct grrl_random *random, enum bench_shape shape, uint8_t n,
                 struct grrl_graph *graph);

/* Makes a pair with a known answer. */
void bench_pair(struct grrl_random *random, enum bench_shape shape, enum bench_question question,
                uint8_t n, struct bench_pair *pair);

/* Makes `legs` equal legs of three links around a hub. Pattern and target differ in which joint of
 * one leg is prismatic, so that all counts of links and joints agree but nothing matches. */
void bench_near_miss(uint8_t legs, struct bench_pair *pair);

/* The same, but the target has one more leg, and the pattern is still not a part of it. */
void bench_near_part(uint8_t legs, struct bench_pair *pair);

/* Nanoseconds to build a graph of this many links and free it; NULL: the library, from a term. */
double bench_build(const struct bench_peer *peer, uint8_t links);

int bench_match(bool json, unsigned n_pairs);
int bench_retrieve(bool json);
int bench_evict(bool json);
int bench_perceive(bool json);

#ifdef __cplusplus
}
#endif

#endif
