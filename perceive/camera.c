/*
 * camera.c: finds a zoom and a tilted table from the distances between points on one body.
 *
 * Zoom: the logarithm of a distance is a term of its pair plus a term of its frame. Alternating
 * medians (Tukey's median polish) separate the two and ignore pairs of two bodies. Tilt: a plane
 * has one rectification for all frames, two numbers for the viewing angle and two for the horizon
 * (Liebowitz and Zisserman 1998). Under it rigid bodies keep their distances.
 */
#include "camera.h"

#include <math.h>
#include <stdlib.h>

#include "camera_pairs.h"

/* Smallest change of the image's size that is undone: perception copes with less. */
#define LEAST_ZOOM 0.05

/* Share of the pairs that must change as the image does between the two frames that differ most,
 * within ZOOM_SIGMAS standard deviations of noise and ZOOM_SLACK of their distance. */
#define ZOOM_AGREE 0.5
#define ZOOM_SIGMAS 3.0
#define ZOOM_SLACK 0.01
enum { LEAST_PAIRS = 24 };

/* Rounds of median polish. */
enum { POLISHES = 6 };

/* Tilts below LEAST_TILT_RAD are not undone; the search ends at MOST_TILT_RAD. */
#define LEAST_TILT_RAD 0.12f
#define MOST_TILT_RAD 0.85f

/* Relative change of scale from the centre of the image to its farthest point. */
#define MOST_HORIZON 0.5
#define LEAST_HORIZON 0.1

/* A tilt is accepted if it leaves at most this share of the cost of the original image, and if this
 * many pairs keep their distance under it (count_kept). In images without a tilt the best guess
 * left at least 0.83 of the cost and kept 0 to 5 pairs (once 19, with 0.95). */
#define TILT_COST 0.85
enum { LEAST_KEPT = 8 };

/* Fewer tracks are no basis for the four numbers of a tilt: of hinges with 16 to 22 points, seen
 * from above and without a background, 1 to 17% seemed tilted; with 24 and more, 0 of 200. */
enum { LEAST_TRACKS = 24 };

/* A distance changes if its variance exceeds this many variances of noise. */
#define CHANGES 4.0

/* First and last step of the search; PARAMETERS as in struct guess. */
#define FIRST_STEP 0.1
#define LAST_STEP 0.002
enum { PARAMETERS = 4, DIRECTIONS = 8, STARTS = 2 };

static int by_size(const void *left, const void *right)
{
    double a = *(const double *)left;
    double b = *(const double *)right;
    return a < b ? -1 : a > b;
}

static double median(double *values, size_t n)
{
    qsort(values, n, sizeof *values, by_size);
    return n > 0 ? values[n / 2] : 0.0;
}

static bool sees(const struct grrl_camera_pairs *pairs, uint32_t m, uint32_t i)
{
    return pairs->seen[m][pairs->a[i]] && pairs->seen[m][pairs->b[i]];
}

static double distance(const struct grrl_camera_pairs *pairs, uint32_t m, uint32_t i)
{
    struct grrl_vec2 d = grrl_vec2_sub(pairs->at[m][pairs->a[i]], pairs->at[m][pairs->b[i]]);
    return (double)grrl_vec2_length(d) + 1e-9;
}

static struct grrl_vec2 centre_of(const struct grrl_tracks *tracks, double *reach)
{
    float low[2] = {HUGE_VALF, HUGE_VALF};
    float high[2] = {-HUGE_VALF, -HUGE_VALF};
    for (size_t i = 0; i < tracks->n_points; i++) {
        low[0] = fminf(low[0], tracks->x[i]);
        high[0] = fmaxf(high[0], tracks->x[i]);
        low[1] = fminf(low[1], tracks->y[i]);
        high[1] = fmaxf(high[1], tracks->y[i]);
    }
    *reach = 0.5 * (double)hypotf(high[0] - low[0], high[1] - low[1]) + 1e-9;
    return (struct grrl_vec2){0.5f * (low[0] + high[0]), 0.5f * (low[1] + high[1])};
}

/* --- zoom ------------------------------------------------------------------------------------- */

