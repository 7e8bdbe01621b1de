/*
 * grrl-perceive: links and joints from tracked points, without a robot.
 *
 * Exit status: 0 fine, 1 the input is wrong or cannot be read, 2 wrong command line.
 */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "handle.h"
#include "motion.h"
#include "options.h"
#include "report.h"
#include "run.h"
#include "tracks.h"

#include "grrl/grrl.h"

enum { EXIT_FINE = 0, EXIT_INPUT = 1 };
static int fail(const char *what)
{
    (void)fprintf(stderr, "grrl-perceive: %s\n", what);
    return EXIT_INPUT;
}

static FILE *open_input(const char *path)
{
    FILE *file = strcmp(path, "-") == 0 ? stdin : fopen(path, "r");
    if (file == NULL)
        (void)fprintf(stderr, "grrl-perceive: %s: %s\n", path, strerror(errno));
    return file;
}

/* Closes a file; whether everything was written. */
static bool close_output(FILE *file, const char *path)
{
    bool good = fflush(file) == 0 && ferror(file) == 0;
    good = (file == stdout || fclose(file) == 0) && good;
    if (!good)
        (void)fprintf(stderr, "grrl-perceive: %s: cannot be written: %s\n", path, strerror(errno));
    return good;
}

/* --- a handle --------------------------------------------------------------------------------- */

static int perceive_handle(const struct grrl_perceive_options *options)
{
    struct grrl_scale unit = grrl_unit_scale(options->unit, false);
    struct grrl_tracks_error error;
    struct grrl_handle handle;
    FILE *file = open_input(options->handle);
    if (file == NULL)
        return EXIT_INPUT;
    bool good = grrl_handle_read(file, options->handle, unit.metres, &handle, &error);
    (void)fclose(file);
    if (!good)
        return fail(error.text);
    struct grrl_trajectory_config config;
    grrl_trajectory_config_default(&config);
    if (options->noise > 0.0f)
        config.noise_m = options->noise * unit.metres;
    struct grrl_trajectory_fit fit;
    enum grrl_status status = grrl_trajectory_fit_of(&handle.trajectory, &config, &fit);
    uint32_t n = handle.trajectory.n;
    grrl_handle_free(&handle);
    if (status == GRRL_ERR_NONE)
        return fail("fewer than five samples are near their neighbours; is the unit right? See "
                    "--unit and --noise");
    if (status == GRRL_ERR_NUMBER)
        return fail("a position is beyond 1 km; is the unit right? See --unit");
    if (status != GRRL_OK)
        return fail(grrl_status_text(status));
    grrl_handle_print(stdout, &fit, n, unit.name, 1.0 / (double)unit.metres, options->json);
    return close_output(stdout, "standard output") ? EXIT_FINE : EXIT_INPUT;
}

/* --- tracks ----------------------------------------------------------------------------------- */

static bool read_tracks(const struct grrl_perceive_options *options, struct grrl_tracks *tracks)
{
    struct grrl_tracks_error error;
    bool good;
    if (options->log != NULL) {
        good = grrl_tracks_read_log(options->log, options->trial, tracks, &error);
    } else {
        FILE *file = open_input(options->tracks);
        if (file == NULL)
            return false;
        good = grrl_tracks_read_csv(file, options->tracks, tracks, &error);
        (void)fclose(file);
    }
    if (!good)
        (void)fail(error.text);
    return good;
}

static FILE *open_output(const char *path)
{
    FILE *file = fopen(path, "w");
    if (file == NULL)
        (void)fprintf(stderr, "grrl-perceive: %s: %s\n", path, strerror(errno));
    return file;
}

static bool write_svg(const char *path, const struct grrl_report *report)
{
    FILE *file = open_output(path);
    if (file == NULL)
        return false;
    grrl_report_svg(file, report);
    return close_output(file, path);
}

static bool write_motion(const char *path, const struct grrl_report *report)
{
    FILE *file = open_output(path);
    if (file == NULL)
        return false;
    bool good = grrl_motion_write(file, report);
    if (!good)
        (void)fail("out of memory");
    return close_output(file, path) && good;
}

static int write_report(const struct grrl_perceive_options *options, const struct grrl_run *run)
{
    grrl_warnings_print(stderr, run->report.warnings);
    if (options->svg != NULL && !write_svg(options->svg, &run->report))
        return EXIT_INPUT;
    if (options->motion != NULL && !write_motion(options->motion, &run->upright))
        return EXIT_INPUT;
    (options->json ? grrl_report_json : grrl_report_text)(stdout, &run->report);
    return close_output(stdout, "standard output") ? EXIT_FINE : EXIT_INPUT;
}

static const char *reason(enum grrl_run_result result, enum grrl_status status)
{
    switch (result) {
    case GRRL_RUN_NO_PIXELS:
        return "the profile camera is for pixels: name the columns x_px and y_px, or give --unit "
               "px";
    case GRRL_RUN_FEW_FOR_NOISE:
        return "--noise auto: too few points are visible in three consecutive frames; give --noise "
               "X";
    case GRRL_RUN_NO_NOISE:
        return "--noise auto: the points do not scatter, or are rounded; give --noise X";
    case GRRL_RUN_TOO_FAR:
        return "every point lies too far from the origin: pixels or millimetres? See --unit";
    case GRRL_RUN_BEYOND:
        return "--rectify: every point lies beyond the horizon of the table; are the four points "
               "right?";
    case GRRL_RUN_NOTHING_SEEN:
        return "no point is visible in any frame";
    case GRRL_RUN_OUT_OF_MEMORY:
        return "out of memory";
    case GRRL_RUN_BAD_NOISE:
        return grrl_status_text(GRRL_ERR_ARGUMENT);
    case GRRL_RUN_FINE:
    case GRRL_RUN_FAILED:
        break;
    }
    return grrl_status_text(status);
}

static int perceive_tracks(const struct grrl_perceive_options *options)
{
    static struct grrl_run run;
    struct grrl_tracks tracks;
    if (!read_tracks(options, &tracks))
        return EXIT_INPUT;
    struct grrl_run_config config = {.unit = options->unit,
                                     .unit_said = options->log != NULL ||
                                                  options->unit != GRRL_UNIT_AS_IN_FILE,
                                     .profile = options->profile,
                                     .noise = options->noise,
                                     .noise_from_points = options->noise_from_points,
                                     .rectify = options->rectifies ? &options->rectify : NULL};
    enum grrl_run_result result = grrl_run_tracks(&run, &config, &tracks);
    int status =
        result == GRRL_RUN_FINE ? write_report(options, &run) : fail(reason(result, run.status));
    grrl_tracks_free(&tracks);
    return status;
}

int main(int argc, char **argv)
{
    struct grrl_perceive_options options;
    enum grrl_options_result parsed = grrl_perceive_options_parse(argc, argv, &options);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    return options.handle != NULL ? perceive_handle(&options) : perceive_tracks(&options);
}
