/* solid_frames.c: the frames of a recording that solids are sought in. */
#include "solid_frames.h"

#include <math.h>
#include <string.h>

#include "grrl/base/geometry.h"

/* A point counts if it is seen in this share of the frames. */
#define LEAST_SEEN 0.7

static int index_of(const struct grrl_model *model, int32_t id)
{
    for (int i = 0; i < model->n_features; i++)
        if (model->feature_id[i] == id)
            return i;
    return -1;
}

/* Frames at equal distances, over the whole recording. */
static void read_frames(struct grrl_solid_frames *frames, const struct grrl_tracks *tracks,
                        const struct grrl_model *model)
{
    size_t n = tracks->n_frames < GRRL_VIEWS_FRAMES ? tracks->n_frames : GRRL_VIEWS_FRAMES;
    *frames = (struct grrl_solid_frames){.n = (unsigned)n, .n_features = model->n_features};
    for (size_t f = 0; f < n; f++) {
        const struct grrl_tracks_frame *frame =
            &tracks->frame[n > 1 ? f * (tracks->n_frames - 1) / (n - 1) : 0];
        for (size_t k = frame->first; k < frame->first + frame->n; k++) {
            int i = index_of(model, tracks->id[k]);
            if (i >= 0) {
                frames->at[f][i] = (struct grrl_vec2){tracks->x[k], tracks->y[k]};
                frames->seen[f][i] = true;
            }
        }
    }
}

/* Marks the features that are seen in most of the frames first to end - 1; returns in how many
 * frames they are seen in total. */
static unsigned count_seen(struct grrl_solid_frames *frames, unsigned first, unsigned end)
{
    unsigned total = 0;
    for (unsigned i = 0; i < frames->n_features; i++) {
        unsigned n = 0;
        for (unsigned f = first; f < end; f++)
            n += frames->seen[f][i];
        frames->mostly[i] = n >= LEAST_SEEN * (end - first);
        total += frames->mostly[i] ? n : 0;
    }
    return total;
}

bool grrl_solid_frames_choose(struct grrl_solid_frames *frames, const struct grrl_tracks *tracks,
                              const struct grrl_model *model, unsigned least)
{
    unsigned best = 0;
    unsigned best_first = 0;
    unsigned best_end = 0;
    read_frames(frames, tracks, model);
    for (unsigned first = 0; first < frames->n; first++) {
        for (unsigned end = first + least; end <= frames->n; end++) {
            unsigned total = count_seen(frames, first, end);
            if (total > best) {
                best = total;
                best_first = first;
                best_end = end;
            }
        }
    }
    (void)count_seen(frames, best_first, best_end);
    frames->n = best_end - best_first;
    memmove(frames->at, frames->at + best_first, frames->n * sizeof frames->at[0]);
    memmove(frames->seen, frames->seen + best_first, frames->n * sizeof frames->seen[0]);
    return frames->n >= least;
}

void grrl_solid_frames_view(const struct grrl_solid_frames *frames, const uint16_t *feature,
                            unsigned n, struct grrl_views *views)
{
    views->n_frames = frames->n;
    for (unsigned k = 0; k < n; k++) {
        for (unsigned f = 0; f < frames->n; f++) {
            views->x[f][views->n_points] = (double)frames->at[f][feature[k]].x;
            views->y[f][views->n_points] = (double)frames->at[f][feature[k]].y;
            views->seen[f][views->n_points] = frames->seen[f][feature[k]];
        }
        views->n_points++;
    }
}

double grrl_solid_frames_distance(const struct grrl_solid_frames *frames, uint16_t a, uint16_t b)
{
    double sum = 0.0;
    double n = 0.0;
    for (unsigned f = 0; f < frames->n; f++) {
        if (frames->seen[f][a] && frames->seen[f][b]) {
            sum += (double)grrl_vec2_length(grrl_vec2_sub(frames->at[f][a], frames->at[f][b]));
            n += 1.0;
        }
    }
    return n > 0.0 ? sum / n : HUGE_VAL;
}
