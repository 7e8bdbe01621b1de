/* columns.h: identifies the columns of a table of tracks by the names that trackers use. */
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
    int place[GRRL_COLUMNS]; /* index of each in a row; GRRL_COLUMN_ABSENT is possible for visible
                                only */
    int n_fields;
    bool in_pixels;
    bool occluded; /* the column visible says the opposite */
};

/*
 * Finds the separator and the columns in the header, the line in csv->text. false, with a message
 * that says what to do: a column is missing or duplicated, or the table does not have one row per
 * point and frame (DeepLabCut, x1,y1,x2,y2, no header). docs/perceive.md lists the names.
 */
bool grrl_columns_find(struct grrl_csv *csv, struct grrl_columns *columns);

/* The message for a file without a header. */
extern const char grrl_columns_advice[];

#endif
