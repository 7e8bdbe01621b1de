/* What each model of a rigid thing explains, and that its residuals are what noise leaves. */

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "draw.h"
#include "solid_fit.h"

/* How a thing moves and how it is seen. */
enum motion { SLIDES_AND_TURNS, TURNS_OUT, FLAT_TURNS_OUT, COMES_NEAR };

enum { MODELS = 4 };

static const struct {
    double (*fit)(const struct grrl_views *views);
    double (*parameters)(unsigned n_frames, unsigned n_points);
} models[MODELS] = {{grrl_fit_similar, grrl_similar_parameters},
                    {grrl_fit_flat, grrl_flat_parameters},
                    {grrl_fit_solid, grrl_solid_parameters},
                    {grrl_fit_near_solid, grrl_near_solid_parameters}};

/* The simplest model that explains each motion. */
static const int simplest[] = {
    [SLIDES_AND_TURNS] = 0, [FLAT_TURNS_OUT] = 1, [TURNS_OUT] = 2, [COMES_NEAR] = 3};

static struct grrl_views views;

/* Points within a cube of 100, or its middle plane, seen from 100,000 away, or from 400. */
static void record(enum motion motion, double noise, double missing)
{
    double from = motion == COMES_NEAR ? 400.0 : 1e5;
    double point[GRRL_VIEWS_POINTS][3];
    views.n_frames = 30;
    views.n_points = 40;
    for (unsigned i = 0; i < views.n_points; i++)
        for (unsigned k = 0; k < 3; k++)
            point[i][k] = k == 2 && motion == FLAT_TURNS_OUT ? 0.0 : uniform(-50.0, 50.0);
    for (unsigned f = 0; f < views.n_frames; f++) {
        double t = (double)f / (views.n_frames - 1);
        double in = 0.5 * sin(4.0 * t);
        double out = motion == SLIDES_AND_TURNS ? 0.0 : 0.8 * t;
        for (unsigned i = 0; i < views.n_points; i++) {
            const double *p = point[i];
            double x = cos(in) * p[0] - sin(in) * p[1];
            double y = sin(in) * p[0] + cos(in) * p[1];
            double z = -sin(out) * x + cos(out) * p[2];
            x = cos(out) * x + sin(out) * p[2];
            double larger = from / (from + z - (motion == COMES_NEAR ? 100.0 * t : 0.0));
            views.x[f][i] = larger * x + 70.0 * t + noise * normal();
            views.y[f][i] = larger * y - 30.0 * t + noise * normal();
            views.seen[f][i] = uniform(0.0, 1.0) >= missing;
        }
    }
}

static double seen_coordinates(void)
{
    double n = 0.0;
    for (unsigned f = 0; f < views.n_frames; f++)
        for (unsigned i = 0; i < views.n_points; i++)
            n += views.seen[f][i] ? 2.0 : 0.0;
    return n;
}

/* The variance of the noise, as a model leaves it. */
static double variance_by(int model)
{
    return models[model].fit(&views) /
           (seen_coordinates() - models[model].parameters(views.n_frames, views.n_points));
}

static void simple_models_do_not_explain_more(void **state)
{
    (void)state;
    grrl_random_init(&random_numbers, 5, 0);
    for (int motion = SLIDES_AND_TURNS; motion <= COMES_NEAR; motion++) {
        record((enum motion)motion, 0.5, 0.0);
        for (int model = 0; model < MODELS; model++) {
            double variance = variance_by(model) / 0.25;
            if (model < simplest[motion])
                assert_true(variance > 2.0);
            else
                assert_true(variance > 0.85 && variance < 1.15);
        }
    }
}

static void points_may_be_missing(void **state)
{
    (void)state;
    grrl_random_init(&random_numbers, 6, 0);
    for (int motion = SLIDES_AND_TURNS; motion <= COMES_NEAR; motion++) {
        record((enum motion)motion, 0.5, 0.2);
        double variance = variance_by(simplest[motion]) / 0.25;
        assert_true(seen_coordinates() < 0.85 * 2.0 * views.n_frames * views.n_points);
        assert_true(variance > 0.85 && variance < 1.2);
    }
}

/* Few points, all in one place or seen once: finite residuals, and no more parameters than
 * coordinates. */
static void degenerate_views(void **state)
{
    (void)state;
    grrl_random_init(&random_numbers, 7, 0);
    for (unsigned n = 1; n <= 8; n++) {
        for (int kind = 0; kind < 3; kind++) {
            record(TURNS_OUT, 0.5, 0.0);
            views.n_points = n;
            for (unsigned f = 0; f < views.n_frames; f++) {
                for (unsigned i = 0; i < n; i++) {
                    if (kind == 1)
                        views.x[f][i] = views.y[f][i] = 3.0;
                    views.seen[f][i] = kind != 2 || f == i;
                }
            }
            for (int model = 0; model < MODELS; model++) {
                double residuals = models[model].fit(&views);
                assert_true(residuals >= 0.0 && residuals < 1e6);
                assert_true(models[model].parameters(views.n_frames, n) <=
                            2.0 * views.n_frames * n);
                if (kind > 0)
                    assert_true(residuals < 1e-3);
            }
        }
    }
}

static void centring_is_by_frame_and_part(void **state)
{
    (void)state;
    grrl_random_init(&random_numbers, 8, 0);
    record(TURNS_OUT, 0.5, 0.2);
    double apart = views.x[0][0] - views.x[0][1];
    views.seen[0][0] = views.seen[0][1] = true;
    double rest = views.y[3][30];
    grrl_views_centre(&views, 0, 20);
    assert_true(fabs(views.x[0][0] - views.x[0][1] - apart) < 1e-9);
    assert_true(views.y[3][30] == rest);
    for (unsigned f = 0; f < views.n_frames; f++) {
        double sum = 0.0;
        for (unsigned i = 0; i < 20; i++)
            sum += views.seen[f][i] ? views.x[f][i] : 0.0;
        assert_true(fabs(sum) < 1e-9);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(simple_models_do_not_explain_more),
        cmocka_unit_test(points_may_be_missing),
        cmocka_unit_test(degenerate_views),
        cmocka_unit_test(centring_is_by_frame_and_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
