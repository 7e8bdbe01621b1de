/*
 * solid_fit.h: how well the images of points fit one rigid thing, by models from flat to solid.
 *
 * Each fit returns the sum of squared residuals, in the unit of the positions squared.
 */
#ifndef GRRL_PERCEIVE_SOLID_FIT_H
#define GRRL_PERCEIVE_SOLID_FIT_H

#include <stdbool.h>

enum { GRRL_VIEWS_FRAMES = 48, GRRL_VIEWS_POINTS = 128 };

/* Points in some frames, which need not see all of them. */
struct grrl_views {
    unsigned n_frames;
    unsigned n_points;
    double x[GRRL_VIEWS_FRAMES][GRRL_VIEWS_POINTS];
    double y[GRRL_VIEWS_FRAMES][GRRL_VIEWS_POINTS];
    bool seen[GRRL_VIEWS_FRAMES][GRRL_VIEWS_POINTS];
};

/* Subtracts from the points first to end - 1 their mean in each frame. */
void grrl_views_centre(struct grrl_views *views, unsigned first, unsigned end);

/* A flat thing in the plane of the image: each frame shifts, turns and scales it. */
double grrl_fit_similar(const struct grrl_views *views);

/* A flat thing before a distant camera, which may turn out of that plane: each frame maps it
 * affinely. */
double grrl_fit_flat(const struct grrl_views *views);

/* A solid before a distant camera (Tomasi and Kanade, IJCV 1992). */
double grrl_fit_solid(const struct grrl_views *views);

/* A solid before a camera nearby: what is nearer is larger. At most grrl_fit_solid. */
double grrl_fit_near_solid(const struct grrl_views *views);

/* Two flat layers before a camera nearby, the points from `second` on in the other one: they turn
 * out of the plane of the image together, and shift against each other. */
double grrl_fit_near_layers(const struct grrl_views *views, unsigned second);

/* Fits a solid near the camera to the first `known` points; variance: for each further one, its
 * mean squared residual as a point of that solid. */
void grrl_fit_further_points(const struct grrl_views *views, unsigned known, double *variance);

/* The parameters that each of these models has, without those that change no image, but not more
 * than there are coordinates. */
double grrl_similar_parameters(unsigned n_frames, unsigned n_points);
double grrl_flat_parameters(unsigned n_frames, unsigned n_points);
double grrl_solid_parameters(unsigned n_frames, unsigned n_points);
double grrl_near_layers_parameters(unsigned n_frames, unsigned n_points);
double grrl_near_solid_parameters(unsigned n_frames, unsigned n_points);

#endif
