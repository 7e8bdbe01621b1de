/*
 * line.h: the bridge's end of a serial line to a controller (link.h). It asks one question at a
 * time and repeats it until it is answered. Repeating is safe: the controller executes a request
 * once.
 */
#ifndef BRIDGE_LINE_H
#define BRIDGE_LINE_H

#include "link.h"

struct bridge_line_counts {
    uint64_t requests;
    uint64_t bytes_out;
    uint64_t bytes_in;
    uint32_t resent;      /* requests, counting each repetition */
    uint32_t damaged_in;  /* frames received damaged */
    uint32_t damaged_out; /* frames the controller received damaged since it started */
    uint32_t late;        /* answers to requests already answered */
};

struct bridge_line {
    struct onboard_packet request; /* to be filled in for bridge_line_ask */
    struct onboard_packet answer;
    struct bridge_line_counts counts;
    bool failed;
    char why[512]; /* after a failure: what failed, and what to do */

    /* private */
    const char *path;
    int fd;
    uint8_t sequence; /* of the latest request */
    struct onboard_receiver receiver;
    uint8_t out[ONBOARD_LINK_BYTES];
    uint8_t in[512]; /* received bytes, processed up to `taken` */
    size_t n_in;
    size_t taken;
};

/*
 * Opens a serial device, or connects to a Unix socket such as QEMU's `-chardev socket,server=on`,
 * for which it waits up to wait_ms. On failure it returns false and sets line->why. `path` must
 * outlive the line.
 */
bool bridge_line_open(struct bridge_line *line, const char *path, int wait_ms);

/* Sends line->request and waits for the answer. On failure it returns false, now and in all later
 * calls; see line->why. */
bool bridge_line_ask(struct bridge_line *line);

void bridge_line_close(struct bridge_line *line);

#endif
