/* report_json.c: the answer for programs. All printed texts are our own (terms, names, units,
 * warnings), so nothing needs escaping. */
#include "report.h"

#include <inttypes.h>

static void print_ids(FILE *file, const struct grrl_model *model, unsigned body)
{
    const char *separator = "";
    (void)fputc('[', file);
    for (unsigned i = 0; i < model->n_features; i++) {
        if (model->feature_body[i] == body) {
            (void)fprintf(file, "%s%d", separator, (int)model->feature_id[i]);
            separator = ", ";
        }
    }
    (void)fputc(']', file);
}

static void print_body(FILE *file, const struct grrl_report *report, unsigned i)
{
    const struct grrl_body *body = &report->model->body[i];
    const double scale = report->per_metre;
    (void)fprintf(file,
                  "    {\"name\": \"f%u\", \"x\": %.6g, \"y\": %.6g, \"length\": %.6g, "
                  "\"width\": %.6g, \"axis\": [%.6g, %.6g], \"solid\": %s,\n     \"features\": ",
                  (unsigned)body->number, (double)body->centroid_m.x * scale,
                  (double)body->centroid_m.y * scale, (double)body->length_m * scale,
                  (double)body->width_m * scale, (double)body->axis.x, (double)body->axis.y,
                  grrl_report_is_solid(report, i) ? "true" : "false");
    print_ids(file, report->model, i);
    (void)fputc('}', file);
}

static void print_joint(FILE *file, const struct grrl_report *report, unsigned i)
{
    const struct grrl_joint *joint = &report->model->joint[i];
    const struct grrl_body *body = report->model->body;
    const double scale = report->per_metre;
    bool slides = joint->type == GRRL_PRISMATIC;
    double to_unit = slides ? scale : 180.0 / (double)GRRL_PI;
    (void)fprintf(file, "    {\"a\": \"f%u\", \"b\": \"f%u\", \"type\": \"%s\",\n",
                  (unsigned)body[joint->a].number, (unsigned)body[joint->b].number,
                  slides ? "prismatic" : "revolute");
    (void)fprintf(file,
                  "     \"probability\": %.6g, \"p_revolute\": %.6g, \"p_prismatic\": %.6g, "
                  "\"p_disconnected\": %.6g,\n",
                  (double)joint->probability, (double)joint->p_revolute, (double)joint->p_prismatic,
                  (double)joint->p_disconnected);
    (void)fprintf(file, "     \"x\": %.6g, \"y\": %.6g, \"covariance\": [%.6g, %.6g, %.6g],\n",
                  (double)joint->point_m.x * scale, (double)joint->point_m.y * scale,
                  (double)joint->point_cov_m2[0] * scale * scale,
                  (double)joint->point_cov_m2[1] * scale * scale,
                  (double)joint->point_cov_m2[2] * scale * scale);
    if (slides)
        (void)fprintf(file, "     \"axis\": [%.6g, %.6g], \"axis_sd_degrees\": %.6g,\n",
                      (double)joint->axis.x, (double)joint->axis.y,
                      (double)joint->axis_sd_rad * 180.0 / (double)GRRL_PI);
    (void)fprintf(file, "     \"lower\": %.6g, \"upper\": %.6g}", (double)joint->lower * to_unit,
                  (double)joint->upper * to_unit);
}

/* The pairs without a joint. */
static void print_pairs(FILE *file, const struct grrl_report *report)
{
    const struct grrl_body *body = report->model->body;
    const char *separator = "\n";
    (void)fputs("  \"pairs\": [", file);
    for (unsigned a = 0; a < report->model->n_bodies; a++) {
        for (unsigned b = a + 1; b < report->model->n_bodies; b++) {
            struct grrl_pair pair;
            const char *relation = grrl_report_relation(report, a, b, &pair);
            if (pair.relation == GRRL_RELATION_JOINED)
                continue;
            (void)fprintf(file,
                          "%s    {\"a\": \"f%u\", \"b\": \"f%u\", \"relation\": \"%s\", "
                          "\"p_revolute\": %.6g, \"p_prismatic\": %.6g, "
                          "\"p_disconnected\": %.6g, \"reason\": \"%s\"}",
                          separator, (unsigned)body[a].number, (unsigned)body[b].number, relation,
                          (double)pair.p_revolute, (double)pair.p_prismatic,
                          (double)pair.p_disconnected, grrl_report_reason(report, &pair).text);
            separator = ",\n";
        }
    }
    (void)fputs(*separator == ',' ? "\n  ],\n" : "],\n", file);
}

