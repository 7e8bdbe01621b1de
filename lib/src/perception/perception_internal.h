/*
 * perception_internal.h: the modules behind perception.h.
 *
 *   perception.c            tracks and keyframes: the observations
 *   rigid.c                 poses and residuals of features taken as one rigid body
 *   initial_segmentation.c  candidate bodies before anything has moved
 *   rest_error.c            position error at rest that averaging does not remove
 *   outliers.c              points that no motion explains
 *   consensus.c             the largest set of features that moved as one
 *   cut.c                   the line that best separates two bodies
 *   assign.c                which body a feature moves with
 *   apart.c                 whether two bodies moved relative to each other
 *   bodies.c                which features form a body: split, reassign, merge
 *   joints.c                the joint between two bodies
 *   joint_place.c           where a joint lies, as evidence for it
 *   joint_pictures.c        evidence for a slide seen by a camera that may move
 *   structure.c             the joints of all bodies, and the model
 */
#ifndef GRRL_PERCEPTION_INTERNAL_H
#define GRRL_PERCEPTION_INTERNAL_H

#include "grrl/perception/perception.h"

/* Cap on one squared residual in units of its variance, 4 standard deviations: noise reaches it
 * once in 3,000 points, and an outlier costs no more. */
#define GRRL_COST_CAP 16.0f

/* m^2, added to inertias to avoid division by zero. */
#define GRRL_LEAST_INERTIA 1e-9f

static inline float grrl_vec2_distance2(struct grrl_vec2 a, struct grrl_vec2 b)
{
    struct grrl_vec2 d = grrl_vec2_sub(a, b);
    return grrl_vec2_dot(d, d);
}

/*
 * rest_error.c. The error of stationary points from rest to rest beyond noise, per axis, m; 0: no
 * more than the configured model error, or not known yet.
 */
float grrl_rest_error(const struct grrl_perception *p);

/* The larger of the measured and the configured error. */
static inline float grrl_perception_model_error(const struct grrl_perception *p)
{
    float given = p->config.model_error_m;
    return p->rest_error_m > given ? p->rest_error_m : given;
}

/* 0: a build for a table before a camera at rest, without the rules for pictures, 2.5 KiB smaller;
 * grrl_perception_init refuses a configuration without static_background. */
#ifndef GRRL_PICTURES
#define GRRL_PICTURES 1
#endif

static inline bool grrl_perception_on_table(const struct grrl_perception *p)
{
    return !GRRL_PICTURES || p->config.static_background;
}

/* From a body's frame to the world and back; the body may appear larger than its shape. */
static inline struct grrl_vec2 grrl_to_world(const struct grrl_perception_pose *pose,
                                             struct grrl_vec2 local)
{
    return grrl_transform(pose->pose, grrl_vec2_scale(local, 1.0f + pose->growth));
}

static inline struct grrl_vec2 grrl_to_local(const struct grrl_perception_pose *pose,
                                             struct grrl_vec2 world)
{
    return grrl_vec2_scale(grrl_untransform(pose->pose, world), 1.0f / (1.0f + pose->growth));
}

/* The origin of body b in the frame of a. */
static inline struct grrl_vec2 grrl_origin_in(const struct grrl_perception_pose *a,
                                              const struct grrl_perception_pose *b)
{
    return grrl_vec2_scale(grrl_unrotate(a->pose, grrl_vec2_sub(b->pose.p, a->pose.p)),
                           1.0f / (1.0f + a->growth));
}

static inline bool grrl_perception_sees_both(const struct grrl_perception *p, uint8_t k, uint8_t a,
                                             uint8_t b)
{
    return p->pose[k][a].weight > 0.0f && p->pose[k][b].weight > 0.0f;
}

/* Variance of a keyframe's point per axis, m^2: noise of `weight` averaged frames + model error. */
static inline float grrl_perception_variance(const struct grrl_perception *p, uint8_t weight)
{
    float noise = p->config.noise_m;
    float model = grrl_perception_model_error(p);
    return noise * noise / (float)weight + model * model;
}

