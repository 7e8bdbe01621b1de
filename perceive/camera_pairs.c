/* camera_pairs.c: samples a recording, and pairs points that probably move together. */
#include "camera_pairs.h"

#include <math.h>
#include <stdlib.h>

/* Frames in which two points must have been seen to be a pair. */
enum { LEAST_FRAMES = 4 };

/* A pair is judged by the change of its distance plus this many standard deviations of noise. */
#define NOISE_WEIGHT 3.0

/* Of the tracks, at most one in so many is a neighbour: the others may be on another body. */
enum { NEIGHBOUR_SHARE = 4 };

static void sample_frames(const struct grrl_tracks *tracks, struct grrl_camera_pairs *pairs)
{
    size_t n = tracks->n_frames < GRRL_CAMERA_FRAMES ? tracks->n_frames : GRRL_CAMERA_FRAMES;
    pairs->n_frames = (uint32_t)n;
    for (size_t m = 0; m < n; m++)
        pairs->frame[m] = n > 1 ? m * (tracks->n_frames - 1) / (n - 1) : 0;
}

/* Takes every n-th track, so that they fit, with its positions in the sampled frames. */
static void sample_tracks(const struct grrl_tracks *tracks, const struct grrl_tracks_sample *sample,
                          struct grrl_vec2 centre, struct grrl_camera_pairs *pairs)
{
    size_t n_tracks = 0;
    size_t end;
    for (size_t i = 0; i < tracks->n_points; i = grrl_tracks_end(sample, tracks->n_points, i))
        n_tracks++;
    size_t stride = (n_tracks + GRRL_CAMERA_TRACKS - 1) / GRRL_CAMERA_TRACKS;
    size_t t = 0;
    pairs->n_tracks = 0;
    for (size_t first = 0; first < tracks->n_points; first = end, t++) {
        end = grrl_tracks_end(sample, tracks->n_points, first);
        if (t % stride != 0)
            continue;
        uint32_t m = 0;
        for (size_t i = first; i < end; i++) {
            while (m < pairs->n_frames && pairs->frame[m] < sample[i].frame)
                m++;
            if (m < pairs->n_frames && pairs->frame[m] == sample[i].frame) {
                pairs->seen[m][pairs->n_tracks] = true;
                pairs->at[m][pairs->n_tracks] = (struct grrl_vec2){
                    tracks->x[sample[i].at] - centre.x, tracks->y[sample[i].at] - centre.y};
            }
        }
        pairs->n_tracks++;
    }
}

/* How unlikely it is that a and b are on one body: the relative change of their distance, or the
 * distance itself while the size of the image is not known. HUGE_VAL: they were hardly ever seen
 * together. */
static double unlike(const struct grrl_camera_pairs *pairs,
                     struct grrl_vec2 (*at)[GRRL_CAMERA_TRACKS], uint32_t a, uint32_t b,
                     double noise, bool size_known)
{
    double n = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (uint32_t m = 0; m < pairs->n_frames; m++) {
        if (!pairs->seen[m][a] || !pairs->seen[m][b])
            continue;
        double d = (double)grrl_vec2_length(grrl_vec2_sub(at[m][a], at[m][b])) + 1e-9;
        n += 1.0;
        sum += d;
        squares += d * d;
    }
    if (n < LEAST_FRAMES)
        return HUGE_VAL;
    double mean = sum / n;
    double variance = squares / n - mean * mean;
    if (!size_known)
        return mean;
    return (sqrt(variance > 0.0 ? variance : 0.0) + NOISE_WEIGHT * noise) / mean;
}

/* Pairs track a with those that are most likely on its body. */
static void add_pairs(struct grrl_camera_pairs *pairs, struct grrl_vec2 (*at)[GRRL_CAMERA_TRACKS],
                      uint32_t a, double noise, bool size_known)
{
    double score[GRRL_CAMERA_NEIGHBOURS];
    uint16_t best[GRRL_CAMERA_NEIGHBOURS];
    uint32_t most = pairs->n_tracks / NEIGHBOUR_SHARE;
    most = most < GRRL_CAMERA_NEIGHBOURS ? most : GRRL_CAMERA_NEIGHBOURS;
    uint32_t n = 0;
    for (uint32_t b = 0; b < pairs->n_tracks && most > 0; b++) {
        double s = a == b ? HUGE_VAL : unlike(pairs, at, a, b, noise, size_known);
        if (!isfinite(s) || (n == most && s >= score[n - 1]))
            continue;
        uint32_t place = n < most ? n++ : n - 1;
        for (; place > 0 && score[place - 1] > s; place--) {
            score[place] = score[place - 1];
            best[place] = best[place - 1];
        }
        score[place] = s;
        best[place] = (uint16_t)b;
    }
    for (uint32_t i = 0; i < n; i++) {
        pairs->a[pairs->n_pairs] = (uint16_t)a;
        pairs->b[pairs->n_pairs++] = best[i];
    }
}

bool grrl_camera_pairs_find(const struct grrl_tracks *tracks, struct grrl_vec2 centre,
                            struct grrl_camera_pairs *pairs)
{
    *pairs = (struct grrl_camera_pairs){0};
    struct grrl_tracks_sample *sample = grrl_tracks_by_id(tracks);
    if (sample == NULL)
        return tracks->n_points == 0;
    sample_frames(tracks, pairs);
    sample_tracks(tracks, sample, centre, pairs);
    free(sample);
    return true;
}

void grrl_camera_pairs_choose(struct grrl_camera_pairs *pairs,
                              struct grrl_vec2 (*at)[GRRL_CAMERA_TRACKS], float noise,
                              bool size_known)
{
    pairs->n_pairs = 0;
    for (uint32_t a = 0; a < pairs->n_tracks; a++)
        add_pairs(pairs, at, a, (double)noise, size_known);
}