static void print_list(FILE *file, const struct grrl_report *report, const char *name, unsigned n,
                       void (*print)(FILE *, const struct grrl_report *, unsigned))
{
    (void)fprintf(file, "  \"%s\": [", name);
    for (unsigned i = 0; i < n; i++) {
        (void)fputs(i == 0 ? "\n" : ",\n", file);
        print(file, report, i);
    }
    (void)fputs(n > 0 ? "\n  ],\n" : "],\n", file);
}

/* What was not used, and why. */
static void print_dropped(FILE *file, const struct grrl_report *report)
{
    const struct grrl_perception_counts *counts = report->counts;
    const struct grrl_tracks_lost *lost = &report->recording->lost;
    const struct grrl_tracks_left_out *out = &report->recording->left_out;
    (void)fprintf(file,
                  "  \"dropped\": {\"outliers\": %u, \"refused\": %u, \"beyond_capacity\": %zu, "
                  "\"lost\": %zu, \"percent\": %.4g},\n",
                  (unsigned)counts->outliers, (unsigned)counts->refused,
                  out->n_points + counts->overflow, lost->marked + lost->frozen + lost->beyond,
                  grrl_report_dropped_percent(report));
    (void)fprintf(
        file,
        "  \"not_visible\": {\"empty\": %zu, \"marked\": %zu, \"frozen\": %zu, \"beyond\": %zu},\n",
        lost->empty, lost->marked, lost->frozen, lost->beyond);
    (void)fprintf(file, "  \"left_out\": {\"tracks\": %zu, \"percent\": %.4g, \"points\": [",
                  out->n, report->tracks > 0 ? 100.0 * (double)out->n / report->tracks : 0.0);
    for (size_t i = 0; i < out->n; i++)
        (void)fprintf(file, "%s%d", i == 0 ? "" : ", ", (int)out->id[i]);
    (void)fputs("]},\n", file);
}

static void print_log(FILE *file, const struct grrl_tracks_log *log)
{
    if (log->n_sessions == 0)
        return;
    (void)fprintf(file,
                  "  \"log\": {\"trial\": %" PRId32 ", \"session\": %" PRId64
                  ", \"sessions\": %" PRIu32 ", \"interleaved\": %s, \"refused\": %" PRIu32
                  ", \"damages\": %" PRIu32 ", \"damaged_bytes\": %" PRId64 ", \"whole\": %s},\n",
                  log->trial, log->session, log->n_sessions, log->interleaved ? "true" : "false",
                  log->refused, log->n_damages, log->damaged_bytes,
                  log->holed || log->unended ? "false" : "true");
}

static void print_warnings(FILE *file, const struct grrl_warnings *warnings)
{
    (void)fputs("  \"warnings\": [", file);
    for (unsigned i = 0; i < warnings->n; i++)
        (void)fprintf(file, "%s\n    \"%s\"", i == 0 ? "" : ",", warnings->text[i]);
    (void)fputs(warnings->n > 0 ? "\n  ],\n" : "],\n", file);
}

void grrl_report_json(FILE *file, const struct grrl_report *report)
{
    const struct grrl_model *model = report->model;
    (void)fprintf(file, "{\n  \"format\": \"grrl-perceive 1\",\n  \"term\": \"%s\",\n",
                  report->term);
    (void)fprintf(file, "  \"unit\": \"%s\", \"profile\": \"%s\", \"noise\": %.6g,\n", report->unit,
                  report->profile, report->noise);
    (void)fprintf(file, "  \"frames\": %u, \"tracks\": %u, \"keyframes\": %u,\n", report->frames,
                  report->tracks, report->keyframes);
    print_dropped(file, report);
    print_log(file, &report->recording->log);
    print_warnings(file, report->warnings);
    print_list(file, report, "bodies", model->n_bodies, print_body);
    print_list(file, report, "joints", model->n_joints, print_joint);
    print_pairs(file, report);
    (void)fputs("  \"background\": ", file);
    print_ids(file, model, GRRL_FEATURE_BACKGROUND);
    (void)fputs(",\n  \"unassigned\": ", file);
    print_ids(file, model, GRRL_FEATURE_NONE);
    (void)fputs("\n}\n", file);
}
