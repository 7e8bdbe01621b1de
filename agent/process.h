/* process.h: what a process around the agent's core needs: LCM, a clock, a session, signals, and
 * the detection of silence. */
#ifndef GRRL_AGENT_PROCESS_H
#define GRRL_AGENT_PROCESS_H

#include <stdbool.h>
#include <stdint.h>

#include "agent.h"

/* How long one lcm_handle_timeout waits; grrl_agent_tick needs 100 ms. */
enum { GRRL_PROCESS_POLL_MS = 50 };

/* NULL after a message on stderr that begins with the program's name. A log is checked first
 * (log_check.h). url NULL: LCM_DEFAULT_URL, or LCM's own default. */
lcm_t *grrl_process_open_lcm(const char *program, const char *url);

/* Whether LCM will read a log instead of a network. */
bool grrl_process_is_log(const char *url);

/* The clock for grrl_agent_config: the time of day at the start plus the time since. Setting the
 * clock meanwhile must not change what is due. */
int64_t grrl_process_now_us(void *context);

/* Random, above 0. */
int64_t grrl_process_random_session(void);

/* From then on SIGINT and SIGTERM make grrl_process_stopped true. */
void grrl_process_catch_signals(void);
bool grrl_process_stopped(void);

/* The state of grrl_process_attended. */
struct grrl_process_watch {
    const char *program;
    double timeout_s; /* silence after which to give up; 0: never */
    bool quiet;       /* no hints while waiting */
    /* private */
    int64_t hinted_us;
};

/* Whether to continue: not after GRRL_STOP, not after the timeout without a simulator or tracker,
 * and not if another agent moves the same robot. Says so on stderr, and every 5 s what it is
 * waiting for. */
bool grrl_process_attended(struct grrl_process_watch *watch, struct grrl_agent *agent);

#endif
