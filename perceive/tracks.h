/*
 * tracks.h: a recording of tracked points in memory, read from CSV or from an LCM log.
 *
 * Order of calls: grrl_tracks_read_csv or grrl_tracks_read_log, perhaps grrl_tracks_join_renewed
 * and grrl_tracks_choose, then the frames, then grrl_tracks_free.
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
    int64_t number; /* of the frame in a CSV file, seq of the message in a log */
    uint32_t n;
    bool pushing; /* the robot acts, or nobody knows */
    bool settled; /* all lies still after a push */
};

/* Points of a CSV file that were not seen, though the column visible did not say so. */
struct grrl_tracks_lost {
    size_t empty;  /* positions empty or NaN */
    size_t marked; /* positions that stand for none: (0, 0) or (-1, -1) */
    size_t frozen; /* positions that a tracker repeats after it has lost the point */
};

/* Tracks that grrl_tracks_choose has left out. */
struct grrl_tracks_left_out {
    size_t n;
    int32_t *id;     /* in ascending order */
    size_t n_points; /* of them, in all frames */
};

/* What of a log was read, and what was wrong with it. */
struct grrl_tracks_log {
    int32_t trial;
    int64_t session;
    uint32_t n_sessions; /* different ones, senders of points */
    bool interleaved;    /* messages of one stand between those of another */
    uint32_t refused;    /* messages on the channel that were no points_t */
    uint32_t n_damages;
    int64_t size;          /* bytes of the log */
    int64_t damaged_at;    /* byte where the first damage begins */
    int64_t whole_at;      /* the first whole event behind it, or the size: there is none */
    int64_t damaged_bytes; /* of all damages */
    bool holed;            /* a damage lies within the trial or beside it */
    bool unended;          /* the log tells of trials, but not of the end of this one */
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
    size_t n_renewed;           /* ids that grrl_tracks_join_renewed has replaced by earlier ones */
    struct grrl_tracks_log log; /* all zero for a CSV file */
};

/* What is wrong, where, and what would be right. */
struct grrl_tracks_error {
    char text[512];
};

/*
 * Reads a table with a row for each point of each frame (columns.h, csv.h). Rows may come in any
 * order; a point that is not visible needs no position. path is for the errors only. The first
 * frame is taken to be at rest, all others as part of one long push: nobody tells when somebody
 * pushed. Ends with grrl_tracks_drop_lost.
 */
bool grrl_tracks_read_csv(FILE *file, const char *path, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error);

/*
 * Reads one trial from an LCM log with the channel GRRL_POINTS, in metres; trial 0: the last one
 * there is. Goes on behind a damage. Of sessions one after the other the last counts, of
 * interleaved ones the one with most messages. tracks->log tells of all this.
 */
bool grrl_tracks_read_log(const char *path, int32_t trial, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error);

/*
 * Takes points away that were not seen (lost.c has the rules): marks such as (0, 0), and positions
 * that are repeated exactly while a seen point never is. Only where the evidence is clear. false:
 * memory is short. Cost: a sort of all points.
 */
bool grrl_tracks_drop_lost(struct grrl_tracks *tracks);

/*
 * Gives tracks that begin where others ended the ids of those: the marks of a tracker that detects
 * anew (renewed.c has the rules). Only where the whole recording shows it. noise: the standard
 * deviation of a point, in the unit of the positions. false: memory is short. Cost: a sort of all
 * points.
 */
bool grrl_tracks_join_renewed(struct grrl_tracks *tracks, float noise);

/*
 * Leaves at most `most` tracks: of the longer ones, evenly over the picture (choose.c). The same
 * for any order of rows. false: memory is short. Cost: a sort of all points.
 */
bool grrl_tracks_choose(struct grrl_tracks *tracks, size_t most);

/* A point's place in its track. */
struct grrl_tracks_sample {
    int32_t id;
    uint32_t frame; /* index */
    size_t at;      /* in the arrays of the recording */
};

/* All points by id and time, to be freed; NULL: memory is short, or there are no points. */
struct grrl_tracks_sample *grrl_tracks_by_id(const struct grrl_tracks *tracks);

/* The sample behind the last one of the track that begins at sample `first`. */
size_t grrl_tracks_end(const struct grrl_tracks_sample *sample, size_t n, size_t first);

/* Keeps the points whose flag is set; frames stay, if only as empty ones. */
void grrl_tracks_keep(struct grrl_tracks *tracks, const bool *keep);

/* How many different ids there are; 0 also when memory is short. */
size_t grrl_tracks_count_ids(const struct grrl_tracks *tracks);

void grrl_tracks_free(struct grrl_tracks *tracks);

#endif
