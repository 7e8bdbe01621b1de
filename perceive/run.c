/* run.c: the order in which a recording goes through perception. */
#include "run.h"

#include <string.h>

#include "doubts.h"
#include "pace.h"

/* A body whose size changes by this share is not planar and at a constant distance from the camera.
 */
#define SIZE_CHANGE 0.05f

static const float pixel_m = 0.001f;

struct grrl_scale grrl_unit_scale(enum grrl_unit unit, bool in_pixels)
{
    if (unit == GRRL_UNIT_AS_IN_FILE)
        unit = in_pixels ? GRRL_UNIT_PX : GRRL_UNIT_M;
    return unit == GRRL_UNIT_PX   ? (struct grrl_scale){"px", pixel_m}
           : unit == GRRL_UNIT_MM ? (struct grrl_scale){"mm", 0.001f}
                                  : (struct grrl_scale){"m", 1.0f};
}

static void to_metres(struct grrl_tracks *tracks, float metres)
{
    for (size_t i = 0; i < tracks->n_points; i++) {
        tracks->x[i] *= metres;
        tracks->y[i] *= metres;
    }
}

static struct grrl_frame frame_of(const struct grrl_tracks *tracks, size_t i)
{
    const struct grrl_tracks_frame *in = &tracks->frame[i];
    return (struct grrl_frame){in->n, tracks->id + in->first, tracks->x + in->first,
                               tracks->y + in->first};
}

/* Measures the noise over all frames: a file does not say when things were at rest. */
static enum grrl_status measure_noise(struct grrl_noise *noise, const struct grrl_tracks *tracks,
                                      float *noise_m)
{
    grrl_noise_init(noise);
    for (size_t i = 0; i < tracks->n_frames; i++) {
        struct grrl_frame frame = frame_of(tracks, i);
        grrl_noise_observe(noise, &frame);
    }
    return grrl_noise_estimate(noise, noise_m);
}

/*
 * Replays the recording as pushes: frames at rest are averaged, others become keyframes when
 * something has moved enough. As in the agent, the estimate after each push builds on the previous
 * one. The last frame counts as rest; with only two frames, the push between them was not seen.
 * Ends early if there are more tracks than the library holds.
 */
static enum grrl_status observe(struct grrl_perception *perception,
                                const struct grrl_tracks *tracks)
{
    static const struct grrl_frame unseen = {0};
    for (size_t i = 0; i < tracks->n_frames; i++) {
        struct grrl_frame frame = frame_of(tracks, i);
        if (i == 1 && tracks->n_frames == 2 && tracks->frame[i].pushing)
            grrl_perception_observe(perception, &unseen, true);
        bool pushing = tracks->frame[i].pushing && i + 1 < tracks->n_frames;
        grrl_perception_observe(perception, &frame, pushing);
        if (perception->counts.overflow > 0)
            return GRRL_ERR_FULL;
        if (tracks->frame[i].settled) {
            enum grrl_status status = grrl_perception_update(perception);
            if (status != GRRL_OK && status != GRRL_ERR_NONE) /* nothing seen yet */
                return status;
        }
    }
    return grrl_perception_update(perception);
}

static unsigned unassigned(const struct grrl_model *model)
{
    unsigned n = 0;
    for (uint16_t i = 0; i < model->n_features; i++)
        n += model->feature_body[i] == GRRL_FEATURE_NONE;
    return n;
}

/* Whether the size of a body changes by so much that rigid bodies do not hold, or as many points
 * as make a body are in none. */
static bool sizes_change(const struct grrl_perception *perception)
{
    const struct grrl_model *model = grrl_perception_model(perception);
    for (uint8_t b = 0; b < model->n_bodies; b++)
        if (grrl_perception_size_change(perception, b) > SIZE_CHANGE)
            return true;
    return unassigned(model) >= perception->config.min_features;
}

/* Whether bodies that grow explain more than rigid ones: fewer for the points, or more that have
 * enough points each. */
