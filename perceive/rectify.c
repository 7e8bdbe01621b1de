/* rectify.c: the homography that maps four pixels to four positions on the table. */
#include "rectify.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Height of a triangle over its longest side, below which its corners are on a line. */
#define THIN 0.02

/* The horizon: the third coordinate of a pixel over the largest of the four points. */
#define HORIZON 1e-3

typedef double matrix[3][3];

/* --- the option ------------------------------------------------------------------------------- */

static bool parse_number(const char **text, char after, double *value)
{
    char *end;
    *value = strtod(*text, &end);
    bool good = end != *text && !isspace((unsigned char)**text) && isfinite(*value) &&
                (after == '\0' ? *end == '\0' || isspace((unsigned char)*end) : *end == after);
    *text = end + (after != '\0' && good);
    return good;
}

const char *grrl_rectify_parse(const char *text,
                               struct grrl_rectify_point point[GRRL_RECTIFY_POINTS])
{
    static const char right[] =
        "four pixels and their positions on the table, PX,PY=X,Y, with blanks between them, as in "
        "\"12,30=0,300 628,30=400,300 12,450=0,0 628,450=400,0\"";
    unsigned n = 0;
    for (;;) {
        while (isspace((unsigned char)*text))
            text++;
        if (*text == '\0')
            return n == GRRL_RECTIFY_POINTS ? NULL : right;
        struct grrl_rectify_point *p = &point[n];
        if (n++ == GRRL_RECTIFY_POINTS || !parse_number(&text, ',', &p->px[0]) ||
            !parse_number(&text, '=', &p->px[1]) || !parse_number(&text, ',', &p->table[0]) ||
            !parse_number(&text, '\0', &p->table[1]))
            return right;
    }
}

/* --- the homography --------------------------------------------------------------------------- */

/* Twice the signed area. */
static double area(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool thin(const double *a, const double *b, const double *c)
{
    double longest = fmax(hypot(b[0] - a[0], b[1] - a[1]), hypot(c[0] - b[0], c[1] - b[1]));
    longest = fmax(longest, hypot(a[0] - c[0], a[1] - c[1]));
    return !(fabs(area(a, b, c)) > THIN * longest * longest);
}

/* The map from the corners of the projective basis to four points: (1,0,0), (0,1,0), (0,0,1) and
 * (1,1,1). Column i is point i times the area of the triangle of the fourth point and the other
 * two.
 */
static void basis_to(const double *const p[GRRL_RECTIFY_POINTS], matrix m)
{
    const double size[3] = {area(p[3], p[1], p[2]), area(p[0], p[3], p[2]), area(p[0], p[1], p[3])};
    for (int i = 0; i < 3; i++) {
        m[0][i] = size[i] * p[i][0];
        m[1][i] = size[i] * p[i][1];
        m[2][i] = size[i];
    }
}

/* The inverse, up to a factor. */
static void adjugate(matrix m, matrix out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[j][i] = m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
                        m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3];
}

static void multiply(matrix a, matrix b, matrix out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

static double third(const struct grrl_rectify *rectify, double x, double y)
{
    const double *row = rectify->matrix[2];
    return row[0] * x + row[1] * y + row[2];
}

/* The horizon must not pass between the points; their sides of it are positive afterwards. */
static bool find_horizon(const struct grrl_rectify_point point[GRRL_RECTIFY_POINTS],
                         struct grrl_rectify *rectify)
{
    double sign = third(rectify, point[0].px[0], point[0].px[1]) < 0.0 ? -1.0 : 1.0;
    double most = 0.0;
    for (int i = 0; i < 9; i++)
        rectify->matrix[i / 3][i % 3] *= sign;
    for (int i = 0; i < GRRL_RECTIFY_POINTS; i++) {
        double w = third(rectify, point[i].px[0], point[i].px[1]);
        if (!(w > 0.0))
            return false;
        most = fmax(most, w);
    }
    rectify->nearest = HORIZON * most;
    return true;
}

/* The area of all four triangles of four points, of which a convex figure is half. */
static double area_of_all(const double *const p[GRRL_RECTIFY_POINTS])
{
    return fabs(area(p[0], p[1], p[2])) + fabs(area(p[0], p[1], p[3])) +
           fabs(area(p[0], p[2], p[3])) + fabs(area(p[1], p[2], p[3]));
}

const char *grrl_rectify_from(const struct grrl_rectify_point point[GRRL_RECTIFY_POINTS],
                              struct grrl_rectify *rectify)
{
    const double *px[GRRL_RECTIFY_POINTS];
    const double *table[GRRL_RECTIFY_POINTS];
    matrix from_px;
    matrix to_px;
    matrix to_table;
    for (int i = 0; i < GRRL_RECTIFY_POINTS; i++) {
        px[i] = point[i].px;
        table[i] = point[i].table;
    }
    for (int i = 0; i < GRRL_RECTIFY_POINTS; i++) {
        int a = (i + 1) % 4;
        int b = (i + 2) % 4;
        int c = (i + 3) % 4;
        if (thin(px[a], px[b], px[c]) || thin(table[a], table[b], table[c]))
            return "four points, no three of them on a line: the corners of a rectangle";
    }
    basis_to(px, to_px);
    basis_to(table, to_table);
    adjugate(to_px, from_px);
    multiply(to_table, from_px, rectify->matrix);
    rectify->table_per_pixel = sqrt(area_of_all(table) / area_of_all(px));
    return find_horizon(point, rectify)
               ? NULL
               : "four points of one plane seen from one side: does each pixel have its own "
                 "position?";
}

/* --- the tracks ------------------------------------------------------------------------------- */

bool grrl_rectify_tracks(const struct grrl_rectify *rectify, struct grrl_tracks *tracks)
{
    size_t n = tracks->n_points;
    bool *keep = malloc(n + 1);
    if (keep == NULL)
        return false;
    for (size_t i = 0; i < n; i++) {
        const double x = (double)tracks->x[i];
        const double y = (double)tracks->y[i];
        double w = third(rectify, x, y);
        const double(*m)[3] = rectify->matrix;
        keep[i] = w >= rectify->nearest;
        tracks->x[i] = (float)((m[0][0] * x + m[0][1] * y + m[0][2]) / w);
        tracks->y[i] = (float)((m[1][0] * x + m[1][1] * y + m[1][2]) / w);
    }
    grrl_tracks_keep(tracks, keep);
    free(keep);
    tracks->lost.beyond = n - tracks->n_points;
    return true;
}