/* Median polish: size[m] becomes the logarithm of the image's size in sampled frame m, own[i] that
 * of the length of pair i. */
static void polish(const struct grrl_camera_pairs *pairs, double *size, double *own,
                   double *scratch)
{
    for (uint32_t m = 0; m < pairs->n_frames; m++)
        size[m] = 0.0;
    for (int round = 0; round < POLISHES; round++) {
        for (uint32_t i = 0; i < pairs->n_pairs; i++) {
            size_t n = 0;
            for (uint32_t m = 0; m < pairs->n_frames; m++)
                if (sees(pairs, m, i))
                    scratch[n++] = log(distance(pairs, m, i)) - size[m];
            own[i] = median(scratch, n);
        }
        for (uint32_t m = 0; m < pairs->n_frames; m++) {
            size_t n = 0;
            for (uint32_t i = 0; i < pairs->n_pairs; i++)
                if (sees(pairs, m, i))
                    scratch[n++] = log(distance(pairs, m, i)) - own[i];
            size[m] = n > 0 ? median(scratch, n) : m > 0 ? size[m - 1] : 0.0;
        }
    }
}

/* Whether most pairs change their length from frame k to m by `change`, within noise. */
static bool agree(const struct grrl_camera_pairs *pairs, uint32_t k, uint32_t m, double change,
                  double noise)
{
    double all = 0.0;
    double good = 0.0;
    for (uint32_t i = 0; i < pairs->n_pairs; i++) {
        if (!sees(pairs, k, i) || !sees(pairs, m, i))
            continue;
        double from = distance(pairs, k, i);
        double off = log(distance(pairs, m, i) / from) - change;
        all += 1.0;
        good += fabs(off) < ZOOM_SLACK + ZOOM_SIGMAS * 2.0 * noise / from;
    }
    return all >= LEAST_PAIRS && good >= ZOOM_AGREE * all;
}

/* Scales frame f about the centre. */
static void scale_frame(struct grrl_tracks *tracks, size_t f, struct grrl_vec2 centre, float scale)
{
    const struct grrl_tracks_frame *frame = &tracks->frame[f];
    for (size_t i = frame->first; i < frame->first + frame->n; i++) {
        tracks->x[i] = centre.x + scale * (tracks->x[i] - centre.x);
        tracks->y[i] = centre.y + scale * (tracks->y[i] - centre.y);
    }
}

static void scale_frames(struct grrl_tracks *tracks, const struct grrl_camera_pairs *pairs,
                         const double *size, struct grrl_vec2 centre)
{
    double last = size[pairs->n_frames - 1];
    for (uint32_t m = 0; m + 1 < pairs->n_frames; m++) {
        size_t from = pairs->frame[m];
        size_t to = pairs->frame[m + 1];
        for (size_t f = from; f < to; f++) {
            double between = (double)(f - from) / (double)(to - from);
            double at = size[m] + between * (size[m + 1] - size[m]);
            scale_frame(tracks, f, centre, (float)exp(last - at));
        }
    }
}

/* Undoes the change of size from frame to frame if most pairs share it. */
static void undo_zoom(struct grrl_tracks *tracks, const struct grrl_camera_pairs *pairs,
                      double noise, double *own, double *scratch, struct grrl_camera *camera)
{
    double size[GRRL_CAMERA_FRAMES];
    uint32_t least = 0;
    uint32_t most = 0;
    polish(pairs, size, own, scratch);
    for (uint32_t m = 0; m < pairs->n_frames; m++) {
        least = size[m] < size[least] ? m : least;
        most = size[m] > size[most] ? m : most;
    }
    double zoom = size[most] - size[least];
    if (zoom < LEAST_ZOOM || !agree(pairs, least, most, zoom, noise))
        return;
    camera->zoomed = true;
    camera->zoom = (float)(exp(zoom) - 1.0);
    scale_frames(tracks, pairs, size, camera->centre);
}

/* --- tilt ------------------------------------------------------------------------------------- */

/* A rectification: the logarithm of the stretch, which has no trace, and the horizon in units of
 * 1 / reach. */
struct guess {
    double at[PARAMETERS];
};

