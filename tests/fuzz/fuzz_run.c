/*
 * A whole recording as CSV, from its reader to the report: the camera, renewed ids, the choice of
 * tracks and the doubts. The first byte chooses the unit and how the noise is known, and whether a
 * table is rectified. What is answered holds finite numbers and can be printed.
 */
#define _POSIX_C_SOURCE 200809L

#include <math.h>

#include "fuzz.h"
#include "motion.h"
#include "report.h"
#include "run.h"

enum { MAX_BYTES = 1 << 16 };

static struct grrl_run run;

static void check(const struct grrl_report *report)
{
    const struct grrl_model *model = report->model;
    REQUIRE(model->n_bodies <= GRRL_MAX_LINKS && model->n_features <= GRRL_MAX_FEATURES);
    for (unsigned i = 0; i < model->n_features; i++)
        REQUIRE(isfinite(model->feature_m[i].x) && isfinite(model->feature_m[i].y));
    for (unsigned j = 0; j < model->n_joints; j++) {
        REQUIRE(model->joint[j].a < model->n_bodies && model->joint[j].b < model->n_bodies);
        REQUIRE(model->joint[j].p_revolute >= 0.0f && model->joint[j].p_prismatic >= 0.0f);
    }
}

static void print(FILE *nowhere)
{
    grrl_report_text(nowhere, &run.report);
    grrl_report_json(nowhere, &run.report);
    grrl_report_svg(nowhere, &run.report);
    REQUIRE(grrl_motion_write(nowhere, &run.upright));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static FILE *nowhere;
    static uint8_t copy[MAX_BYTES];
    struct grrl_tracks tracks;
    struct grrl_tracks_error error;
    struct grrl_rectify rectify;
    struct grrl_rectify_point point[GRRL_RECTIFY_POINTS];
    if (size < 2 || size > MAX_BYTES)
        return 0;
    nowhere = nowhere == NULL ? fopen("/dev/null", "w") : nowhere;
    REQUIRE(nowhere != NULL);
    struct grrl_run_config config = {.unit = (enum grrl_unit)(data[0] & 3u),
                                     .noise_from_points = (data[0] & 4u) != 0};
    bool rectifies = (data[0] & 8u) != 0 && config.unit != GRRL_UNIT_PX;
    REQUIRE(grrl_rectify_parse("0,0=0,0 640,0=400,0 700,480=400,300 -60,480=0,300", point) == NULL);
    REQUIRE(grrl_rectify_from(point, &rectify) == NULL);
    config.rectify = rectifies ? &rectify : NULL;
    for (size_t i = 1; i < size; i++) /* fmemopen lacks const */
        copy[i - 1] = data[i];
    FILE *file = fmemopen(copy, size - 1, "r");
    REQUIRE(file != NULL);
    if (grrl_tracks_read_csv(file, "input", &tracks, &error)) {
        if (grrl_run_tracks(&run, &config, &tracks) == GRRL_RUN_FINE) {
            check(&run.report);
            check(&run.upright);
            print(nowhere);
        }
        grrl_tracks_free(&tracks);
    }
    (void)fclose(file);
    return 0;
}
