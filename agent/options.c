/* options.c: the table of grrl-agent's options. */
#include "options.h"

#include <string.h>

static const struct grrl_program program = {
    .name = "grrl-agent",
    .usage = "grrl-agent [OPTION]...",
    .intro = "Learns to find out how articulated objects move by pushing them.\n"
             "Waits for feature points on LCM; grrl-sim sends some.\n",
    .outro = "Without --lcm-url the environment variable LCM_DEFAULT_URL counts.\n"
             "Exit status: 0 all trials done, log read or stopped by a signal; 1 trouble;\n"
             "2 wrong command line.\n",
};

/* A parameter of the policy; the library knows which values are in its range. */
struct parameter {
    struct grrl_policy_config *policy;
    float *value;
    const char *right;
};

static const char *take_parameter(void *context, const char *text)
{
    const struct parameter *parameter = context;
    const char *field = "";
    double value;
    if (!grrl_option_number_of(text, &value))
        return parameter->right;
    *parameter->value = (float)value;
    return grrl_policy_config_check(parameter->policy, &field) == GRRL_OK ? NULL : parameter->right;
}

static const char *take_policy(void *context, const char *text)
{
    static const struct {
        const char *name;
        enum grrl_policy_kind kind;
    } names[] = {
        {"learn", GRRL_POLICY_LEARN}, {"paper", GRRL_POLICY_PAPER}, {"random", GRRL_POLICY_RANDOM}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(text, names[i].name) == 0) {
            *(enum grrl_policy_kind *)context = names[i].kind;
            return NULL;
        }
    }
    return "learn, paper or random";
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

enum grrl_options_result grrl_agent_options_parse(int argc, char **argv,
                                                  struct grrl_agent_options *options)
{
    memset(options, 0, sizeof *options);
    grrl_learner_config_default(&options->learner);
    options->learner.seed = 1;
    options->experiences = 1000;
    struct grrl_policy_config *policy = &options->learner.policy;
    struct parameter alpha = {policy, &policy->alpha, "a number above 0 to 1"};
    struct parameter gamma = {policy, &policy->gamma, "a number from 0 to below 1"};
    struct parameter beta = {policy, &policy->beta, "a number from 0 to 1000"};
    struct parameter z = {policy, &policy->z, "a number from 0 to 1000"};
    const struct grrl_option rows[] = {
        grrl_option_call("policy", "NAME", "how pushes are chosen: learn, paper or random (learn)",
                         take_policy, &policy->kind),
        grrl_option_text("store", "FILE",
                         "load experiences from FILE and save them there after each trial",
                         &options->store),
        grrl_option_u32("experiences", "N", "memory for N experiences, 1 to 1000000 (1000)", 1,
                        1000000, &options->experiences),
        grrl_option_u64("seed", "N", "seed of all random choices (1)", 0, UINT64_MAX,
                        &options->learner.seed),
        grrl_option_call("alpha", "X", "paper: learning rate, above 0 to 1 (0.3)", take_parameter,
                         &alpha),
        grrl_option_call("gamma", "X", "paper: discount of later rewards, 0 to below 1 (0.1)",
                         take_parameter, &gamma),
        grrl_option_call("beta", "X", "paper: a new action has probability exp(-beta phi) (2)",
                         take_parameter, &beta),
        grrl_option_call("z", "X", "paper: width of the bounds of Interval Estimation (0.25)",
                         take_parameter, &z),
        grrl_option_call("noise", "MM", "standard deviation of a tracked point, millimetres (0.7)",
                         take_noise, &options->learner.perception.noise_m),
        grrl_option_flag("observe", "learn from another agent's pushes, live or from a log",
                         &options->observe),
        grrl_option_number("tracker-timeout", "S",
                           "give up when nothing is heard for S seconds (wait for ever)", 0.1, 1e6,
                           1.0, &options->tracker_timeout_s),
        grrl_option_text("lcm-url", "URL", "LCM provider; a log is file://run.lcm?speed=0",
                         &options->lcm_url),
        grrl_option_flag("quiet", "print errors only", &options->quiet),
        grrl_option_flag("explain", "print a line for each decision: what and why",
                         &options->explain),
    };
    enum grrl_options_result result =
        grrl_options_parse(&program, rows, sizeof rows / sizeof rows[0], argc, argv, NULL);
    if (result == GRRL_OPTIONS_RUN && options->quiet && options->explain)
        return grrl_options_wrong(&program, "--quiet and --explain contradict each other");
    return result;
}
