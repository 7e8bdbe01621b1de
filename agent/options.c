#define _POSIX_C_SOURCE 200809L

#include "options.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef GRRL_VERSION
#define GRRL_VERSION "unknown"
#endif

enum option_id {
    OPT_POLICY = 256,
    OPT_STORE,
    OPT_EXPERIENCES,
    OPT_SEED,
    OPT_NOISE,
    OPT_OBSERVE,
    OPT_TRACKER_TIMEOUT,
    OPT_LCM_URL,
    OPT_QUIET,
    OPT_EXPLAIN,
    OPT_HELP,
    OPT_VERSION,
    OPT_PARAMETER /* and up: the parameters of all policies, one after another */
};

/* The one list of options: getopt's table and --help are both made from it. */
static const struct {
    enum option_id id;
    const char *name;
    const char *argument; /* NULL: it has none */
    const char *help;
} table[] = {
    {OPT_POLICY, "policy", "NAME", "how pushes are chosen, see below (learn)"},
    {OPT_STORE, "store", "FILE", "load experiences from FILE and save them there after each trial"},
    {OPT_EXPERIENCES, "experiences", "N", "memory for N experiences, 1 to 1000000 (1000)"},
    {OPT_SEED, "seed", "N", "seed of all random choices (1)"},
    {OPT_NOISE, "noise", "MM", "standard deviation of a tracked point, millimetres (0.7)"},
    {OPT_OBSERVE, "observe", NULL, "learn from another agent's pushes, live or from a log"},
    {OPT_TRACKER_TIMEOUT, "tracker-timeout", "S",
     "give up when nothing is heard for S seconds (wait for ever)"},
    {OPT_LCM_URL, "lcm-url", "URL", "LCM provider; a log is file://run.lcm?speed=0"},
    {OPT_QUIET, "quiet", NULL, "print errors only"},
    {OPT_EXPLAIN, "explain", NULL, "print a line for each decision: what and why"},
    {OPT_HELP, "help", NULL, "print this text"},
    {OPT_VERSION, "version", NULL, "print the version"},
};

enum { N_OPTIONS = sizeof table / sizeof table[0], MOST_PARAMETERS = 32 };

/* A parameter of a policy, and what the user gave for it. */
struct given {
    const struct grrl_policy_type *policy;
    const struct grrl_parameter *parameter;
    const char *text; /* NULL: not given */
};

static size_t list_parameters(struct given *given)
{
    size_t n = 0;
    for (const struct grrl_policy_type *const *type = grrl_policies; *type != NULL; type++)
        for (size_t i = 0; i < (*type)->n_parameters && n < MOST_PARAMETERS; i++)
            given[n++] = (struct given){*type, &(*type)->parameters[i], NULL};
    return n;
}

static float *value_of(const struct grrl_parameter *parameter, void *config)
{
    return (float *)(void *)((unsigned char *)config + parameter->offset);
}

static void print_policies(void)
{
    union {
        max_align_t aligned;
        unsigned char bytes[GRRL_POLICY_CONFIG_BYTES];
    } config;
    (void)printf("\nPolicies and their parameters:\n");
    for (const struct grrl_policy_type *const *type = grrl_policies; *type != NULL; type++) {
        (void)printf("  %-22s %s\n", (*type)->name, (*type)->text);
        if ((*type)->config_default != NULL)
            (*type)->config_default(config.bytes);
        for (size_t i = 0; i < (*type)->n_parameters; i++) {
            const struct grrl_parameter *parameter = &(*type)->parameters[i];
            char left[40];
            (void)snprintf(left, sizeof left, "--%s X", parameter->name);
            (void)printf("    %-20s %s, %s (%g)\n", left, parameter->help, parameter->range,
                         (double)*value_of(parameter, config.bytes));
        }
    }
}

