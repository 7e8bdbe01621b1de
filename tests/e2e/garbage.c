/* garbage URL SECONDS: random bytes on every channel, half of them behind a right fingerprint. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "grrl/base/random.h"
#include "wire.h"

enum { PAUSE_NS = 500000, MOST_BYTES = 600 };

static const struct {
    const char *channel;
    int64_t (*fingerprint)(void);
} targets[] = {
    {GRRL_CHANNEL_POINTS, __grrl_points_t_get_hash},
    {GRRL_CHANNEL_PUSH_COMMAND, __grrl_push_command_t_get_hash},
    {GRRL_CHANNEL_PUSH_STATUS, __grrl_push_status_t_get_hash},
    {GRRL_CHANNEL_TRIAL, __grrl_trial_t_get_hash},
    {GRRL_CHANNEL_MODEL, __grrl_model_t_get_hash},
    {GRRL_CHANNEL_DECISION, __grrl_decision_t_get_hash},
    {GRRL_CHANNEL_AGENT_STATUS, __grrl_agent_status_t_get_hash},
};

enum { N_TARGETS = sizeof targets / sizeof targets[0] };

static void send_one(lcm_t *lcm, struct grrl_random *random)
{
    uint8_t bytes[MOST_BYTES];
    uint32_t size = grrl_random_below(random, MOST_BYTES);
    uint32_t target = grrl_random_below(random, N_TARGETS);
    for (uint32_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)grrl_random_next(random);
    uint64_t fingerprint = (uint64_t)targets[target].fingerprint();
    if (grrl_random_below(random, 2) == 0)
        for (uint32_t i = 0; i < 8 && i < size; i++)
            bytes[i] = (uint8_t)(fingerprint >> (56 - 8 * i));
    (void)lcm_publish(lcm, targets[target].channel, bytes, size);
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    lcm_t *lcm = lcm_create(argv[1]);
    if (lcm == NULL)
        return 1;
    struct grrl_random random;
    grrl_random_init(&random, 1, 1);
    const struct timespec pause = {0, PAUSE_NS};
    const time_t end = time(NULL) + atoi(argv[2]);
    while (time(NULL) < end) {
        send_one(lcm, &random);
        (void)nanosleep(&pause, NULL);
    }
    lcm_destroy(lcm);
    return 0;
}
