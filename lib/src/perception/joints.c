/*
 * joints.c: the joint between two bodies.
 *
 * Three models of the relative motion of a pair are compared over all keyframes that saw both:
 *   revolute    one point of either body stays on one point of the other: 4 parameters
 *   prismatic   no relative turn, sliding along one line: 3 parameters
 *   free        anything; explains all, but pays for each keyframe in which it was needed
 * A pivot far from both bodies is unlikely a priori (otherwise a revolute joint would explain any
 * sliding), and a joint type is accepted only if the motion excites it.
 *
 * All are compared in chi squared, -2 ln(likelihood), so odds are exp(-chi2 / 2). A model with m
 * parameters over n keyframes, 2 residuals each, has an expected chi squared of 2 n - m; its excess
 * is the rest. This is the Laplace approximation of the marginal likelihood with a charge of 1 in
 * chi squared per parameter. That is accurate enough: revolute and prismatic differ by one
 * parameter, and TYPE_MARGIN is 8. docs/perception.md derives the fits and the evidence.
 */
#include "perception/perception_internal.h"

/* Chi squared that free motion pays in a keyframe that needs it. A rigid pair (the 3 parameters of
 * free motion are 0) reaches 14 by chance once in 340 keyframes: less does not count as motion. */
#define FREE_COST 14.0f

/* Limit on the total: ten keyframes. Neighbouring keyframes of a push are not independent, so forty
 * of them must not make free motion impossible. */
#define FREE_COST_MAX 140.0f

/* Chi squared by which a type must beat the other type and free motion: odds of 55 to 1 (exp(8 /
 * 2)), a probability of 0.98. */
#define TYPE_MARGIN 8.0f

/* The most a keyframe of a push counts against a joint: the cost of free motion, reached by chance
 * once in 1,100 keyframes. A few frames of a fast body can be off by ten standard deviations. With
 * 20% missing points and 2% outliers, this lowered the trials of PRPRPRP that ended at the cap from
 * 2.5 to 1.0% (seed 47000). */
#define MOVING_MISS_MAX FREE_COST

/* Chi squared in favour of a joint if the motion shows nothing: odds of e to 1. Things side by side
 * on the table are more likely joined than not. */
#define JOINT_PRIOR 2.0f

/* The same for a camera that may move, where the scene need not be one object: things are
 * independent until proven joined. Odds of 20 to 1 against an untested joint. */
#define INDEPENDENT_PRIOR (-6.0f)

/* Bodies whose relative size changes by this share are not in one plane. */
#define SIZES_DIFFER 0.1f

/* A joint less likely than this does not enter the model. */
#define BELIEVED 0.5f

/* Evidence from each further push that slid along the same line. Independent things would move
 * within 12 degrees of it, either way, once in exp(4 / 2) = 7 pushes. */
#define PUSH_EVIDENCE 4.0f

/* Excess above which a type does not explain the motion: this plus a number of standard deviations
 * of chi squared over all keyframes (2 sqrt(n) each, for 2 n residuals). Noise alone hardly ever
 * gets there (4 in 10^6 trials of ten keyframes); the margin is for bodies that are not quite
 * rigid. */
#define MISFIT_BASE 10.0f
#define MISFIT_SIGMAS 5.0f

/* Weight of the excess in the order of joints that are equally well supported: it decides between
 * two, but within the limits above it is small compared with WELL_SUPPORTED. */
#define MISFIT_WEIGHT 0.1f

/* Gain over independent motion in chi squared beyond which one joint ranks no higher than another
 * (odds of 20 to 1). */
#define WELL_SUPPORTED 6.0f

/* A range of motion excites a type if it is this many standard deviations of one keyframe; see
 * FAR_SIGMAS in apart.c. */
#define EXCITED_SIGMAS 5.0f

/* The relative motion of bodies a and b in one keyframe, in the frame of a. */
struct relative {
    float c; /* rotation of b in a */
    float s;
    struct grrl_vec2 d; /* origin of b in a */
    const struct grrl_perception_pose *pa;
    const struct grrl_perception_pose *pb;
    float turn; /* from the mean rotation */
    float turn_variance;
    float middle_variance; /* of a point halfway between the bodies */
};

