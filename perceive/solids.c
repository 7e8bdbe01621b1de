/*
 * solids.c: which pieces are one solid.
 *
 * Two motions have more parameters than one, which pays off if they differ. F is what they save in
 * squared residuals for each further parameter, over the variance of the noise: about 1 for two
 * pieces of one thing, tens or hundreds for two things. The pair with the least F is joined first.
 *
 * Three guards keep apart what flat things explain as well. A piece must move as no flat rigid
 * thing does, or there is nothing to explain. Depth must show within the pieces: two flat layers
 * that shift against each other may be one solid seen by a moving camera, or two things that slide.
 * And points in no body beside a flat thing are tracks that slide along its edges.
 */
#include "solids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "grrl/base/geometry.h"

#include "solid_bodies.h"
#include "solid_fit.h"
#include "solid_frames.h"

/* F up to which two pieces are one: 99% of 607 pairs of pieces of one solid have at most 1.4, be
 * the noise white or not; larger values allow for a few points of another thing. */
#define MOST_F 2.0

/* If F is above this for a solid before a distant camera, no near one is tried. */
#define HOPELESS 1000.0

/* What a parameter must save to be needed: two standard deviations. */
#define NEEDED 4.0

/* The least energy of depth within two pieces, over that between them. */
#define LEAST_DEPTH 0.005

/* The least noise, since positions are rounded: in pixels, which count as millimetres. */
#define LEAST_NOISE 5e-5

/* A flat rigid model is good enough up to this share of the squared model error of perception. */
#define GOOD_ENOUGH 0.16

/* A point belongs to a solid if its variance is up to this many times that of the noise. */
#define MOST_VARIANCE 2.5

enum {
    PIECE_POINTS = GRRL_VIEWS_POINTS / 2, /* of a piece, evenly chosen */
    LEAST_FRAMES = 6,
    LEAST_POINTS = 4,   /* of a piece */
    TURNING_POINTS = 6, /* to see that a piece turns */
    NOISE_POINTS = 10,  /* to measure the noise */
    SEED_POINTS = 6,    /* neighbours in no body that may be a solid */
    LEAST_NEW = 8       /* points of a solid that perception has not found */
};

/* Models of a thing that may turn out of the plane of the image, from simple to general. */
enum { FLAT, SOLID, NEAR_SOLID, MODELS };

static const struct {
    double (*fit)(const struct grrl_views *views);
    double (*parameters)(unsigned n_frames, unsigned n_points);
} models[MODELS] = {{grrl_fit_flat, grrl_flat_parameters},
                    {grrl_fit_solid, grrl_solid_parameters},
                    {grrl_fit_near_solid, grrl_near_solid_parameters}};

/* A body, or several joined. */
struct piece {
    unsigned n; /* 0: too few points, or joined to another */
    uint16_t feature[PIECE_POINTS];
    bool turns;
    bool found;               /* among the points in no body */
    double residuals[MODELS]; /* squared */
};

struct search {
    struct grrl_solid_frames frames;
    double variance;     /* of the noise */
    double model_error2; /* squared, that perception allows for flat bodies */
    struct grrl_model *model;
    struct piece piece[GRRL_MAX_LINKS]; /* of the bodies of the model */
    uint8_t into[GRRL_MAX_LINKS];       /* the piece that a body belongs to */
    bool solid[GRRL_MAX_LINKS];
    double f[GRRL_MAX_LINKS][GRRL_MAX_LINKS];
    struct grrl_views views;
};

/* --- fits ------------------------------------------------------------------------------------- */

/* Fills the views with the points of a, and of b unless it is NULL. */
static void view(struct search *search, const struct piece *a, const struct piece *b)
{
    search->views.n_points = 0;
    grrl_solid_frames_view(&search->frames, a->feature, a->n, &search->views);
    if (b != NULL)
        grrl_solid_frames_view(&search->frames, b->feature, b->n, &search->views);
}

/* What further parameters save each. */
static double saved(const struct search *search, double residuals, double parameters)
{
    return parameters > 0.0 ? residuals / parameters / search->variance : HUGE_VAL;
}