static void set_view(const struct guess *guess, double reach, struct grrl_camera *camera)
{
    double t = hypot(guess->at[0], guess->at[1]);
    double sinh_t = t > 0.0 ? sinh(t) / t : 1.0;
    camera->stretch[0] = (float)(cosh(t) + sinh_t * guess->at[0]);
    camera->stretch[1] = (float)(sinh_t * guess->at[1]);
    camera->stretch[2] = (float)(cosh(t) - sinh_t * guess->at[0]);
    camera->horizon.x = (float)(guess->at[2] / reach);
    camera->horizon.y = (float)(guess->at[3] / reach);
    camera->tilt_rad = acosf(expf(-2.0f * (float)t));
}

static struct grrl_vec2 upright(const struct grrl_camera *camera, struct grrl_vec2 p)
{
    float w = 1.0f / (1.0f + grrl_vec2_dot(camera->horizon, p));
    return (struct grrl_vec2){w * (camera->stretch[0] * p.x + camera->stretch[1] * p.y),
                              w * (camera->stretch[1] * p.x + camera->stretch[2] * p.y)};
}

/* Variance of a pair's distance, by positions `at`, over that of noise. length: of the pair in the
 * image, to which the noise refers. */
static double scatter(const struct grrl_camera_pairs *pairs,
                      struct grrl_vec2 (*at)[GRRL_CAMERA_TRACKS], uint32_t i, double noise,
                      double length)
{
    double n = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (uint32_t m = 0; m < pairs->n_frames; m++) {
        if (!sees(pairs, m, i))
            continue;
        double d =
            (double)grrl_vec2_length(grrl_vec2_sub(at[m][pairs->a[i]], at[m][pairs->b[i]])) + 1e-9;
        n += 1.0;
        sum += d;
        squares += d * d;
    }
    double mean = sum / n;
    double relative = squares / (n * mean * mean) - 1.0;
    return (relative > 0.0 ? relative : 0.0) * length * length / (2.0 * noise * noise);
}

/* The data of a search. */
struct search {
    struct grrl_camera_pairs *pairs;
    struct grrl_vec2 (*at)[GRRL_CAMERA_TRACKS]; /* seen from above */
    double *length;                             /* mean distance of each pair in the image */
    double noise;
    double reach;
};

/* The cost of a guess. The logarithm limits the influence of pairs of two bodies. */
static double cost_of(const struct search *search, const struct guess *guess)
{
    struct grrl_camera camera = {0};
    double cost = 0.0;
    if (hypot(guess->at[2], guess->at[3]) > MOST_HORIZON)
        return HUGE_VAL;
    set_view(guess, search->reach, &camera);
    if (camera.tilt_rad > MOST_TILT_RAD)
        return HUGE_VAL;
    for (uint32_t m = 0; m < search->pairs->n_frames; m++)
        for (uint32_t t = 0; t < search->pairs->n_tracks; t++)
            if (search->pairs->seen[m][t])
                search->at[m][t] = upright(&camera, search->pairs->at[m][t]);
    for (uint32_t i = 0; i < search->pairs->n_pairs; i++)
        cost += log1p(scatter(search->pairs, search->at, i, search->noise, search->length[i]));
    return cost;
}

/* The best starting points, best first, since the cost has many local minima: tilts by 30 degrees
 * from all sides, with the horizon far away or near on either side. */
static void first_guesses(const struct search *search, struct guess *best)
{
    double least[STARTS];
    for (int k = 0; k < STARTS; k++)
        least[k] = HUGE_VAL;
    for (int i = 0; i < DIRECTIONS * 3; i++) {
        double angle = 2.0 * (double)GRRL_PI * (i / 3) / DIRECTIONS; /* twice that of the axis */
        double horizon = 0.2 * (i % 3 - 1);
        struct guess guess = {{0.07 * cos(angle), 0.07 * sin(angle), -horizon * sin(0.5 * angle),
                               horizon * cos(0.5 * angle)}};
        double cost = cost_of(search, &guess);
        if (cost >= least[STARTS - 1])
            continue;
        int k = STARTS - 1;
        for (; k > 0 && least[k - 1] > cost; k--) {
            least[k] = least[k - 1];
            best[k] = best[k - 1];
        }
        least[k] = cost;
        best[k] = guess;
    }
}