struct motion {
    uint8_t n;
    struct relative at[GRRL_MAX_KEYFRAMES];
    bool at_rest[GRRL_MAX_KEYFRAMES];
    float noise2;
    float bend_a; /* variances of the bodies' residuals beyond noise, per axis */
    float bend_b;
    float c0; /* mean rotation */
    float s0;
    struct grrl_vec2 middle; /* mean of d, not weighted */
};

/* Variance per axis of the distance between a point of a and a point of b, given their squared
 * distances from the origins of the bodies; includes the model error of both. */
static float point_variance(const struct grrl_perception *p, const struct motion *motion,
                            const struct relative *r, float lever_a2, float lever_b2)
{
    float model = grrl_perception_model_error(p);
    return motion->noise2 * (1.0f / r->pa->weight + 1.0f / r->pb->weight +
                             0.5f * (lever_a2 / (r->pa->inertia + GRRL_LEAST_INERTIA) +
                                     lever_b2 / (r->pb->inertia + GRRL_LEAST_INERTIA))) +
           2.0f * model * model + motion->bend_a + motion->bend_b;
}

static float turn_variance(const struct grrl_perception *p, const struct motion *motion,
                           const struct relative *r)
{
    /* the model error of a body's n features affects its turn like noise of one frame each */
    float model = grrl_perception_model_error(p);
    float model2 = model * model;
    return (motion->noise2 + 4.0f * model2) * (1.0f / (r->pa->inertia + GRRL_LEAST_INERTIA) +
                                               1.0f / (r->pb->inertia + GRRL_LEAST_INERTIA)) +
           motion->bend_a * r->pa->weight / (r->pa->inertia + GRRL_LEAST_INERTIA) +
           motion->bend_b * r->pb->weight / (r->pb->inertia + GRRL_LEAST_INERTIA);
}

static float turn_from_mean(const struct motion *motion, const struct relative *r)
{
    return grrl_atan2(r->s * motion->c0 - r->c * motion->s0, r->c * motion->c0 + r->s * motion->s0);
}

static void collect(const struct grrl_perception *p, uint8_t a, uint8_t b, struct motion *motion)
{
    motion->n = 0;
    motion->noise2 = p->config.noise_m * p->config.noise_m;
    motion->bend_a = p->bend_m2[a];
    motion->bend_b = p->bend_m2[b];
    float c = 0.0f;
    float s = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        const struct grrl_perception_pose *pa = &p->pose[k][a];
        const struct grrl_perception_pose *pb = &p->pose[k][b];
        if (!(pa->weight > 0.0f) || !(pb->weight > 0.0f))
            continue;
        motion->at_rest[motion->n] = p->keyframe[k].at_rest;
        struct relative *r = &motion->at[motion->n++];
        r->c = pa->pose.c * pb->pose.c + pa->pose.s * pb->pose.s;
        r->s = pa->pose.c * pb->pose.s - pa->pose.s * pb->pose.c;
        r->d = grrl_origin_in(pa, pb);
        r->pa = pa;
        r->pb = pb;
        c += r->c;
        s += r->s;
    }
    float length = grrl_sqrt(c * c + s * s);
    motion->c0 = length > 0.0f ? c / length : 1.0f;
    motion->s0 = length > 0.0f ? s / length : 0.0f;
    motion->middle = (struct grrl_vec2){0.0f, 0.0f};
    for (uint8_t k = 0; k < motion->n; k++)
        motion->middle = grrl_vec2_add(motion->middle,
                                       grrl_vec2_scale(motion->at[k].d, 1.0f / (float)motion->n));
    float lever2 = 0.25f * grrl_vec2_dot(motion->middle, motion->middle);
    for (uint8_t k = 0; k < motion->n; k++) {
        struct relative *r = &motion->at[k];
        r->turn = turn_from_mean(motion, r);
        r->turn_variance = turn_variance(p, motion, r);
        r->middle_variance = point_variance(p, motion, r, lever2, lever2);
    }
}

/* Whether a keyframe that the fit misses by chi2 may itself be wrong. At rest many frames are
 * averaged, in a push only a few: a gap and an outlier can displace a fast body and outweigh
 * everything else. */
static bool is_doubtful(const struct motion *motion, uint8_t k, float chi2)
{
    return !motion->at_rest[k] && chi2 > MOVING_MISS_MAX;
}

/* Sums over the keyframes, each weighted by 1 / variance of the distance of the two pivots. */
struct pivot_sums {
    float w;
    float mc; /* sum of the rotations, w (c, s) */
    float ms;
    struct grrl_vec2 d; /* sum of w d */
    struct grrl_vec2 e; /* sum of w R^T d */
};

