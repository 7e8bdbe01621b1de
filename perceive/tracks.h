/*
 * tracks.h: a recording of tracked points in memory, read from CSV or from an LCM log.
 *
 * Order of calls: grrl_tracks_read_csv or grrl_tracks_read_log, then the frames, then
 * grrl_tracks_free.
 */
#ifndef GRRL_PERCEIVE_TRACKS_H
#define GRRL_PERCEIVE_TRACKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The points of one time, by ascending id; at `first` in the arrays of the recording. */
struct grrl_tracks_frame {
    size_t first;
    uint32_t n;
    bool pushing; /* the robot acts, or nobody knows */
    bool settled; /* all lies still after a push */
};

struct grrl_tracks {
    size_t n_points; /* of all frames together */
    int32_t *id;
    float *x;
    float *y;
    size_t n_frames;
    struct grrl_tracks_frame *frame;
    bool in_pixels;   /* the columns were x_px and y_px */
    int32_t trial;    /* of a log: which one this is */
    uint32_t refused; /* messages of a log that were no points_t */
};

/* What is wrong, where, and what would be right. */
struct grrl_tracks_error {
    char text[512];
};

/*
 * Reads rows of comma-separated values. The header names the columns frame, point, x, y (or x_px,
 * y_px) and perhaps visible in any order; others are ignored. Rows may come in any order; a point
 * that is not visible needs no position. path is for the errors only. The first frame is taken to
 * be at rest, all others as part of one long push: nobody tells when somebody pushed.
 */
bool grrl_tracks_read_csv(FILE *file, const char *path, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error);

/*
 * Reads one trial from an LCM log with the channel GRRL_POINTS, in metres; trial 0: the last one
 * there is. Messages that are damaged are left out and counted.
 */
bool grrl_tracks_read_log(const char *path, int32_t trial, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error);

/* How many different ids there are; 0 also when memory is short. */
size_t grrl_tracks_count_ids(const struct grrl_tracks *tracks);

void grrl_tracks_free(struct grrl_tracks *tracks);

#endif