/*
 * rigid.c. A set of features is a list of slots. `shape` holds one point per slot in the body's
 * frame, whose origin is the centroid of the features.
 */

/*
 * How much larger a body appears than its shape, given the length of the sum of products and the
 * inertia of a fit. The prior is normal about 0, so that a body of few features does not grow and
 * shrink with their noise.
 */
float grrl_rigid_growth(const struct grrl_perception *p, float length, float inertia);

/* The poses in all keyframes, and the shape, that fit best. poses[k] for k < n_keyframes. */
void grrl_rigid_fit(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                    struct grrl_vec2 *shape, struct grrl_perception_pose *poses, size_t stride);

/*
 * Fits the poses again, in each keyframe without the points off the body: the farthest is removed
 * first, then the next, until none is off. More than a third are not outliers, and the pose stays
 * as it was.
 */
void grrl_rigid_refit(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                      const struct grrl_vec2 *shape, struct grrl_perception_pose *poses,
                      size_t stride);

/* The keyframe that saw most of these features; of several, the one averaged over most frames. */
uint8_t grrl_rigid_reference(const struct grrl_perception *p, const uint16_t *slots, uint16_t n);

/* Where the point of `slot` lies in the frame of these poses: the mean over all keyframes. */
bool grrl_rigid_place(const struct grrl_perception *p, uint16_t slot,
                      const struct grrl_perception_pose *poses, size_t stride,
                      struct grrl_vec2 *local);

/*
 * Squared residuals of a slot over their variance, each capped at GRRL_COST_CAP, summed over the
 * keyframes; each is 2 on average. *n counts the keyframes that saw both. A sum that exceeds
 * `enough` is not finished, and *n is left as it was.
 */
float grrl_rigid_cost(const struct grrl_perception *p, uint16_t slot, struct grrl_vec2 local,
                      const struct grrl_perception_pose *poses, size_t stride, float enough,
                      uint16_t *n);

/* Whether the cost of a slot exceeds `enough` for sure, wherever its place. Cheap; often false for
 * costs that do. */
bool grrl_rigid_is_off(const struct grrl_perception *p, uint16_t slot,
                       const struct grrl_perception_pose *poses, size_t stride, float enough);

#define GRRL_COST_ANY 1e9f /* enough for no sum */

/* The members of body `body` (or GRRL_FEATURE_..), as slots. */
uint16_t grrl_rigid_slots(const struct grrl_perception *p, uint8_t body, uint16_t *slots);

/* initial_segmentation.c: the candidate bodies in the first keyframe. */
void grrl_initial_segmentation(struct grrl_perception *p);

/* Sorts in ascending order, by insertion. */
void grrl_perception_sort(float *values, uint16_t n);

/* Whether enough features of a body lay densely there by themselves, not linked by those of others.
 */
bool grrl_initial_is_compact(const struct grrl_perception *p, uint8_t body);

/* outliers.c: removes isolated points that lie off their bodies from the keyframes of pushes not
 * yet examined. Returns whether there were any. */
bool grrl_outliers_drop(struct grrl_perception *p);

/*
 * consensus.c. The misfit of a body with these slots: the largest over its keyframes and over all
 * of them together, in standard deviations of chi squared; score[k] is that of keyframe k.
 */
float grrl_consensus_misfit(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                            uint8_t body, float *score);

/* The keyframe relative to which motions are measured: features it did not see take no part. true:
 * tracks are shorter than the motion, so there are many such features. */
bool grrl_consensus_reference(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                              const float *score, uint8_t *reference);

/* The largest set among `slots` that moved as one in the keyframes with the highest scores; returns
 * its size, members[] holds it. */
uint16_t grrl_consensus_find(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                             const float *score, uint16_t *members);

/* Features fitted as one rigid body. */
struct grrl_rigid_group {
    uint16_t n;
    uint16_t slot[GRRL_MAX_FEATURES];
    struct grrl_vec2 shape[GRRL_MAX_FEATURES];
    struct grrl_perception_pose pose[GRRL_MAX_KEYFRAMES];
};