static struct pivot_sums sum_for_pivot(const struct grrl_perception *p, const struct motion *motion,
                                       float lever_a2, float lever_b2)
{
    struct pivot_sums sums = {0};
    for (uint8_t k = 0; k < motion->n; k++) {
        const struct relative *r = &motion->at[k];
        float wk = 1.0f / point_variance(p, motion, r, lever_a2, lever_b2);
        sums.w += wk;
        sums.mc += wk * r->c;
        sums.ms += wk * r->s;
        sums.d = grrl_vec2_add(sums.d, grrl_vec2_scale(r->d, wk));
        sums.e.x += wk * (r->c * r->d.x + r->s * r->d.y);
        sums.e.y += wk * (-r->s * r->d.x + r->c * r->d.y);
    }
    return sums;
}

/*
 * Least squares for the pivot, a in the frame of body a and b in that of body b. They minimise sum
 * w |a - R b - d|^2 + |a|^2 / sa^2 + |b|^2 / sb^2, where R and d are the turn and shift of b's
 * frame in a's. With M = sum w R, D = sum w d and E = sum w R^T d the normal equations are
 *     (W + 1 / sa^2) a - M b = D,    -M^T a + (W + 1 / sb^2) b = -E.
 * M is a rotation times a number, so that M^T M = |m|^2 I, and eliminating a leaves one scalar, the
 * Schur complement: schur b = M^T D / (W + 1 / sa^2) - E. 1 / schur is the variance of b.
 */
static void solve_pivot(const struct pivot_sums *sums, float sa, float sb,
                        struct grrl_joint_fit *fit)
{
    float a = sums->w + 1.0f / (sa * sa);
    float b = sums->w + 1.0f / (sb * sb);
    float mc = sums->mc;
    float ms = sums->ms;
    struct grrl_vec2 d = sums->d;
    float schur = b - (mc * mc + ms * ms) / a;
    schur = schur > 1.0f / (sb * sb) ? schur : 1.0f / (sb * sb); /* rounding */
    fit->in_b.x = ((mc * d.x + ms * d.y) / a - sums->e.x) / schur;
    fit->in_b.y = ((-ms * d.x + mc * d.y) / a - sums->e.y) / schur;
    fit->in_a.x = (d.x + mc * fit->in_b.x - ms * fit->in_b.y) / a;
    fit->in_a.y = (d.y + ms * fit->in_b.x + mc * fit->in_b.y) / a;
    fit->point_variance = 1.0f / schur;
}

/* Chi squared of the pivots' distance in a keyframe. */
static float pivot_miss(const struct grrl_perception *p, const struct motion *motion,
                        const struct relative *r, const struct grrl_joint_fit *fit, float lever_a2,
                        float lever_b2)
{
    struct grrl_vec2 q = {r->c * fit->in_b.x - r->s * fit->in_b.y,
                          r->s * fit->in_b.x + r->c * fit->in_b.y};
    struct grrl_vec2 miss = grrl_vec2_sub(grrl_vec2_sub(fit->in_a, q), r->d);
    return grrl_vec2_dot(miss, miss) / point_variance(p, motion, r, lever_a2, lever_b2);
}

/* The pivot, how well the motion agrees with it, and the range of the turn. The weights depend on
 * the distance of the pivot from both bodies: half their extent in the first round, then the pivot
 * found. */
