/* grrl-bridge: the agent's core on LCM with its learner on a controller behind a serial line. */
#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agent.h"
#include "process.h"
#include "remote_learner.h"

/* How long a socket that is not there yet is waited for. */
enum { SOCKET_MS = 5000 };

static struct grrl_agent agent; /* large, and there is one */
static struct bridge_line line;

struct run {
    const char *serial;
    const char *lcm_url;
    struct grrl_policy_type policy; /* its name alone */
    uint64_t seed;
    bool quiet;
    int32_t trials; /* that count */
    int64_t pushes; /* in them */
};

static const char help[] =
    "Usage: grrl-bridge --serial PATH [OPTION]...\n"
    "Puts a controller that runs grrl-image on LCM: takes the place of grrl-agent, and asks the\n"
    "controller for everything that is believed, chosen and learned.\n\n"
    "  --serial PATH   Unix socket (qemu-system-arm -chardev socket,path=PATH,server=on) or "
    "serial\n"
    "                  device with the controller behind it; needed\n"
    "  --policy NAME   how the controller chooses, a policy of its image (learn)\n"
    "  --seed N        seed of all random choices (1)\n"
    "  --lcm-url URL   LCM provider\n"
    "  --quiet         print errors only\n"
    "  --help          print this text\n"
    "  --version       print the version\n\n"
    "Without --lcm-url the environment variable LCM_DEFAULT_URL counts. Damaged bytes on the line\n"
    "cost time and change nothing; they are counted and shown at the end.\n"
    "Exit status: 0 all trials done or stopped by a signal; 1 trouble; 2 wrong command line.\n";

enum { OPT_SERIAL = 256, OPT_POLICY, OPT_SEED, OPT_LCM_URL, OPT_QUIET, OPT_HELP, OPT_VERSION };

static const struct option options[] = {{"serial", required_argument, NULL, OPT_SERIAL},
                                        {"policy", required_argument, NULL, OPT_POLICY},
                                        {"seed", required_argument, NULL, OPT_SEED},
                                        {"lcm-url", required_argument, NULL, OPT_LCM_URL},
                                        {"quiet", no_argument, NULL, OPT_QUIET},
                                        {"help", no_argument, NULL, OPT_HELP},
                                        {"version", no_argument, NULL, OPT_VERSION},
                                        {NULL, 0, NULL, 0}};

enum { GO_ON = -1, WRONG_USAGE = 2 };

static int wrong(const char *option, const char *text, const char *right)
{
    (void)fprintf(stderr, "grrl-bridge: --%s %s: must be %s\n", option, text, right);
    return WRONG_USAGE;
}

/* Which policies there are, the controller knows. */
static int take_policy(struct run *run, const char *text)
{
    run->policy.name = text;
    bool fits = text[0] != '\0' && strlen(text) < GRRL_POLICY_NAME_BYTES;
    return fits ? GO_ON : wrong("policy", text, "a name of 1 to 15 characters");
}

static int take_seed(struct run *run, const char *text)
{
    char *end;
    errno = 0;
    run->seed = strtoull(text, &end, 10);
    bool digits = text[0] >= '0' && text[0] <= '9';
    return digits && *end == '\0' && errno == 0 ? GO_ON : wrong("seed", text, "a number from 0");
}

static int take(struct run *run, int id)
{
    switch (id) {
    case OPT_SERIAL:
        run->serial = optarg;
        return GO_ON;
    case OPT_POLICY:
        return take_policy(run, optarg);
    case OPT_SEED:
        return take_seed(run, optarg);
    case OPT_LCM_URL:
        run->lcm_url = optarg;
        return GO_ON;
    case OPT_QUIET:
        run->quiet = true;
        return GO_ON;
    case OPT_HELP:
        (void)fputs(help, stdout);
        return EXIT_SUCCESS;
    case OPT_VERSION:
        (void)printf("grrl-bridge %s\n", GRRL_VERSION);
        return EXIT_SUCCESS;
    default:
        (void)fprintf(stderr, "Try grrl-bridge --help\n");
        return WRONG_USAGE;
    }
}

/* GO_ON, or the exit status. */
static int parse(int argc, char **argv, struct run *run)
{
    *run = (struct run){.policy = {.name = "learn"}, .seed = 1};
    int id;
    while ((id = getopt_long(argc, argv, "", options, NULL)) != -1) {
        int status = take(run, id);
        if (status != GO_ON)
            return status;
    }
    if (optind < argc) {
        (void)fprintf(stderr, "grrl-bridge: %s: there are no arguments, only options\n",
                      argv[optind]);
        return WRONG_USAGE;
    }
    if (run->serial == NULL) {
        (void)fprintf(stderr,
                      "grrl-bridge: --serial is needed, the controller's socket or device\n");
        return WRONG_USAGE;
    }
    return GO_ON;
}

