/*
 * grrl-perceive: links and joints from tracked points, without a robot.
 *
 * Exit status: 0 fine, 1 the input is wrong or cannot be read, 2 wrong command line.
 */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "doubts.h"
#include "handle.h"
#include "motion.h"
#include "options.h"
#include "pace.h"
#include "report.h"
#include "tracks.h"

#include "grrl/grrl.h"

enum { EXIT_FINE = 0, EXIT_INPUT = 1 };
enum { TERM_NODES = 4 * GRRL_MAX_LINKS + 8 * GRRL_MAX_JOINTS + 8, TERM_BYTES = 32 * TERM_NODES };

/* Links at least this long are labelled large, as for the learner. */
#define LARGE_M 0.15f

/* A body whose size changes by this share is not planar and at a constant distance from the camera.
 */
#define SIZE_CHANGE 0.05f

/* The library gets a pixel as a millimetre. */
static const float pixel_m = 0.001f;

static struct grrl_perception perception;

struct unit {
    const char *name;
    float metres;
};

static int fail(const char *what)
{
    (void)fprintf(stderr, "grrl-perceive: %s\n", what);
    return EXIT_INPUT;
}

static struct unit unit_of(enum grrl_unit unit, bool in_pixels)
{
    if (unit == GRRL_UNIT_AS_IN_FILE)
        unit = in_pixels ? GRRL_UNIT_PX : GRRL_UNIT_M;
    return unit == GRRL_UNIT_PX   ? (struct unit){"px", pixel_m}
           : unit == GRRL_UNIT_MM ? (struct unit){"mm", 0.001f}
                                  : (struct unit){"m", 1.0f};
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
    struct unit unit = unit_of(options->unit, false);
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

/* The configuration of a profile; *name is its name. */
static struct grrl_perception_config configure(const struct grrl_perceive_options *options,
                                               struct unit unit, const char **name)
{
    struct grrl_perception_config config;
    bool camera = options->profile == GRRL_PROFILE_CAMERA ||
                  (options->profile == GRRL_PROFILE_OF_UNIT && strcmp(unit.name, "px") == 0);
    if (camera)
        grrl_perception_config_camera(&config, pixel_m);
    else
        grrl_perception_config_default(&config);
    if (options->noise > 0.0f)
        config.noise_m = options->noise * unit.metres;
    *name = camera ? "camera" : "tracker";
    return config;
}

static void to_metres(struct grrl_tracks *tracks, struct unit unit)
{
    for (size_t i = 0; i < tracks->n_points; i++) {
        tracks->x[i] *= unit.metres;
        tracks->y[i] *= unit.metres;
    }
}

static struct grrl_frame frame_of(const struct grrl_tracks *tracks, size_t i)
{
    const struct grrl_tracks_frame *in = &tracks->frame[i];
    return (struct grrl_frame){in->n, tracks->id + in->first, tracks->x + in->first,
                               tracks->y + in->first};
}

/* Measures the noise over all frames: a file does not say when things were at rest. */
static bool measure_noise(const struct grrl_tracks *tracks, float *noise_m)
{
    static struct grrl_noise noise;
    grrl_noise_init(&noise);
    for (size_t i = 0; i < tracks->n_frames; i++) {
        struct grrl_frame frame = frame_of(tracks, i);
        grrl_noise_observe(&noise, &frame);
    }
    enum grrl_status status = grrl_noise_estimate(&noise, noise_m);
    if (status == GRRL_ERR_NONE)
        (void)fail(
            "--noise auto: too few points are visible in three consecutive frames; give --noise X");
    else if (status != GRRL_OK)
        (void)fail("--noise auto: the points do not scatter, or are rounded; give --noise X");
    return status == GRRL_OK;
}

/*
 * Replays the recording as pushes: frames at rest are averaged, others become keyframes when
 * something has moved enough. As in the agent, the estimate after each push builds on the previous
 * one. The last frame counts as rest; with only two frames, the push between them was not seen.
 * Ends early if there are more tracks than the library holds.
 */
static enum grrl_status observe(const struct grrl_tracks *tracks)
{
    static const struct grrl_frame unseen = {0};
    for (size_t i = 0; i < tracks->n_frames; i++) {
        struct grrl_frame frame = frame_of(tracks, i);
        if (i == 1 && tracks->n_frames == 2 && tracks->frame[i].pushing)
            grrl_perception_observe(&perception, &unseen, true);
        bool pushing = tracks->frame[i].pushing && i + 1 < tracks->n_frames;
        grrl_perception_observe(&perception, &frame, pushing);
        if (perception.counts.overflow > 0)
            return GRRL_ERR_FULL;
        if (tracks->frame[i].settled) {
            enum grrl_status status = grrl_perception_update(&perception);
            if (status != GRRL_OK && status != GRRL_ERR_NONE) /* nothing seen yet */
                return status;
        }
    }
    return grrl_perception_update(&perception);
}

static enum grrl_status print_term(const struct grrl_model *model, float large_m, char *text,
                                   size_t capacity)
{
    static struct grrl_term_node nodes[TERM_NODES];
    struct grrl_term_store store;
    struct grrl_graph graph;
    struct grrl_name names[GRRL_MAX_LINKS];
    struct grrl_edge edges[GRRL_MAX_JOINTS];
    grrl_term term;
    grrl_term_store_init(&store, nodes, TERM_NODES);
    grrl_relational_state_of(model, large_m, &graph, names, edges);
    enum grrl_status status =
        grrl_graph_to_term(&store, &graph, names, edges, model->n_joints, true, &term);
    return status == GRRL_OK ? grrl_term_print(&store, term, capacity, text, NULL) : status;
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

static int report_model(const struct grrl_perceive_options *options,
                        const struct grrl_tracks *tracks, struct unit unit, const char *profile)
{
    static char term[TERM_BYTES];
    static struct grrl_warnings warnings;
    const struct grrl_model *model = grrl_perception_model(&perception);
    enum grrl_status status = print_term(model, LARGE_M, term, sizeof term);
    if (status != GRRL_OK)
        return fail(grrl_status_text(status));
    double per_metre = 1.0 / (double)unit.metres;
    struct grrl_report report = {.model = model,
                                 .perception = &perception,
                                 .counts = &perception.counts,
                                 .recording = tracks,
                                 .warnings = &warnings,
                                 .term = term,
                                 .unit = unit.name,
                                 .profile = profile,
                                 .per_metre = per_metre,
                                 .noise = (double)perception.config.noise_m * per_metre,
                                 .frames = (unsigned)tracks->n_frames,
                                 .tracks = (unsigned)(grrl_tracks_count_ids(tracks) +
                                                      tracks->left_out.n + tracks->n_renewed),
                                 .keyframes = perception.counts.keyframes_high,
                                 .y_down = strcmp(unit.name, "px") == 0};
    bool said = options->log != NULL || options->unit != GRRL_UNIT_AS_IN_FILE;
    grrl_doubt_input(tracks, &warnings);
    grrl_doubt_unit(tracks, &report, said, &warnings);
    grrl_doubt_losses(&report, &warnings);
    grrl_warnings_print(stderr, &warnings);
    if (options->svg != NULL && !write_svg(options->svg, &report))
        return EXIT_INPUT;
    if (options->motion != NULL && !write_motion(options->motion, &report))
        return EXIT_INPUT;
    (options->json ? grrl_report_json : grrl_report_text)(stdout, &report);
    return close_output(stdout, "standard output") ? EXIT_FINE : EXIT_INPUT;
}

/* Whether the size of a body changes too much for the rigid model. */
static bool sizes_change(void)
{
    const struct grrl_model *model = grrl_perception_model(&perception);
    for (uint8_t b = 0; b < model->n_bodies; b++)
        if (grrl_perception_size_change(&perception, b) > SIZE_CHANGE)
            return true;
    return false;
}

static unsigned unassigned(const struct grrl_model *model)
{
    unsigned n = 0;
    for (uint16_t i = 0; i < model->n_features; i++)
        n += model->feature_body[i] == GRRL_FEATURE_NONE;
    return n;
}

/*
 * If the camera zooms or something approaches it, a rigid body falls into slices. Tries again with
 * bodies that may grow, and keeps that result if it explains as many points with fewer bodies.
 */
static enum grrl_status observe_growing(const struct grrl_perception_config *config,
                                        const struct grrl_tracks *tracks)
{
    static struct grrl_perception rigid;
    struct grrl_perception_config growing = *config;
    if (config->static_background || !sizes_change())
        return GRRL_OK;
    rigid = perception;
    growing.sizes_change = true;
    enum grrl_status status = grrl_perception_init(&perception, &growing);
    status = status == GRRL_OK ? observe(tracks) : status;
    if (status != GRRL_OK ||
        grrl_perception_model(&perception)->n_bodies >= grrl_perception_model(&rigid)->n_bodies ||
        unassigned(grrl_perception_model(&perception)) > unassigned(grrl_perception_model(&rigid)))
        perception = rigid;
    return GRRL_OK;
}

/* More tracks than the library holds: tries again with the most informative ones. */
static enum grrl_status observe_chosen(const struct grrl_perception_config *config,
                                       struct grrl_tracks *tracks)
{
    if (!grrl_tracks_choose(tracks, GRRL_MAX_FEATURES))
        return GRRL_ERR_FULL;
    enum grrl_status status = grrl_perception_init(&perception, config);
    return status == GRRL_OK ? observe(tracks) : status;
}

static int perceive_with(const struct grrl_perception_config *config,
                         const struct grrl_perceive_options *options, struct grrl_tracks *tracks,
                         struct unit unit, const char *profile)
{
    enum grrl_status status = grrl_perception_init(&perception, config);
    status = status == GRRL_OK ? observe(tracks) : status;
    if (perception.counts.overflow > 0)
        status = observe_chosen(config, tracks);
    if (status == GRRL_OK)
        status = observe_growing(config, tracks);
    if (status == GRRL_ERR_NONE && perception.counts.refused > 0)
        return fail("every point lies too far from the origin: pixels or millimetres? See --unit");
    if (status == GRRL_ERR_NONE)
        return fail("no point is visible in any frame");
    if (status != GRRL_OK)
        return fail(grrl_status_text(status));
    return report_model(options, tracks, unit, profile);
}

static int perceive_tracks(const struct grrl_perceive_options *options)
{
    struct grrl_tracks tracks;
    if (!read_tracks(options, &tracks))
        return EXIT_INPUT;
    struct unit unit = unit_of(options->unit, tracks.in_pixels);
    int result = EXIT_INPUT;
    const char *profile;
    if (options->profile == GRRL_PROFILE_CAMERA && strcmp(unit.name, "px") != 0) {
        (void)fail("the profile camera is for pixels: name the columns x_px and y_px, or give "
                   "--unit px");
    } else {
        struct grrl_perception_config config = configure(options, unit, &profile);
        to_metres(&tracks, unit);
        if (options->noise_from_points && !measure_noise(&tracks, &config.noise_m))
            result = EXIT_INPUT;
        else if (!grrl_tracks_join_renewed(&tracks, config.noise_m) ||
                 !grrl_pace_configure(&tracks, &config))
            result = fail("out of memory");
        else
            result = perceive_with(&config, options, &tracks, unit, profile);
    }
    grrl_tracks_free(&tracks);
    return result;
}

int main(int argc, char **argv)
{
    struct grrl_perceive_options options;
    enum grrl_options_result parsed = grrl_perceive_options_parse(argc, argv, &options);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    return options.handle != NULL ? perceive_handle(&options) : perceive_tracks(&options);
}