/* Pattern search (Hooke and Jeeves 1961): steps along each axis, then once more along their sum. */
static struct guess search_guess(const struct search *search, struct guess best)
{
    double least = cost_of(search, &best);
    for (double step = FIRST_STEP; step > LAST_STEP;) {
        struct guess from = best;
        struct guess next = best;
        double cost = least;
        for (int i = 0; i < 2 * PARAMETERS; i++) {
            struct guess trial = next;
            trial.at[i / 2] += i % 2 == 0 ? step : -step;
            double c = cost_of(search, &trial);
            if (c < cost) {
                cost = c;
                next = trial;
            }
        }
        if (cost >= least) {
            step *= 0.5;
            continue;
        }
        best = next;
        least = cost;
        for (int i = 0; i < PARAMETERS; i++)
            next.at[i] += next.at[i] - from.at[i];
        cost = cost_of(search, &next);
        if (cost < least) {
            best = next;
            least = cost;
        }
    }
    return best;
}

/* Mean distances of the pairs in the image: the noise is that of the image. */
static void measure_lengths(const struct search *search)
{
    for (uint32_t i = 0; i < search->pairs->n_pairs; i++) {
        double n = 0.0;
        double sum = 0.0;
        for (uint32_t m = 0; m < search->pairs->n_frames; m++) {
            if (sees(search->pairs, m, i)) {
                sum += distance(search->pairs, m, i);
                n += 1.0;
            }
        }
        search->length[i] = sum / n;
    }
}

/* Chooses the pairs whose distances a guess keeps best; returns their cost. A comparison of two
 * guesses is fair only if each has chosen its own pairs. */
static double choose_by(const struct search *search, const struct guess *guess)
{
    (void)cost_of(search, guess); /* for search->at */
    grrl_camera_pairs_choose(search->pairs, search->at, (float)search->noise, true);
    measure_lengths(search);
    return cost_of(search, guess);
}

/* The guess of least cost over all starts; returns the cost. Each search runs with the nearest
 * pairs first and then with those that its guess keeps. */
static double best_guess(const struct search *search, struct guess *best)
{
    struct guess start[STARTS];
    double least = HUGE_VAL;
    grrl_camera_pairs_choose(search->pairs, search->pairs->at, (float)search->noise, false);
    measure_lengths(search);
    first_guesses(search, start);
    for (int k = 0; k < STARTS; k++) {
        grrl_camera_pairs_choose(search->pairs, search->pairs->at, (float)search->noise, false);
        measure_lengths(search);
        struct guess guess = search_guess(search, start[k]);
        (void)choose_by(search, &guess);
        guess = search_guess(search, guess);
        double cost = choose_by(search, &guess);
        if (cost < least) {
            least = cost;
            *best = guess;
        }
    }
    return least;
}

/* Counts the pairs whose distance changes in the image but not under the guess. Some guess lowers
 * the cost of bodies that grow or are not flat, too, but hardly any of their pairs keeps its
 * distance. */
static uint32_t count_kept(const struct search *search, const struct guess *guess)
{
    uint32_t kept = 0;
    (void)cost_of(search, guess);
    for (uint32_t i = 0; i < search->pairs->n_pairs; i++)
        kept +=
            scatter(search->pairs, search->pairs->at, i, search->noise, search->length[i]) >
                CHANGES &&
            scatter(search->pairs, search->at, i, search->noise, search->length[i]) < 0.5 * CHANGES;
    return kept;
}

