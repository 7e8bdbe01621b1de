/*
 * line.h: the bridge's end of a serial line to a controller (link.h): one question at a time, asked
 * again until it is answered. Asking again does no harm: the controller does a request once.
 */
#ifndef BRIDGE_LINE_H
#define BRIDGE_LINE_H

#include "link.h"

struct bridge_line_counts {
    uint64_t requests;
    uint64_t bytes_out;
    uint64_t bytes_in;
    uint32_t resent;      /* requests, each time */
    uint32_t damaged_in;  /* frames that came in damaged */
    uint32_t damaged_out; /* frames the controller says it got damaged, since it was started */
    uint32_t late;        /* answers to a request that had been answered */
};

struct bridge_line {
    struct onboard_packet request; /* to be filled in for bridge_line_ask */
    struct onboard_packet answer;
    struct bridge_line_counts counts;
    bool failed;
    char why[512]; /* if it failed: what, and what to do */

    /* private */
    const char *path;
    int fd;
    uint8_t sequence; /* of the newest request */
    struct onboard_receiver receiver;
    uint8_t out[ONBOARD_LINK_BYTES];
    uint8_t in[512]; /* read, and taken up to `taken` */
    size_t n_in;
    size_t taken;
};

/*
 * Opens a serial device, or connects to a Unix socket such as QEMU's `-chardev socket,server=on`,
 * which is waited for up to wait_ms. False: line->why. `path` must stay.
 */
bool bridge_line_open(struct bridge_line *line, const char *path, int wait_ms);

/* Sends line->request and waits for its answer. False, now and from then on: line->why. */
bool bridge_line_ask(struct bridge_line *line);

void bridge_line_close(struct bridge_line *line);

#endif
