/* grrl-agent: options, files and terminal output around the agent's core. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agent.h"
#include "found.h"
#include "options.h"
#include "process.h"
#include "shipped_store.h"
#include "store_file.h"

static struct grrl_agent agent; /* large, and there is only one */

/* Beyond EXIT_FAILURE and the 2 of a wrong command line. */
enum { EXIT_STOPPED = 3 };

enum { PATH_BYTES = 4096 };

struct run {
    struct grrl_agent_options options;
    struct grrl_found found;
    bool failed;
    int32_t trials; /* not counting aborted ones */
    int64_t pushes; /* in these trials */
};

static void save(struct run *run)
{
    struct grrl_store_report report;
    if (run->options.store == NULL ||
        grrl_store_file_save(&grrl_file_calls_posix, run->options.store, &agent.learner, &report))
        return;
    (void)fprintf(stderr, "grrl-agent: cannot save what was learned: %s\n", report.text);
    run->failed = true;
}

static void explain(const grrl_decision_t *decision)
{
    static const char *const reasons[] = {"at random", "new action", "best bound", "adopted",
                                          "by rule"};
    static const char *const sources[] = {"nothing", "the same structure",
                                          "the same structure, properties dropped",
                                          "a sub-structure", "all cases"};
    (void)printf("trial %" PRId32 " push %" PRId32 ": f%d at %d deg, %s", decision->trial_id,
                 decision->cmd_seq, decision->link_number, decision->direction_deg,
                 reasons[decision->reason]);
    if (decision->source != GRRL_DECISION_T_NONE)
        (void)printf(" %.2f (%.2f to %.2f) from %s, closest %" PRId32 " at distance %d",
                     (double)decision->value, (double)decision->lower, (double)decision->upper,
                     sources[decision->source], decision->source_index, decision->distance);
    (void)printf("; phi %.2f, last reward %g\n", (double)decision->phi,
                 (double)decision->last_reward);
}

static void end_of_trial(struct run *run, const struct grrl_agent_event *event)
{
    if (event->trial_id == 0) { /* nobody judged; the end of the run reports how it ended */
        save(run);
        return;
    }
    static const char *const outcomes[] = {"ended", "discovered", "capped", "aborted"};
    if (event->outcome != GRRL_TRIAL_T_ABORTED) {
        run->trials++;
        run->pushes += event->pushes;
    }
    const char *entries = run->options.policy->entries;
    if (!run->options.quiet && entries != NULL)
        (void)printf("trial %" PRId32 ": %" PRId32 " pushes, %s, %" PRIu32 " %s\n", event->trial_id,
                     event->pushes, outcomes[event->outcome], grrl_learner_usage(&agent.learner).n,
                     entries);
    else if (!run->options.quiet)
        (void)printf("trial %" PRId32 ": %" PRId32 " pushes, %s\n", event->trial_id, event->pushes,
                     outcomes[event->outcome]);
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
    case GRRL_AGENT_PERCEIVED:
        if (run->options.explain || event->trial_id == 0)
            grrl_found_take(&run->found, &agent, event);
        if (run->options.explain)
            grrl_found_print_line(&run->found);
        break;
    case GRRL_AGENT_DECIDED:
        if (run->options.explain)
            explain(event->decision);
        break;
    case GRRL_AGENT_LEARNED:
        if (event->trial_id == 0) /* without a supervisor, no trial ends at which to save */
            save(run);
        break;
    case GRRL_AGENT_TRIAL_END:
        end_of_trial(run, event);
        break;
    }
    (void)fflush(stdout);
}

/* Runs until the trials are over, the log ends, a signal arrives or LCM fails. */
static void loop(struct run *run, lcm_t *lcm)
{
    struct grrl_process_watch watch = {.program = "grrl-agent",
                                       .timeout_s = run->options.tracker_timeout_s,
                                       .quiet = run->options.quiet};
    bool from_log = grrl_process_is_log(run->options.lcm_url);
    while (!grrl_process_stopped() && !run->failed && !grrl_agent_finished(&agent)) {
        if (lcm_handle_timeout(lcm, GRRL_PROCESS_POLL_MS) < 0 && !grrl_process_stopped()) {
            if (!from_log) {
                (void)fprintf(stderr, "grrl-agent: LCM failed to receive\n");
                run->failed = true;
            }
            break;
        }
        grrl_agent_tick(&agent);
        if (!from_log && !grrl_process_attended(&watch, &agent))
            run->failed = true;
    }
}

