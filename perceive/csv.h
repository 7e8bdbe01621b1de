/*
 * csv.h: lines and fields of separated values from any program.
 *
 * Lines end with LF, CRLF or CR. Fields may be quoted as in RFC 4180; a quoted field ends on its
 * line. Order of calls: grrl_csv_next_line, grrl_csv_find_separator on the header, grrl_csv_split
 * on each line, grrl_csv_free.
 */
#ifndef GRRL_PERCEIVE_CSV_H
#define GRRL_PERCEIVE_CSV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "tracks.h"

enum { GRRL_CSV_MAX_FIELDS = 1024 };

/* A field of the line being read, without the blanks and quotes around it. */
struct grrl_csv_field {
    char *text;
    int column; /* of its first character, counted from 1 */
};

/* Fill in the first three fields, zero the rest. */
struct grrl_csv {
    FILE *file;
    const char *path;                /* for the errors */
    struct grrl_tracks_error *error; /* of the call that failed */
    size_t line;                     /* the last one read, counted from 1 */
    char separator;
    char *text; /* of that line; grrl_csv_split changes it */
    size_t capacity;
    int past_end; /* the column after its last field */
};

enum grrl_csv_status { GRRL_CSV_LINE, GRRL_CSV_END, GRRL_CSV_BAD };

/* Reads the next line that is not blank into csv->text. At the end, csv->line is one past the last
 * line. */
enum grrl_csv_status grrl_csv_next_line(struct grrl_csv *csv);

/* Picks comma, semicolon or tab, whichever is most frequent in the line outside quotes; by default
 * a comma. */
void grrl_csv_find_separator(struct grrl_csv *csv);

/* Splits csv->text into fields. Returns how many; -1: a quote is not closed, or there are too many.
 */
int grrl_csv_split(struct grrl_csv *csv, struct grrl_csv_field *fields);

/* Writes PATH:LINE:COLUMN: TEXT: WHAT into csv->error; text "" is left out. Always returns false.
 */
bool grrl_csv_fail(struct grrl_csv *csv, int column, const char *what, const char *text);

void grrl_csv_free(struct grrl_csv *csv);

#endif