/*
 * cut.c: the straight cut that separates the features best, if it beats the present partition into
 * those of `body` and the others. Returns the gain in chi squared; part[] holds one side.
 */
float grrl_cut_best(const struct grrl_perception *p, const struct grrl_rigid_group *together,
                    uint8_t body, uint16_t *part, uint16_t *n_part);

/* The same for two links that cross, which no straight cut separates. */
float grrl_cut_best_cross(const struct grrl_perception *p, const struct grrl_rigid_group *together,
                          uint8_t body, uint16_t *part, uint16_t *n_part);

/* By how many standard deviations of chi squared the features of a body separate along some line,
 * beyond noise; 0: they do not. */
float grrl_cut_hidden_joint(const struct grrl_perception *p, uint8_t body);

/*
 * assign.c. Whether a feature has ever moved. A body has moved if most of its features have.
 */
bool grrl_assign_moves(const struct grrl_perception *p, uint16_t slot);
bool grrl_assign_body_has_moved(const struct grrl_perception *p, uint8_t body);

/* Where bodies come from: the blob of each in the first keyframe, 0: none, and whether it has
 * moved. Up to date until features change sides. */
struct grrl_assign_origins {
    uint8_t blob[GRRL_MAX_LINKS];
    bool has_moved[GRRL_MAX_LINKS];
};

void grrl_assign_find_origins(const struct grrl_perception *p, struct grrl_assign_origins *origins);

/* Whether features of bodies a and b may share one body: they come from the same blob, or both
 * moved. */
bool grrl_assign_bodies_may_share(const struct grrl_perception *p, uint8_t a, uint8_t b);

/*
 * The body a feature moves with, or GRRL_FEATURE_.. Bit b of `changed`: body b has changed since
 * this was last found for the feature. The others did not win then, and do not win now unless its
 * own body has changed.
 */
uint8_t grrl_assign_best(const struct grrl_perception *p, const struct grrl_assign_origins *origins,
                         uint16_t slot, uint32_t changed);

/* Whether a feature of no body, or of another, moves with `body` as well; at least `least`
 * keyframes must have seen both. */
bool grrl_assign_follows(const struct grrl_perception *p, uint16_t slot, uint8_t body,
                         uint16_t least);

/* Whether a feature of a body of n_own features fits some other body as well. */
bool grrl_assign_fits_elsewhere(const struct grrl_perception *p,
                                const struct grrl_assign_origins *origins, uint16_t slot,
                                uint16_t n_own);

/* apart.c: the range of relative motion of two bodies from rest to rest, and its variances. */
struct grrl_apart_range {
    float turn;
    float shift2;   /* squared, of the point halfway between them */
    float turn_var; /* the largest, so that noise alone does not look like motion */
    float shift_var;
};

struct grrl_apart_range grrl_apart_range_between(const struct grrl_perception *p, uint8_t a,
                                                 uint8_t b);

/* The features of two bodies fitted as one. */
void grrl_apart_fit_both(const struct grrl_perception *p, uint8_t a, uint8_t b,
                         struct grrl_rigid_group *together);

/* Evidence for relative motion of two bodies, in chi squared: what separate poses save in each
 * keyframe beyond the cost of their parameters. A sum that has reached `enough` is not finished. */
float grrl_apart_evidence(const struct grrl_perception *p, uint8_t a, uint8_t b, float enough);

/* Whether two bodies may be one: their relative motion is in no keyframe significant, or is below
 * the joint detection threshold. */
bool grrl_apart_may_merge(const struct grrl_perception *p, uint8_t a, uint8_t b);

/* Whether two bodies show no relative motion beyond noise. */
bool grrl_apart_are_still(const struct grrl_perception *p, uint8_t a, uint8_t b);

/* Whether neither of two bodies moved in a recording, which shows all there is to see. If rests are
 * known there are pushes, and the next one may tell. */
