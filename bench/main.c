/* grrl-bench: the speed of matching and retrieval, compared with other programs. */
#include <string.h>

#include "bench.h"
#include "cli/options.h"

static const struct grrl_program program = {
    .name = "grrl-bench",
    .usage = "grrl-bench match|retrieve|evict|perceive [OPTION]...",
    .intro = "\n"
             "match     nanoseconds per query for pairs of structures of 4 to 32 links: the "
             "library with\n"
             "          and without stored plans, and the peers it was built with\n"
             "retrieve  nanoseconds per query among 1000 and 100000 stored states\n"
             "evict     the share of updates whose experience a full store still has\n"
             "perceive  milliseconds of perception by links, features and keyframes\n",
    .max_arguments = 1,
    .arguments = "give only one measurement",
};

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
    return grrl_options_wrong(&program, "give one of match, retrieve, evict or perceive");
}
