/* Reads tracks from CSV, and says which line is wrong. */
#define _POSIX_C_SOURCE 200809L

#include "tracks.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

enum column { FRAME, POINT, X, Y, VISIBLE, N_COLUMNS };
enum { ABSENT = -1, MAX_FIELDS = 256 };

static const char header_advice[] = "the header names the columns frame,point,x,y and perhaps "
                                    "visible (x_px,y_px for pixels), separated by commas";

struct row {
    long long frame;
    int32_t point;
    float x;
    float y;
    bool visible;
    size_t line;
};

struct reader {
    const char *path;
    struct grrl_tracks_error *error;
    size_t line;
    int place[N_COLUMNS]; /* of each column in a row, or ABSENT */
    int n_fields;         /* of the header */
    bool in_pixels;
    struct row *row;
    size_t n_rows;
    size_t capacity;
};

/* A field of the line being read, without the blanks around it. */
struct field {
    char *text;
    int column; /* of its first character, from 1 */
};

static bool fail(struct reader *reader, int column, const char *what, const char *text)
{
    (void)snprintf(reader->error->text, sizeof reader->error->text, "%.200s:%zu:%d: %.60s%s%.200s",
                   reader->path, reader->line, column, text, *text != '\0' ? ": " : "", what);
    return false;
}

/* Cuts a line at its commas. The number of fields, MAX_FIELDS + 1 if there are more. */
static int split(char *line, struct field *fields)
{
    int n = 0;
    char *at = line;
    for (;;) {
        char *end = at + strcspn(at, ",");
        bool last = *end == '\0';
        *end = '\0';
        if (n == MAX_FIELDS)
            return MAX_FIELDS + 1;
        char *text = at + strspn(at, " \t");
        fields[n++] = (struct field){text, (int)(text - line) + 1};
        for (char *p = end; p > text && (p[-1] == ' ' || p[-1] == '\t');)
            *--p = '\0';
        if (last)
            return n;
        at = end + 1;
    }
}

static int column_of_name(const char *name, bool *in_pixels)
{
    static const char *const names[] = {"frame", "point", "x", "y", "visible"};
    for (int i = 0; i < N_COLUMNS; i++)
        if (strcmp(name, names[i]) == 0)
            return i;
    *in_pixels = *in_pixels || strcmp(name, "x_px") == 0 || strcmp(name, "y_px") == 0;
    return strcmp(name, "x_px") == 0 ? X : strcmp(name, "y_px") == 0 ? Y : ABSENT;
}

static bool read_header(struct reader *reader, char *line)
{
    static const char *const missing[] = {"there is no column frame", "there is no column point",
                                          "there is no column x or x_px",
                                          "there is no column y or y_px"};
    struct field fields[MAX_FIELDS];
    if (strncmp(line, "\xef\xbb\xbf", 3) == 0) /* a byte order mark */
        line += 3;
    for (int i = 0; i < N_COLUMNS; i++)
        reader->place[i] = ABSENT;
    reader->n_fields = split(line, fields);
    if (reader->n_fields > MAX_FIELDS)
        return fail(reader, 1, "at most 256 columns, please", "");
    for (int i = 0; i < reader->n_fields; i++) {
        int column = column_of_name(fields[i].text, &reader->in_pixels);
        if (column == ABSENT)
            continue;
        if (reader->place[column] != ABSENT)
            return fail(reader, fields[i].column, "another column means the same", fields[i].text);
        reader->place[column] = i;
    }
    for (int i = FRAME; i <= Y; i++)
        if (reader->place[i] == ABSENT)
            return fail(reader, 1, header_advice, missing[i]);
    const struct field *y = &fields[reader->place[Y]];
    if (reader->in_pixels &&
        (strcmp(y->text, "y") == 0 || strcmp(fields[reader->place[X]].text, "x") == 0))
        return fail(reader, y->column, "one of x and y is in pixels, the other not", y->text);
    return true;
}

static bool parse_whole(const char *text, long long low, long long high, long long *value)
{
    char *end;
    errno = 0;
    *value = strtoll(text, &end, 10);
    return end != text && *end == '\0' && errno == 0 && *value >= low && *value <= high;
}

static bool parse_position(struct reader *reader, const struct field *field, float *value)
{
    char *end;
    *value = strtof(field->text, &end);
    if (end == field->text || *end != '\0' || !isfinite(*value))
        return fail(reader, field->column,
                    "a position is a finite number; a point that was not seen has visible 0",
                    field->text);
    return true;
}

static bool parse_row(struct reader *reader, const struct field *fields, struct row *row)
{
    const struct field *frame = &fields[reader->place[FRAME]];
    const struct field *point = &fields[reader->place[POINT]];
    long long number;
    if (!parse_whole(frame->text, LLONG_MIN + 1, LLONG_MAX, &row->frame))
        return fail(reader, frame->column, "a frame is a whole number", frame->text);
    if (!parse_whole(point->text, INT32_MIN, INT32_MAX, &number))
        return fail(reader, point->column, "a point is a whole number of 32 bits", point->text);
    row->point = (int32_t)number;
    row->visible = true;
    if (reader->place[VISIBLE] != ABSENT) {
        const struct field *visible = &fields[reader->place[VISIBLE]];
        if (!parse_whole(visible->text, 0, 1, &number))
            return fail(reader, visible->column, "visible is 0 or 1", visible->text);
        row->visible = number != 0;
    }
    row->x = row->y = 0.0f;
    return !row->visible || (parse_position(reader, &fields[reader->place[X]], &row->x) &&
                             parse_position(reader, &fields[reader->place[Y]], &row->y));
}