bool grrl_apart_never_moved(const struct grrl_perception *p, uint8_t a, uint8_t b);

/* Whether two bodies moved so little relative to each other that their boundary is in doubt. */
bool grrl_apart_is_little(const struct grrl_perception *p, uint8_t a, uint8_t b);

/* bodies.c: a new body without features, the last in the list; there must be room. */
void grrl_bodies_add(struct grrl_perception *p);

/* Brings body_of, shape and pose up to date. */
void grrl_bodies_update(struct grrl_perception *p);

/* How well a joint type explains the relative motion of two bodies. */
struct grrl_joint_fit {
    float excess; /* chi squared beyond its expectation */
    bool excited; /* the motion is large enough to decide */
    float lower;  /* excursion from the first keyframe, rad or m */
    float upper;
    struct grrl_vec2 in_a; /* the pivot, or a point on the axis, in the frame of a */
    struct grrl_vec2 in_b;
    struct grrl_vec2 axis_in_a;
    float point_variance; /* of the pivot per axis; of the sliding line across */
    float axis_variance;  /* of the sliding direction, rad^2 */
};

/* The evidence for a joint between bodies a < b. */
struct grrl_joint_evidence {
    float weight; /* gain over free motion in chi squared */
    float order;  /* gain over independent motion in chi squared, less a cost for distance; if it is
                     a joint */
    float odds;   /* gain over the other type in chi squared */
    float p[3];   /* probabilities: revolute, prismatic, free */
    uint8_t a;
    uint8_t b;
    uint8_t type;
    bool told;     /* the motion supports it; the place of the joint may still rule it out */
    uint8_t doubt; /* enum grrl_reason: why it is not a joint */
    struct grrl_joint_fit fit;
};

/* joints.c: weighs the evidence for a joint between a and b; false: no joint is supported. */
bool grrl_joints_weigh(const struct grrl_perception *p, uint8_t a, uint8_t b,
                       struct grrl_joint_evidence *evidence);

/* Pivots closer than this, in units of gap_m (20 mm), are one pin: the width of a link and the
 * error of a pivot that turned just enough to be detected. On a body that passes by a pivot, the
 * pivot moves farther than this. */
#define GRRL_PIN_REACH 0.2f

/* joint_place.c: half the extent of a body's features. */
float grrl_joint_half_extent(const struct grrl_perception *p, uint8_t body);

/* Whether two bodies lie near enough to their joint. The limit grows if the joint beats independent
 * motion by a wide margin (`support`, in chi squared). Sliding bodies must lie side by side at both
 * ends. */
bool grrl_joint_is_near(const struct grrl_perception *p, const struct grrl_joint_evidence *e,
                        float support);

/* Evidence for a pivot from its place, as seen by a camera; it falls with the distance from a body.
 */
float grrl_joint_place_evidence(const struct grrl_perception *p,
                                const struct grrl_joint_evidence *e);

/* Cost of a joint's distance: of two joints equally well supported, the one nearer to its bodies is
 * more likely. */
float grrl_joint_distance_cost(const struct grrl_perception *p,
                               const struct grrl_joint_evidence *e);

/* Limit on the evidence for a slide from a common turn: odds of 3 million to 1. More would only
 * hide the evidence of later pushes. */
#define GRRL_TURN_EVIDENCE_MAX 30.0f

/* joint_pictures.c: evidence for a slide, in chi squared, as seen by a camera that may move.
 * variance: of a position across the line in one keyframe. */
float grrl_joint_slide_in_pictures(const struct grrl_perception *p,
                                   const struct grrl_joint_evidence *e, float variance);

/* structure.c: whether a third body turns relative to both bodies about the same pivot, or slides
 * along both while they never moved. */
bool grrl_structure_move_as_one(const struct grrl_perception *p, uint8_t a, uint8_t b);

/* Fills the model from the bodies and the joints between them. */
void grrl_structure_update(struct grrl_perception *p);

#endif
