/* process.h: what a process around the agent's core needs: LCM, a clock, a session, signals. */
#ifndef GRRL_AGENT_PROCESS_H
#define GRRL_AGENT_PROCESS_H

#include <stdbool.h>
#include <stdint.h>

#include <lcm/lcm.h>

/* How long one lcm_handle_timeout waits; grrl_agent_tick needs 100 ms. */
enum { GRRL_PROCESS_POLL_MS = 50 };

/* NULL after a message on stderr that begins with the program's name. */
lcm_t *grrl_process_open_lcm(const char *program, const char *url);

/* Wall clock, as grrl_agent_config wants it. */
int64_t grrl_process_now_us(void *context);

/* Random, above 0. */
int64_t grrl_process_random_session(void);

/* From then on SIGINT and SIGTERM end the program by grrl_process_stopped. */
void grrl_process_catch_signals(void);
bool grrl_process_stopped(void);

#endif
