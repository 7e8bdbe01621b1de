/*
 * rectify.h: a table seen at an angle, undone by four points whose positions on it are known.
 */
#ifndef GRRL_PERCEIVE_RECTIFY_H
#define GRRL_PERCEIVE_RECTIFY_H

#include <stdbool.h>
#include <stddef.h>

#include "tracks.h"

enum { GRRL_RECTIFY_POINTS = 4 };

/* A pixel, and the position on the table that it shows, in any unit. */
struct grrl_rectify_point {
    double px[2];
    double table[2];
};

struct grrl_rectify {
    double matrix[3][3]; /* from pixels to the table, homogeneous */
    double nearest;      /* the least third coordinate of what counts as this side of the horizon */
    double table_per_pixel; /* between the four points */
};

/* Each returns NULL, or what it must be. */
const char *grrl_rectify_parse(const char *text,
                               struct grrl_rectify_point point[GRRL_RECTIFY_POINTS]);
const char *grrl_rectify_from(const struct grrl_rectify_point point[GRRL_RECTIFY_POINTS],
                              struct grrl_rectify *rectify);

/* Moves all points to their position on the table; those beyond its horizon are removed and counted
 * in tracks->lost. false: out of memory. */
bool grrl_rectify_tracks(const struct grrl_rectify *rectify, struct grrl_tracks *tracks);

#endif
