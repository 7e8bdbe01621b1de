/*
 * camera.c: a zoom and a tilted table, by the distances of points that move together.
 *
 * Zoom: the logarithm of a distance is one of its pair plus one of its frame; medians of either in
 * turn (Tukey's polish) do not see pairs that two bodies share. Tilt: a plane has one rectification
 * for all frames, two numbers for the angle from which it is seen and two for its horizon
 * (Liebowitz and Zisserman 1998), under which rigid bodies keep their distances.
 */
#include "camera.h"

#include <math.h>
#include <stdlib.h>

#include "camera_pairs.h"

/* A picture that changes less is not scaled: rigid bodies stand that. */
#define LEAST_ZOOM 0.05

/* Of the pairs in the frames that differ most, so many must change as the picture does, within so
 * many standard deviations of noise and this share. */
#define ZOOM_AGREE 0.5
#define ZOOM_SIGMAS 3.0
#define ZOOM_SLACK 0.01
enum { LEAST_PAIRS = 24 };

/* Rounds of medians. */
enum { POLISHES = 6 };

/* A table that is tilted less is not rectified; one tilted more is not looked at. */
#define LEAST_TILT_RAD 0.12f
#define MOST_TILT_RAD 0.85f

/* Of the farthest point from the centre, the most that the picture is larger at one end. */
#define MOST_HORIZON 0.5
#define LEAST_HORIZON 0.1

/* Of the cost of the picture as it is, what a tilt must leave at most, and the pairs that must keep
 * their distance under it (count_kept). Without a tilt the best guess left 0.83 of the cost and
 * more, and 0 to 5 pairs (19 once, with 0.95). */
#define TILT_COST 0.85
enum { LEAST_KEPT = 8 };

/* The variance of a distance, in variances of noise, from which on it changes. */
#define CHANGES 4.0

/* The search: where it begins, in natural units, and ends. */
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

/* The logarithm of the size of each sampled frame; size[m] and own[i] are worked out in turn. */
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

/* Whether most pairs have the size of frame m against frame k, as far as noise lets one tell. */
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

/* The picture's size from frame to frame, if it is that of most of what it shows. */
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

/* A rectification: the traceless logarithm of the stretch, and the horizon in units of the reach.
 */
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

/* The variance of a pair's distance over that of noise, seen from above; *mean: the distance. */
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

/* What the search works on. */
struct search {
    struct grrl_camera_pairs *pairs;
    struct grrl_vec2 (*at)[GRRL_CAMERA_TRACKS]; /* seen from above */
    double *length;                             /* of each pair, in the picture */
    double *scattered;                          /* by the last guess */
    double noise;
    double reach;
};

/* Of pairs that two bodies share little depends on the guess: the logarithm sees to that. */
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

/* Tilts by 30 degrees from all sides with the horizon far, or near on either side: the best ones,
 * best first, for the cost has many dips. */
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

/* Hooke and Jeeves (1961): along each axis, then on in the direction that all of it went. */
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

/* The distances of the pairs in the picture, on which the noise counts. */
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

/* Chooses the pairs that a guess keeps best; returns their cost. Two guesses compare fairly only
 * with pairs of their own. */
static double choose_by(const struct search *search, const struct guess *guess)
{
    (void)cost_of(search, guess); /* leaves the positions */
    grrl_camera_pairs_choose(search->pairs, search->at, (float)search->noise, true);
    measure_lengths(search);
    return cost_of(search, guess);
}

/* The guess of least cost over all starts; returns it. First with the pairs of the picture, then
 * with those that the guess keeps. */
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

/* Pairs whose distance changes in the picture and not under the guess. What grows or is no plane
 * costs less under some guess, too, but hardly a pair of it keeps its distance. */
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
    if (good)
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

/* A direction at p, of length 1. */
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