static void fit_revolute(const struct grrl_perception *p, const struct motion *motion, float ha,
                         float hb, struct grrl_joint_fit *fit)
{
    float sa = p->config.pivot_scale_m + ha;
    float sb = p->config.pivot_scale_m + hb;
    float lever_a2 = ha * ha;
    float lever_b2 = hb * hb;
    float chi2 = 0.0f;
    for (int round = 0; round < 2; round++) {
        struct pivot_sums sums = sum_for_pivot(p, motion, lever_a2, lever_b2);
        solve_pivot(&sums, sa, sb, fit);
        lever_a2 = grrl_vec2_dot(fit->in_a, fit->in_a);
        lever_b2 = grrl_vec2_dot(fit->in_b, fit->in_b);
    }
    fit->lower = 0.0f;
    fit->upper = 0.0f;
    float first = motion->at[0].turn;
    float least_variance = 1e9f;
    for (uint8_t k = 0; k < motion->n; k++) {
        const struct relative *r = &motion->at[k];
        float missed = pivot_miss(p, motion, r, fit, lever_a2, lever_b2);
        if (is_doubtful(motion, k, missed)) {
            chi2 += MOVING_MISS_MAX;
            continue;
        }
        chi2 += missed;
        float turn = grrl_wrap_rad(r->turn - first);
        fit->lower = turn < fit->lower ? turn : fit->lower;
        fit->upper = turn > fit->upper ? turn : fit->upper;
        least_variance = r->turn_variance < least_variance ? r->turn_variance : least_variance;
    }
    chi2 += lever_a2 / (sa * sa) + lever_b2 / (sb * sb);
    fit->excess = chi2 - 2.0f * (float)motion->n + 4.0f;
    float range = fit->upper - fit->lower;
    fit->excited = range > p->config.min_turn_rad &&
                   range * range > EXCITED_SIGMAS * EXCITED_SIGMAS * least_variance;
    fit->axis_in_a = (struct grrl_vec2){0.0f, 0.0f};
    fit->axis_variance = 0.0f;
}

/* The sliding point halfway between the bodies, so that the turn noise of both counts equally. */
static struct grrl_vec2 slide_point(const struct motion *motion, const struct relative *r)
{
    struct grrl_vec2 middle = motion->middle;
    float turn = r->s * motion->c0 - r->c * motion->s0;
    return (struct grrl_vec2){r->d.x - 0.5f * (middle.x - turn * middle.y),
                              r->d.y - 0.5f * (middle.y + turn * middle.x)};
}

/* The line on which a pair slides: a point on it, and the sum of weights. */
struct slide {
    struct grrl_vec2 mean;
    float w;
};

static struct slide find_middle(const struct motion *motion)
{
    struct slide slide = {.w = 0.0f};
    for (uint8_t k = 0; k < motion->n; k++) {
        float wk = 1.0f / motion->at[k].middle_variance;
        struct grrl_vec2 point = slide_point(motion, &motion->at[k]);
        slide.w += wk;
        slide.mean = grrl_vec2_add(slide.mean, grrl_vec2_scale(point, wk));
    }
    slide.mean = grrl_vec2_scale(slide.mean, 1.0f / slide.w);
    return slide;
}

/* The line by total least squares: the principal axis of the weighted positions. Returns the sum of
 * squares along it divided by the variance; its inverse is the variance of the direction. */
static float find_slide_axis(const struct motion *motion, const struct slide *slide,
                             struct grrl_vec2 *axis)
{
    float xx = 0.0f;
    float xy = 0.0f;
    float yy = 0.0f;
    for (uint8_t k = 0; k < motion->n; k++) {
        struct grrl_vec2 q = grrl_vec2_sub(slide_point(motion, &motion->at[k]), slide->mean);
        float wk = 1.0f / motion->at[k].middle_variance;
        xx += wk * q.x * q.x;
        xy += wk * q.x * q.y;
        yy += wk * q.y * q.y;
    }
    float major;
    float minor;
    grrl_principal_axes(xx, xy, yy, &major, &minor, axis);
    return major;
}

/* The line of sliding, how well the motion agrees with it, and the range of the slide. A keyframe
 * has two residuals: across the line, and the turn from the mean turn. */
static void fit_prismatic(const struct grrl_perception *p, const struct motion *motion,
                          struct grrl_joint_fit *fit)
{
    struct slide slide = find_middle(motion);
    float major = find_slide_axis(motion, &slide, &fit->axis_in_a);
    float chi2 = 0.0f;
    float first = grrl_vec2_dot(slide_point(motion, &motion->at[0]), fit->axis_in_a);
    fit->lower = 0.0f;
    fit->upper = 0.0f;
    for (uint8_t k = 0; k < motion->n; k++) {
        const struct relative *r = &motion->at[k];
        struct grrl_vec2 point = slide_point(motion, r);
        float across = grrl_vec2_cross(fit->axis_in_a, grrl_vec2_sub(point, slide.mean));
        float missed = across * across / r->middle_variance + r->turn * r->turn / r->turn_variance;
        if (is_doubtful(motion, k, missed)) {
            chi2 += MOVING_MISS_MAX;
            continue;
        }
        chi2 += missed;
        float slid = grrl_vec2_dot(point, fit->axis_in_a) - first;
        fit->lower = slid < fit->lower ? slid : fit->lower;
        fit->upper = slid > fit->upper ? slid : fit->upper;
    }
    fit->excess = chi2 - 2.0f * (float)motion->n + 3.0f;
    float range = fit->upper - fit->lower;
    fit->excited = range > p->config.min_slide_m &&
                   range * range * slide.w > EXCITED_SIGMAS * EXCITED_SIGMAS * (float)motion->n;
    fit->in_a = slide.mean;
    fit->in_b = (struct grrl_vec2){0.0f, 0.0f};
    fit->point_variance = 1.0f / slide.w;
    fit->axis_variance = 1.0f / (major + 1.0f);
}