static double parameters_of(const struct search *search, int model, unsigned n)
{
    return models[model].parameters(search->frames.n, n);
}

static void fit_piece(struct search *search, struct piece *piece)
{
    view(search, piece, NULL);
    for (int model = 0; model < MODELS; model++)
        piece->residuals[model] = models[model].fit(&search->views);
}

/* The coordinates seen beyond the parameters of a fit to the points in the views. */
static double freedom_of(const struct search *search, double parameters)
{
    double freedom = -parameters;
    for (unsigned f = 0; f < search->views.n_frames; f++)
        for (unsigned i = 0; i < search->views.n_points; i++)
            freedom += search->views.seen[f][i] ? 2.0 : 0.0;
    return freedom;
}

/* Whether a piece moves as no flat rigid thing in the plane of the image does: another model is
 * needed, and the error without it is not small. */
static bool turns(struct search *search, const struct piece *piece)
{
    if (piece->n < TURNING_POINTS)
        return false;
    view(search, piece, NULL);
    double residuals = grrl_fit_similar(&search->views);
    double parameters = grrl_similar_parameters(search->frames.n, piece->n);
    double freedom = freedom_of(search, parameters);
    double error = residuals / (freedom > 0.0 ? freedom : HUGE_VAL) - search->variance;
    for (int model = 0; model < MODELS; model++)
        if (saved(search, residuals - piece->residuals[model],
                  parameters_of(search, model, piece->n) - parameters) > NEEDED)
            return error > GOOD_ENOUGH * search->model_error2;
    return false;
}

/* Whether two pieces in the views have depth, which two flat layers that shift do not have; and not
 * far less than their shift would take. near: the squared residuals with depth. */
static bool is_deep(const struct search *search, const struct piece *a, double near)
{
    unsigned n = search->views.n_points;
    double layers = grrl_fit_near_layers(&search->views, a->n);
    double between = grrl_fit_flat(&search->views) - layers;
    double within = layers - near;
    double parameters =
        parameters_of(search, NEAR_SOLID, n) - grrl_near_layers_parameters(search->frames.n, n);
    return saved(search, within, parameters) > NEEDED && within > LEAST_DEPTH * between;
}

/* F of two pieces with these residuals together, by one model. */
static double f_by(const struct search *search, int model, const struct piece *a,
                   const struct piece *b, double together)
{
    return saved(search, together - a->residuals[model] - b->residuals[model],
                 parameters_of(search, model, a->n) + parameters_of(search, model, b->n) -
                     parameters_of(search, model, a->n + b->n));
}

/* Whether points in no body are beside a flat thing: tracks slide along its edges. */
static bool slides_along(const struct piece *found, const struct piece *other)
{
    return found->found && !other->turns && other->n >= TURNING_POINTS;
}

