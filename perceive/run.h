/*
 * run.h: perception on a whole recording; what grrl-perceive and the Python package share.
 */
#ifndef GRRL_PERCEIVE_RUN_H
#define GRRL_PERCEIVE_RUN_H

#include "camera.h"
#include "rectify.h"
#include "report.h"
#include "solids.h"
#include "tracks.h"
#include "warnings.h"

#include "grrl/grrl.h"

enum grrl_unit { GRRL_UNIT_AS_IN_FILE, GRRL_UNIT_M, GRRL_UNIT_MM, GRRL_UNIT_PX };

enum grrl_profile { GRRL_PROFILE_OF_UNIT, GRRL_PROFILE_TRACKER, GRRL_PROFILE_CAMERA };

enum {
    GRRL_RUN_TERM_NODES = 4 * GRRL_MAX_LINKS + 8 * GRRL_MAX_JOINTS + 8,
    GRRL_RUN_TERM_BYTES = 32 * GRRL_RUN_TERM_NODES
};

/* Links at least this long are labelled large, as for the learner. */
#define GRRL_RUN_LARGE_M 0.15f

struct grrl_run_config {
    enum grrl_unit unit;       /* of the recording; AS_IN_FILE: pixels if it says so, else metres */
    bool unit_said;            /* the user or the format named it: no doubt about it */
    enum grrl_profile profile; /* OF_UNIT: the camera for pixels */
    float noise;               /* of a point, in that unit; 0: as the profile has it */
    bool noise_from_points;    /* estimate it from all frames */

    /* NULL, or how the pixels of the recording map to the table; unit (m or mm) is then that of the
     * table, of noise and of the answer. */
    const struct grrl_rectify *rectify;
};

enum grrl_run_result {
    GRRL_RUN_FINE,
    GRRL_RUN_NO_PIXELS,     /* the profile camera needs pixels */
    GRRL_RUN_FEW_FOR_NOISE, /* noise_from_points: too few points in three frames in a row */
    GRRL_RUN_NO_NOISE,      /* noise_from_points: they do not scatter, or are rounded */
    GRRL_RUN_BAD_NOISE,     /* noise is out of range */
    GRRL_RUN_TOO_FAR,       /* every point lies too far from the origin */
    GRRL_RUN_BEYOND,        /* rectify: every point lies beyond the horizon of the table */
    GRRL_RUN_NOTHING_SEEN,  /* no point is visible in any frame */
    GRRL_RUN_OUT_OF_MEMORY,
    GRRL_RUN_FAILED /* status says why */
};

/* Some hundred KiB: static or on the heap. It must not be copied: report points into it. */
struct grrl_run {
    struct grrl_report report;  /* once the run was fine: as the picture shows it, */
    struct grrl_report upright; /* and with what the camera added undone, for motion.h */
    enum grrl_status status;

    /* private */
    struct grrl_perception perception;
    struct grrl_perception rigid;
    struct grrl_camera camera;
    struct grrl_model joined; /* the model after solids were joined */
    struct grrl_solids solids;
    struct grrl_model picture;
    struct grrl_noise noise;
    struct grrl_warnings warnings;
    struct grrl_term_node nodes[GRRL_RUN_TERM_NODES];
    char term[GRRL_RUN_TERM_BYTES];
};

/* The name of a unit, and its metres; the library gets a pixel as a millimetre. */
struct grrl_scale {
    const char *name;
    float metres;
};

struct grrl_scale grrl_unit_scale(enum grrl_unit unit, bool in_pixels);

/*
 * Perceives a recording and fills run->report. The tracks come in the unit of config and are left
 * in metres, without tracks beyond the capacity; the report refers to them.
 */
enum grrl_run_result grrl_run_tracks(struct grrl_run *run, const struct grrl_run_config *config,
                                     struct grrl_tracks *tracks);

#endif
