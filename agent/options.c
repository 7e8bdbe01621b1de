/* options.c: the table of grrl-agent's options; each policy of the library adds its parameters. */
#include "options.h"

#include <stdio.h>
#include <string.h>

enum { MAX_PARAMETERS = 24, N_LIMITS = 6, HELP_BYTES = 160 };

static const struct grrl_program program = {
    .name = "grrl-agent",
    .usage = "grrl-agent [OPTION]...",
    .intro = "Learns to discover how articulated objects move by pushing them.\n"
             "Waits for feature points on LCM; grrl-sim sends some.\n",
    .outro = "Without --lcm-url it uses the environment variable LCM_DEFAULT_URL.\n"
             "Exit status: 0 all trials done, sure (--until-sure), all --pushes done, log read or\n"
             "stopped by a signal; 1 failed, or --pushes done and not sure; 2 wrong command line;\n"
             "3 stopped by GRRL_STOP.\n",
};

/* A policy's configuration, whatever its type. */
union configuration {
    max_align_t aligned;
    unsigned char bytes[GRRL_POLICY_CONFIG_BYTES];
};

/* A parameter of a policy, and the value that the user gave. */
struct given {
    const struct grrl_policy_type *policy;
    const struct grrl_parameter *parameter;
    bool is_given;
    float value;
    char help[HELP_BYTES];
};

static float *value_of(const struct grrl_parameter *parameter, union configuration *config)
{
    return (float *)(void *)(config->bytes + parameter->offset);
}

static const char *take_parameter(void *context, const char *text)
{
    struct given *given = context;
    union configuration config;
    double value;
    if (!grrl_option_number_of(text, &value))
        return given->parameter->range;
    given->is_given = true;
    given->value = (float)value;
    given->policy->config_default(config.bytes);
    *value_of(given->parameter, &config) = given->value;
    return given->policy->config_check(config.bytes, NULL) == GRRL_OK ? NULL
                                                                      : given->parameter->range;
}

/* A row for each parameter of each policy; returns how many. */
static size_t add_parameters(struct given *given, struct grrl_option *rows)
{
    size_t n = 0;
    for (const struct grrl_policy_type *const *type = grrl_policies; *type != NULL; type++) {
        union configuration config;
        if ((*type)->config_default != NULL)
            (*type)->config_default(config.bytes);
        for (size_t i = 0; i < (*type)->n_parameters && n < MAX_PARAMETERS; i++, n++) {
            const struct grrl_parameter *parameter = &(*type)->parameters[i];
            given[n] = (struct given){.policy = *type, .parameter = parameter};
            (void)snprintf(given[n].help, HELP_BYTES, "%s: %s, %s (%g)", (*type)->name,
                           parameter->help, parameter->range,
                           (double)*value_of(parameter, &config));
            rows[n] =
                grrl_option_call(parameter->name, "X", given[n].help, take_parameter, &given[n]);
        }
    }
    return n;
}

/* Lists the policies in one line for an error message, or one per line with their texts for --help.
 */
static void list_policies(const char *before, const char *between, bool with_text, char *to,
                          size_t capacity)
{
    (void)snprintf(to, capacity, "%s", before);
    for (const struct grrl_policy_type *const *type = grrl_policies; *type != NULL; type++) {
        size_t length = strlen(to);
        (void)snprintf(to + length, capacity - length, "%s%s%s%s",
                       type == grrl_policies ? "" : between, (*type)->name, with_text ? ": " : "",
                       with_text ? (*type)->text : "");
    }
}

static const char *take_policy(void *context, const char *text)
{
    static char right[HELP_BYTES];
    const struct grrl_policy_type **policy = context;
    *policy = grrl_policy_find(text);
    list_policies("one of ", ", ", false, right, sizeof right);
    return *policy != NULL ? NULL : right;
}

static const char *take_noise(void *context, const char *text)
{
    double mm;
    bool good = grrl_option_number_of(text, &mm) && mm <= 100.0;
    float noise_m = good ? (float)mm * 0.001f : 0.0f;
    if (!(noise_m > 0.0f))
        return "millimetres, above 0 to 100";
    *(float *)context = noise_m;
    return NULL;
}