/* F of two pieces as one; HUGE_VAL: they are not one. */
static double f_of(struct search *search, const struct piece *a, const struct piece *b)
{
    if (a->n == 0 || b->n == 0 || !(a->turns || b->turns) || slides_along(a, b) ||
        slides_along(b, a))
        return HUGE_VAL;
    view(search, a, b);
    double f = f_by(search, FLAT, a, b, grrl_fit_flat(&search->views));
    if (f < MOST_F)
        return f;
    if (f_by(search, SOLID, a, b, grrl_fit_solid(&search->views)) > HOPELESS)
        return HUGE_VAL;
    double near = grrl_fit_near_solid(&search->views);
    f = f_by(search, NEAR_SOLID, a, b, near);
    return f < MOST_F && is_deep(search, a, near) ? f : HUGE_VAL;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median over the pieces with many points; false: there is none. */
static bool measure_noise(struct search *search, double most)
{
    double variance[GRRL_MAX_LINKS];
    unsigned n = 0;
    for (unsigned b = 0; b < search->model->n_bodies; b++) {
        struct piece *piece = &search->piece[b];
        if (piece->n < NOISE_POINTS)
            continue;
        view(search, piece, NULL);
        double freedom = freedom_of(search, parameters_of(search, NEAR_SOLID, piece->n));
        if (freedom > 0.0)
            variance[n++] = piece->residuals[NEAR_SOLID] / freedom;
    }
    if (n == 0)
        return false;
    qsort(variance, n, sizeof variance[0], by_value);
    search->variance = fmin(most * most, fmax(LEAST_NOISE * LEAST_NOISE, variance[n / 2]));
    return true;
}

/* --- pieces ----------------------------------------------------------------------------------- */

/* Evenly chosen features, as many as a piece may have. */
static void choose(struct piece *piece, const uint16_t *feature, unsigned n)
{
    piece->n = n < PIECE_POINTS ? n : PIECE_POINTS;
    for (unsigned k = 0; k < piece->n; k++)
        piece->feature[k] = feature[k * n / piece->n];
}

static void make_piece(struct search *search, struct piece *piece, const uint16_t *feature,
                       unsigned n)
{
    choose(piece, feature, n);
    fit_piece(search, piece);
}

/* The features of a body, or of none, that are seen in most frames. */
static unsigned features_of(const struct search *search, uint8_t body, uint16_t *feature)
{
    unsigned n = 0;
    for (uint16_t i = 0; i < search->model->n_features; i++)
        if (search->model->feature_body[i] == body && search->frames.mostly[i])
            feature[n++] = i;
    return n;
}

static bool make_pieces(struct search *search, double noise)
{
    for (uint8_t b = 0; b < search->model->n_bodies; b++) {
        uint16_t feature[GRRL_MAX_FEATURES];
        unsigned n = features_of(search, b, feature);
        if (n >= LEAST_POINTS)
            make_piece(search, &search->piece[b], feature, n);
    }
    if (!measure_noise(search, noise))
        return false;
    for (uint8_t b = 0; b < search->model->n_bodies; b++)
        search->piece[b].turns = turns(search, &search->piece[b]);
    return true;
}

static void compare(struct search *search, unsigned a, unsigned b)
{
    unsigned low = a < b ? a : b;
    unsigned high = a < b ? b : a;
    search->f[low][high] = f_of(search, &search->piece[low], &search->piece[high]);
}

/* Joins piece b to piece a. */
static void join(struct search *search, unsigned a, unsigned b)
{
    struct piece *piece = &search->piece[a];
    const struct piece *other = &search->piece[b];
    uint16_t feature[2 * PIECE_POINTS];
    memcpy(feature, piece->feature, piece->n * sizeof feature[0]);
    memcpy(feature + piece->n, other->feature, other->n * sizeof feature[0]);
    make_piece(search, piece, feature, piece->n + other->n);
    piece->turns = true;
    search->piece[b].n = 0;
    search->solid[a] = true;
    for (unsigned i = 0; i < search->model->n_bodies; i++)
        search->into[i] = search->into[i] == b ? (uint8_t)a : search->into[i];
    for (unsigned i = 0; i < search->model->n_bodies; i++) {
        if (i != b)
            compare(search, b, i); /* no longer a piece */
        if (i != a)
            compare(search, a, i);
    }
}

static void join_all(struct search *search)
{
    unsigned n = search->model->n_bodies;
    for (unsigned a = 0; a < n; a++) {
        search->f[a][a] = HUGE_VAL;
        for (unsigned b = a + 1; b < n; b++)
            compare(search, a, b);
    }
    for (;;) {
        unsigned best_a = 0;
        unsigned best_b = 0;
        for (unsigned a = 0; a < n; a++) {
            for (unsigned b = a + 1; b < n; b++) {
                if (search->f[a][b] < search->f[best_a][best_b]) {
                    best_a = a;
                    best_b = b;
                }
            }
        }
        if (best_a == best_b)
            return;
        join(search, best_a, best_b);
    }
}

/* --- points in no body ------------------------------------------------------------------------ */

/* Of the n features, moves those after the first `known` that belong to the solid of these to them,
 * or the one that fits best if it nearly does; returns the new number known. */
static unsigned find_members(struct search *search, uint16_t *feature, unsigned known, unsigned n)
{
    double variance[GRRL_VIEWS_POINTS];
    struct piece first;
    struct piece rest = {.n = n - known < PIECE_POINTS ? n - known : PIECE_POINTS};
    double most = MOST_VARIANCE * search->variance;
    double least = HUGE_VAL;
    choose(&first, feature, known);
    memcpy(rest.feature, feature + known, rest.n * sizeof feature[0]);
    view(search, &first, &rest);
    grrl_fit_further_points(&search->views, first.n, variance);
    for (unsigned k = 0; k < rest.n; k++)
        least = fmin(least, variance[k]);
    if (least > most && least < search->variance + search->model_error2)
        most = least;
    for (unsigned k = 0; k < rest.n; k++) {
        if (variance[k] > most)
            continue;
        unsigned at = known;
        while (feature[at] != rest.feature[k])
            at++;
        feature[at] = feature[known];
        feature[known++] = rest.feature[k];
    }
    return known;
}

/* Whether the first features are one solid. */
static bool is_solid(struct search *search, const uint16_t *feature, unsigned n, int model)
{
    struct piece piece;
    choose(&piece, feature, n);
    view(search, &piece, NULL);
    double freedom = freedom_of(search, parameters_of(search, model, piece.n));
    return freedom > 0.0 &&
           models[model].fit(&search->views) / freedom < MOST_VARIANCE * search->variance;
}

/* Adds to the first `known` features of a solid those of the others that belong to it, as long as
 * they remain one; returns the new number. */
static unsigned grow(struct search *search, uint16_t *feature, unsigned known, unsigned n)
{
    for (;;) {
        unsigned more = find_members(search, feature, known, n);
        if (more == known || !is_solid(search, feature, more, NEAR_SOLID))
            return known;
        known = more;
    }
}

/* Gives points in no body to the solids to which they belong. */
static void complete(struct search *search)
{
    for (uint8_t b = 0; b < search->model->n_bodies; b++) {
        const struct piece *piece = &search->piece[b];
        uint16_t feature[PIECE_POINTS + GRRL_MAX_FEATURES];
        if (piece->n < LEAST_NEW || !search->solid[b])
            continue;
        memcpy(feature, piece->feature, piece->n * sizeof feature[0]);
        unsigned n = piece->n + features_of(search, GRRL_FEATURE_NONE, feature + piece->n);
        unsigned known = grow(search, feature, piece->n, n);
        for (unsigned k = piece->n; k < known; k++)
            search->model->feature_body[feature[k]] = b;
    }
}

/* Puts the nearest features to the one at `seed`, and that itself, first. */
static void nearest_first(const struct search *search, uint16_t *feature, unsigned n, unsigned seed)
{
    const struct grrl_solid_frames *frames = &search->frames;
    uint16_t middle = feature[seed];
    for (unsigned k = 0; k < SEED_POINTS; k++) {
        unsigned best = k;
        for (unsigned i = k + 1; i < n; i++)
            if (grrl_solid_frames_distance(frames, middle, feature[i]) <
                grrl_solid_frames_distance(frames, middle, feature[best]))
                best = i;
        uint16_t swapped = feature[k];
        feature[k] = feature[best];
        feature[best] = swapped;
    }
}

/* Whether a body has too few points to tell whether it turns. */
static bool is_splinter(const struct search *search, uint8_t b)
{
    return b < search->model->n_bodies && !search->solid[b] && search->piece[b].n > 0 &&
           search->piece[b].n < TURNING_POINTS;
}

/* The features in no body and in splinters that are seen in most frames. */
static unsigned loose_features(const struct search *search, uint16_t *feature)
{
    const struct grrl_model *model = search->model;
    unsigned n = 0;
    for (uint16_t i = 0; i < model->n_features; i++)
        if (search->frames.mostly[i] && (model->feature_body[i] == GRRL_FEATURE_NONE ||
                                         is_splinter(search, model->feature_body[i])))
            feature[n++] = i;
    return n;
}

/* Whether one of the splinters among the features is a flat layer that shifts against the others:
 * a link, not a piece of a solid. */
static bool has_a_layer(struct search *search, const uint16_t *feature, unsigned n)
{
    for (uint8_t b = 0; b < search->model->n_bodies; b++) {
        struct piece part[2] = {{.n = 0}, {.n = 0}};
        for (unsigned k = 0; k < n && k < PIECE_POINTS; k++) {
            struct piece *of = &part[search->model->feature_body[feature[k]] == b ? 0 : 1];
            of->feature[of->n++] = feature[k];
        }
        if (part[0].n < LEAST_POINTS || part[1].n == 0)
            continue;
        view(search, &part[0], &part[1]);
        if (!is_deep(search, &part[0], grrl_fit_near_solid(&search->views)))
            return true;
    }
    return false;
}

/* A further body of the model. */
static uint8_t add_body(struct grrl_model *model)
{
    uint16_t number = 0;
    for (uint8_t i = 0; i < model->n_bodies; i++)
        number = model->body[i].number > number ? model->body[i].number : number;
    model->body[model->n_bodies] = (struct grrl_body){.number = (uint16_t)(number + 1)};
    return model->n_bodies++;
}

/* Makes a solid of these features; the splinters that they leave nearly empty become part of it. */
static void make_solid(struct search *search, const uint16_t *feature, unsigned n)
{
    struct grrl_model *model = search->model;
    uint8_t solid = GRRL_FEATURE_NONE;
    uint16_t left[GRRL_MAX_FEATURES];
    for (unsigned k = 0; k < n; k++)
        model->feature_body[feature[k]] = GRRL_FEATURE_NONE;
    for (uint8_t b = 0; b < model->n_bodies; b++) {
        unsigned rest = features_of(search, b, left);
        if (!is_splinter(search, b) || rest == search->piece[b].n || rest >= LEAST_POINTS)
            continue;
        solid = solid == GRRL_FEATURE_NONE ? b : solid;
        search->into[b] = solid;
        search->piece[b].n = 0;
        for (unsigned k = 0; k < rest; k++)
            model->feature_body[left[k]] = GRRL_FEATURE_NONE;
    }
    if (solid == GRRL_FEATURE_NONE)
        solid = add_body(model);
    for (unsigned k = 0; k < n; k++)
        model->feature_body[feature[k]] = solid;
    search->solid[solid] = true;
    make_piece(search, &search->piece[solid], feature, n);
    search->piece[solid].turns = true;
    search->piece[solid].found = true;
}

/* A solid that turns so fast that no large piece of it looks flat leaves its points in splinters
 * and in no body. */
static void find_solids(struct search *search)
{
    uint16_t feature[GRRL_MAX_FEATURES];
    unsigned n = loose_features(search, feature);
    unsigned seed = 0;
    while (seed < n && n >= LEAST_NEW) {
        uint16_t near[GRRL_MAX_FEATURES];
        memcpy(near, feature, sizeof near);
        nearest_first(search, near, n, seed++);
        if (!is_solid(search, near, SEED_POINTS, SOLID) ||
            search->model->n_bodies == GRRL_MAX_LINKS)
            continue;
        unsigned known = grow(search, near, SEED_POINTS, n);
        if (known < LEAST_NEW || has_a_layer(search, near, known))
            continue;
        make_solid(search, near, known);
        n = loose_features(search, feature);
        seed = 0;
    }
}

bool grrl_solids_join(const struct grrl_tracks *tracks, const struct grrl_perception_config *config,
                      struct grrl_model *model, struct grrl_solids *solids)
{
    struct search *search = calloc(1, sizeof *search);
    if (search == NULL)
        return false;
    search->model_error2 = (double)(config->model_error_m * config->model_error_m);
    search->model = model;
    for (uint8_t b = 0; b < GRRL_MAX_LINKS; b++)
        search->into[b] = b;
    if (grrl_solid_frames_choose(&search->frames, tracks, model, LEAST_FRAMES) &&
        make_pieces(search, (double)config->noise_m)) {
        find_solids(search);
        join_all(search);
        complete(search);
    }
    grrl_solids_renumber(search->into, search->solid, model, solids);
    free(search);
    return true;
}