static bool read_row(struct reader *reader, char *line)
{
    struct field fields[MAX_FIELDS];
    int n = split(line, fields);
    if (n != reader->n_fields) {
        char what[80];
        (void)snprintf(what, sizeof what, "%d fields, but the header has %d", n, reader->n_fields);
        return fail(reader, 1, what, "");
    }
    if (reader->n_rows == reader->capacity) {
        size_t capacity = reader->capacity == 0 ? 1024 : 2 * reader->capacity;
        struct row *grown = realloc(reader->row, capacity * sizeof *grown);
        if (grown == NULL)
            return fail(reader, 1, "out of memory", "");
        reader->row = grown;
        reader->capacity = capacity;
    }
    struct row *row = &reader->row[reader->n_rows];
    row->line = reader->line;
    if (!parse_row(reader, fields, row))
        return false;
    reader->n_rows++;
    return true;
}

static bool read_lines(struct reader *reader, FILE *file)
{
    char *line = NULL;
    size_t size = 0;
    ssize_t length;
    bool header = false;
    bool good = true;
    while (good && (length = getline(&line, &size, file)) >= 0) {
        reader->line++;
        if (memchr(line, '\0', (size_t)length) != NULL) {
            good = fail(reader, 1, "this is no text: there is a zero byte in it", "");
            break;
        }
        line[strcspn(line, "\r\n")] = '\0';
        if (line[strspn(line, " \t")] == '\0')
            continue;
        good = header ? read_row(reader, line) : read_header(reader, line);
        header = true;
    }
    free(line);
    if (good && ferror(file)) {
        reader->line++;
        return fail(reader, 1, strerror(errno), "");
    }
    if (good && reader->n_rows == 0) {
        reader->line++;
        return fail(reader, 1, header ? "rows are needed below the header" : header_advice,
                    "the file ends here");
    }
    return good;
}

static int by_frame_and_point(const void *left, const void *right)
{
    const struct row *a = left;
    const struct row *b = right;
    if (a->frame != b->frame)
        return a->frame < b->frame ? -1 : 1;
    if (a->point != b->point)
        return a->point < b->point ? -1 : 1;
    return a->line < b->line ? -1 : a->line > b->line;
}

static bool check_twice(struct reader *reader)
{
    for (size_t i = 1; i < reader->n_rows; i++) {
        const struct row *a = &reader->row[i - 1];
        const struct row *b = &reader->row[i];
        if (a->frame == b->frame && a->point == b->point) {
            char what[160];
            reader->line = b->line;
            (void)snprintf(what, sizeof what,
                           "point %d of frame %lld stands in line %zu already; once is right",
                           (int)b->point, b->frame, a->line);
            return fail(reader, 1, what, "");
        }
    }
    return true;
}

/* Rows in order become frames; a frame of which nothing is visible stays as an empty one. */
static bool build(struct reader *reader, struct grrl_tracks *tracks)
{
    size_t n = reader->n_rows;
    tracks->id = malloc(n * sizeof *tracks->id);
    tracks->x = malloc(n * sizeof *tracks->x);
    tracks->y = malloc(n * sizeof *tracks->y);
    tracks->frame = malloc(n * sizeof *tracks->frame);
    if (tracks->id == NULL || tracks->x == NULL || tracks->y == NULL || tracks->frame == NULL)
        return fail(reader, 1, "out of memory", "");
    for (size_t i = 0; i < n; i++) {
        const struct row *row = &reader->row[i];
        if (i == 0 || row->frame != reader->row[i - 1].frame)
            tracks->frame[tracks->n_frames++] =
                (struct grrl_tracks_frame){.first = tracks->n_points, .pushing = i > 0};
        if (row->visible) {
            tracks->id[tracks->n_points] = row->point;
            tracks->x[tracks->n_points] = row->x;
            tracks->y[tracks->n_points] = row->y;
            tracks->n_points++;
            tracks->frame[tracks->n_frames - 1].n++;
        }
    }
    tracks->in_pixels = reader->in_pixels;
    return true;
}

bool grrl_tracks_read_csv(FILE *file, const char *path, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error)
{
    struct reader reader = {.path = path, .error = error};
    *tracks = (struct grrl_tracks){0};
    bool good = read_lines(&reader, file);
    if (good) {
        qsort(reader.row, reader.n_rows, sizeof *reader.row, by_frame_and_point);
        good = check_twice(&reader) && build(&reader, tracks);
    }
    free(reader.row);
    if (!good)
        grrl_tracks_free(tracks);
    return good;
}
