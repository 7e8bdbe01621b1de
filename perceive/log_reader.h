/*
 * log_reader.h: the events of an LCM log, even of a damaged one.
 *
 * LCM's own reader stops silently at the first damage. This one continues after it and reports
 * which bytes are lost. An event counts if its header is plausible and another event, or the end of
 * the file, follows directly. Order of calls: grrl_log_open, grrl_log_next until GRRL_LOG_END or
 * GRRL_LOG_FAILED, grrl_log_close.
 */
#ifndef GRRL_PERCEIVE_LOG_READER_H
#define GRRL_PERCEIVE_LOG_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tracks.h"

struct grrl_log_event {
    int64_t at;      /* byte offset in the file */
    uint64_t number; /* increases by one from event to event */
    const char *channel;
    size_t channel_length;
    const uint8_t *data; /* valid until the next call */
    size_t data_length;
};

/* Bytes from..to, excluding `to`, are not events; from == to: events are missing at this point. */
struct grrl_log_damage {
    int64_t from;
    int64_t to;
};

struct grrl_log_reader {
    int fd;
    const char *path; /* for the errors */
    int64_t size;
    int64_t at;
    uint64_t number; /* expected for the next event; 0: any */
    uint8_t *bytes;
    size_t capacity;
};

enum grrl_log_step { GRRL_LOG_EVENT, GRRL_LOG_DAMAGE, GRRL_LOG_END, GRRL_LOG_FAILED };

/* false: no such file, or not one that can be read twice. */
bool grrl_log_open(struct grrl_log_reader *reader, const char *path,
                   struct grrl_tracks_error *error);

/* The next event, or the damage before it. A log that ends within an event ends with damage. */
enum grrl_log_step grrl_log_next(struct grrl_log_reader *reader, struct grrl_log_event *event,
                                 struct grrl_log_damage *damage, struct grrl_tracks_error *error);

void grrl_log_close(struct grrl_log_reader *reader);

#endif
