/* columns.h: which column of a table of tracks is which, by the names that trackers give them. */
#ifndef GRRL_PERCEIVE_COLUMNS_H
#define GRRL_PERCEIVE_COLUMNS_H

#include "csv.h"

enum grrl_column {
    GRRL_COLUMN_FRAME,
    GRRL_COLUMN_POINT,
    GRRL_COLUMN_X,
    GRRL_COLUMN_Y,
    GRRL_COLUMN_VISIBLE,
    GRRL_COLUMNS
};

enum { GRRL_COLUMN_ABSENT = -1 };

struct grrl_columns {
    int place[GRRL_COLUMNS]; /* of each in a row, or GRRL_COLUMN_ABSENT: visible only */
    int n_fields;
    bool in_pixels;
    bool occluded; /* the column visible says the opposite */
};

/*
 * Finds the separator and the columns in the header, which is the line in csv->text. False, with a
 * message: a column is missing or there twice, or the table is none with a row for each point of
 * each frame (one of DeepLabCut, x1,y1,x2,y2, no header), and what to do then. docs/perceive.md has
 * the names.
 */
bool grrl_columns_find(struct grrl_csv *csv, struct grrl_columns *columns);

/* The message of a file that has no header. */
extern const char grrl_columns_advice[];

#endif
