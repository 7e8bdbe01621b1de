/* handle.c: reads the trajectory of one point from a text file, prints the answer. */
#define _POSIX_C_SOURCE 200809L

#include "handle.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#include "grrl/base/geometry.h"

struct reader {
    const char *path;
    struct grrl_tracks_error *error;
    float scale;
    size_t line;
    size_t n; /* number of coordinates so far */
    size_t capacity;
    float *value;
    int numbers;    /* per row; 0: no row yet */
    int dimensions; /* of a position in a row */
};

static bool fail(struct reader *reader, int column, const char *what)
{
    (void)snprintf(reader->error->text, sizeof reader->error->text, "%.200s:%zu:%d: %.200s",
                   reader->path, reader->line, column, what);
    return false;
}

static bool add(struct reader *reader, float value)
{
    if (reader->n == reader->capacity) {
        size_t capacity = reader->capacity == 0 ? 1024 : 2 * reader->capacity;
        float *grown = realloc(reader->value, capacity * sizeof *grown);
        if (grown == NULL)
            return fail(reader, 1, "out of memory");
        reader->value = grown;
        reader->capacity = capacity;
    }
    reader->value[reader->n++] = value * reader->scale;
    return true;
}

/* Numbers in a row: two or three are a position, seven a pose. */
enum { MOST = 8, POSE = 7, QUATERNION = 3 };

/* Tolerance of a quaternion's norm: text is rounded. */
#define NORM_SLACK 0.05f

static const char row_advice[] = "a row is x y, x y z or a pose: x y z and a quaternion";

static bool check_count(struct reader *reader, int n, const float *value)
{
    char what[160];
    if (n == POSE) {
        float norm2 = 0.0f;
        for (int i = QUATERNION; i < POSE; i++)
            norm2 += value[i] * value[i];
        return fabsf(sqrtf(norm2) - 1.0f) <= NORM_SLACK ||
               fail(reader, 1,
                    "seven numbers, but the last four are not a quaternion of length 1; a pose is "
                    "x y z and a quaternion");
    }
    if (n == 2 || n == 3)
        return true;
    (void)snprintf(what, sizeof what, "%d number%s%s; %s%s", n, n == 1 ? "" : "s",
                   n == 1 ? " only" : "", row_advice,
                   n == MOST ? " (remove a leading time stamp)" : "");
    return fail(reader, 1, what);
}

static bool read_row(struct reader *reader, const char *line)
{
    static const char blanks[] = " \t\r\n,";
    float value[MOST];
    int n = 0;
    const char *at = line + strspn(line, blanks);
    if (*at == '\0' || *at == '#')
        return true;
    while (*at != '\0') {
        char *end;
        float number = strtof(at, &end);
        int column = (int)(at - line) + 1;
        if (end == at || (*end != '\0' && strchr(blanks, *end) == NULL) || !isfinite(number))
            return fail(reader, column, "not a finite number; a row is x y, x y z or a pose");
        if (n == MOST)
            return fail(reader, column, "a ninth number; a row is x y, x y z or a pose");
        value[n++] = number;
        at = end + strspn(end, blanks);
    }
    if (!check_count(reader, n, value))
        return false;
    if (reader->numbers != 0 && n != reader->numbers) {
        char what[80];
        (void)snprintf(what, sizeof what, "%d numbers, but the rows before have %d", n,
                       reader->numbers);
        return fail(reader, 1, what);
    }
    reader->numbers = n;
    reader->dimensions = n == POSE ? 3 : n;
    for (int i = 0; i < reader->dimensions; i++)
        if (!add(reader, value[i]))
            return false;
    return true;
}

bool grrl_handle_read(FILE *file, const char *path, float scale, struct grrl_handle *handle,
                      struct grrl_tracks_error *error)
{
    struct reader reader = {.path = path, .error = error, .scale = scale};
    char *line = NULL;
    size_t size = 0;
    bool good = true;
    while (good && getline(&line, &size, file) >= 0) {
        reader.line++;
        good = read_row(&reader, line);
    }
    free(line);
    reader.line += good ? 1 : 0;
    if (good && ferror(file))
        good = fail(&reader, 1, strerror(errno));
    size_t rows = reader.dimensions == 0 ? 0 : reader.n / (size_t)reader.dimensions;
    if (good && (rows < GRRL_TRAJECTORY_MIN_SAMPLES || rows > UINT32_MAX))
        good = fail(&reader, 1, "the file ends here; at least five rows x y [z] are needed");
    if (!good) {
        free(reader.value);
        return false;
    }
    handle->rows_m = reader.value;
    handle->trajectory =
        (struct grrl_trajectory){(uint32_t)rows, (uint8_t)reader.dimensions, reader.value};
    return true;
}

void grrl_handle_free(struct grrl_handle *handle)
{
    free(handle->rows_m);
    *handle = (struct grrl_handle){.rows_m = NULL};
}

