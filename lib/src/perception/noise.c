/*
 * noise.c: a histogram of second differences, and the spread of its middle.
 */
#include "grrl/perception/noise.h"

#include <string.h>

/* Exponent of the first bin, biased by 127: 2^-24 m or 60 nm, below the resolution of a coordinate
 * of one metre in single precision. */
#define FINEST 103

/* Median absolute value of a normal variable in standard deviations: the 75% quantile. */
#define MEDIAN_OF_NORMAL 0.6745f

/* The variance of x1 - 2 x2 + x3 is (1 + 4 + 1) times that of x. */
#define ROOT_6 2.4494897f

/* Differences beyond this are outliers and motion: normal noise exceeds it 6 times in 10^7. */
#define TRIM_SIGMAS 5.0f

#define MAX_SAMPLES UINT32_C(0x7fffffff) /* so that twice as many fit in 32 bits */

enum {
    BITS = 4,   /* 2^BITS bins per octave, 4 to 6% wide each; the median is interpolated */
    ROUNDS = 4, /* of trimming; the median hardly changes after two */
    PROBES = 8  /* slots searched for a track */
};

void grrl_noise_init(struct grrl_noise *noise)
{
    memset(noise, 0, sizeof *noise);
}

/* From the exponent and the leading bits of the number: approximately its logarithm. */
static uint32_t bin_of(float size)
{
    uint32_t bits;
    memcpy(&bits, &size, sizeof bits);
    uint32_t place = bits >> (23 - BITS);
    uint32_t first = (uint32_t)FINEST << BITS;
    place = place > first ? place - first : 0;
    return place < GRRL_NOISE_BINS ? place : GRRL_NOISE_BINS - 1;
}

/* The number in a bin that has `share` of the bin below it. */
static float size_at(uint32_t bin, float share)
{
    uint32_t bits[2] = {(bin + ((uint32_t)FINEST << BITS)) << (23 - BITS),
                        (bin + 1 + ((uint32_t)FINEST << BITS)) << (23 - BITS)};
    float edge[2];
    memcpy(edge, bits, sizeof edge);
    return edge[0] + share * (edge[1] - edge[0]);
}

/* The track of an id, or a free one near its hash; NULL: no room. A track not seen in the last
 * frame is free. */
static struct grrl_noise_track *find_track(struct grrl_noise *noise, int32_t id)
{
    uint32_t home = ((uint32_t)id * UINT32_C(2654435761)) >> 7;
    struct grrl_noise_track *room = NULL;
    for (uint32_t i = 0; i < PROBES; i++) {
        struct grrl_noise_track *track = &noise->track[(home + i) % GRRL_MAX_FEATURES];
        bool is_free = track->seen == 0 || track->frame + 1 < noise->n_frames;
        if (!is_free && track->id == id)
            return track;
        room = room == NULL && is_free ? track : room;
    }
    if (room != NULL)
        *room = (struct grrl_noise_track){.id = id};
    return room;
}

static void count(struct grrl_noise *noise, float difference)
{
    if (noise->n_samples < MAX_SAMPLES) {
        noise->bin[bin_of(difference < 0.0f ? -difference : difference)]++;
        noise->n_samples++;
    }
}

void grrl_noise_observe(struct grrl_noise *noise, const struct grrl_frame *frame)
{
    noise->n_frames++;
    for (uint32_t i = 0; i < frame->n; i++) {
        struct grrl_vec2 point = {frame->x_m[i], frame->y_m[i]};
        struct grrl_noise_track *track = grrl_is_finite(point.x) && grrl_is_finite(point.y)
                                             ? find_track(noise, frame->id[i])
                                             : NULL;
        if (track == NULL || (track->seen > 0 && track->frame == noise->n_frames))
            continue; /* no room, or twice in a frame */
        if (track->seen >= 2) {
            count(noise, point.x - 2.0f * track->last.x + track->before.x);
            count(noise, point.y - 2.0f * track->last.y + track->before.y);
        }
        track->before = track->last;
        track->last = point;
        track->frame = noise->n_frames;
        track->seen = track->seen < 2 ? track->seen + 1 : 2;
    }
}

/* The median size of the differences up to bin `end`. */
static float median_below(const struct grrl_noise *noise, uint32_t end)
{
    uint32_t total = 0;
    for (uint32_t i = 0; i < end; i++)
        total += noise->bin[i];
    uint32_t below = 0;
    uint32_t i = 0;
    while (i + 1 < end && 2 * (below + noise->bin[i]) < total)
        below += noise->bin[i++];
    float inside = (float)noise->bin[i];
    float share = inside > 0.0f ? (0.5f * (float)total - (float)below) / inside : 0.5f;
    return size_at(i, share);
}

enum grrl_status grrl_noise_estimate(const struct grrl_noise *noise, float *sigma_m)
{
    if (noise->n_samples < GRRL_NOISE_MIN_SAMPLES)
        return GRRL_ERR_NONE;
    if (2 * noise->bin[0] >= noise->n_samples)
        return GRRL_ERR_NUMBER;
    /* Outliers shift the median a little: drop those far beyond it and take it again. */
    uint32_t end = GRRL_NOISE_BINS;
    float spread = 0.0f;
    for (int round = 0; round < ROUNDS; round++) {
        spread = median_below(noise, end) / MEDIAN_OF_NORMAL;
        uint32_t limit = bin_of(TRIM_SIGMAS * spread) + 1;
        end = limit < end ? limit : end;
    }
    *sigma_m = spread / ROOT_6;
    return GRRL_OK;
}
