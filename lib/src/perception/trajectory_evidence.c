/*
 * trajectory_evidence.c: splits the residuals of a trajectory into slow waves and noise, and weighs
 * the evidence.
 *
 * Residuals are projected onto cosines with one half wave over the trajectory, two, and so on: the
 * power of a wave is the part of their autocorrelation at that frequency. Noise, however correlated
 * in time, has the same power in slow waves as in slightly faster ones, and the ratio of that power
 * to the total is one over the number of independent samples. Any further power in the slowest
 * waves comes from errors of the hand and the mechanism, which no number of samples averages out,
 * or from a wrong model. A hand errs in all of the slow waves alike. A curve that is no circle
 * misses the fitted one smoothly, so nearly all of its power is in the slower half.
 */
#include "perception/trajectory_evidence.h"

#include <string.h>

#include "grrl/base/geometry.h"

/* Waves can be separated with at least this many samples; with fewer, all residuals count as slow.
 */
enum { LEAST_SAMPLES = 12 };

/* An arc of length l with a root mean square distance x from its chord turns by x / l divided by
 * this: 1 / (8 * 3 / 2 * sqrt(5)) for a parabola. */
#define BOW_PER_TURN 0.0372678f

/* Prior probabilities. */
#define PRIOR_RIGID 0.1f
#define PRIOR_NEITHER 0.1f /* given that it moves; the two joints are equally likely */

/* Standard deviation of the logarithm of a handle's distance from its hinge: a factor of three,
 * from scissors to garage doors. */
#define RADIUS_SPREAD 1.2f

/* A handle at rest drifts by this much (root mean square); one that moves travels about 0.3 m,
 * within a factor of three. */
#define WANDER_M 0.0003f
#define MOTION_M 0.09f
#define MOTION_SPREAD 1.2f

/* Slow residuals divided by the length, root mean square: for mechanisms, and for paths that are
 * neither a line nor a circle, the latter within a factor of three. */
#define JOINT_SLOW 0.006f
#define NEITHER_SLOW 0.02f
#define NEITHER_SPREAD 1.0f

/* The logarithm of bend over sway. Of the bend's four waves a fitted circle takes up about two, so
 * a hand leaves somewhat more power in the sway; power that falls with the fourth power of the
 * frequency, as that of a smooth curve does, leaves about a sixth there. */
#define JOINT_SHAPE (-0.1f)
#define JOINT_SHAPE_SPREAD 1.1f
#define NEITHER_SHAPE 1.8f
#define NEITHER_SHAPE_SPREAD 0.8f

#define ROOT_TWO_PI 2.5066283f

enum { STEPS = 32 }; /* of the integral over the turn, on each side */
#define STEP_SIGMAS 0.25f

void grrl_trajectory_spectrum_begin(struct grrl_trajectory_spectrum *spectrum, uint32_t n)
{
    *spectrum = (struct grrl_trajectory_spectrum){.n = n};
}

/* cos((k + 1) x) = 2 cos x cos(k x) - cos((k - 1) x). */
void grrl_trajectory_spectrum_add(struct grrl_trajectory_spectrum *spectrum, float residual_m)
{
    float x = GRRL_PI * ((float)spectrum->i + 0.5f) / (float)spectrum->n;
    float twice = 2.0f * grrl_cos(x);
    float before = 1.0f;
    float now = 0.5f * twice;
    for (int k = 0; k < GRRL_TRAJECTORY_WAVES; k++) {
        spectrum->wave[k] += residual_m * now;
        float next = twice * now - before;
        before = now;
        now = next;
    }
    spectrum->squares += residual_m * residual_m;
    spectrum->i++;
}

struct grrl_trajectory_residuals
grrl_trajectory_spectrum_end(const struct grrl_trajectory_spectrum *spectrum)
{
    float n = (float)spectrum->n;
    struct grrl_trajectory_residuals result = {.total = spectrum->squares / n};
    if (spectrum->n < LEAST_SAMPLES) {
        result.slow = result.total;
        result.wave = result.total / (n > 4.0f ? n - 3.0f : 1.0f);
        return result;
    }
    uint32_t slow_n = (spectrum->n - 1) / 3;
    slow_n = slow_n < GRRL_TRAJECTORY_SLOW ? slow_n : GRRL_TRAJECTORY_SLOW;
    for (uint32_t k = 0; k < 3 * slow_n; k++) {
        float power = 2.0f * spectrum->wave[k] * spectrum->wave[k] / (n * n);
        if (k < slow_n)
            result.slow += power;
        else
            result.wave += power / (float)(2 * slow_n);
        if (slow_n == GRRL_TRAJECTORY_SLOW && k < slow_n)
            *(k < GRRL_TRAJECTORY_BEND ? &result.bend : &result.sway) += power;
    }
    result.slow -= (float)slow_n * result.wave;
    result.slow = result.slow > 0.0f ? result.slow : 0.0f;
    float white = result.total > result.slow ? (result.total - result.slow) / n : 0.0f;
    result.wave = result.wave > white ? result.wave : white; /* a sample counts at most once */
    return result;
}