static const char *name_of(enum grrl_trajectory_answer answer)
{
    static const char *const names[] = {[GRRL_TRAJECTORY_UNDETERMINED] = "undetermined",
                                        [GRRL_TRAJECTORY_REVOLUTE] = "revolute",
                                        [GRRL_TRAJECTORY_PRISMATIC] = "prismatic",
                                        [GRRL_TRAJECTORY_RIGID] = "rigid",
                                        [GRRL_TRAJECTORY_NEITHER] = "neither"};
    return names[answer];
}

/* The probability of the answer; if undetermined, the greatest one. */
static float probability_of(const struct grrl_trajectory_fit *fit)
{
    const float p[] = {fit->revolute.probability, fit->prismatic.probability, fit->p_rigid,
                       fit->p_neither};
    float most = 0.0f;
    for (size_t i = 0; i < sizeof p / sizeof *p; i++)
        most = p[i] > most ? p[i] : most;
    return most;
}

static void print_text(FILE *file, const struct grrl_trajectory_fit *fit, uint32_t n,
                       const char *unit, double scale)
{
    const struct grrl_trajectory_model *r = &fit->revolute;
    const struct grrl_trajectory_model *p = &fit->prismatic;
    (void)fprintf(file, "%s %.3f\n", name_of(fit->answer), (double)probability_of(fit));
    (void)fprintf(file,
                  "  revolute  %.3f: centre (%.4g, %.4g, %.4g), axis (%.3f, %.3f, %.3f), radius "
                  "%.4g %s, %.1f degrees, residual %.2g %s\n",
                  (double)r->probability, (double)r->point_m[0] * scale,
                  (double)r->point_m[1] * scale, (double)r->point_m[2] * scale, (double)r->axis[0],
                  (double)r->axis[1], (double)r->axis[2], (double)fit->radius_m * scale, unit,
                  (double)r->travel * 180.0 / (double)GRRL_PI, (double)r->residual_m * scale, unit);
    (void)fprintf(file,
                  "  prismatic %.3f: through (%.4g, %.4g, %.4g), axis (%.3f, %.3f, %.3f), %.4g "
                  "%s, residual %.2g %s\n",
                  (double)p->probability, (double)p->point_m[0] * scale,
                  (double)p->point_m[1] * scale, (double)p->point_m[2] * scale, (double)p->axis[0],
                  (double)p->axis[1], (double)p->axis[2], (double)p->travel * scale, unit,
                  (double)p->residual_m * scale, unit);
    (void)fprintf(file,
                  "  rigid     %.3f\n  neither   %.3f: slow residuals of the circle %.2g %s\n",
                  (double)fit->p_rigid, (double)fit->p_neither, (double)fit->slow_m * scale, unit);
    (void)fprintf(file,
                  "  %u samples, worth %.3g, %u outliers left out, %.2g %s out of the plane\n",
                  (unsigned)n, (double)fit->effective_samples, (unsigned)fit->outliers,
                  (double)fit->out_of_plane_m * scale, unit);
}

static void print_json_model(FILE *file, const char *name,
                             const struct grrl_trajectory_model *model, double scale)
{
    (void)fprintf(file,
                  "  \"%s\": {\"probability\": %.6g, \"point\": [%.6g, %.6g, %.6g], \"axis\": "
                  "[%.6g, %.6g, %.6g], \"residual\": %.6g, ",
                  name, (double)model->probability, (double)model->point_m[0] * scale,
                  (double)model->point_m[1] * scale, (double)model->point_m[2] * scale,
                  (double)model->axis[0], (double)model->axis[1], (double)model->axis[2],
                  (double)model->residual_m * scale);
}

static void print_json(FILE *file, const struct grrl_trajectory_fit *fit, uint32_t n,
                       const char *unit, double scale)
{
    (void)fprintf(file,
                  "{\n  \"format\": \"grrl-perceive handle 1\",\n  \"type\": \"%s\", \"unit\": "
                  "\"%s\",\n",
                  name_of(fit->answer), unit);
    print_json_model(file, "revolute", &fit->revolute, scale);
    (void)fprintf(file, "\"radius\": %.6g, \"travel_degrees\": %.6g},\n",
                  (double)fit->radius_m * scale,
                  (double)fit->revolute.travel * 180.0 / (double)GRRL_PI);
    print_json_model(file, "prismatic", &fit->prismatic, scale);
    (void)fprintf(file, "\"travel\": %.6g},\n", (double)fit->prismatic.travel * scale);
    (void)fprintf(file, "  \"p_rigid\": %.6g, \"p_neither\": %.6g, \"slow_residual\": %.6g,\n",
                  (double)fit->p_rigid, (double)fit->p_neither, (double)fit->slow_m * scale);
    (void)fprintf(file,
                  "  \"samples\": %u, \"effective_samples\": %.6g, \"outliers\": %u, "
                  "\"out_of_plane\": %.6g\n}\n",
                  (unsigned)n, (double)fit->effective_samples, (unsigned)fit->outliers,
                  (double)fit->out_of_plane_m * scale);
}

void grrl_handle_print(FILE *file, const struct grrl_trajectory_fit *fit, uint32_t n,
                       const char *unit, double per_metre, bool json)
{
    (json ? print_json : print_text)(file, fit, n, unit, per_metre);
}
