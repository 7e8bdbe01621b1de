#include "options.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <getopt.h>
#include <vector>

#ifndef GRRL_VERSION
#define GRRL_VERSION "unknown"
#endif

namespace grrl_sim
{

namespace
{

bool bad(const std::string &name, const char *text, const std::string &right)
{
    (void)std::fprintf(stderr, "grrl-sim: --%s %s: must be %s\n", name.c_str(), text,
                       right.c_str());
    return false;
}

bool parse_double(const char *name, const char *text, double low, double high, double &value)
{
    char *end;
    double parsed = std::strtod(text, &end);
    if (end == text || *end != '\0' || !(parsed >= low && parsed <= high)) {
        char right[80];
        (void)std::snprintf(right, sizeof right, "a number from %g to %g", low, high);
        return bad(name, text, right);
    }
    value = parsed;
    return true;
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

bool parse_count(const char *name, const char *text, int &value)
{
    uint64_t parsed = 0;
    if (!parse_integer(name, text, 1, 1000000, parsed))
        return false;
    value = static_cast<int>(parsed);
    return true;
}

bool parse_noise(const char *text, double &noise_m)
{
    double mm = 0.0;
    if (!parse_double("noise", text, 0.0, 100.0, mm))
        return false;
    noise_m = mm * 0.001;
    return true;
}

bool parse_look(const char *text, CameraLook &look)
{
    std::string problem = parse_camera_look(text, look);
    if (!problem.empty())
        (void)std::fprintf(stderr, "grrl-sim: --camera-look %s\n", problem.c_str());
    return problem.empty();
}

/* The one list of options: getopt's table and --help are both made from it. */
struct Row {
    const char *name;
    const char *argument; /* nullptr: it has none */
    const char *help;
    bool (*take)(const char *text, Options &options);
};

const Row table[] = {
    {"object", "OBJECT", "chain (RPR), term (D(lb, R(l1, l2))) or file; needed",
     [](const char *t, Options &o) { return o.object = t, true; }},
    {"trials", "N", "trials until the end (1)",
     [](const char *t, Options &o) { return parse_count("trials", t, o.trials); }},
    {"cap", "N", "pushes after which a trial is given up (100)",
     [](const char *t, Options &o) { return parse_count("cap", t, o.cap); }},
    {"seed", "N", "seed of poses, noise and friction (1)",
     [](const char *t, Options &o) { return parse_integer("seed", t, 0, UINT64_MAX, o.seed); }},
    {"noise", "MM", "standard deviation of a tracked point, millimetres (0.7)",
     [](const char *t, Options &o) { return parse_noise(t, o.tracker.noise_sigma_m); }},
    {"dropout", "P", "probability of a point to be missing in a frame (0)",
     [](const char *t, Options &o) {
         return parse_double("dropout", t, 0.0, 1.0, o.tracker.dropout_probability);
     }},
    {"outliers", "P", "probability of a point to be elsewhere in a frame (0)",
     [](const char *t, Options &o) {
         return parse_double("outliers", t, 0.0, 1.0, o.tracker.outlier_probability);
     }},
    {"camera", nullptr, "publish pictures for grrl-track instead of points (needs OpenCV)",
     [](const char *, Options &o) { return o.camera = true; }},
    {"camera-look", "NAME=X,..", "how the camera sees, see below",
     [](const char *t, Options &o) { return parse_look(t, o.look); }},
    {"real-time", nullptr, "30 frames a second instead of lock-step with the agent",
     [](const char *, Options &o) { return o.real_time = true; }},
    {"agent-timeout", "S", "give up when no agent is heard for S seconds (wait for ever)",
     [](const char *t, Options &o) {
         return parse_double("agent-timeout", t, 0.1, 1e6, o.agent_timeout_s);
     }},
    {"log", "FILE", "write every message to an LCM log",
     [](const char *t, Options &o) { return o.log = t, true; }},
    {"results", "FILE", "write trial,pushes,outcome lines (CSV)",
     [](const char *t, Options &o) { return o.results = t, true; }},
    {"lcm-url", "URL", "LCM provider",
     [](const char *t, Options &o) { return o.lcm_url = t, true; }},
    {"quiet", nullptr, "print errors only",
     [](const char *, Options &o) { return o.quiet = true; }},
    {"help", nullptr, "print this text", nullptr},
    {"version", nullptr, "print the version", nullptr},
};

void print_help()
{
    (void)std::printf("Usage: grrl-sim --object OBJECT [OPTION]...\n"
                      "A table with an articulated object, a camera that tracks points, a finger\n"
                      "that pushes, and a supervisor, all on LCM for grrl-agent.\n\n");
    for (const Row &row : table) {
        std::string left = std::string("--") + row.name;
        if (row.argument != nullptr)
            left += std::string(" ") + row.argument;
        (void)std::printf("  %-18s %s\n", left.c_str(), row.help);
    }
    (void)std::printf("\nThe camera's look:\n%s", camera_look_help().c_str());
    (void)std::printf("\nWithout --lcm-url the environment variable LCM_DEFAULT_URL counts.\n"
                      "Exit status: 0 all trials done or stopped by a signal; 1 trouble; 2 wrong\n"
                      "command line.\n");
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
            (void)std::fprintf(stderr, "Try grrl-sim --help\n");
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
            (void)std::printf("grrl-sim %s\n", GRRL_VERSION);
        return OptionsResult::DONE;
    }
    if (optind < argc) {
        (void)std::fprintf(stderr, "grrl-sim: %s: there are no arguments, only options\n",
                           argv[optind]);
        return OptionsResult::BAD;
    }
    if (options.object.empty()) {
        (void)std::fprintf(stderr, "grrl-sim: --object is needed, for example --object RPR\n");
        return OptionsResult::BAD;
    }
    return OptionsResult::RUN;
}

} // namespace grrl_sim