/* Fills in a new store from the one it starts with. */
static bool start_store(const struct run *run)
{
    char path[PATH_BYTES];
    struct grrl_store_report report;
    grrl_shipped_store_path(run->options.start, sizeof path, path);
    if (!grrl_store_file_copy(&grrl_file_calls_posix, path, &agent.learner, &report)) {
        (void)fprintf(stderr, "grrl-agent: --start: %s\n", report.text);
        return false;
    }
    if (!run->options.quiet)
        (void)printf("%s is new: it starts with %" PRIu32 " %s of %s\n", run->options.store,
                     grrl_learner_usage(&agent.learner).n, run->options.policy->entries, path);
    return true;
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
    if (report.text[0] != '\0') /* --quiet does not silence losses */
        (void)fprintf(stderr, "grrl-agent: %s\n", report.text);
    if (result == GRRL_STORE_REFUSED ||
        (result == GRRL_STORE_NEW && run->options.start != NULL && !start_store(run)))
        return false;
    save(run); /* shows before learning whether the file can be written */
    return !run->failed;
}

/* Reports the result of the run, and the mistakes of the tracker and the robot. */
static void tell_end(struct run *run)
{
    const double wanted = (double)run->options.until_sure;
    enum grrl_agent_end end = grrl_agent_end(&agent);
    bool unsure = end == GRRL_AGENT_PUSHES_DONE && wanted > 0.0;
    if (unsure) /* the request was not met */
        (void)fprintf(stderr,
                      "grrl-agent: not sure after %" PRId32 " pushes: a pair of links is decided "
                      "with probability %.3f, --until-sure %g\n",
                      run->found.pushes, (double)run->found.sure, wanted);
    run->failed = run->failed || unsure;
    if (run->options.quiet)
        return;
    if (end == GRRL_AGENT_SURE)
        (void)printf("sure: every pair of links is decided with a probability of at least %.3f\n",
                     (double)run->found.sure);
    if (run->found.trial_id == 0)
        grrl_found_print(&run->found);
    for (int i = 0; i < GRRL_AGENT_MISTAKES; i++) {
        int64_t n = grrl_agent_mistakes(&agent, (enum grrl_agent_mistake)i);
        if (n > 0)
            (void)fprintf(stderr, "grrl-agent: in all %" PRId64 " %s\n", n,
                          grrl_agent_mistake_text((enum grrl_agent_mistake)i));
    }
}

static int run_agent(struct run *run)
{
    const struct grrl_policy_type *type = run->options.policy;
    struct grrl_agent_config config = {
        .learner = run->options.learner,
        .session_id = grrl_process_random_session(),
        .observe = run->options.observe,
        .table = run->options.table,
        .max_pushes = run->options.pushes,
        .until_sure = run->options.until_sure,
        .pair = grrl_perception_pair,
        .ground = grrl_grounding_push,
        .now_us = grrl_process_now_us,
        .on_event = on_event,
        .context = run,
    };
    size_t bytes = type->bytes(run->options.experiences);
    void *memory = calloc(1, bytes + 1);
    if (memory == NULL || grrl_policy_make(type, memory, bytes, run->options.experiences,
                                           run->options.policy_config, &config.policy) != GRRL_OK) {
        (void)fprintf(stderr, "grrl-agent: not enough memory for %" PRIu32 " %s\n",
                      run->options.experiences, type->entries);
        free(memory);
        return EXIT_FAILURE;
    }
    lcm_t *lcm = grrl_process_open_lcm("grrl-agent", run->options.lcm_url);
    bool started = lcm != NULL && start(run, &config, lcm);
    if (started) {
        loop(run, lcm);
        grrl_agent_close(&agent);
        save(run);
        tell_end(run);
    }
    if (lcm != NULL)
        lcm_destroy(lcm);
    free(memory);
    if (started && grrl_agent_end(&agent) == GRRL_AGENT_STOPPED)
        return EXIT_STOPPED;
    return started && !run->failed ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    static struct run run;
    enum grrl_options_result parsed = grrl_agent_options_parse(argc, argv, &run.options);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    grrl_process_catch_signals();
    int status = run_agent(&run);
    if (run.trials > 0 && !run.options.quiet)
        (void)printf("%" PRId32 " trials, %.2f pushes on average\n", run.trials,
                     (double)run.pushes / run.trials);
    return status;
}