static void undo_tilt(struct grrl_tracks *tracks, const struct search *search,
                      struct grrl_camera *camera)
{
    struct guess guess = {{0.0}};
    double flat = choose_by(search, &guess);
    double tilted = best_guess(search, &guess);
    (void)choose_by(search, &guess);
    set_view(&guess, search->reach, camera);
    double horizon = hypot(guess.at[2], guess.at[3]);
    camera->tilted = (camera->tilt_rad > LEAST_TILT_RAD || horizon > LEAST_HORIZON) &&
                     tilted < TILT_COST * flat && count_kept(search, &guess) >= LEAST_KEPT;
    for (size_t i = 0; i < tracks->n_points && camera->tilted; i++) {
        struct grrl_vec2 p = {tracks->x[i] - camera->centre.x, tracks->y[i] - camera->centre.y};
        struct grrl_vec2 seen = upright(camera, p);
        tracks->x[i] = camera->centre.x + seen.x;
        tracks->y[i] = camera->centre.y + seen.y;
    }
}

bool grrl_camera_undo(struct grrl_tracks *tracks, float noise, struct grrl_camera *camera)
{
    *camera = (struct grrl_camera){0};
    if (tracks->n_points == 0)
        return true;
    struct search search = {.noise = (double)noise};
    camera->centre = centre_of(tracks, &search.reach);
    search.pairs = malloc(sizeof *search.pairs);
    search.at = malloc(sizeof search.pairs->at);
    search.length = malloc(2 * GRRL_CAMERA_PAIRS * sizeof *search.length);
    bool good = search.pairs != NULL && search.at != NULL && search.length != NULL &&
                grrl_camera_pairs_find(tracks, camera->centre, search.pairs);
    if (good) {
        grrl_camera_pairs_choose(search.pairs, search.pairs->at, noise, false);
        undo_zoom(tracks, search.pairs, search.noise, search.length,
                  search.length + GRRL_CAMERA_PAIRS, camera);
        good = !camera->zoomed || grrl_camera_pairs_find(tracks, camera->centre, search.pairs);
    }
    if (good && search.pairs->n_tracks >= LEAST_TRACKS)
        undo_tilt(tracks, &search, camera);
    free(search.length);
    free(search.at);
    free(search.pairs);
    return good;
}

/* --- back ------------------------------------------------------------------------------------- */

static struct grrl_vec2 in_picture(const struct grrl_camera *camera, struct grrl_vec2 p)
{
    struct grrl_vec2 d = grrl_vec2_sub(p, camera->centre);
    struct grrl_vec2 q = {camera->stretch[2] * d.x - camera->stretch[1] * d.y,
                          -camera->stretch[1] * d.x + camera->stretch[0] * d.y};
    float w = 1.0f / (1.0f - grrl_vec2_dot(camera->horizon, q));
    return grrl_vec2_add(camera->centre, grrl_vec2_scale(q, w));
}

/* The image of a direction at p, as a unit vector; length: that of the segment it is taken from. */
static struct grrl_vec2 axis_in_picture(const struct grrl_camera *camera, struct grrl_vec2 p,
                                        struct grrl_vec2 axis, float length)
{
    struct grrl_vec2 end = grrl_vec2_add(p, grrl_vec2_scale(axis, length));
    struct grrl_vec2 d = grrl_vec2_sub(in_picture(camera, end), in_picture(camera, p));
    float size = grrl_vec2_length(d);
    return size > 0.0f ? grrl_vec2_scale(d, 1.0f / size) : axis;
}

void grrl_camera_to_picture(const struct grrl_camera *camera, const struct grrl_model *model,
                            struct grrl_model *picture)
{
    *picture = *model;
    if (!camera->tilted)
        return;
    for (uint16_t i = 0; i < model->n_features; i++)
        picture->feature_m[i] = in_picture(camera, model->feature_m[i]);
    for (uint8_t b = 0; b < model->n_bodies; b++) {
        const struct grrl_body *body = &model->body[b];
        picture->body[b].centroid_m = in_picture(camera, body->centroid_m);
        picture->body[b].axis =
            axis_in_picture(camera, body->centroid_m, body->axis, 0.5f * body->length_m);
    }
    for (uint8_t j = 0; j < model->n_joints; j++) {
        const struct grrl_joint *joint = &model->joint[j];
        float length = 0.5f * model->body[joint->a].length_m;
        picture->joint[j].point_m = in_picture(camera, joint->point_m);
        if (joint->type == GRRL_PRISMATIC)
            picture->joint[j].axis = axis_in_picture(camera, joint->point_m, joint->axis, length);
    }
}