static bool explains_more(const struct grrl_model *growing, const struct grrl_model *rigid,
                          unsigned min_features)
{
    int more_bodies = (int)growing->n_bodies - (int)rigid->n_bodies;
    int more_points = (int)unassigned(rigid) - (int)unassigned(growing);
    return more_bodies < 0 ? more_points >= 0
                           : more_points > 0 && more_points >= 2 * (int)min_features * more_bodies;
}

/*
 * If the camera zooms or something approaches it, a rigid body falls into slices, or points into
 * none. Tries again with bodies that may grow.
 */
static void observe_growing(struct grrl_run *run, const struct grrl_perception_config *config,
                            const struct grrl_tracks *tracks)
{
    struct grrl_perception_config growing = *config;
    if (config->static_background || !(run->camera.zoomed || sizes_change(&run->perception)))
        return;
    run->rigid = run->perception;
    growing.sizes_change = true;
    enum grrl_status status = grrl_perception_init(&run->perception, &growing);
    status = status == GRRL_OK ? observe(&run->perception, tracks) : status;
    const struct grrl_model *grown = grrl_perception_model(&run->perception);
    const struct grrl_model *rigid = grrl_perception_model(&run->rigid);
    if (status != GRRL_OK || !explains_more(grown, rigid, config->min_features))
        run->perception = run->rigid;
}

/* More tracks than the library holds: tries again with the most informative ones. */
static enum grrl_status observe_chosen(struct grrl_run *run,
                                       const struct grrl_perception_config *config,
                                       struct grrl_tracks *tracks)
{
    if (!grrl_tracks_choose(tracks, GRRL_MAX_FEATURES))
        return GRRL_ERR_FULL;
    enum grrl_status status = grrl_perception_init(&run->perception, config);
    return status == GRRL_OK ? observe(&run->perception, tracks) : status;
}

static enum grrl_run_result perceive(struct grrl_run *run,
                                     const struct grrl_perception_config *config,
                                     struct grrl_tracks *tracks)
{
    if (grrl_perception_init(&run->perception, config) != GRRL_OK)
        return GRRL_RUN_BAD_NOISE;
    run->status = observe(&run->perception, tracks);
    if (run->perception.counts.overflow > 0)
        run->status = observe_chosen(run, config, tracks);
    if (run->status == GRRL_OK && tracks->log.size == 0 &&
        grrl_pace_stop_for_two(tracks, config->keyframe_m, run->perception.counts.keyframes_high) &&
        grrl_perception_init(&run->perception, config) == GRRL_OK)
        run->status = observe(&run->perception, tracks);
    if (run->status == GRRL_OK)
        observe_growing(run, config, tracks);
    /* An update divides a body only once. Points in no body are those of solids, or badly tracked:
     * dividing on would only make splinters. */
    if (run->status == GRRL_OK && tracks->log.size == 0 &&
        unassigned(grrl_perception_model(&run->perception)) == 0)
        run->status = grrl_perception_update(&run->perception);
    if (run->status == GRRL_ERR_NONE)
        return run->perception.counts.refused > 0 ? GRRL_RUN_TOO_FAR : GRRL_RUN_NOTHING_SEEN;
    return run->status == GRRL_OK ? GRRL_RUN_FINE : GRRL_RUN_FAILED;
}

static enum grrl_status print_term(struct grrl_run *run, const struct grrl_model *model)
{
    struct grrl_term_store store;
    grrl_term term;
    grrl_term_store_init(&store, run->nodes, GRRL_RUN_TERM_NODES);
    enum grrl_status status = grrl_relational_term_of(model, GRRL_RUN_LARGE_M, &store, &term);
    return status == GRRL_OK ? grrl_term_print(&store, term, sizeof run->term, run->term, NULL)
                             : status;
}