/* The cost of free motion: it pays for the keyframes that differ from a rigid pair, up to a limit.
 */
static float free_cost(const struct motion *motion)
{
    float cost = 0.0f;
    for (uint8_t k = 0; k < motion->n; k++) {
        const struct relative *r = &motion->at[k];
        struct grrl_vec2 off = grrl_vec2_sub(r->d, motion->middle);
        float rigid =
            grrl_vec2_dot(off, off) / r->middle_variance + r->turn * r->turn / r->turn_variance;
        cost += rigid < FREE_COST ? rigid : FREE_COST;
    }
    return cost < FREE_COST_MAX ? cost : FREE_COST_MAX;
}

/*
 * Evidence for a pivot beyond first order: any relative motion with a steady turn and a steady
 * drift has a pivot; only the curvature of the path, half the squared turn times the distance from
 * the pivot, shows that it stays in place.
 */
static float curvature_evidence(const struct grrl_perception *p, const struct motion *motion,
                                const struct grrl_joint_fit *fit)
{
    float a2 = grrl_vec2_dot(fit->in_a, fit->in_a);
    float b2 = grrl_vec2_dot(fit->in_b, fit->in_b);
    float lever2 = a2 > b2 ? a2 : b2;
    float w = 0.0f;
    float m[5] = {0.0f}; /* moments of the turn, weighted */
    for (uint8_t k = 0; k < motion->n; k++) {
        const struct relative *r = &motion->at[k];
        float wk = 1.0f / point_variance(p, motion, r, a2, b2);
        float power = wk;
        for (int i = 0; i < 5; i++) {
            m[i] += power;
            power *= r->turn;
        }
        w += wk;
    }
    /* what remains of turn^2 / 2 after regression on 1 and turn */
    float mean = m[1] / w;
    float var = m[2] - w * mean * mean;
    float cov = m[3] - mean * m[2];
    float sum = m[4] - m[2] * m[2] / w;
    float rest = var > 0.0f ? sum - cov * cov / var : 0.0f;
    return rest > 0.0f ? 0.25f * lever2 * rest : 0.0f;
}

/*
 * Evidence for sliding: two things that move in parallel look the same. They are joined if they
 * turned together, or slid along the same line in several pushes.
 */
static float sliding_evidence(const struct grrl_perception *p, const struct motion *motion,
                              const struct grrl_joint_fit *fit)
{
    const struct grrl_pose *first = &motion->at[0].pa->pose;
    float turned = 0.0f;
    float pushes = -1.0f;
    float last = grrl_vec2_dot(motion->at[0].d, fit->axis_in_a);
    for (uint8_t k = 1; k < motion->n; k++) {
        const struct relative *r = &motion->at[k];
        float turn = first->c * r->pa->pose.s - first->s * r->pa->pose.c;
        turned += turn * turn / r->turn_variance;
        float at = grrl_vec2_dot(r->d, fit->axis_in_a);
        if (motion->at_rest[k]) {
            float slid = at > last ? at - last : last - at;
            pushes += slid > p->config.min_slide_m ? 1.0f : 0.0f;
            last = at;
        }
    }
    turned = turned < GRRL_TURN_EVIDENCE_MAX ? turned : GRRL_TURN_EVIDENCE_MAX;
    return turned + (pushes > 0.0f ? PUSH_EVIDENCE * pushes : 0.0f);
}

/*
 * Chi squared of independent motion. It can also mimic the motion of a joint, and is then as likely
 * as the joint except for the evidence beyond first order.
 */
