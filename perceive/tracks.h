/*
 * tracks.h: a recording of tracked points in memory, read from CSV or from an LCM log.
 *
 * Order of calls: grrl_tracks_read_csv or grrl_tracks_read_log, optionally grrl_tracks_join_renewed
 * and grrl_tracks_choose, then use the frames, then grrl_tracks_free.
 */
#ifndef GRRL_PERCEIVE_TRACKS_H
#define GRRL_PERCEIVE_TRACKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The points of one frame by ascending id; they start at `first` in the arrays of the recording. */
struct grrl_tracks_frame {
    size_t first;
    int64_t number; /* of the frame in a CSV file, seq of the message in a log */
    uint32_t n;
    bool pushing; /* the robot is acting, or this is unknown */
    bool settled; /* everything is at rest after a push */
};

/* Points of a CSV file that were not visible although the column visible did not say so. */
struct grrl_tracks_lost {
    size_t empty;  /* positions empty or NaN */
    size_t marked; /* positions that mean "none": (0, 0) or (-1, -1) */
    size_t frozen; /* positions that a tracker repeats after it has lost the point */
    size_t beyond; /* positions that grrl_rectify_tracks found beyond the horizon of the table */
};

/* Tracks that grrl_tracks_choose has left out. */
struct grrl_tracks_left_out {
    size_t n;
    int32_t *id;     /* in ascending order */
    size_t n_points; /* of these tracks, in all frames */
};

/* What was read from a log, and what was wrong with it. */
struct grrl_tracks_log {
    int32_t trial;
    int64_t session;
    uint32_t n_sessions; /* number of different senders of points */
    bool interleaved;    /* messages of different sessions are mixed */
    uint32_t refused;    /* messages on the channel that were not a points_t */
    uint32_t n_damages;
    int64_t size;          /* bytes of the log */
    int64_t damaged_at;    /* byte offset of the first damage */
    int64_t whole_at;      /* the first intact event after it; the size: there is none */
    int64_t damaged_bytes; /* lost in total */
    bool holed;            /* there is damage within or next to the trial */
    bool unended;          /* the log has trial messages, but not the end of this trial */
};

struct grrl_tracks {
    size_t n_points; /* of all frames together */
    int32_t *id;
    float *x;
    float *y;
    size_t n_frames;
    struct grrl_tracks_frame *frame;
    bool in_pixels; /* the columns were x_px and y_px */
    struct grrl_tracks_lost lost;
    struct grrl_tracks_left_out left_out;
    size_t n_renewed;           /* ids that grrl_tracks_join_renewed replaced by earlier ones */
    struct grrl_tracks_log log; /* all zero for a CSV file */
};

/* What is wrong, where, and what would be right. */
struct grrl_tracks_error {
    char text[512];
};

/*
 * Reads a table with one row per point and frame (columns.h, csv.h), in any order; a point that is
 * not visible needs no position. path is only for error messages. The first frame counts as rest
 * and all others as one long push, since the file does not say when a push happened. Calls
 * grrl_tracks_drop_lost at the end.
 */
bool grrl_tracks_read_csv(FILE *file, const char *path, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error);

/*
 * Reads one trial from an LCM log with the channel GRRL_POINTS, in metres; trial 0: the last one.
 * Continues after damage. Of consecutive sessions the last one is read, of interleaved ones the one
 * with most messages. tracks->log reports all this.
 */
bool grrl_tracks_read_log(const char *path, int32_t trial, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error);

/*
 * Removes points that were not visible (see lost.c for the rules): marks such as (0, 0), and
 * positions repeated exactly in a recording whose visible points never repeat. Does so only if the
 * evidence is clear. false: out of memory. Cost: a sort of all points.
 */
bool grrl_tracks_drop_lost(struct grrl_tracks *tracks);

/*
 * Gives tracks that begin where others ended the ids of those, since some trackers renew ids when
 * they redetect a point (see renewed.c for the rules). Does so only if the whole recording shows
 * this. noise: the standard deviation of a point, in the unit of the positions. false: out of
 * memory. Cost: a sort of all points.
 */
bool grrl_tracks_join_renewed(struct grrl_tracks *tracks, float noise);

/*
 * Keeps at most `most` tracks: long ones, spread evenly over the image (choose.c). The result does
 * not depend on the order of rows. false: out of memory. Cost: a sort of all points.
 */
bool grrl_tracks_choose(struct grrl_tracks *tracks, size_t most);

/* A point as a sample of its track. */
struct grrl_tracks_sample {
    int32_t id;
    uint32_t frame; /* index */
    size_t at;      /* in the arrays of the recording */
};

/* All points by id and frame; the caller frees them. NULL: out of memory, or there are no points.
 */
struct grrl_tracks_sample *grrl_tracks_by_id(const struct grrl_tracks *tracks);

/* The index one past the last sample of the track that begins at `first`. */
size_t grrl_tracks_end(const struct grrl_tracks_sample *sample, size_t n, size_t first);

/* Keeps the points whose flag is set; frames stay even if they become empty. */
void grrl_tracks_keep(struct grrl_tracks *tracks, const bool *keep);

/* The number of different ids; 0 also if out of memory. */
size_t grrl_tracks_count_ids(const struct grrl_tracks *tracks);

void grrl_tracks_free(struct grrl_tracks *tracks);

#endif