static const char *take_table(void *context, const char *text)
{
    static const char right[] = "X0,Y0,X1,Y1 in metres, X0 below X1 and Y0 below Y1, -1000 to 1000";
    char copy[HELP_BYTES];
    double value[4];
    if (strlen(text) >= sizeof copy)
        return right;
    (void)snprintf(copy, sizeof copy, "%s", text);
    char *at = copy;
    for (int i = 0; i < 4; i++) {
        char *comma = strchr(at, ',');
        if ((comma == NULL) != (i == 3))
            return right;
        if (comma != NULL)
            *comma = '\0';
        if (!grrl_option_number_of(at, &value[i]) || value[i] < -1e3 || value[i] > 1e3)
            return right;
        at = comma + 1;
    }
    struct grrl_agent_table table = {(float)value[0], (float)value[1], (float)value[2],
                                     (float)value[3]};
    if (!(table.x0_m < table.x1_m && table.y0_m < table.y1_m))
        return right;
    *(struct grrl_agent_table *)context = table;
    return NULL;
}

/* The limits of a push on the command line; 0: the default. */
struct limits {
    double force_n;
    double speed_m_s;
    double travel_m;
    double until_sure;
};

/* The timeout allows the same distance to the first contact as the default, whatever the speed. */
static void take_limits(const struct limits *limits, struct grrl_agent_options *options)
{
    struct grrl_grounding_config *push = &options->learner.grounding;
    float way_m = push->speed_m_s * push->timeout_s - push->travel_m;
    if (limits->force_n > 0.0)
        push->force_n = (float)limits->force_n;
    if (limits->speed_m_s > 0.0)
        push->speed_m_s = (float)limits->speed_m_s;
    if (limits->travel_m > 0.0)
        push->travel_m = (float)limits->travel_m;
    if (limits->speed_m_s > 0.0 || limits->travel_m > 0.0)
        push->timeout_s = (way_m + push->travel_m) / push->speed_m_s;
    options->until_sure = (float)limits->until_sure;
}

/* Adds the rows of the push options; returns how many. */
static size_t add_limits(struct limits *limits, struct grrl_agent_options *options,
                         struct grrl_option *rows)
{
    const struct grrl_option own[N_LIMITS] = {
        grrl_option_call("table", "X0,Y0,X1,Y1",
                         "refuse points and pushes outside this rectangle, metres; needed "
                         "if\npoints span more than 2 m",
                         take_table, &options->table),
        grrl_option_number("force", "N", "push with at most N newtons, 0.1 to 100 (10)", 0.1, 100.0,
                           1.0, &limits->force_n),
        grrl_option_number("speed", "V", "push at V metres per second, 0.005 to 0.5 (0.08)", 0.005,
                           0.5, 1.0, &limits->speed_m_s),
        grrl_option_number("travel", "MM",
                           "push on for MM millimetres after the first contact, 5 to 200 (30)", 5.0,
                           200.0, 0.001, &limits->travel_m),
        grrl_option_int("pushes", "N", "without a supervisor: end after N pushes (no end)", 1,
                        1000000, &options->pushes),
        grrl_option_number("until-sure", "P",
                           "without a supervisor: end when every pair of links is decided with\n"
                           "probability P, 0.5 to 0.999 (no end)",
                           0.5, 0.999, 1.0, &limits->until_sure),
    };
    memcpy(rows, own, sizeof own);
    return N_LIMITS;
}

static bool pushes_itself(const struct grrl_agent_options *options, const struct limits *limits)
{
    return options->pushes > 0 || options->table.x0_m < options->table.x1_m ||
           limits->until_sure > 0.0 || limits->force_n > 0.0 || limits->speed_m_s > 0.0 ||
           limits->travel_m > 0.0;
}

