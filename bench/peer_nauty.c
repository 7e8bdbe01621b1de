/*
 * nauty: canonical forms by densenauty, isomorphism only. Joint types become two layers per link:
 * revolute joints in the first, prismatic ones in the second, with a link's two layers connected
 * (the nauty manual's method for coloured edges). Every query canonises both graphs; of the peer
 * `nauty kept`, building does, and a query compares hashes of the forms, then the forms.
 */
#include <nauty/nauty.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"

enum { MAX_ROWS = 2 * GRRL_MAX_LINKS, WORDS = (MAX_ROWS + WORDSIZE - 1) / WORDSIZE };

struct layered {
    int n;
    graph rows[MAX_ROWS * WORDS];
    grrl_label label[GRRL_MAX_LINKS];
};

static void *build(const struct grrl_graph *from)
{
    struct layered *built = calloc(1, sizeof *built);
    if (built == NULL)
        abort();
    built->n = from->n;
    memcpy(built->label, from->label, sizeof built->label);
    for (int i = 0; i < from->n; i++) {
        ADDONEEDGE(built->rows, i, i + from->n, WORDS);
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            for (int j = 0; j < i; j++)
                if ((from->joined[type][i] >> j & 1u) != 0)
                    ADDONEEDGE(built->rows, i + type * from->n, j + type * from->n, WORDS);
    }
    return built;
}

static void canonise(const struct layered *from, graph *form, grrl_label *labels)
{
    static DEFAULTOPTIONS_GRAPH(options);
    statsblk stats;
    int order[MAX_ROWS];
    int ends[MAX_ROWS];
    int orbits[MAX_ROWS];
    graph rows[MAX_ROWS * WORDS];
    memcpy(rows, from->rows, sizeof rows);
    options.getcanon = TRUE;
    options.defaultptn = FALSE;
    int at = 0;
    for (int layer = 0; layer < 2; layer++) { /* vertices by layer, then by label */
        bool taken[GRRL_MAX_LINKS] = {false};
        for (int left = from->n; left > 0;) {
            grrl_label smallest = UINT64_MAX;
            for (int i = 0; i < from->n; i++)
                if (!taken[i] && from->label[i] < smallest)
                    smallest = from->label[i];
            for (int i = 0; i < from->n; i++) {
                if (taken[i] || from->label[i] != smallest)
                    continue;
                taken[i] = true;
                left--;
                order[at] = i + layer * from->n;
                ends[at++] = 1;
            }
            ends[at - 1] = 0;
        }
    }
    densenauty(rows, order, ends, orbits, &options, &stats, WORDS, 2 * from->n, form);
    for (int i = 0; i < from->n; i++)
        labels[i] = from->label[order[i]];
}

static void destroy(void *built)
{
    free(built);
}

static int match(enum grrl_match_kind kind, const void *pattern, const void *target)
{
    const struct layered *from[2] = {pattern, target};
    if (kind != GRRL_MATCH_ISOMORPHISM)
        return -1;
    if (from[0]->n != from[1]->n)
        return 0;
    graph form[2][MAX_ROWS * WORDS];
    grrl_label labels[2][GRRL_MAX_LINKS];
    for (int i = 0; i < 2; i++)
        canonise(from[i], form[i], labels[i]);
    size_t n = (size_t)from[0]->n;
    return memcmp(labels[0], labels[1], n * sizeof labels[0][0]) == 0 &&
           memcmp(form[0], form[1], 2 * n * WORDS * sizeof(graph)) == 0;
}

struct kept {
    int n;
    long hash; /* of the form, with nauty's own function */
    graph form[MAX_ROWS * WORDS];
    grrl_label labels[GRRL_MAX_LINKS];
};

static void *build_kept(const struct grrl_graph *from)
{
    struct layered *layered = build(from);
    struct kept *kept = calloc(1, sizeof *kept);
    if (kept == NULL)
        abort();
    kept->n = from->n;
    canonise(layered, kept->form, kept->labels);
    kept->hash = hashgraph(kept->form, WORDS, 2 * kept->n, 1);
    free(layered);
    return kept;
}

static int match_kept(enum grrl_match_kind kind, const void *pattern, const void *target)
{
    const struct kept *a = pattern;
    const struct kept *b = target;
    if (kind != GRRL_MATCH_ISOMORPHISM)
        return -1;
    return a->hash == b->hash && a->n == b->n &&
           memcmp(a->labels, b->labels, (size_t)a->n * sizeof a->labels[0]) == 0 &&
           memcmp(a->form, b->form, 2 * (size_t)a->n * WORDS * sizeof(graph)) == 0;
}

const struct bench_peer bench_nauty = {"nauty", build, destroy, match};
const struct bench_peer bench_nauty_kept = {"nauty kept", build_kept, destroy, match_kept};
