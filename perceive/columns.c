/* columns.c: column names; distinguishes tables of another shape from a misspelt header. */
#include "columns.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

const char grrl_columns_advice[] =
    "the header must name the columns frame,point,x,y and optionally visible (x_px,y_px for "
    "pixels), separated by commas, semicolons or tabs";

static const char wide_advice[] =
    "a table with several points per row; write one row per point and frame, with the columns "
    "frame,point,x,y (docs/perceive.md, Wide tables)";

static const char no_header_advice[] =
    "numbers, but no header; the first line must name the columns: frame,point,x,y";

enum { NAME_BYTES = 40 };

/* Which name of x goes with which name of y. */
enum family { NONE, PLAIN, PIXELS, POS_X, X_POS, POSITION_X, X_POSITION };

/* The smaller the rank, the higher the priority: if a file has several, the first counts; two of
 * the same rank are refused. */
static const struct name {
    const char *text;
    enum grrl_column column;
    int rank;
    enum family family;
} names[] = {
    {"frame", GRRL_COLUMN_FRAME, 1, NONE},
    {"frame_id", GRRL_COLUMN_FRAME, 2, NONE},
    {"frame_idx", GRRL_COLUMN_FRAME, 2, NONE},
    {"frame_index", GRRL_COLUMN_FRAME, 2, NONE},
    {"frame_no", GRRL_COLUMN_FRAME, 2, NONE},
    {"frame_number", GRRL_COLUMN_FRAME, 2, NONE},
    {"time_index", GRRL_COLUMN_FRAME, 3, NONE},
    {"time_step", GRRL_COLUMN_FRAME, 3, NONE},
    {"timestep", GRRL_COLUMN_FRAME, 3, NONE},
    {"image_id", GRRL_COLUMN_FRAME, 3, NONE},
    {"slice", GRRL_COLUMN_FRAME, 3, NONE},
    {"t", GRRL_COLUMN_FRAME, 4, NONE},
    {"time", GRRL_COLUMN_FRAME, 4, NONE},
    {"point", GRRL_COLUMN_POINT, 1, NONE},
    {"point_id", GRRL_COLUMN_POINT, 2, NONE},
    {"track", GRRL_COLUMN_POINT, 2, NONE},
    {"track_id", GRRL_COLUMN_POINT, 2, NONE},
    {"trackid", GRRL_COLUMN_POINT, 2, NONE},
    {"trajectory", GRRL_COLUMN_POINT, 2, NONE},
    {"particle", GRRL_COLUMN_POINT, 2, NONE},
    {"particle_id", GRRL_COLUMN_POINT, 2, NONE},
    {"feature", GRRL_COLUMN_POINT, 2, NONE},
    {"feature_id", GRRL_COLUMN_POINT, 2, NONE},
    {"marker", GRRL_COLUMN_POINT, 2, NONE},
    {"marker_id", GRRL_COLUMN_POINT, 2, NONE},
    {"id", GRRL_COLUMN_POINT, 3, NONE},
    {"label", GRRL_COLUMN_POINT, 4, NONE},
    {"x", GRRL_COLUMN_X, 1, PLAIN},
    {"y", GRRL_COLUMN_Y, 1, PLAIN},
    {"x_px", GRRL_COLUMN_X, 1, PIXELS},
    {"y_px", GRRL_COLUMN_Y, 1, PIXELS},
    {"pos_x", GRRL_COLUMN_X, 2, POS_X},
    {"pos_y", GRRL_COLUMN_Y, 2, POS_X},
    {"x_pos", GRRL_COLUMN_X, 2, X_POS},
    {"y_pos", GRRL_COLUMN_Y, 2, X_POS},
    {"position_x", GRRL_COLUMN_X, 2, POSITION_X},
    {"position_y", GRRL_COLUMN_Y, 2, POSITION_X},
    {"x_position", GRRL_COLUMN_X, 2, X_POSITION},
    {"y_position", GRRL_COLUMN_Y, 2, X_POSITION},
    {"visible", GRRL_COLUMN_VISIBLE, 1, NONE},
    {"visibility", GRRL_COLUMN_VISIBLE, 2, NONE},
    {"is_visible", GRRL_COLUMN_VISIBLE, 2, NONE},
    {"occluded", GRRL_COLUMN_VISIBLE, 3, NONE},
    {"is_occluded", GRRL_COLUMN_VISIBLE, 3, NONE},
    {"lost", GRRL_COLUMN_VISIBLE, 3, NONE},
    {"is_lost", GRRL_COLUMN_VISIBLE, 3, NONE},
};

enum { N_NAMES = sizeof names / sizeof names[0], OCCLUDED_RANK = 3 };

/* In lower case, with _ for blanks, dots and dashes: Track ID becomes track_id. */
static void normalise(const char *text, char *name)
{
    size_t n = 0;
    for (; text[n] != '\0' && n + 1 < NAME_BYTES; n++)
        name[n] = strchr(" .-", text[n]) != NULL ? '_' : (char)tolower((unsigned char)text[n]);
    name[n] = '\0';
}

