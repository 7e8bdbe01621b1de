/* doubts.c: warnings about lost points, units, sizes and damaged logs. */
#include "doubts.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Points whose extent is below this, in standard deviations of the noise, are no basis for an
 * answer. */
#define SMALL_WORLD 20.0

/* Pixels or millimetres within this extent are more likely metres, or normalised. */
#define SMALL_IN_UNITS 3.0

/* For a position converted from its unit to metres and back. */
#define ROUNDING 1e-6

/* From this relative change in size on, the rigid model does not hold. */
#define SIZE_CHANGE 0.05

/* No table is this wide, in metres. */
#define LARGE_WORLD_M 20.0

/* Points that scatter by this many times the noise assumed look like motion: 5% more is chance. */
#define NOISIER 1.3

/* Points that move with no body are told from here on. */
enum { LEAST_STRAYS = 2 };

/* --- the input -------------------------------------------------------------------------------- */

static void doubt_lost(const struct grrl_tracks *tracks, struct grrl_warnings *warnings)
{
    const struct grrl_tracks_lost *lost = &tracks->lost;
    size_t all = tracks->n_points + lost->empty + lost->marked + lost->frozen + lost->beyond;
    if (lost->empty > 0)
        grrl_warn(warnings, "%zu of %zu positions are empty or NaN: taken as not visible",
                  lost->empty, all);
    if (lost->marked > 0)
        grrl_warn(warnings,
                  "%zu of %zu positions are exactly (0, 0) or (-1, -1), in tracks that jump there: "
                  "taken as not visible",
                  lost->marked, all);
    if (lost->frozen > 0)
        grrl_warn(warnings,
                  "%zu of %zu positions repeat the previous one exactly while other points "
                  "scatter: taken as not visible",
                  lost->frozen, all);
    if (lost->beyond > 0)
        grrl_warn(
            warnings,
            "%zu of %zu positions are beyond the horizon of the table: left out; are the four "
            "points right?",
            lost->beyond, all);
}

static void doubt_damage(const struct grrl_tracks_log *log, struct grrl_warnings *warnings)
{
    char where[120];
    if (log->whole_at == log->size)
        (void)snprintf(where, sizeof where,
                       "the log is cut off or damaged from byte %" PRId64 " to its end",
                       log->damaged_at);
    else if (log->whole_at == log->damaged_at)
        (void)snprintf(where, sizeof where, "the log lacks events before byte %" PRId64,
                       log->damaged_at);
    else
        (void)snprintf(where, sizeof where,
                       "the log is damaged at byte %" PRId64 " and whole again at byte %" PRId64,
                       log->damaged_at, log->whole_at);
    if (log->n_damages > 1)
        grrl_warn(warnings, "%s, and in %" PRIu32 " more places; %" PRId64 " bytes are lost in all",
                  where, log->n_damages - 1, log->damaged_bytes);
    else
        grrl_warn(warnings, "%s; %" PRId64 " bytes are lost", where, log->damaged_bytes);
    grrl_warn(warnings, "trial %" PRId32 " is read, %s", log->trial,
              log->holed ? "and frames of it may be lost there"
                         : "which the damage does not affect");
}

static void doubt_log(const struct grrl_tracks_log *log, struct grrl_warnings *warnings)
{
    if (log->refused > 0)
        grrl_warn(warnings, "%" PRIu32 " damaged messages left out", log->refused);
    if (log->interleaved)
        grrl_warn(warnings,
                  "messages of %" PRIu32 " sessions are mixed: two senders, or logs merged; only "
                  "session %" PRId64 ", which has the most, is read",
                  log->n_sessions, log->session);
    else if (log->n_sessions > 1)
        grrl_warn(warnings,
                  "%" PRIu32 " sessions, one after the other; only session %" PRId64
                  ", the last, is read",
                  log->n_sessions, log->session);
    if (log->n_damages > 0)
        doubt_damage(log, warnings);
    if (log->unended)
        grrl_warn(warnings, "the log has no end of trial %" PRId32 ": it may be a part of it",
                  log->trial);
}

void grrl_doubt_input(const struct grrl_tracks *tracks, struct grrl_warnings *warnings)
{
    doubt_lost(tracks, warnings);
    if (tracks->n_renewed > 0)
        grrl_warn(warnings,
                  "%zu tracks begin where others ended: taken as the same points with new ids",
                  tracks->n_renewed);
    doubt_log(&tracks->log, warnings);
}

/* --- the unit --------------------------------------------------------------------------------- */

