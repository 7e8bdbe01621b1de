/*
 * bench.h: what the parts of grrl-bench share.
 *
 * A peer is another program's matcher behind three functions. It sees the same pairs as the library
 * in the same run, so that ratios hold whatever the machine does.
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
    BENCH_ISO_NO, /* one joint or label is another, all counts the same */
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

/* A matcher, with its own form of a graph; NULL pointers: not built in. */
struct bench_peer {
    const char *name;
    void *(*build)(const struct grrl_graph *graph);
    void (*destroy)(void *graph);
    /* 1: a mapping exists; 0: none; -1: cannot be asked this. */
    int (*match)(enum grrl_match_kind kind, const void *pattern, const void *target);
};

#ifdef GRRL_BENCH_BOOST
extern const struct bench_peer bench_boost;
#endif
#ifdef GRRL_BENCH_IGRAPH
extern const struct bench_peer bench_igraph;
#endif
#ifdef GRRL_BENCH_NAUTY
extern const struct bench_peer bench_nauty;
#endif

#ifdef GRRL_BENCH_NETWORKX
/* Nanoseconds of a query and of building both graphs, as Python counts them; false: it failed. */
bool bench_networkx(const struct bench_pair *pairs, unsigned n, double *match_ns, double *build_ns);
#endif

/* Nanoseconds this thread has had a processor: others on the machine do not count. */
double bench_now_ns(void);

/* Nanoseconds of a sorted sample below which the share lies. */
double bench_quantile(const double *sorted, size_t n, double share);
void bench_sort(double *values, size_t n);

/* A random graph of n links of a shape: joints of both types, two labels. */
void bench_graph(struct grrl_random *random, enum bench_shape shape, uint8_t n,
                 struct grrl_graph *graph);

/* A pair whose answer is known. */
void bench_pair(struct grrl_random *random, enum bench_shape shape, enum bench_question question,
                uint8_t n, struct bench_pair *pair);

/* `legs` equal legs of three links around a hub; in pattern and target another joint of one leg is
 * prismatic, so that all counts of links and joints agree and nothing matches. */
void bench_near_miss(uint8_t legs, struct bench_pair *pair);

/* The same, the target with one more leg: no part of it. */
void bench_near_part(uint8_t legs, struct bench_pair *pair);

/* Nanoseconds to make one graph of so many links and to give it up again; NULL: the library, out of
 * a term. */
double bench_build(const struct bench_peer *peer, uint8_t links);

int bench_match(bool json, unsigned n_pairs);
int bench_retrieve(bool json);
int bench_evict(bool json);
int bench_perceive(bool json);

#ifdef __cplusplus
}
#endif

#endif
