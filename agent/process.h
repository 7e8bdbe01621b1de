/* process.h: what a process around the agent's core needs: LCM, a clock, a session, signals, and to
 * notice that nobody is there. */
#ifndef GRRL_AGENT_PROCESS_H
#define GRRL_AGENT_PROCESS_H

#include <stdbool.h>
#include <stdint.h>

#include "agent.h"

/* How long one lcm_handle_timeout waits; grrl_agent_tick needs 100 ms. */
enum { GRRL_PROCESS_POLL_MS = 50 };

/* NULL after a message on stderr that begins with the program's name. A log is looked through first
 * (log_check.h). url: NULL is LCM_DEFAULT_URL, or LCM's own default. */
lcm_t *grrl_process_open_lcm(const char *program, const char *url);

/* Whether LCM will read a log and no network. */
bool grrl_process_is_log(const char *url);

/* As grrl_agent_config wants it: the time of day at the start, and what has passed since, so that a
 * clock that is set meanwhile does not change what is due. */
int64_t grrl_process_now_us(void *context);

/* Random, above 0. */
int64_t grrl_process_random_session(void);

/* From then on SIGINT and SIGTERM end the program by grrl_process_stopped. */
void grrl_process_catch_signals(void);
bool grrl_process_stopped(void);

/* What grrl_process_attended remembers. */
struct grrl_process_watch {
    const char *program;
    double timeout_s; /* silence after which to give up; 0: never */
    bool quiet;       /* no hints while waiting */
    /* private */
    int64_t hinted_us;
};

/* Whether to go on: not after GRRL_STOP, not without end when the simulator or tracker is gone, nor
 * beside an agent that moves the same robot. Says so on stderr, and every 5 s what it waits for. */
bool grrl_process_attended(struct grrl_process_watch *watch, struct grrl_agent *agent);

#endif
