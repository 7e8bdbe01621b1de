/* NetworkX: one Python process for the whole run, which measures its own times. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "bench.h"

struct process {
    FILE *to;
    FILE *from;
};

static bool start(struct process *process)
{
    int down[2];
    int up[2];
    if (pipe(down) != 0 || pipe(up) != 0)
        return false;
    (void)fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        (void)dup2(down[0], STDIN_FILENO);
        (void)dup2(up[1], STDOUT_FILENO);
        (void)close(down[1]);
        (void)close(up[0]);
        (void)execl(GRRL_BENCH_PYTHON, "python3", GRRL_BENCH_NETWORKX, (char *)NULL);
        _exit(127);
    }
    (void)close(down[0]);
    (void)close(up[1]);
    process->to = fdopen(down[1], "w");
    process->from = fdopen(up[0], "r");
    return child > 0 && process->to != NULL && process->from != NULL;
}

static void send_graph(FILE *to, const struct grrl_graph *graph)
{
    (void)fprintf(to, "%u", (unsigned)graph->n);
    for (unsigned i = 0; i < graph->n; i++)
        (void)fprintf(to, " %llu", (unsigned long long)graph->label[i]);
    (void)fprintf(to, " %u", grrl_graph_joint_count(graph));
    for (uint8_t a = 0; a < graph->n; a++)
        for (uint8_t b = 0; b < a; b++)
            if (grrl_graph_joint(graph, a, b) != GRRL_NO_JOINT)
                (void)fprintf(to, " %u %u %d", (unsigned)a, (unsigned)b,
                              grrl_graph_joint(graph, a, b));
    (void)fprintf(to, "\n");
}

bool bench_networkx(const struct bench_pair *pairs, unsigned n, double *match_ns, double *build_ns)
{
    static struct process process;
    if (process.to == NULL && !start(&process))
        return false;
    (void)fprintf(process.to, "%s %u\n", pairs[0].kind == GRRL_MATCH_ISOMORPHISM ? "iso" : "mono",
                  n);
    for (unsigned i = 0; i < n; i++) {
        send_graph(process.to, &pairs[i].pattern);
        send_graph(process.to, &pairs[i].target);
    }
    (void)fflush(process.to);
    if (fscanf(process.from, "%lf %lf", match_ns, build_ns) != 2)
        return false;
    for (unsigned i = 0; i < n; i++) {
        int answer;
        if (fscanf(process.from, "%d", &answer) != 1)
            return false;
        if (answer != (int)pairs[i].matches) {
            (void)fprintf(stderr, "grrl-bench: networkx answers %d instead of %d\n", answer,
                          (int)pairs[i].matches);
            exit(1);
        }
    }
    return true;
}