void grrl_doubt_unit(const struct grrl_tracks *tracks, const struct grrl_report *report, bool said,
                     struct grrl_warnings *warnings)
{
    double low[2] = {HUGE_VAL, HUGE_VAL};
    double high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < tracks->n_points; i++) {
        const double at[2] = {(double)tracks->x[i] * report->per_metre,
                              (double)tracks->y[i] * report->per_metre};
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = fmin(low[axis], at[axis]);
            high[axis] = fmax(high[axis], at[axis]);
        }
    }
    double extent = fmax(high[0] - low[0], high[1] - low[1]);
    bool metres = strcmp(report->unit, "m") == 0;
    bool in_unit_square = fmin(low[0], low[1]) >= 0.0 && fmax(high[0], high[1]) <= 1.0 + ROUNDING;
    if (tracks->n_points == 0)
        return;
    if (in_unit_square && !(metres && said))
        grrl_warn(warnings,
                  "all points lie within 0 to 1: normalised coordinates? Scale x by the width and "
                  "y by the height of the picture, or give --unit m; is the unit right?");
    else if (extent < SMALL_WORLD * report->noise || (!metres && extent < SMALL_IN_UNITS))
        grrl_warn(warnings,
                  "all points lie within %.3g %s, and the noise is %.3g %s; is the unit right? See "
                  "--unit",
                  extent, report->unit, report->noise, report->unit);
    else if (metres && !said && extent > LARGE_WORLD_M)
        grrl_warn(warnings, "the points lie %.4g m apart: pixels or millimetres? See --unit",
                  extent);
}

/* --- the camera ------------------------------------------------------------------------------- */

void grrl_doubt_camera(const struct grrl_camera *camera, struct grrl_warnings *warnings)
{
    if (camera->zoomed)
        grrl_warn(warnings, "the whole image grows or shrinks by %.0f%%: undone, as a zoom",
                  100.0 * (double)camera->zoom);
    if (camera->tilted)
        grrl_warn(
            warnings,
            "the camera looks at the plane from %.0f degrees aside: undone; lengths are those "
            "at the centre of the image",
            (double)camera->tilt_rad * 180.0 / (double)GRRL_PI);
}

/* --- what was left out ------------------------------------------------------------------------ */

/* Features that moved, but with no body. */
static unsigned count_strays(const struct grrl_model *model)
{
    unsigned n = 0;
    for (unsigned i = 0; i < model->n_features; i++)
        n += model->feature_body[i] == GRRL_FEATURE_NONE;
    return n;
}

void grrl_doubt_noise(const struct grrl_report *report, double noise_m,
                      struct grrl_warnings *warnings)
{
    double noise = noise_m * report->per_metre;
    if (noise > NOISIER * report->noise)
        grrl_warn(
            warnings,
            "the points scatter by %.2g %s from frame to frame, but %.2g is assumed, which can "
            "split bodies: use --noise auto, or --noise X",
            noise, report->unit, report->noise);
}

void grrl_doubt_losses(const struct grrl_report *report, struct grrl_warnings *warnings)
{
    const struct grrl_perception_counts *counts = report->counts;
    const struct grrl_tracks_left_out *out = &report->recording->left_out;
    double percent = grrl_report_dropped_percent(report);
    if (out->n > 0)
        grrl_warn(warnings,
                  "%u tracks, but this build holds %d at a time: %zu (%.0f%%) left out, short ones "
                  "and neighbours first",
                  report->tracks, GRRL_MAX_FEATURES, out->n,
                  100.0 * (double)out->n / (double)report->tracks);
    if (counts->refused > 0)
        grrl_warn(warnings,
                  "%" PRIu32 " points too far from the origin left out; is the unit right? See "
                  "--unit",
                  counts->refused);
    if (percent >= 100.0 / 3.0)
        grrl_warn(warnings, "%.0f%% of the points are not used: see the dropped points", percent);
    for (unsigned b = 0; b < report->model->n_bodies; b++) {
        if (grrl_report_is_solid(report, b)) {
            grrl_warn(warnings,
                      "f%u is a solid that turns out of the image plane or comes near: how it is "
                      "joined to others cannot be told",
                      (unsigned)report->model->body[b].number);
            continue;
        }
        double change =
            (double)grrl_perception_size_change(report->perception, grrl_report_origin(report, b));
        if (change > SIZE_CHANGE)
            grrl_warn(warnings,
                      "the size of f%u changes by %.0f%%: not a plane seen from above at a "
                      "constant distance; bodies and joints are doubtful",
                      (unsigned)report->model->body[b].number, 100.0 * change);
    }
    if (report->model->n_bodies == GRRL_MAX_LINKS)
        grrl_warn(warnings, "%d bodies are the limit of this build; there may be more",
                  GRRL_MAX_LINKS);
    unsigned strays = count_strays(report->model);
    if (strays >= LEAST_STRAYS)
        grrl_warn(
            warnings,
            "%u points move with no body: links of fewer than %u points, or badly tracked ones",
            strays, (unsigned)report->perception->config.min_features);
    unsigned least = 2u * report->perception->config.min_features;
    if (report->tracks < least)
        grrl_warn(warnings,
                  "%u tracks: a link needs at least %u points; fewer are assigned to another link",
                  report->tracks, least / 2);
}
