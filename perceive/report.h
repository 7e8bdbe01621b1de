/*
 * report.h: the answer as text for people, as JSON for programs and as an SVG picture.
 *
 * Lengths are printed in the unit of the input: one metre is `per_metre` of them.
 */
#ifndef GRRL_PERCEIVE_REPORT_H
#define GRRL_PERCEIVE_REPORT_H

#include <stdbool.h>
#include <stdio.h>

#include "solids.h"
#include "tracks.h"
#include "warnings.h"

#include "grrl/perception/perception.h"

struct grrl_report {
    const struct grrl_model *model;
    const struct grrl_perception *perception; /* that made the model */
    const struct grrl_solids *solids; /* which of its bodies were joined afterwards; NULL: none */
    const struct grrl_perception_counts *counts;
    const struct grrl_tracks *recording; /* in metres, without what was left out */
    const struct grrl_warnings *warnings;
    const char *term;
    const char *unit;    /* "m", "mm" or "px" */
    const char *profile; /* "tracker" or "camera" */
    double per_metre;
    double noise; /* in that unit */
    unsigned frames;
    unsigned tracks;    /* number of ids in the input */
    unsigned keyframes; /* most at a time */
    bool y_down;        /* as in images */
};

/* Whether a body is a solid that turns out of the plane of the image. */
static inline bool grrl_report_is_solid(const struct grrl_report *report, unsigned body)
{
    return report->solids != NULL && report->solids->solid[body];
}

/* The index of a body in the perception that made the model. */
static inline uint8_t grrl_report_origin(const struct grrl_report *report, unsigned body)
{
    return report->solids != NULL ? report->solids->origin[body] : (uint8_t)body;
}

/* The relation of bodies a and b in one word; *pair has the probabilities. */
const char *grrl_report_relation(const struct grrl_report *report, unsigned a, unsigned b,
                                 struct grrl_pair *pair);

/* Why they are undetermined, in words, and what would tell; empty if they are not. */
struct grrl_reason_text {
    char text[160];
};

struct grrl_reason_text grrl_report_reason(const struct grrl_report *report,
                                           const struct grrl_pair *pair);

/* The share of points with a position that are not used: lost, outliers, refused, or in tracks left
 * out. */
double grrl_report_dropped_percent(const struct grrl_report *report);

void grrl_report_text(FILE *file, const struct grrl_report *report);
void grrl_report_json(FILE *file, const struct grrl_report *report);
void grrl_report_svg(FILE *file, const struct grrl_report *report);

#endif
