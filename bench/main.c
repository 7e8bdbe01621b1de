/* grrl-bench: how fast matching and retrieval are, next to what others offer. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"

static const char usage[] =
    "usage: grrl-bench match|retrieve|evict|perceive [--json] [--pairs N]\n"
    "\n"
    "match     nanoseconds a query for pairs of structures of 4 to 32 links: the library with and\n"
    "          without stored plans, and the peers it was built with\n"
    "retrieve  nanoseconds a query among 1000 and 100000 stored states\n"
    "evict     the share of updates that a full store knows the experience of\n"
    "perceive  milliseconds of perception by links, features and keyframes\n"
    "\n"
    "  --json     one JSON array instead of a table\n"
    "  --pairs N  pairs a case, 1 to 256 (64); match only\n"
    "  --help     this text\n"
    "  --version  the version\n";

int main(int argc, char **argv)
{
    bool json = false;
    unsigned n_pairs = 64;
    const char *command = NULL;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0)
            return fputs(usage, stdout) < 0;
        if (strcmp(argv[i], "--version") == 0)
            return puts("grrl-bench " GRRL_VERSION) < 0;
        char *end = NULL;
        if (strcmp(argv[i], "--json") == 0) {
            json = true;
        } else if (strcmp(argv[i], "--pairs") == 0 && i + 1 < argc &&
                   (n_pairs = (unsigned)strtoul(argv[i + 1], &end, 10)) >= 1 && n_pairs <= 256 &&
                   *end == '\0') {
            i++;
        } else if (command == NULL && argv[i][0] != '-') {
            command = argv[i];
        } else {
            (void)fprintf(stderr, "grrl-bench: cannot use `%s' here\n%s", argv[i], usage);
            return 2;
        }
    }
    if (command != NULL && strcmp(command, "match") == 0)
        return bench_match(json, n_pairs);
    if (command != NULL && strcmp(command, "retrieve") == 0)
        return bench_retrieve(json);
    if (command != NULL && strcmp(command, "evict") == 0)
        return bench_evict(json);
    if (command != NULL && strcmp(command, "perceive") == 0)
        return bench_perceive(json);
    (void)fprintf(stderr, "grrl-bench: say what to measure\n%s", usage);
    return 2;
}