static void print_help(void)
{
    (void)printf("Usage: grrl-agent [OPTION]...\n"
                 "Learns to find out how articulated objects move by pushing them.\n"
                 "Waits for feature points on LCM; grrl-sim sends some.\n\n");
    for (size_t i = 0; i < N_OPTIONS; i++) {
        char left[40];
        (void)snprintf(left, sizeof left, "--%s%s%s", table[i].name,
                       table[i].argument != NULL ? " " : "",
                       table[i].argument != NULL ? table[i].argument : "");
        (void)printf("  %-22s %s\n", left, table[i].help);
    }
    print_policies();
    (void)printf("\nWithout --lcm-url the environment variable LCM_DEFAULT_URL counts.\n"
                 "Exit status: 0 all trials done, log read or stopped by a signal; 1 trouble;\n"
                 "2 wrong command line.\n");
}

static bool bad(const char *name, const char *text, const char *right)
{
    (void)fprintf(stderr, "grrl-agent: --%s %s: must be %s\n", name, text, right);
    return false;
}

static bool parse_float(const char *name, const char *text, const char *right, float *value)
{
    char *end;
    float parsed = strtof(text, &end);
    if (end == text || *end != '\0' || !isfinite(parsed))
        return bad(name, text, right);
    *value = parsed;
    return true;
}

static bool parse_unsigned(const char *name, const char *text, unsigned long long low,
                           unsigned long long high, const char *right, unsigned long long *value)
{
    char *end;
    errno = 0;
    unsigned long long parsed = strtoull(text, &end, 10);
    bool digits = text[0] >= '0' && text[0] <= '9';
    if (!digits || *end != '\0' || errno != 0 || parsed < low || parsed > high)
        return bad(name, text, right);
    *value = parsed;
    return true;
}

static bool parse_policy(const char *text, const struct grrl_policy_type **policy)
{
    char names[160] = "one of";
    *policy = grrl_policy_find(text);
    for (const struct grrl_policy_type *const *type = grrl_policies; *type != NULL; type++) {
        size_t length = strlen(names);
        (void)snprintf(names + length, sizeof names - length, " %s", (*type)->name);
    }
    return *policy != NULL || bad("policy", text, names);
}

/* Makes the policy's configuration from what was given. */
static bool configure(const struct given *given, size_t n, struct grrl_agent_options *options)
{
    static union {
        max_align_t aligned;
        unsigned char bytes[GRRL_POLICY_CONFIG_BYTES];
    } config;
    const struct grrl_policy_type *policy = options->policy;
    if (policy->config_default != NULL) {
        policy->config_default(config.bytes);
        options->policy_config = config.bytes;
    }
    for (size_t i = 0; i < n; i++) {
        const struct grrl_parameter *parameter = given[i].parameter;
        if (given[i].text == NULL)
            continue;
        if (given[i].policy != policy) {
            (void)fprintf(stderr, "grrl-agent: --%s goes with --policy %s\n", parameter->name,
                          given[i].policy->name);
            return false;
        }
        if (!parse_float(parameter->name, given[i].text, parameter->range,
                         value_of(parameter, config.bytes)))
            return false;
        if (policy->config_check(config.bytes, NULL) != GRRL_OK)
            return bad(parameter->name, given[i].text, parameter->range);
    }
    return true;
}

static bool parse_noise(const char *text, float *noise_m)
{
    float mm;
    if (!parse_float("noise", text, "millimetres, above 0 to 100", &mm))
        return false;
    if (!(mm > 0.0f && mm <= 100.0f))
        return bad("noise", text, "millimetres, above 0 to 100");
    *noise_m = mm * 0.001f;
    return true;
}

static bool parse_timeout(const char *text, double *seconds)
{
    float parsed;
    const char *right = "seconds, 0.1 to 1000000";
    if (!parse_float("tracker-timeout", text, right, &parsed))
        return false;
    if (!(parsed >= 0.1f && parsed <= 1e6f))
        return bad("tracker-timeout", text, right);
    *seconds = (double)parsed;
    return true;
}