static enum grrl_run_result report(struct grrl_run *run, struct grrl_scale scale,
                                   const struct grrl_run_config *config,
                                   const struct grrl_tracks *tracks, const char *profile)
{
    const struct grrl_perception *perception = &run->perception;
    const struct grrl_model *model = &run->joined;
    double per_metre = 1.0 / (double)scale.metres;
    float noise_m;
    bool solids = !perception->config.static_background; /* above a table all is flat */
    run->joined = *grrl_perception_model(perception);
    if (solids && !grrl_solids_join(tracks, &perception->config, &run->joined, &run->solids))
        return GRRL_RUN_OUT_OF_MEMORY;
    run->status = print_term(run, model);
    if (run->status != GRRL_OK)
        return GRRL_RUN_FAILED;
    run->upright =
        (struct grrl_report){.model = model,
                             .perception = perception,
                             .solids = solids ? &run->solids : NULL,
                             .counts = &perception->counts,
                             .recording = tracks,
                             .warnings = &run->warnings,
                             .term = run->term,
                             .unit = scale.name,
                             .profile = profile,
                             .per_metre = per_metre,
                             .noise = (double)perception->config.noise_m * per_metre,
                             .frames = (unsigned)tracks->n_frames,
                             .tracks = (unsigned)(grrl_tracks_count_ids(tracks) +
                                                  tracks->left_out.n + tracks->n_renewed),
                             .keyframes = perception->counts.keyframes_high,
                             .y_down = strcmp(scale.name, "px") == 0};
    run->warnings.n = 0;
    grrl_doubt_input(tracks, &run->warnings);
    grrl_doubt_camera(&run->camera, &run->warnings);
    grrl_doubt_unit(tracks, &run->upright, config->unit_said || config->rectify != NULL,
                    &run->warnings);
    bool slow = perception->config.push_frames != 1; /* else motion scatters, too */
    if (slow && config->noise == 0.0f && !config->noise_from_points &&
        measure_noise(&run->noise, tracks, &noise_m) == GRRL_OK)
        grrl_doubt_noise(&run->upright, (double)noise_m, &run->warnings);
    grrl_doubt_losses(&run->upright, &run->warnings);
    grrl_camera_to_picture(&run->camera, model, &run->picture);
    run->report = run->upright;
    run->report.model = &run->picture;
    return GRRL_RUN_FINE;
}

enum grrl_run_result grrl_run_tracks(struct grrl_run *run, const struct grrl_run_config *config,
                                     struct grrl_tracks *tracks)
{
    const struct grrl_rectify *rectify = config->rectify;
    struct grrl_scale scale = grrl_unit_scale(config->unit, tracks->in_pixels && rectify == NULL);
    bool pixels = rectify != NULL || strcmp(scale.name, "px") == 0;
    bool camera = config->profile == GRRL_PROFILE_CAMERA ||
                  (config->profile == GRRL_PROFILE_OF_UNIT && pixels);
    if (camera && !pixels)
        return GRRL_RUN_NO_PIXELS;
    struct grrl_perception_config perception;
    if (rectify != NULL && !grrl_rectify_tracks(rectify, tracks))
        return GRRL_RUN_OUT_OF_MEMORY;
    if (tracks->n_points == 0 && tracks->lost.beyond > 0)
        return GRRL_RUN_BEYOND;
    if (camera)
        grrl_perception_config_camera(
            &perception,
            rectify != NULL ? (float)rectify->table_per_pixel * scale.metres : pixel_m);
    else
        grrl_perception_config_default(&perception);
    if (config->noise > 0.0f)
        perception.noise_m = config->noise * scale.metres;
    to_metres(tracks, scale.metres);
    if (config->noise_from_points) {
        run->status = measure_noise(&run->noise, tracks, &perception.noise_m);
        if (run->status != GRRL_OK)
            return run->status == GRRL_ERR_NONE ? GRRL_RUN_FEW_FOR_NOISE : GRRL_RUN_NO_NOISE;
    }
    run->camera = (struct grrl_camera){0};
    if (!grrl_tracks_join_renewed(tracks, perception.noise_m) ||
        (camera && rectify == NULL &&
         !grrl_camera_undo(tracks, perception.noise_m, &run->camera)) ||
        !grrl_pace_configure(tracks, &perception))
        return GRRL_RUN_OUT_OF_MEMORY;
    enum grrl_run_result result = perceive(run, &perception, tracks);
    return result == GRRL_RUN_FINE
               ? report(run, scale, config, tracks, camera ? "camera" : "tracker")
               : result;
}
