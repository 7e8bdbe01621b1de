/* grrl-agent: options, files, signals and lines on the terminal around the agent's core. */
#define _POSIX_C_SOURCE 200809L

#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "agent.h"
#include "log_check.h"
#include "options.h"
#include "store_file.h"

/* How long one lcm_handle_timeout waits; the tick needs 100 ms. */
enum { POLL_MS = 50 };

enum { HINT_PERIOD_US = 5000000 };

static volatile sig_atomic_t stop;

static struct grrl_agent agent; /* large, and there is one */

struct run {
    struct grrl_agent_options options;
    bool failed;
    int32_t trials; /* that count */
    int64_t pushes; /* in them */
};

static void on_signal(int number)
{
    (void)number;
    stop = 1;
}

static int64_t read_clock_us(clockid_t clock)
{
    struct timespec now;
    (void)clock_gettime(clock, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

/* The time of day at the start, and what has passed since: a clock that is set meanwhile must not
 * change what is due. */
static int64_t now_us(void *context)
{
    static int64_t offset_us;
    (void)context;
    if (offset_us == 0)
        offset_us = read_clock_us(CLOCK_REALTIME) - read_clock_us(CLOCK_MONOTONIC);
    return read_clock_us(CLOCK_MONOTONIC) + offset_us;
}

static int64_t random_session(void)
{
    int64_t session = 0;
    int fd = open("/dev/urandom", O_RDONLY | O_CLOEXEC);
    if (fd >= 0) {
        if (read(fd, &session, sizeof session) != (ssize_t)sizeof session)
            session = 0;
        (void)close(fd);
    }
    session ^= now_us(NULL) ^ (int64_t)getpid() << 32;
    session &= INT64_MAX;
    return session != 0 ? session : 1;
}

static void save(struct run *run)
{
    struct grrl_store_report report;
    if (run->options.store == NULL ||
        grrl_store_file_save(&grrl_file_calls_posix, run->options.store, &agent.learner, &report))
        return;
    (void)fprintf(stderr, "grrl-agent: cannot save the experiences: %s\n", report.text);
    run->failed = true;
}

static void explain(const grrl_decision_t *decision)
{
    static const char *const reasons[] = {"at random", "new action", "best bound", "adopted"};
    static const char *const levels[] = {"same structure", "same structure, properties dropped",
                                         "sub-structure", "similar actions"};
    (void)printf("trial %" PRId32 " push %" PRId32 ": f%d at %d deg, %s", decision->trial_id,
                 decision->cmd_seq, decision->link_number, decision->direction_deg,
                 reasons[decision->reason]);
    if (decision->experience >= 0)
        (void)printf(" %.2f (%.2f to %.2f) from %s, closest %" PRId32 " at distance %d",
                     (double)decision->value, (double)decision->lower, (double)decision->upper,
                     levels[decision->level], decision->experience, decision->distance);
    (void)printf("; phi %.2f, last reward %g\n", (double)decision->phi,
                 (double)decision->last_reward);
}

static void end_of_trial(struct run *run, const struct grrl_agent_event *event)
{
    static const char *const outcomes[] = {"ended", "discovered", "capped", "aborted"};
    if (event->outcome != GRRL_TRIAL_T_ABORTED) {
        run->trials++;
        run->pushes += event->pushes;
    }
    if (!run->options.quiet)
        (void)printf("trial %" PRId32 ": %" PRId32 " pushes, %s, %u experiences\n", event->trial_id,
                     event->pushes, outcomes[event->outcome],
                     (unsigned)grrl_learner_usage(&agent.learner).n);
    save(run);
}

static void on_event(void *context, const struct grrl_agent_event *event)
{
    struct run *run = context;
    switch (event->kind) {
    case GRRL_AGENT_NOTE:
        if (!run->options.quiet)
            (void)fprintf(stderr, "grrl-agent: %s\n", event->text);
        break;
    case GRRL_AGENT_DECIDED:
        if (run->options.explain)
            explain(event->decision);
        break;
    case GRRL_AGENT_LEARNED:
        if (event->trial_id == 0) /* without a supervisor there is no end of a trial to save at */
            save(run);
        break;
    case GRRL_AGENT_TRIAL_END:
        end_of_trial(run, event);
        break;
    }
    (void)fflush(stdout);
}

/* The URL that LCM will use; NULL: its own default. */
static const char *used_url(const char *url)
{
    return url != NULL ? url : getenv("LCM_DEFAULT_URL");
}

static bool is_log(const char *url)
{
    char path[1];
    return url != NULL && grrl_log_path(url, sizeof path, path);
}

static lcm_t *open_lcm(const char *url)
{
    char path[4096];
    struct grrl_log_why why;
    const char *used = used_url(url);
    if (used != NULL && grrl_log_path(used, sizeof path, path) && !grrl_log_check(path, &why)) {
        (void)fprintf(stderr, "grrl-agent: %s\n", why.text);
        return NULL;
    }
    lcm_t *lcm = lcm_create(url);
    if (lcm != NULL && lcm_get_fileno(lcm) >= 0)
        return lcm;
    (void)fprintf(stderr, "grrl-agent: LCM does not start. If this machine has no network:\n"
                          "  ip link set lo up; ip route add 224.0.0.0/4 dev lo\n"
                          "or name another provider with --lcm-url.\n");
    if (lcm != NULL)
        lcm_destroy(lcm);
    return NULL;
}

static void catch_signals(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
}

/* Whether to go on: not without end when the simulator or tracker is gone, nor beside an agent that
 * moves the same robot. */
static bool attended(const struct run *run, int64_t *hinted_us)
{
    int64_t silence_us = grrl_agent_silence_us(&agent);
    double timeout_s = run->options.tracker_timeout_s;
    if (grrl_agent_gave_way(&agent)) {
        (void)fprintf(stderr, "grrl-agent: the robot moves for another agent: stop one of the two, "
                              "then start this one again\n");
        return false;
    }
    if (timeout_s > 0.0 && (double)silence_us >= timeout_s * 1e6) {
        (void)fprintf(stderr, "grrl-agent: no simulator or tracker for %g s, giving up\n",
                      timeout_s);
        return false;
    }
    if (silence_us < HINT_PERIOD_US)
        *hinted_us = 0;
    if (silence_us - *hinted_us >= HINT_PERIOD_US) {
        *hinted_us = silence_us;
        if (!run->options.quiet)
            (void)fprintf(stderr, "grrl-agent: waiting for points on the same LCM provider: start "
                                  "grrl-sim or your tracker\n");
    }
    return true;
}

/* Until the trials are over, the log ends, a signal comes or LCM fails. */
static void loop(struct run *run, lcm_t *lcm)
{
    int64_t hinted_us = 0;
    bool from_log = is_log(used_url(run->options.lcm_url));
    while (!stop && !run->failed && !grrl_agent_finished(&agent)) {
        if (lcm_handle_timeout(lcm, POLL_MS) < 0 && !stop) {
            if (!from_log) {
                (void)fprintf(stderr, "grrl-agent: LCM fails to receive\n");
                run->failed = true;
            }
            break;
        }
        grrl_agent_tick(&agent);
        if (!from_log && !attended(run, &hinted_us))
            run->failed = true;
    }
}

static bool start(struct run *run, struct grrl_agent_config *config, lcm_t *lcm)
{
    struct grrl_store_report report;
    enum grrl_status status = grrl_agent_init(&agent, config, lcm);
    if (status != GRRL_OK) {
        (void)fprintf(stderr, "grrl-agent: %s\n", grrl_status_text(status));
        return false;
    }
    if (run->options.store == NULL)
        return true;
    enum grrl_store_result result =
        grrl_store_file_load(&grrl_file_calls_posix, run->options.store, &agent.learner, &report);
    if (result != GRRL_STORE_LOADED) /* --quiet does not silence what was lost */
        (void)fprintf(stderr, "grrl-agent: %s\n", report.text);
    if (result == GRRL_STORE_REFUSED)
        return false;
    save(run); /* the same again: where it cannot be written, that shows before anything is learned
                */
    return !run->failed;
}

static int run_agent(struct run *run)
{
    struct grrl_agent_config config = {
        .learner = run->options.learner,
        .session_id = random_session(),
        .observe = run->options.observe,
        .now_us = now_us,
        .on_event = on_event,
        .context = run,
        .memory = {.cases_capacity = run->options.experiences,
                   .states_capacity = run->options.experiences,
                   .experiences_capacity = run->options.experiences},
    };
    struct grrl_learner_memory *memory = &config.memory;
    memory->cases = calloc(memory->cases_capacity, sizeof *memory->cases);
    memory->states = calloc(memory->states_capacity, sizeof *memory->states);
    memory->experiences = calloc(memory->experiences_capacity, sizeof *memory->experiences);
    lcm_t *lcm = NULL;
    bool started = false;
    if (memory->cases != NULL && memory->states != NULL && memory->experiences != NULL)
        lcm = open_lcm(run->options.lcm_url);
    if (lcm != NULL)
        started = start(run, &config, lcm);
    if (started) {
        loop(run, lcm);
        grrl_agent_close(&agent);
        save(run);
    }
    if (lcm != NULL)
        lcm_destroy(lcm);
    free(memory->cases);
    free(memory->states);
    free(memory->experiences);
    return started && !run->failed ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    static struct run run;
    switch (grrl_agent_options_parse(argc, argv, &run.options)) {
    case GRRL_OPTIONS_DONE:
        return EXIT_SUCCESS;
    case GRRL_OPTIONS_BAD:
        return 2;
    case GRRL_OPTIONS_RUN:
        break;
    }
    catch_signals();
    int status = run_agent(&run);
    if (run.trials > 0 && !run.options.quiet)
        (void)printf("%" PRId32 " trials, %.2f pushes on average\n", run.trials,
                     (double)run.pushes / run.trials);
    return status;
}
