#include "options.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <getopt.h>

#include "plan.hpp"

#ifndef GRRL_VERSION
#define GRRL_VERSION "unknown"
#endif

namespace grrl_experiment
{

namespace
{

bool bad(const std::string &name, const std::string &text, const std::string &right)
{
    (void)std::fprintf(stderr, "grrl-experiment: --%s %s: must be %s\n", name.c_str(), text.c_str(),
                       right.c_str());
    return false;
}

bool parse_integer(const char *name, const std::string &text, uint64_t low, uint64_t high,
                   uint64_t &value)
{
    char *end;
    errno = 0;
    unsigned long long parsed = std::strtoull(text.c_str(), &end, 10);
    bool digits = !text.empty() && text[0] >= '0' && text[0] <= '9';
    if (!digits || *end != '\0' || errno != 0 || parsed < low || parsed > high)
        return bad(name, text,
                   "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    value = parsed;
    return true;
}

bool parse_count(const char *name, const std::string &text, int most, int &value)
{
    uint64_t parsed = 0;
    if (!parse_integer(name, text, 1, static_cast<uint64_t>(most), parsed))
        return false;
    value = static_cast<int>(parsed);
    return true;
}

bool parse_noise(const char *text, double &mm)
{
    char *end;
    double parsed = std::strtod(text, &end);
    if (end == text || *end != '\0' || !(parsed >= 0.0 && parsed <= 100.0))
        return bad("noise", text, "a number from 0 to 100");
    mm = parsed;
    return true;
}

std::string policy_names()
{
    std::string names;
    for (const Policy &policy : policies())
        names += (names.empty() ? "" : ", ") + policy.name;
    return names + ", or an ablation (--help)";
}

bool parse_policies(const std::string &text, std::vector<const Policy *> &chosen)
{
    chosen.clear();
    for (size_t at = 0; at <= text.size();) {
        size_t end = std::min(text.find(',', at), text.size());
        const Policy *policy = find_policy(text.substr(at, end - at));
        bool again = std::find(chosen.begin(), chosen.end(), policy) != chosen.end();
        if (policy == nullptr || again)
            return bad("policy", text, "one or several, none twice, of " + policy_names());
        chosen.push_back(policy);
        at = end + 1;
    }
    return true;
}

bool parse_pretrain(const std::string &text, Options &options)
{
    size_t colon = text.rfind(':');
    if (colon == std::string::npos || colon == 0)
        return bad("pretrain", text, "an object, a colon and a number of trials, as RRRRR:50");
    options.pretrain = text.substr(0, colon);
    return parse_count("pretrain", text.substr(colon + 1), 10000, options.pretrain_trials);
}

bool parse_transport(const std::string &text, Transport &transport)
{
    transport = text == "udpm" ? Transport::UDPM : Transport::MEMQ;
    return text == "udpm" || text == "memq" || bad("transport", text, "memq or udpm");
}

bool parse_figure(const std::string &text, std::string &figure)
{
    figure = text;
    std::vector<std::string> names = figure_names();
    return std::find(names.begin(), names.end(), text) != names.end() ||
           bad("figure", text, "3b, 4a, 4b, 4c, all or ablations");
}

/* The one list of options: getopt's table and --help are both made from it. */
struct Row {
    const char *name;
    const char *argument; /* nullptr: it has none */
    const char *help;
    bool (*take)(const char *text, Options &options);
};

const Row table[] = {
    {"figure", "NAME", "of the paper: 3b, 4a, 4b, 4c or all; or ablations",
     [](const char *t, Options &o) { return parse_figure(t, o.figure); }},
    {"object", "OBJECT", "or: chain (RPR), term (D(lb, R(l1, l2))) or file",
     [](const char *t, Options &o) { return o.object = t, true; }},
    {"policy", "NAME[,..]", "who chooses, see below (learn; with --figure: the figure's)",
     [](const char *t, Options &o) { return parse_policies(t, o.policies); }},
    {"pretrain", "OBJECT:N", "with --object: compare with N trials of another one before",
     [](const char *t, Options &o) { return parse_pretrain(t, o); }},
    {"trials", "N", "of an experiment (50)",
     [](const char *t, Options &o) { return parse_count("trials", t, 10000, o.trials); }},
    {"experiments", "N", "that start without experience (20)",
     [](const char *t, Options &o) { return parse_count("experiments", t, 1000, o.experiments); }},
    {"seed", "N", "experiment i has the seed 1000 N + i (1)",
     [](const char *t, Options &o) { return parse_integer("seed", t, 0, 1000000000, o.seed); }},
    {"jobs", "N", "experiments at the same time (one for each core)",
     [](const char *t, Options &o) { return parse_count("jobs", t, 256, o.jobs); }},
    {"out", "DIR", "folder for the results; needed",
     [](const char *t, Options &o) { return o.out = t, true; }},
    {"transport", "NAME", "memq: agent and simulator in one process; udpm: in two (memq)",
     [](const char *t, Options &o) { return parse_transport(t, o.transport); }},
    {"cap", "N", "pushes after which a trial is given up (100)",
     [](const char *t, Options &o) { return parse_count("cap", t, 100000, o.cap); }},
    {"noise", "MM", "standard deviation of a tracked point (0.7)",
     [](const char *t, Options &o) { return parse_noise(t, o.noise_mm); }},
    {"help", nullptr, "print this text", nullptr},
    {"version", nullptr, "print the version", nullptr},
};

void print_help()
{
    (void)std::printf("Usage: grrl-experiment (--figure NAME | --object OBJECT) --out DIR "
                      "[OPTION]...\n"
                      "Lets policies find out the structure of objects in trial after trial and "
                      "compares\nthem: learning curves with intervals, and transfer.\n\n");
    for (const Row &row : table) {
        std::string left = std::string("--") + row.name;
        if (row.argument != nullptr)
            left += std::string(" ") + row.argument;
        (void)std::printf("  %-21s %s\n", left.c_str(), row.help);
    }
    (void)std::printf("\nPolicies:\n");
    for (const Policy &policy : policies())
        (void)std::printf("  %-12s %s\n", policy.name.c_str(), policy.text.c_str());
    (void)std::printf("\nAblations, by --figure ablations (RPRPRPR) or by name:\n");
    for (const Policy &policy : ablations())
        (void)std::printf("  %-25s %s\n", policy.name.c_str(), policy.text.c_str());
    (void)std::printf(
        "\nDIR gets trials.csv, summary.csv, report.html and pictures (SVG, PNG; needs gnuplot).\n"
        "A run that was stopped goes on where it was: finished experiments are kept there.\n"
        "The same command gives the same CSV whatever --jobs and --transport are.\n"
        "Exit status: 0 done; 1 trouble; 2 wrong command line; 130 interrupted.\n");
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

bool complain(const char *text)
{
    (void)std::fprintf(stderr, "grrl-experiment: %s\n", text);
    return false;
}

bool consistent(const Options &options)
{
    if (options.object.empty() == options.figure.empty())
        return complain("one of --figure and --object is needed, for example --object RPR");
    if (!options.figure.empty() && !options.pretrain.empty())
        return complain("--pretrain goes with --object; a figure has its own");
    if (options.out.empty())
        return complain("--out is needed: a folder for the results");
    for (const Policy *policy : options.policies)
        if (policy->needs_truth && options.transport != Transport::MEMQ)
            return complain("--policy clairvoyant: needs the simulator in the same process, "
                            "--transport memq");
    return true;
}

} // namespace

OptionsResult parse_options(int argc, char **argv, Options &options)
{
    for (int i = 0; i < argc; i++) {
        std::string word = i > 0 ? argv[i] : "grrl-experiment";
        bool plain = word.find_first_of(" ()'\"$&;*?<>|\\") == std::string::npos;
        options.command += (i > 0 ? " " : "") + (plain ? word : "\"" + word + "\"");
    }
    std::vector<option> rows = getopt_table();
    int id;
    while ((id = getopt_long(argc, argv, "", rows.data(), nullptr)) != -1) {
        if (id == '?') {
            (void)std::fprintf(stderr, "Try grrl-experiment --help\n");
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
            (void)std::printf("grrl-experiment %s\n", GRRL_VERSION);
        return OptionsResult::DONE;
    }
    if (optind < argc) {
        (void)std::fprintf(stderr, "grrl-experiment: %s: there are no arguments, only options\n",
                           argv[optind]);
        return OptionsResult::BAD;
    }
    return consistent(options) ? OptionsResult::RUN : OptionsResult::BAD;
}

} // namespace grrl_experiment
