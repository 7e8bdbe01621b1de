/* tracks_csv.c: turns the rows of a table, one per point and frame, into a recording. */
#include "tracks.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "columns.h"
#include "csv.h"

#define LARGEST_WHOLE 9007199254740992.0 /* a double represents every whole number up to this */

static const char position_advice[] = "a position is a finite number; for a point that is not "
                                      "visible, visible is 0 or both cells are empty";
static const char comma_advice[] =
    "is this a decimal comma or a thousands separator? Use decimal points";

struct row {
    long long frame;
    int32_t point;
    float x;
    float y;
    bool visible;
    size_t line;
};

/* A cell to report later. */
struct place {
    size_t line; /* 0: none yet */
    int column;
    char text[24];
};

struct reader {
    struct grrl_csv csv;
    struct grrl_columns columns;
    struct row *row;
    size_t n_rows;
    size_t capacity;
    size_t n_empty; /* rows without a position */
    /* for numbers separated by semicolons: */
    struct place first_comma;
    bool comma_is_decimal; /* one was seen that cannot be a thousands separator */
    struct place first_point;
};

static bool fail_at(struct reader *reader, const struct place *place, const char *what)
{
    reader->csv.line = place->line;
    return grrl_csv_fail(&reader->csv, place->column, what, place->text);
}

static void remember(const struct reader *reader, const struct grrl_csv_field *field,
                     struct place *place)
{
    if (place->line > 0)
        return;
    place->line = reader->csv.line;
    place->column = field->column;
    (void)snprintf(place->text, sizeof place->text, "%s", field->text);
}

/* Whether a number with one comma may have a thousands separator: one to three digits without a
 * leading zero, then three. */
static bool may_be_thousands(const char *text, const char *comma)
{
    text += strspn(text, "+-");
    return comma > text && comma - text <= 3 && *text != '0' && strlen(comma + 1) == 3 &&
           strspn(comma + 1, "0123456789") == 3;
}

/* Between semicolons a comma may be a decimal comma: it becomes a point. check_commas decides for
 * the file as a whole. */
static void take_comma(struct reader *reader, const struct grrl_csv_field *field)
{
    char *comma = strchr(field->text, ',');
    if (reader->csv.separator != ';')
        return;
    if (strchr(field->text, '.') != NULL) {
        remember(reader, field, &reader->first_point);
    } else if (comma != NULL && strchr(comma + 1, ',') == NULL) {
        remember(reader, field, &reader->first_comma);
        reader->comma_is_decimal =
            reader->comma_is_decimal || !may_be_thousands(field->text, comma);
        *comma = '.';
    }
}

static bool check_commas(struct reader *reader)
{
    if (reader->first_comma.line == 0)
        return true;
    if (reader->first_point.line > 0)
        return fail_at(reader, &reader->first_point,
                       "a decimal point, but other numbers use a decimal comma");
    return reader->comma_is_decimal || fail_at(reader, &reader->first_comma, comma_advice);
}

static bool looks_like_a_number(const char *text)
{
    return *text != '\0' && strspn(text, "+-.0123456789eE") == strlen(text);
}

/* A whole number, also as 12.0 or 1e+05. */
static bool parse_whole(struct reader *reader, const struct grrl_csv_field *field, long long low,
                        long long high, long long *value)
{
    char *end;
    take_comma(reader, field);
    if (!looks_like_a_number(field->text))
        return false;
    errno = 0;
    *value = strtoll(field->text, &end, 10);
    if (*end != '\0') {
        double number = strtod(field->text, &end);
        if (!(fabs(number) <= LARGEST_WHOLE) || floor(number) != number)
            return false;
        *value = (long long)number;
    }
    return *end == '\0' && errno == 0 && *value >= low && *value <= high;
}

static bool parse_position(struct reader *reader, const struct grrl_csv_field *field, float *value)
{
    char *end;
    take_comma(reader, field);
    *value = strtof(field->text, &end);
    if (!looks_like_a_number(field->text) || *end != '\0' || !isfinite(*value))
        return grrl_csv_fail(&reader->csv, field->column, position_advice, field->text);
    return true;
}

static bool is_word(const char *text, const char *lower_case)
{
    while (*text != '\0' && tolower((unsigned char)*text) == *lower_case) {
        text++;
        lower_case++;
    }
    return *text == '\0' && *lower_case == '\0';
}

