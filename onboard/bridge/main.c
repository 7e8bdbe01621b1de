/* grrl-bridge: the agent's core on LCM, with its learner on a controller behind a serial line. */
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agent.h"
#include "cli/options.h"
#include "process.h"
#include "remote_learner.h"

/* How long to wait for a socket that does not exist yet. */
enum { SOCKET_MS = 5000 };

static struct grrl_agent agent; /* too large for the stack */
static struct bridge_line line;

struct run {
    const char *serial;
    const char *lcm_url;
    struct grrl_policy_type policy; /* only the name is set */
    uint64_t seed;
    bool quiet;
    int32_t trials; /* completed, not aborted */
    int64_t pushes; /* in these trials */
};

static const struct grrl_program program = {
    .name = "grrl-bridge",
    .usage = "grrl-bridge --serial PATH [OPTION]...",
    .intro = "Connects a controller that runs grrl-image to LCM, in place of grrl-agent. The "
             "controller\n"
             "does all perception, choosing and learning.\n",
    .outro =
        "Without --lcm-url it uses the environment variable LCM_DEFAULT_URL. Damaged bytes on the "
        "line\ncost time but do not change results; they are counted and shown at the end.\n"
        "Exit status: 0 all trials done or stopped by a signal; 1 failure; 2 wrong command line.\n",
};

/* Only the controller knows its policies, so only the length is checked. */
static const char *take_policy(void *context, const char *text)
{
    ((struct grrl_policy_type *)context)->name = text;
    bool fits = text[0] != '\0' && strlen(text) < GRRL_POLICY_NAME_BYTES;
    return fits ? NULL : "a name of 1 to 15 characters";
}

static enum grrl_options_result parse(int argc, char **argv, struct run *run)
{
    *run = (struct run){.policy = {.name = "learn"}, .seed = 1};
    const struct grrl_option rows[] = {
        grrl_option_text(
            "serial", "PATH",
            "Unix socket (qemu-system-arm -chardev socket,path=PATH,server=on) or serial\n"
            "device of the controller; required",
            &run->serial),
        grrl_option_call("policy", "NAME", "a policy in the controller's image (learn)",
                         take_policy, &run->policy),
        grrl_option_u64("seed", "N", "seed of all random choices (1)", 0, UINT64_MAX, &run->seed),
        grrl_option_text("lcm-url", "URL", "LCM provider", &run->lcm_url),
        grrl_option_flag("quiet", "print errors only", &run->quiet),
    };
    enum grrl_options_result result =
        grrl_options_parse(&program, rows, sizeof rows / sizeof rows[0], argc, argv, NULL);
    if (result == GRRL_OPTIONS_RUN && run->serial == NULL)
        return grrl_options_wrong(&program,
                                  "--serial is required: the controller's socket or device");
    return result;
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

/* Runs until the trials are over, a signal arrives, or LCM or the line fails. */
static bool loop(const struct run *run, lcm_t *lcm)
{
    struct grrl_process_watch watch = {.program = "grrl-bridge", .quiet = run->quiet};
    while (!grrl_process_stopped() && !line.failed && !grrl_agent_finished(&agent)) {
        if (lcm_handle_timeout(lcm, GRRL_PROCESS_POLL_MS) < 0 && !grrl_process_stopped()) {
            (void)fprintf(stderr, "grrl-bridge: LCM failed to receive\n");
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
                 " requests resent, %" PRIu32 " surplus answers\n",
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
    enum grrl_options_result parsed = parse(argc, argv, &run);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    grrl_process_catch_signals();
    (void)signal(SIGPIPE, SIG_IGN); /* a closed connection is an error of write */
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
