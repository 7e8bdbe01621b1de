/*
 * log_reader.h: the events of an LCM log, also of one that is damaged.
 *
 * LCM's own reader ends in silence at the first damage. This one goes on behind it and tells which
 * bytes are lost. An event counts if its header is plausible and another event, or the end of the
 * file, follows right behind it. Order of calls: grrl_log_open, grrl_log_next until GRRL_LOG_END or
 * GRRL_LOG_FAILED, grrl_log_close.
 */
#ifndef GRRL_PERCEIVE_LOG_READER_H
#define GRRL_PERCEIVE_LOG_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tracks.h"

struct grrl_log_event {
    int64_t at;      /* byte in the file */
    uint64_t number; /* counts up by one in a log */
    const char *channel;
    size_t channel_length;
    const uint8_t *data; /* until the next call */
    size_t data_length;
};

/* Bytes from..to, `to` excluded, are no events; from == to: events are missing between two. */
struct grrl_log_damage {
    int64_t from;
    int64_t to;
};

struct grrl_log_reader {
    int fd;
    const char *path; /* for the errors */
    int64_t size;
    int64_t at;
    uint64_t number; /* expected of the next event; 0: any */
    uint8_t *bytes;
    size_t capacity;
};

enum grrl_log_step { GRRL_LOG_EVENT, GRRL_LOG_DAMAGE, GRRL_LOG_END, GRRL_LOG_FAILED };

/* False: no such file, or none that can be read twice. */
bool grrl_log_open(struct grrl_log_reader *reader, const char *path,
                   struct grrl_tracks_error *error);

/* The next event or the damage before it. A log that ends within an event ends with a damage. */
enum grrl_log_step grrl_log_next(struct grrl_log_reader *reader, struct grrl_log_event *event,
                                 struct grrl_log_damage *damage, struct grrl_tracks_error *error);

void grrl_log_close(struct grrl_log_reader *reader);

#endif