/* The density at x of Student's t with four degrees of freedom, and with eight. */
static float student4(float x)
{
    float square = 1.0f + 0.25f * x * x;
    return 0.375f / (square * square * grrl_sqrt(square));
}

static float student8(float x)
{
    float square = 1.0f + 0.125f * x * x;
    float fourth = square * square * square * square;
    return 0.386699f / (fourth * grrl_sqrt(square));
}

static float normal(float x, float mean, float spread)
{
    float z = (x - mean) / spread;
    return grrl_exp(-0.5f * z * z) / (spread * ROOT_TWO_PI);
}

/* The log-normal density at x: the logarithm has the standard deviation `spread` about that of the
 * median. */
static float log_normal(float x, float median, float spread)
{
    if (!(x > 0.0f))
        return 0.0f;
    return normal(grrl_log(x / median), 0.0f, spread) / x;
}

/* The likelihood ratio of a curve against a joint, from the shape of the slow residuals. */
static float smoothness(const struct grrl_trajectory_residuals *residuals)
{
    if (!(residuals->bend > 0.0f && residuals->sway > 0.0f))
        return 1.0f;
    float shape = grrl_log(residuals->bend / residuals->sway);
    shape = shape < NEITHER_SHAPE ? shape : NEITHER_SHAPE; /* no evidence in being smoother still */
    float joint = student8((shape - JOINT_SHAPE) / JOINT_SHAPE_SPREAD) / JOINT_SHAPE_SPREAD;
    return normal(shape, NEITHER_SHAPE, NEITHER_SHAPE_SPREAD) / joint;
}

/* The density of the observed turn if the handle turns by the length over the radius. */
static float density_of_circle(const struct grrl_trajectory_config *config,
                               const struct grrl_trajectory_clues *clues, float sigma_rad)
{
    float sum = 0.0f;
    float weights = 0.0f;
    for (int i = -STEPS; i <= STEPS; i++) {
        float at = STEP_SIGMAS * (float)i;
        float turn = clues->turn_rad + sigma_rad * at;
        float weight = student4(at);
        weights += weight;
        turn = turn < 0.0f ? -turn : turn; /* symmetric */
        sum += 0.5f * weight * log_normal(turn, clues->length_m / config->radius_m, RADIUS_SPREAD);
    }
    return sum / weights;
}

/* The posterior probability of a hypothesis, from its prior and the densities under it and
 * otherwise. */
static float share_of(float prior, float density, float otherwise)
{
    float both = prior * density + (1.0f - prior) * otherwise;
    return both > 0.0f ? prior * density / both : prior;
}

static enum grrl_trajectory_answer answer_of(const struct grrl_trajectory_fit *fit, float decided)
{
    return fit->p_rigid >= decided                 ? GRRL_TRAJECTORY_RIGID
           : fit->p_neither >= decided             ? GRRL_TRAJECTORY_NEITHER
           : fit->revolute.probability >= decided  ? GRRL_TRAJECTORY_REVOLUTE
           : fit->prismatic.probability >= decided ? GRRL_TRAJECTORY_PRISMATIC
                                                   : GRRL_TRAJECTORY_UNDETERMINED;
}

void grrl_trajectory_weigh(const struct grrl_trajectory_config *config,
                           const struct grrl_trajectory_clues *clues,
                           struct grrl_trajectory_fit *fit)
{
    const struct grrl_trajectory_residuals *r = &clues->residuals;
    float bow2 = r->wave + r->slow;
    float bow_rad = BOW_PER_TURN * clues->length_m;
    float sigma_rad = grrl_sqrt(config->play_rad * config->play_rad + bow2 / (bow_rad * bow_rad));
    float line = student4(clues->turn_rad / sigma_rad) / sigma_rad;
    float circle = density_of_circle(config, clues, sigma_rad);
    float slow = grrl_sqrt(r->slow) / clues->length_m;
    float joint = 2.0f * student4(slow / JOINT_SLOW) / JOINT_SLOW;
    float neither = log_normal(slow, NEITHER_SLOW, NEITHER_SPREAD) * smoothness(r);
    float place_m = grrl_sqrt(clues->places.slow);
    float still = 2.0f * student4(place_m / WANDER_M) / WANDER_M;
    float moving = log_normal(place_m, MOTION_M, MOTION_SPREAD);
    fit->p_rigid = share_of(PRIOR_RIGID, still, moving);
    fit->p_neither = (1.0f - fit->p_rigid) * share_of(PRIOR_NEITHER, neither, joint);
    float rest = 1.0f - fit->p_rigid - fit->p_neither;
    fit->revolute.probability = rest * share_of(0.5f, circle, line);
    fit->prismatic.probability = rest - fit->revolute.probability;
    fit->answer = answer_of(fit, config->decided);
    fit->slow_m = grrl_sqrt(r->slow);
    fit->effective_samples = bow2 > 0.0f ? r->total / bow2 : 0.0f;
}