static bool take(enum option_id id, const char *text, struct grrl_agent_options *options)
{
    unsigned long long n = 0;
    bool good = true;
    switch (id) {
    case OPT_POLICY:
        return parse_policy(text, &options->policy);
    case OPT_STORE:
        options->store = text;
        return true;
    case OPT_EXPERIENCES:
        good = parse_unsigned("experiences", text, 1, 1000000, "a number from 1 to 1000000", &n);
        options->experiences = (uint32_t)n;
        return good;
    case OPT_SEED:
        good = parse_unsigned("seed", text, 0, UINT64_MAX, "a number from 0", &n);
        options->learner.seed = n;
        return good;
    case OPT_NOISE:
        return parse_noise(text, &options->learner.perception.noise_m);
    case OPT_OBSERVE:
        options->observe = true;
        return true;
    case OPT_TRACKER_TIMEOUT:
        return parse_timeout(text, &options->tracker_timeout_s);
    case OPT_LCM_URL:
        options->lcm_url = text;
        return true;
    case OPT_QUIET:
        options->quiet = true;
        return true;
    case OPT_EXPLAIN:
        options->explain = true;
        return true;
    default:
        return false;
    }
}

static bool consistent(const struct grrl_agent_options *options)
{
    if (options->quiet && options->explain) {
        (void)fprintf(stderr, "grrl-agent: --quiet and --explain contradict each other\n");
        return false;
    }
    if (options->store != NULL && options->policy->entries == NULL) {
        (void)fprintf(stderr, "grrl-agent: --store: the policy %s does not learn\n",
                      options->policy->name);
        return false;
    }
    return true;
}

static void make_getopt_table(const struct given *given, size_t n, struct option *options)
{
    memset(options, 0, (N_OPTIONS + n + 1) * sizeof *options);
    for (size_t i = 0; i < N_OPTIONS; i++) {
        options[i].name = table[i].name;
        options[i].has_arg = table[i].argument != NULL ? required_argument : no_argument;
        options[i].val = (int)table[i].id;
    }
    for (size_t i = 0; i < n; i++) {
        options[N_OPTIONS + i].name = given[i].parameter->name;
        options[N_OPTIONS + i].has_arg = required_argument;
        options[N_OPTIONS + i].val = OPT_PARAMETER + (int)i;
    }
}

enum grrl_options_result grrl_agent_options_parse(int argc, char **argv,
                                                  struct grrl_agent_options *options)
{
    struct given given[MOST_PARAMETERS];
    size_t n = list_parameters(given);
    struct option getopt_table[N_OPTIONS + MOST_PARAMETERS + 1];
    make_getopt_table(given, n, getopt_table);
    memset(options, 0, sizeof *options);
    grrl_learner_config_default(&options->learner);
    options->learner.seed = 1;
    options->policy = grrl_policies[0];
    options->experiences = 1000;
    int id;
    while ((id = getopt_long(argc, argv, "", getopt_table, NULL)) != -1) {
        if (id == OPT_HELP) {
            print_help();
            return GRRL_OPTIONS_DONE;
        }
        if (id == OPT_VERSION) {
            (void)printf("grrl-agent %s\n", GRRL_VERSION);
            return GRRL_OPTIONS_DONE;
        }
        if (id == '?') {
            (void)fprintf(stderr, "Try grrl-agent --help\n");
            return GRRL_OPTIONS_BAD;
        }
        if (id >= OPT_PARAMETER)
            given[id - OPT_PARAMETER].text = optarg;
        else if (!take((enum option_id)id, optarg, options))
            return GRRL_OPTIONS_BAD;
    }
    if (optind < argc) {
        (void)fprintf(stderr, "grrl-agent: %s: there are no arguments, only options\n",
                      argv[optind]);
        return GRRL_OPTIONS_BAD;
    }
    return configure(given, n, options) && consistent(options) ? GRRL_OPTIONS_RUN
                                                               : GRRL_OPTIONS_BAD;
}
