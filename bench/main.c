/* grrl-bench: the speed of matching and retrieval, compared with other programs. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "bench.h"
#include "cli/options.h"

static const struct grrl_program program = {
    .name = "grrl-bench",
    .usage = "grrl-bench match|retrieve|evict|perceive|push|rules [OPTION]...",
    .intro = "\n"
             "match     nanoseconds per query for pairs of structures of 4 to 32 links: the "
             "library with\n"
             "          and without stored plans, and the peers it was built with\n"
             "retrieve  microseconds per query among 1000 and 100000 stored states, and next to\n"
             "          RDKit among 1000 and 10000; about a minute\n"
             "evict     the share of updates whose experience a full store still has\n"
             "perceive  milliseconds of perception by links, features and keyframes\n"
             "push      what a push of RPRPRPR costs with learn, in instructions if valgrind is\n"
             "          installed or the processor counts them, and each part next to raw Box2D\n"
             "rules     how many choices of robots that start with the store that comes with grrl\n"
             "          its rules explain\n",
    .max_arguments = 1,
    .arguments = "give only one measurement",
};

/* Runs of agent and simulator link the library with its usual capacities, so they are programs of
 * their own, beside this one. Returns only on failure. */
static int run_beside(const char *name, bool json)
{
    char path[4096];
    size_t most = strlen(name) + sizeof "-";
    ssize_t n = readlink("/proc/self/exe", path, sizeof path - most);
    if (n > 0) {
        (void)snprintf(path + n, most, "-%s", name);
        (void)execl(path, path, json ? "json" : (char *)NULL, (char *)NULL);
        (void)fprintf(stderr, "grrl-bench: cannot run %s: build the target grrl-bench-%s\n", path,
                      name);
    }
    return 1;
}

int main(int argc, char **argv)
{
    bool json = false;
    uint32_t n_pairs = 64;
    const struct grrl_option rows[] = {
        grrl_option_flag("json", "one JSON array instead of a table", &json),
        grrl_option_u32("pairs", "N", "pairs per case, 1 to 256 (64); match only", 1, 256,
                        &n_pairs),
    };
    int first;
    enum grrl_options_result parsed =
        grrl_options_parse(&program, rows, sizeof rows / sizeof rows[0], argc, argv, &first);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    const char *command = first < argc ? argv[first] : "";
    if (strcmp(command, "match") == 0)
        return bench_match(json, n_pairs);
    if (strcmp(command, "retrieve") == 0)
        return bench_retrieve(json);
    if (strcmp(command, "evict") == 0)
        return bench_evict(json);
    if (strcmp(command, "perceive") == 0)
        return bench_perceive(json);
    if (strcmp(command, "push") == 0 || strcmp(command, "rules") == 0)
        return run_beside(command, json);
    return grrl_options_wrong(&program,
                              "give one of match, retrieve, evict, perceive, push or rules");
}
