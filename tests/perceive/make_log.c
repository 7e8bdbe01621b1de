/* Writes an LCM log: make_log FILE KIND. Two trials of a hinge that opens while the phase says
 * PUSHING, frames repeated as in lock-step. KIND `damaged` cuts some messages short, `empty` has
 * another channel only, `mixed` has messages of another session, in which nothing moves, after
 * every third one, `restarted` has that session first; `ended` tells that the first trial has
 * ended, and of the second that it runs. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <lcm/lcm.h>

#include "wire.h"

enum { PER_LINK = 12, FRAMES = 60, REST = 10 };

static struct grrl_wire_points points;

static void place(int frame)
{
    float turn = frame < REST ? 0.0f : 0.7f * (float)(frame - REST) / (float)(FRAMES - REST);
    for (int i = 0; i < 2 * PER_LINK; i++) {
        float u = 0.13f * ((float)(i % PER_LINK) + 0.5f) / (float)PER_LINK;
        float v = 0.008f * (float)(i * 7 % 5 - 2);
        float a = i < PER_LINK ? 3.1416f - turn : 0.4f * turn;
        points.id[i] = i;
        points.x[i] = u * cosf(a) - v * sinf(a);
        points.y[i] = u * sinf(a) + v * cosf(a);
    }
}

static int write_event(lcm_eventlog_t *log, const char *channel, void *data, int size)
{
    char name[64];
    (void)snprintf(name, sizeof name, "%s", channel);
    lcm_eventlog_event_t event = {.timestamp = points.message.utime,
                                  .channellen = (int32_t)strlen(name),
                                  .datalen = size,
                                  .channel = name,
                                  .data = data};
    return lcm_eventlog_write_event(log, &event);
}

static int write_frame(lcm_eventlog_t *log, const char *kind, int trial, int frame)
{
    uint8_t data[GRRL_WIRE_MAX_BYTES];
    struct grrl_wire_why why;
    place(trial == 1 ? 0 : frame); /* in the first trial nothing moves */
    points.message.seq++;
    points.message.utime += 33333;
    points.message.trial_id = trial;
    points.message.phase = frame < REST ? GRRL_POINTS_T_SETTLED : GRRL_POINTS_T_PUSHING;
    points.message.n_points = 2 * PER_LINK;
    int size = grrl_wire_encode_points(&points.message, sizeof data, data, &why);
    if (size < 0) {
        (void)fprintf(stderr, "make_log: %s\n", why.text);
        return -1;
    }
    if (strcmp(kind, "damaged") == 0 && frame % 7 == 3)
        size -= 5;
    const char *channel = strcmp(kind, "empty") == 0 ? "SOMETHING_ELSE" : GRRL_CHANNEL_POINTS;
    int status = write_event(log, channel, data, size);
    return status != 0 ? status : write_event(log, channel, data, size);
}

/* A message of another sender, which sees the same points at rest. */
static int write_other(lcm_eventlog_t *log, int frame)
{
    int64_t seq = points.message.seq;
    points.message.session_id = 9;
    points.message.seq = frame + 1;
    int status = write_frame(log, "whole", 1, 0);
    points.message.session_id = 7;
    points.message.seq = seq;
    return status;
}

static int write_trial(lcm_eventlog_t *log, int trial, int8_t phase)
{
    uint8_t data[GRRL_WIRE_MAX_BYTES];
    struct grrl_wire_why why;
    const grrl_trial_t message = {.session_id = 7,
                                  .trial_id = trial,
                                  .revision = 2 * trial + phase,
                                  .judged_cmd_seq = -1,
                                  .phase = phase,
                                  .outcome = phase == GRRL_TRIAL_T_ENDED};
    int size = grrl_wire_encode_trial(&message, sizeof data, data, &why);
    return size < 0 ? -1 : write_event(log, GRRL_CHANNEL_TRIAL, data, size);
}

static int write_trials(lcm_eventlog_t *log, const char *kind)
{
    int status = 0;
    bool tells = strcmp(kind, "ended") == 0;
    for (int trial = 1; trial <= 2; trial++) {
        if (tells)
            status |= write_trial(log, trial, GRRL_TRIAL_T_RUNNING);
        for (int frame = 0; frame < FRAMES; frame++) {
            status |= write_frame(log, kind, trial, frame);
            if (strcmp(kind, "mixed") == 0 && frame % 3 == 0)
                status |= write_other(log, FRAMES * trial + frame);
        }
        if (tells && trial == 1)
            status |= write_trial(log, trial, GRRL_TRIAL_T_ENDED);
    }
    return status;
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    lcm_eventlog_t *log = lcm_eventlog_create(argv[1], "w");
    if (log == NULL)
        return 1;
    grrl_wire_bind_points(&points);
    points.message.session_id = 7;
    points.message.mode = GRRL_POINTS_T_LOCK_STEP;
    int status = 0;
    for (int frame = 0; strcmp(argv[2], "restarted") == 0 && frame < FRAMES; frame++)
        status |= write_other(log, frame);
    status |= write_trials(log, argv[2]);
    lcm_eventlog_destroy(log);
    return status != 0;
}