/* Builds the policy's configuration from the given parameters; RUN if they belong to the policy. */
static enum grrl_options_result configure(const struct given *given, size_t n,
                                          struct grrl_agent_options *options)
{
    static union configuration config;
    char what[HELP_BYTES];
    const struct grrl_policy_type *policy = options->policy;
    if (policy->config_default != NULL) {
        policy->config_default(config.bytes);
        options->policy_config = config.bytes;
    }
    for (size_t i = 0; i < n; i++) {
        if (given[i].is_given && given[i].policy != policy) {
            (void)snprintf(what, sizeof what, "--%s needs --policy %s", given[i].parameter->name,
                           given[i].policy->name);
            return grrl_options_wrong(&program, what);
        }
        if (given[i].is_given)
            *value_of(given[i].parameter, &config) = given[i].value;
    }
    if (options->store != NULL && policy->entries == NULL) {
        (void)snprintf(what, sizeof what, "--store: the policy %s does not learn", policy->name);
        return grrl_options_wrong(&program, what);
    }
    if (options->start != NULL && options->store == NULL)
        return grrl_options_wrong(&program, "--start needs --store, the file that it starts");
    return GRRL_OPTIONS_RUN;
}

enum grrl_options_result grrl_agent_options_parse(int argc, char **argv,
                                                  struct grrl_agent_options *options)
{
    char policies[4 * HELP_BYTES];
    struct given given[MAX_PARAMETERS];
    struct limits limits = {0.0, 0.0, 0.0, 0.0};
    struct grrl_option rows[GRRL_OPTIONS_MAX];
    memset(options, 0, sizeof *options);
    grrl_learner_config_default(&options->learner);
    options->experiences = 1000;
    options->policy = grrl_policies[0];
    list_policies("how pushes are chosen (the first)\n", "\n", true, policies, sizeof policies);
    const struct grrl_option own[] = {
        grrl_option_call("policy", "NAME", policies, take_policy, &options->policy),
        grrl_option_text("store", "FILE",
                         "load what was learned from FILE and save it there after each trial",
                         &options->store),
        grrl_option_text("start", "FILE",
                         "if there is no --store FILE yet, start with what this one holds;\n"
                         "mixed: the one that comes with grrl",
                         &options->start),
        grrl_option_u32("experiences", "N",
                        "memory for N cases or experiences, 1 to 1000000 (1000)", 1, 1000000,
                        &options->experiences),
        grrl_option_u64("seed", "N", "seed of all random choices (1)", 0, UINT64_MAX,
                        &options->learner.seed),
        grrl_option_call("noise", "MM", "standard deviation of a tracked point, millimetres (0.7)",
                         take_noise, &options->learner.perception.noise_m),
        grrl_option_flag("observe", "learn from another agent's pushes, live or from a log",
                         &options->observe),
        grrl_option_number("tracker-timeout", "S",
                           "give up after S seconds without messages (wait forever)", 0.1, 1e6, 1.0,
                           &options->tracker_timeout_s),
        grrl_option_text("lcm-url", "URL", "LCM provider; a log is file://run.lcm?speed=0",
                         &options->lcm_url),
        grrl_option_flag("quiet", "print errors only", &options->quiet),
        grrl_option_flag("explain", "print a line for each model and each decision: what and why",
                         &options->explain),
    };
    enum { OWN = sizeof own / sizeof own[0] };
    _Static_assert((int)OWN + (int)N_LIMITS + (int)MAX_PARAMETERS <= (int)GRRL_OPTIONS_MAX,
                   "all rows fit");
    memcpy(rows, own, sizeof own);
    size_t fixed = OWN + add_limits(&limits, options, rows + OWN);
    size_t n = add_parameters(given, rows + fixed);
    enum grrl_options_result result =
        grrl_options_parse(&program, rows, fixed + n, argc, argv, NULL);
    if (result == GRRL_OPTIONS_RUN && options->quiet && options->explain)
        return grrl_options_wrong(&program, "--quiet and --explain contradict each other");
    if (result == GRRL_OPTIONS_RUN && options->observe && pushes_itself(options, &limits))
        return grrl_options_wrong(&program,
                                  "--observe pushes nothing: --table, --force, --speed, --travel, "
                                  "--pushes and --until-sure go without it");
    take_limits(&limits, options);
    return result == GRRL_OPTIONS_RUN ? configure(given, n, options) : result;
}
