/* Writes an LCM log: make_log FILE KIND. Two trials of a hinge that opens while the phase says
 * PUSHING, frames repeated as in lock-step; KIND `damaged` cuts some messages short, `empty` has
 * another channel only. */
#include <math.h>
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
    for (int trial = 1; trial <= 2; trial++)
        for (int frame = 0; frame < FRAMES; frame++)
            status |= write_frame(log, argv[2], trial, frame);
    lcm_eventlog_destroy(log);
    return status != 0;
}