/* What exporters write for a missing number. */
static bool is_missing(const char *text)
{
    static const char *const words[] = {"", "nan", "-nan", "na", "<na>", "none", "null"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (is_word(text, words[i]))
            return true;
    return false;
}

static bool parse_visible(struct reader *reader, const struct grrl_csv_field *field, bool *visible)
{
    long long number = is_word(field->text, "true");
    if (number == 0 && !is_word(field->text, "false") && !parse_whole(reader, field, 0, 1, &number))
        return grrl_csv_fail(&reader->csv, field->column,
                             reader->columns.occluded ? "occluded must be 0 or 1, true or false"
                                                      : "visible must be 0 or 1, true or false",
                             field->text);
    *visible = (number != 0) != reader->columns.occluded;
    return true;
}

static bool parse_xy(struct reader *reader, const struct grrl_csv_field *x,
                     const struct grrl_csv_field *y, struct row *row)
{
    if (is_missing(x->text) && is_missing(y->text)) {
        row->visible = false;
        reader->n_empty++;
        return true;
    }
    return parse_position(reader, x, &row->x) && parse_position(reader, y, &row->y);
}

static bool parse_row(struct reader *reader, const struct grrl_csv_field *fields, struct row *row)
{
    const int *place = reader->columns.place;
    const struct grrl_csv_field *frame = &fields[place[GRRL_COLUMN_FRAME]];
    const struct grrl_csv_field *point = &fields[place[GRRL_COLUMN_POINT]];
    long long number;
    if (!parse_whole(reader, frame, LLONG_MIN + 1, LLONG_MAX, &row->frame))
        return grrl_csv_fail(
            &reader->csv, frame->column,
            "a frame must be a whole number; number the frames if the file has times in seconds",
            frame->text);
    if (!parse_whole(reader, point, INT32_MIN, INT32_MAX, &number))
        return grrl_csv_fail(&reader->csv, point->column,
                             "a point must be a whole number of 32 bits", point->text);
    *row = (struct row){row->frame, (int32_t)number, 0.0f, 0.0f, true, reader->csv.line};
    if (place[GRRL_COLUMN_VISIBLE] != GRRL_COLUMN_ABSENT &&
        !parse_visible(reader, &fields[place[GRRL_COLUMN_VISIBLE]], &row->visible))
        return false;
    return !row->visible ||
           parse_xy(reader, &fields[place[GRRL_COLUMN_X]], &fields[place[GRRL_COLUMN_Y]], row);
}

static bool fail_ragged(struct reader *reader, const struct grrl_csv_field *fields, int n)
{
    char what[80];
    int expected = reader->columns.n_fields;
    (void)snprintf(what, sizeof what, "%d field%s, but the header has %d", n, n == 1 ? "" : "s",
                   expected);
    return grrl_csv_fail(&reader->csv,
                         n > expected ? fields[expected].column : reader->csv.past_end, what, "");
}

static bool read_row(struct reader *reader)
{
    struct grrl_csv_field fields[GRRL_CSV_MAX_FIELDS];
    int n = grrl_csv_split(&reader->csv, fields);
    if (n < 0)
        return false;
    if (n != reader->columns.n_fields)
        return fail_ragged(reader, fields, n);
    if (reader->n_rows == reader->capacity) {
        size_t capacity = reader->capacity == 0 ? 1024 : 2 * reader->capacity;
        struct row *grown = realloc(reader->row, capacity * sizeof *grown);
        if (grown == NULL)
            return grrl_csv_fail(&reader->csv, 1, "out of memory", "");
        reader->row = grown;
        reader->capacity = capacity;
    }
    if (!parse_row(reader, fields, &reader->row[reader->n_rows]))
        return false;
    reader->n_rows++;
    return true;
}

static bool read_lines(struct reader *reader)
{
    enum grrl_csv_status status = grrl_csv_next_line(&reader->csv);
    if (status == GRRL_CSV_END)
        return grrl_csv_fail(&reader->csv, 1, grrl_columns_advice, "the file ends here");
    if (status == GRRL_CSV_BAD || !grrl_columns_find(&reader->csv, &reader->columns))
        return false;
    while ((status = grrl_csv_next_line(&reader->csv)) == GRRL_CSV_LINE)
        if (!read_row(reader))
            return false;
    if (status == GRRL_CSV_END && reader->n_rows == 0)
        return grrl_csv_fail(&reader->csv, 1, "rows are needed below the header",
                             "the file ends here");
    return status == GRRL_CSV_END && check_commas(reader);
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
            reader->csv.line = b->line;
            (void)snprintf(
                what, sizeof what,
                "point %d of frame %lld is already in line %zu; it must be there only once",
                (int)b->point, b->frame, a->line);
            return grrl_csv_fail(&reader->csv, 1, what, "");
        }
    }
    return true;
}

/* Turns sorted rows into frames; a frame without visible points stays as an empty one. */
static bool build(struct reader *reader, struct grrl_tracks *tracks)
{
    size_t n = reader->n_rows;
    tracks->id = malloc(n * sizeof *tracks->id);
    tracks->x = malloc(n * sizeof *tracks->x);
    tracks->y = malloc(n * sizeof *tracks->y);
    tracks->frame = malloc(n * sizeof *tracks->frame);
    if (tracks->id == NULL || tracks->x == NULL || tracks->y == NULL || tracks->frame == NULL)
        return grrl_csv_fail(&reader->csv, 1, "out of memory", "");
    for (size_t i = 0; i < n; i++) {
        const struct row *row = &reader->row[i];
        if (i == 0 || row->frame != reader->row[i - 1].frame)
            tracks->frame[tracks->n_frames++] = (struct grrl_tracks_frame){
                .first = tracks->n_points, .number = row->frame, .pushing = i > 0};
        if (row->visible) {
            tracks->id[tracks->n_points] = row->point;
            tracks->x[tracks->n_points] = row->x;
            tracks->y[tracks->n_points] = row->y;
            tracks->n_points++;
            tracks->frame[tracks->n_frames - 1].n++;
        }
    }
    tracks->in_pixels = reader->columns.in_pixels;
    tracks->lost.empty = reader->n_empty;
    return true;
}

bool grrl_tracks_read_csv(FILE *file, const char *path, struct grrl_tracks *tracks,
                          struct grrl_tracks_error *error)
{
    struct reader reader = {.csv = {.file = file, .path = path, .error = error}};
    *tracks = (struct grrl_tracks){0};
    bool good = read_lines(&reader);
    if (good) {
        qsort(reader.row, reader.n_rows, sizeof *reader.row, by_frame_and_point);
        good = check_twice(&reader) && build(&reader, tracks);
    }
    if (good && !grrl_tracks_drop_lost(tracks))
        good = grrl_csv_fail(&reader.csv, 1, "out of memory", "");
    free(reader.row);
    grrl_csv_free(&reader.csv);
    if (!good)
        grrl_tracks_free(tracks);
    return good;
}