static void on_event(void *context, const struct grrl_agent_event *event)
{
    static const char *const outcomes[] = {"ended", "discovered", "capped", "aborted"};
    struct run *run = context;
    if (event->kind == GRRL_AGENT_NOTE && !run->quiet)
        (void)fprintf(stderr, "grrl-bridge: %s\n", event->text);
    if (event->kind != GRRL_AGENT_TRIAL_END)
        return;
    if (event->outcome != GRRL_TRIAL_T_ABORTED) {
        run->trials++;
        run->pushes += event->pushes;
    }
    if (!run->quiet)
        (void)printf("trial %" PRId32 ": %" PRId32 " pushes, %s, %u entries\n", event->trial_id,
                     event->pushes, outcomes[event->outcome],
                     (unsigned)grrl_learner_usage(&agent.learner).n);
    (void)fflush(stdout);
}

/* Until the trials are over, a signal comes, or LCM or the line fails. */
static bool loop(const struct run *run, lcm_t *lcm)
{
    struct grrl_process_watch watch = {.program = "grrl-bridge", .quiet = run->quiet};
    while (!grrl_process_stopped() && !line.failed && !grrl_agent_finished(&agent)) {
        if (lcm_handle_timeout(lcm, GRRL_PROCESS_POLL_MS) < 0 && !grrl_process_stopped()) {
            (void)fprintf(stderr, "grrl-bridge: LCM fails to receive\n");
            return false;
        }
        grrl_agent_tick(&agent);
        if (!grrl_process_attended(&watch, &agent))
            return false;
    }
    return !line.failed;
}

static void report(const struct run *run, const struct bridge_result *result)
{
    const struct bridge_line_counts *counts = &line.counts;
    (void)printf("%" PRId32 " trials, %.2f pushes on average\n", run->trials,
                 run->trials > 0 ? (double)run->pushes / run->trials : 0.0);
    (void)printf("line: %" PRIu64 " requests, %" PRIu64 " bytes out, %" PRIu64
                 " in; damaged frames: %" PRIu32 " out, %" PRIu32 " in; %" PRIu32
                 " requests sent again, %" PRIu32 " answers too many\n",
                 counts->requests, counts->bytes_out, counts->bytes_in, counts->damaged_out,
                 counts->damaged_in, counts->resent, counts->late);
    (void)printf("models %016" PRIx64 "\ndecisions %016" PRIx64 "\nupdates %016" PRIx64
                 "\nstore %016" PRIx64 "\n",
                 result->models, result->decisions, result->updates, result->store);
}

static bool run_bridge(struct run *run, lcm_t *lcm)
{
    struct grrl_agent_config config = {
        .session_id = grrl_process_random_session(),
        .now_us = grrl_process_now_us,
        .on_event = on_event,
        .context = run,
    };
    config.learner.seed = run->seed;
    config.policy.type = &run->policy;
    if (!bridge_line_open(&line, run->serial, SOCKET_MS))
        return false;
    bridge_learner_use(&line);
    enum grrl_status status = grrl_agent_init(&agent, &config, lcm);
    if (status != GRRL_OK) {
        if (!line.failed)
            (void)fprintf(stderr, "grrl-bridge: %s\n", grrl_status_text(status));
        return false;
    }
    bool fine = loop(run, lcm);
    grrl_agent_close(&agent);
    struct bridge_result result;
    fine = fine && bridge_learner_close(&result);
    if (fine && !run->quiet)
        report(run, &result);
    return fine;
}

int main(int argc, char **argv)
{
    struct run run;
    int usage = parse(argc, argv, &run);
    if (usage != GO_ON)
        return usage;
    grrl_process_catch_signals();
    (void)signal(SIGPIPE, SIG_IGN); /* a controller that is gone is an error of write */
    lcm_t *lcm = grrl_process_open_lcm("grrl-bridge", run.lcm_url);
    if (lcm == NULL)
        return EXIT_FAILURE;
    bool fine = run_bridge(&run, lcm);
    if (line.failed)
        (void)fprintf(stderr, "grrl-bridge: %s\n", line.why);
    bridge_line_close(&line);
    lcm_destroy(lcm);
    return fine ? EXIT_SUCCESS : EXIT_FAILURE;
}
