#include "options.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <getopt.h>

#include "objects.hpp"

#ifndef GRRL_VERSION
#error "GRRL_VERSION comes from the build"
#endif

namespace grrl_evaluate
{

namespace
{

bool bad(const char *name, const char *text, const std::string &right)
{
    (void)std::fprintf(stderr, "grrl-evaluate: --%s %s: must be %s\n", name, text, right.c_str());
    return false;
}

bool parse_probability(const char *name, const char *text, double &value)
{
    char *end;
    value = std::strtod(text, &end);
    return (end != text && *end == '\0' && value >= 0.0 && value <= 1.0) ||
           bad(name, text, "a number from 0 to 1");
}

bool parse_integer(const char *name, const char *text, uint64_t low, uint64_t high, uint64_t &value)
{
    char *end;
    errno = 0;
    unsigned long long parsed = std::strtoull(text, &end, 10);
    bool digits = text[0] >= '0' && text[0] <= '9';
    if (!digits || *end != '\0' || errno != 0 || parsed < low || parsed > high)
        return bad(name, text,
                   "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    value = parsed;
    return true;
}

bool parse_count(const char *name, const char *text, int &value, uint64_t high = 1000000)
{
    uint64_t parsed = 0;
    if (!parse_integer(name, text, 1, high, parsed))
        return false;
    value = static_cast<int>(parsed);
    return true;
}

bool parse_noise(const char *text, std::vector<double> &noise)
{
    noise.clear();
    for (const char *at = text;; at++) {
        char *end;
        double level = std::strtod(at, &end);
        if (end == at || (*end != '\0' && *end != ',') || !(level > 0.0 && level <= 100.0))
            return bad("noise", text, "numbers above 0 to 100 between commas, such as 1,2");
        noise.push_back(level);
        if (*end == '\0')
            return true;
        at = end;
    }
}

/* The one list of options: getopt's table and --help are both made from it. */
struct Row {
    const char *name;
    const char *argument; /* nullptr: it has none */
    const char *help;
    bool (*take)(const char *text, Options &options);
};

const Row table[] = {
    {"objects", "LIST", "between semicolons: names below, chains, terms, files (all below)",
     [](const char *t, Options &o) { return o.objects = t, true; }},
    {"trials", "N", "trials for each object and noise level (50)",
     [](const char *t, Options &o) { return parse_count("trials", t, o.trials); }},
    {"seed", "N", "of the first trial; the next ones count up (1)",
     [](const char *t, Options &o) {
         return parse_integer("seed", t, 0, UINT64_MAX - 1000000, o.seed);
     }},
    {"noise", "LIST", "levels, times the default of 0.7 mm (1,2)",
     [](const char *t, Options &o) { return parse_noise(t, o.noise); }},
    {"dropout", "P", "probability of a feature to be missing in a frame (0)",
     [](const char *t, Options &o) {
         return parse_probability("dropout", t, o.trial.world.tracker.dropout_probability);
     }},
    {"outliers", "P", "probability of a feature to be elsewhere in a frame (0)",
     [](const char *t, Options &o) {
         return parse_probability("outliers", t, o.trial.world.tracker.outlier_probability);
     }},
    {"cap", "N", "pushes after which a trial is given up (100)",
     [](const char *t, Options &o) { return parse_count("cap", t, o.trial.cap); }},
    {"jobs", "N", "trials at the same time (1)",
     [](const char *t, Options &o) { return parse_count("jobs", t, o.jobs, 256); }},
    {"csv", "FILE", "write every figure, and the counts it is made of",
     [](const char *t, Options &o) { return o.csv = t, true; }},
    {"svg", "FILE", "draw the figures (needs gnuplot)",
     [](const char *t, Options &o) { return o.svg = t, true; }},
    {"quiet", nullptr, "no progress", [](const char *, Options &o) { return o.quiet = true; }},
    {"help", nullptr, "print this text", nullptr},
    {"version", nullptr, "print the version", nullptr},
};

void print_help()
{
    (void)std::printf("Usage: grrl-evaluate perception [OPTION]...\n"
                      "Measures perception on simulated objects under random pushes, against the\n"
                      "truth and against the baseline of the paper, in one run.\n\n");
    for (const Row &row : table) {
        std::string left = std::string("--") + row.name;
        if (row.argument != nullptr)
            left += std::string(" ") + row.argument;
        (void)std::printf("  %-18s %s\n", left.c_str(), row.help);
    }
    (void)std::printf("\nObjects: %s\n"
                      "The same seed gives the same figures, whatever --jobs is.\n"
                      "Exit status: 0 fine; 1 trouble; 2 wrong command line.\n",
                      object_names().c_str());
}

std::vector<option> getopt_table()
{
    std::vector<option> options;
    for (const Row &row : table)
        options.push_back({row.name, row.argument != nullptr ? required_argument : no_argument,
                           nullptr, static_cast<int>(options.size()) + 256});
    options.push_back({nullptr, 0, nullptr, 0});
    return options;
}

} // namespace

OptionsResult parse_options(int argc, char **argv, Options &options)
{
    std::vector<option> rows = getopt_table();
    int id;
    while ((id = getopt_long(argc, argv, "", rows.data(), nullptr)) != -1) {
        if (id == '?') {
            (void)std::fprintf(stderr, "Try grrl-evaluate --help\n");
            return OptionsResult::BAD;
        }
        const Row &row = table[id - 256];
        if (row.take != nullptr) {
            if (!row.take(optarg, options))
                return OptionsResult::BAD;
            continue;
        }
        if (std::string(row.name) == "help")
            print_help();
        else
            (void)std::printf("grrl-evaluate %s\n", GRRL_VERSION);
        return OptionsResult::DONE;
    }
    if (optind + 1 != argc || std::string(argv[optind]) != "perception") {
        (void)std::fprintf(stderr, "grrl-evaluate: what is to be measured? There is: perception\n"
                                   "Try grrl-evaluate --help\n");
        return OptionsResult::BAD;
    }
    return OptionsResult::RUN;
}

} // namespace grrl_evaluate