static float untied_cost(const struct grrl_perception *p, const struct motion *motion,
                         const struct grrl_joint_evidence *e, float free)
{
    const struct grrl_joint_fit *fit = &e->fit;
    bool table = grrl_perception_on_table(p);
    float tested;
    if (e->type == GRRL_REVOLUTE)
        tested =
            curvature_evidence(p, motion, fit) + (table ? 0.0f : grrl_joint_place_evidence(p, e));
    else if (table)
        tested = sliding_evidence(p, motion, fit);
    else
        tested = grrl_joint_slide_in_pictures(p, e, fit->point_variance * (float)motion->n);
    float untested = fit->excess + tested + (table ? JOINT_PRIOR : INDEPENDENT_PRIOR);
    return free < untested ? free : untested;
}

/* Probabilities from chi squared, with equal priors. */
static void model_probabilities(const float *chi2, float *probability)
{
    float least = chi2[0] < chi2[1] ? chi2[0] : chi2[1];
    least = chi2[2] < least ? chi2[2] : least;
    float sum = 0.0f;
    for (int i = 0; i < 3; i++) {
        probability[i] = grrl_exp(-0.5f * (chi2[i] - least));
        sum += probability[i];
    }
    for (int i = 0; i < 3; i++)
        probability[i] /= sum;
}

/*
 * Whether the relative size of two bodies is constant. It is for bodies in one plane seen from
 * above, whatever the camera does; a body that approaches the camera alone is on no joint of that
 * plane.
 */
static bool sizes_agree(const struct motion *motion)
{
    float least = 1e9f;
    float most = 0.0f;
    for (uint8_t k = 0; k < motion->n; k++) {
        const struct relative *r = &motion->at[k];
        float ratio = (1.0f + r->pb->growth) / (1.0f + r->pa->growth);
        least = ratio < least ? ratio : least;
        most = ratio > most ? ratio : most;
    }
    return most - least < SIZES_DIFFER * most;
}

/* Weighs the evidence for a joint between a and b; false: no joint is supported. */
bool grrl_joints_weigh(const struct grrl_perception *p, uint8_t a, uint8_t b,
                       struct grrl_joint_evidence *e)
{
    struct motion motion;
    struct grrl_joint_fit revolute;
    struct grrl_joint_fit prismatic;
    collect(p, a, b, &motion);
    e->told = false;
    e->doubt = GRRL_REASON_LITTLE;
    if (motion.n < 2 || grrl_apart_never_moved(p, a, b))
        return false;
    fit_revolute(p, &motion, grrl_joint_half_extent(p, a), grrl_joint_half_extent(p, b), &revolute);
    fit_prismatic(p, &motion, &prismatic);
    float free = free_cost(&motion);
    bool is_revolute = revolute.excess < prismatic.excess;
    e->fit = is_revolute ? revolute : prismatic;
    e->type = is_revolute ? GRRL_REVOLUTE : GRRL_PRISMATIC;
    e->a = a;
    e->b = b;
    e->weight = free - e->fit.excess;
    e->odds = is_revolute ? prismatic.excess - revolute.excess : revolute.excess - prismatic.excess;
    float untied = untied_cost(p, &motion, e, free);
    float chi2[3] = {revolute.excess, prismatic.excess, untied};
    model_probabilities(chi2, e->p);
    float support = untied - e->fit.excess;
    bool fits = e->fit.excess < MISFIT_BASE + 2.0f * MISFIT_SIGMAS * grrl_sqrt((float)motion.n);
    e->doubt = !e->fit.excited                                        ? GRRL_REASON_LITTLE
               : !sizes_agree(&motion)                                ? GRRL_REASON_SIZES
               : !fits || e->odds <= TYPE_MARGIN                      ? GRRL_REASON_NO_TYPE
               : e->weight <= TYPE_MARGIN || e->p[e->type] < BELIEVED ? GRRL_REASON_UNPROVEN
                                                                      : GRRL_REASON_NONE;
    e->told = e->doubt == GRRL_REASON_NONE;
    if (e->told && !grrl_joint_is_near(p, e, support))
        e->doubt = GRRL_REASON_FAR;
    if (e->doubt != GRRL_REASON_NONE)
        return false;
    float misfit = e->fit.excess > 0.0f ? MISFIT_WEIGHT * e->fit.excess : 0.0f;
    e->order = (support < WELL_SUPPORTED ? support : WELL_SUPPORTED) -
               grrl_joint_distance_cost(p, e) - misfit;
    return true;
}
