/*
 * What handles are called, over many synthetic trajectories: lines, arcs of 3 to 120 degrees,
 * S-curves, spirals and handles at rest; 20 to 2000 samples, white and correlated noise, play of
 * the hand. Prints the confusion with 95% intervals and holds it to bounds.
 */

#include "support.h"

#include <math.h>

#include "grrl/perception/trajectory.h"

enum { MOST = 2000, RUNS = 400 };
enum truth { LINE, SHORT_ARC, ARC, CURVE, SPIRAL, STILL, TRUTHS };

static const char *const truths[TRUTHS] = {
    "line", "arc, 3 to 30 degrees", "arc, 30 to 120", "S", "spiral", "still"};
static const char *const answers[] = {"undetermined", "revolute", "prismatic", "rigid", "neither"};
enum { ANSWERS = 5 };
static const enum grrl_trajectory_answer right[TRUTHS] = {
    GRRL_TRAJECTORY_PRISMATIC, GRRL_TRAJECTORY_REVOLUTE, GRRL_TRAJECTORY_REVOLUTE,
    GRRL_TRAJECTORY_NEITHER,   GRRL_TRAJECTORY_NEITHER,  GRRL_TRAJECTORY_RIGID};

static float rows[3 * MOST];

static double uniform(struct grrl_random *random, double low, double high)
{
    return low + (high - low) * (double)grrl_random_uniform(random);
}

static double log_uniform(struct grrl_random *random, double low, double high)
{
    return low * pow(high / low, uniform(random, 0.0, 1.0));
}

static double normal(struct grrl_random *random)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++)
        sum += (double)grrl_random_uniform(random);
    return sum;
}

/* A path of the given length, at s of it from 0 to 1. */
static void place(enum truth truth, double length, double turn, double wave, double s, double *x,
                  double *y)
{
    if (truth == SHORT_ARC || truth == ARC) {
        double radius = length / turn;
        *x = radius * sin(turn * s);
        *y = radius * (1.0 - cos(turn * s));
    } else if (truth == SPIRAL) { /* the radius doubles to trebles over half a turn */
        double radius = length * (1.0 + (1.0 + 4.0 * wave) * s) / 6.0;
        *x = radius * cos(3.14159265 * s);
        *y = radius * sin(3.14159265 * s);
    } else {
        *x = truth == STILL ? 0.0 : length * s;
        *y = truth == CURVE ? wave * length * sin(6.283185307 * s) : 0.0;
    }
}

/* Noise with a standard deviation and, of one sample to the next, a correlation; and the play of a
 * hand, a slow wave of 0.5% of the length. */
static struct grrl_trajectory_fit draw(struct grrl_random *random, enum truth truth)
{
    double turn =
        0.0174533 * (truth == ARC ? uniform(random, 30.0, 120.0) : log_uniform(random, 3.0, 30.0));
    bool turns = truth == ARC || truth == SHORT_ARC;
    double length = turns ? turn * log_uniform(random, 0.05, 1.0) : log_uniform(random, 0.05, 0.7);
    double wave = uniform(random, 0.1, 0.25);
    double noise = fmin(log_uniform(random, 0.0002, 0.003), 0.02 * length);
    double correlation = grrl_random_below(random, 2) == 0 ? 0.0 : uniform(random, 0.3, 0.9);
    double play = truth == STILL ? 0.0 : 0.007 * length * uniform(random, 0.0, 1.0);
    double phase = uniform(random, 0.0, 6.28);
    double halves = uniform(random, 1.5, 5.0);
    uint32_t n = (uint32_t)log_uniform(random, 20.0, MOST);
    double error[3] = {normal(random), normal(random), normal(random)};
    for (uint32_t i = 0; i < n; i++) {
        double s = (double)i / (n - 1);
        double at[3] = {0.0, 0.0, 0.0};
        place(truth, length, turn, wave, s * s * (3.0 - 2.0 * s), &at[0], &at[1]);
        at[1] += play * sin(3.14159265 * halves * s + phase);
        for (int k = 0; k < 3; k++) {
            error[k] =
                correlation * error[k] + sqrt(1.0 - correlation * correlation) * normal(random);
            rows[3 * i + (uint32_t)k] = (float)(at[k] + noise * error[k]);
        }
    }
    struct grrl_trajectory trajectory = {n, 3, rows};
    struct grrl_trajectory_config config;
    struct grrl_trajectory_fit fit;
    grrl_trajectory_config_default(&config);
    assert_int_equal(grrl_trajectory_fit_of(&trajectory, &config, &fit), GRRL_OK);
    return fit;
}

/* Wilson's interval, in percent. */
static void print_share(const char *what, int part, int of)
{
    double z2 = 1.959964 * 1.959964;
    double p = of > 0 ? (double)part / of : 0.0;
    double centre = (p + z2 / (2.0 * of)) / (1.0 + z2 / of);
    double half = sqrt(z2 * (p * (1.0 - p) / of + z2 / (4.0 * of * of))) / (1.0 + z2 / of);
    print_message("  %-13s %5.1f%% (%.1f to %.1f)", what, 100.0 * p, 100.0 * (centre - half),
                  100.0 * (centre + half));
}

static void test_confusion(void **state)
{
    (void)state;
    struct grrl_random random = support_random("confusion");
    int called[TRUTHS][ANSWERS] = {{0}};
    int sure = 0;
    int sure_right = 0;
    int sure_of_spiral = 0;
    for (int t = 0; t < TRUTHS; t++) {
        for (int run = 0; run < RUNS; run++) {
            struct grrl_trajectory_fit fit = draw(&random, (enum truth)t);
            float p[ANSWERS] = {0.0f, fit.revolute.probability, fit.prismatic.probability,
                                fit.p_rigid, fit.p_neither};
            called[t][fit.answer]++;
            sure += p[fit.answer] >= 0.95f;
            sure_right += p[fit.answer] >= 0.95f && fit.answer == right[t];
            sure_of_spiral += t == SPIRAL && fit.revolute.probability >= 0.95f;
        }
        print_message("%s\n", truths[t]);
        for (int a = 0; a < ANSWERS; a++)
            print_share(answers[a], called[t][a], RUNS);
        print_message("\n");
    }
    print_share("of .95 on", sure_right, sure);
    print_message(" right, of %d\n", sure);
    assert_true(called[LINE][GRRL_TRAJECTORY_PRISMATIC] > 0.9 * RUNS);
    assert_true(called[LINE][GRRL_TRAJECTORY_REVOLUTE] < 0.02 * RUNS);
    assert_true(called[SHORT_ARC][GRRL_TRAJECTORY_PRISMATIC] < 0.15 * RUNS);
    assert_true(called[ARC][GRRL_TRAJECTORY_REVOLUTE] > 0.95 * RUNS);
    assert_true(called[CURVE][GRRL_TRAJECTORY_NEITHER] > 0.95 * RUNS);
    assert_true(sure_of_spiral < 0.02 * RUNS);
    assert_true(called[STILL][GRRL_TRAJECTORY_RIGID] > 0.95 * RUNS);
    assert_true(sure_right > 0.98 * sure && sure > 0.4 * TRUTHS * RUNS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_confusion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