static const struct name *name_of(const char *text)
{
    char name[NAME_BYTES];
    normalise(text, name);
    for (size_t i = 0; i < N_NAMES; i++)
        if (strcmp(names[i].text, name) == 0 && strlen(text) < NAME_BYTES)
            return &names[i];
    return NULL;
}

/* One of several: x1, x_1, nose_x, nose.x for the axis x. */
static bool is_one_of_many(const char *text, char axis)
{
    char name[NAME_BYTES];
    normalise(text, name);
    size_t n = strlen(name);
    if (n < 2)
        return false;
    const char *digits = name + 1 + (name[1] == '_');
    bool counted =
        name[0] == axis && *digits != '\0' && strspn(digits, "0123456789") == strlen(digits);
    bool named = name[n - 1] == axis && (name[n - 2] == '_' || isdigit((unsigned char)name[n - 2]));
    return counted || named;
}

static bool is_wide(const struct grrl_csv_field *fields, int n)
{
    int many[2] = {0, 0};
    for (int i = 0; i < n; i++) {
        many[0] += is_one_of_many(fields[i].text, 'x');
        many[1] += is_one_of_many(fields[i].text, 'y');
    }
    return many[0] > 1 && many[1] > 1;
}

static bool is_number(const char *text)
{
    char *end;
    (void)strtod(text, &end);
    return end != text && *end == '\0';
}

static bool has_no_header(const struct grrl_csv_field *fields, int n)
{
    for (int i = 0; i < n; i++)
        if (!is_number(fields[i].text))
            return false;
    return n > 1;
}

static bool check_shape(struct grrl_csv *csv, const struct grrl_csv_field *fields, int n,
                        const struct grrl_columns *columns)
{
    static const char *const missing[] = {
        "the column frame is missing", "the column point is missing",
        "the column x or x_px is missing", "the column y or y_px is missing"};
    char first[NAME_BYTES];
    normalise(fields[0].text, first);
    if (strcmp(first, "scorer") == 0)
        return grrl_csv_fail(csv, 1, wide_advice, "DeepLabCut, three header rows");
    if (has_no_header(fields, n))
        return grrl_csv_fail(csv, 1, no_header_advice, "");
    const int *place = columns->place;
    bool lacks_position =
        place[GRRL_COLUMN_X] == GRRL_COLUMN_ABSENT || place[GRRL_COLUMN_Y] == GRRL_COLUMN_ABSENT;
    if (lacks_position && is_wide(fields, n))
        return grrl_csv_fail(csv, 1, wide_advice, "");
    for (int i = GRRL_COLUMN_FRAME; i <= GRRL_COLUMN_Y; i++)
        if (place[i] == GRRL_COLUMN_ABSENT)
            return grrl_csv_fail(csv, 1, grrl_columns_advice, missing[i]);
    return true;
}

static bool check_pair(struct grrl_csv *csv, const struct grrl_csv_field *y,
                       const struct name *of_x, const struct name *of_y)
{
    if (of_x->family == of_y->family)
        return true;
    bool pixels = of_x->family == PIXELS || of_y->family == PIXELS;
    return grrl_csv_fail(csv, y->column,
                         pixels ? "one of x and y is in pixels, the other is not"
                                : "this name does not match that of the x column",
                         y->text);
}

bool grrl_columns_find(struct grrl_csv *csv, struct grrl_columns *columns)
{
    struct grrl_csv_field fields[GRRL_CSV_MAX_FIELDS];
    const struct name *taken[GRRL_COLUMNS] = {NULL};
    grrl_csv_find_separator(csv);
    int n = grrl_csv_split(csv, fields);
    if (n < 0)
        return false;
    *columns = (struct grrl_columns){.n_fields = n};
    for (int i = 0; i < GRRL_COLUMNS; i++)
        columns->place[i] = GRRL_COLUMN_ABSENT;
    const struct grrl_csv_field *twice[GRRL_COLUMNS] = {NULL};
    for (int i = 0; i < n; i++) {
        const struct name *name = name_of(fields[i].text);
        if (name == NULL)
            continue;
        const struct name **best = &taken[name->column];
        if (*best == NULL || name->rank < (*best)->rank) {
            *best = name;
            columns->place[name->column] = i;
            twice[name->column] = NULL;
        } else if (name->rank == (*best)->rank && twice[name->column] == NULL) {
            twice[name->column] = &fields[i];
        }
    }
    for (int i = 0; i < GRRL_COLUMNS; i++)
        if (twice[i] != NULL)
            return grrl_csv_fail(csv, twice[i]->column, "another column has the same meaning",
                                 twice[i]->text);
    if (!check_shape(csv, fields, n, columns) ||
        !check_pair(csv, &fields[columns->place[GRRL_COLUMN_Y]], taken[GRRL_COLUMN_X],
                    taken[GRRL_COLUMN_Y]))
        return false;
    columns->in_pixels = taken[GRRL_COLUMN_X]->family == PIXELS;
    columns->occluded =
        taken[GRRL_COLUMN_VISIBLE] != NULL && taken[GRRL_COLUMN_VISIBLE]->rank == OCCLUDED_RANK;
    return true;
}
