/*
 * perception.h: from tracked feature points to links and joints (paper, section IV).
 *
 * Points come in frame by frame, each with only an id and a position in the table plane. Frames at
 * rest and frames of a push are averaged into keyframes; the keyframes of a trial are the evidence.
 * From them grrl_perception_update finds the bodies (sets of features that move as one rigid body)
 * and, for each pair that moved relative to each other, a revolute or prismatic joint if the motion
 * supports one. Evidence accumulates over the pushes of a trial and may overturn an earlier answer.
 * docs/perception.md describes the method.
 *
 * Order of calls: grrl_perception_init once; grrl_perception_reset for each object;
 * grrl_perception_observe for each frame; at rest after each push grrl_perception_update, then
 * grrl_perception_model.
 */
#ifndef GRRL_PERCEPTION_H
#define GRRL_PERCEPTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "grrl/base/api.h"
#include "grrl/base/config.h"
#include "grrl/base/geometry.h"
#include "grrl/base/joint_type.h"
#include "grrl/base/status.h"

GRRL_API_BEGIN

#define grrl_perception_init GRRL_SIZED(grrl_perception_init)

/* The points visible at one time: table plane, right-handed, metres. An id is any number that stays
 * with its feature; the order of ids means nothing. */
struct grrl_frame {
    uint32_t n;
    const int32_t *id;
    const float *x_m;
    const float *y_m;
};

/* Fill with grrl_perception_config_default, then change what differs. */
struct grrl_perception_config {
    float noise_m;       /* standard deviation of a point in one frame, per axis; 0.0007 */
    float model_error_m; /* how far bodies may deviate from rigidity and joints from their models,
                            per axis; 0.0001. The error measured at rest can raise it */
    float keyframe_m;    /* how far features move in a push before the next keyframe; 0.008 */
    float jump_m;        /* a point that moved farther in one frame is an outlier; 0.015 */
    float table_m;       /* points beyond this distance from the origin are refused; 100 */
    float min_turn_rad;  /* relative rotation below this supports no joint type; 0.035 */
    float min_slide_m;   /* relative sliding below this supports no joint type; 0.00175 */
    float pivot_scale_m; /* pivots farther than this from their bodies are unlikely; 0.1 */
    float gap_m;         /* joined bodies stay this close, three of their features; 0.1 */
    float slack; /* factor on the thresholds for splitting a body, >= 1; 1. Camera images are not an
                    exact plane: 5 */
    uint8_t min_features; /* fewer features do not make a body, >= 3; 4. One less is enough for a
                             body that moved far from every other, or, without static_background,
                             if one of another body moves with both */
    uint8_t push_frames;  /* averaged into a keyframe of a push, 0: 3. Use 1 if points move farther
                             than keyframe_m from frame to frame, or if tracks are short */
    bool static_background; /* sparse points that never move are background; true. false: any
                               visible point may belong to a body, as with a moving camera */
    bool sizes_change; /* the camera zooms or comes closer: bodies may grow and shrink; false */
};

/* What a feature belongs to if it belongs to no body. */
enum { GRRL_FEATURE_BACKGROUND = 0xfe, GRRL_FEATURE_NONE = 0xff };

/* A link: the current point cloud of its features, in the world frame. */
struct grrl_body {
    uint16_t number; /* stays the same for the trial: the n of its grounding set fn */
    uint16_t n_features;
    struct grrl_vec2 centroid_m;
    struct grrl_vec2 axis; /* unit vector along the principal axis; its sign is arbitrary */
    float length_m;        /* extent of the cloud along the axis */
    float width_m;         /* and across */
};

/* A joint between bodies a < b (indices) at its current place in the world frame. */
struct grrl_joint {
    uint8_t a;
    uint8_t b;
    uint8_t type;      /* enum grrl_joint_type */
    float probability; /* of this type, given the evidence */
    float p_revolute;  /* of each possibility; the three sum to 1 */
    float p_prismatic;
    float p_disconnected;
    struct grrl_vec2 point_m; /* the pivot; a point on the sliding axis */
    float point_cov_m2[3];    /* its covariance xx, xy, yy; for a prismatic joint across the axis */
    struct grrl_vec2 axis;    /* unit vector of sliding; (0, 0) for a revolute joint */
    float axis_sd_rad;        /* standard deviation of its direction */
    float lower;              /* smallest and largest excursion so far from the first keyframe, */
    float upper;              /* radians (b relative to a) or metres (along the axis) */
};

/* What is known about two bodies. Features of the same body are rigid; these are the other answers.
 */
enum grrl_relation {
    GRRL_RELATION_UNDETERMINED, /* they moved too little, or in too few ways, to decide */
    GRRL_RELATION_DISCONNECTED, /* with a probability of at least 0.95 */
    GRRL_RELATION_JOINED        /* by a joint of the model */
};

/* Why two bodies are undetermined. */
enum grrl_reason {
    GRRL_REASON_NONE,    /* they are not */
    GRRL_REASON_LITTLE,  /* the relative motion is below min_turn_rad and min_slide_m, or within the
                            noise */
    GRRL_REASON_NO_TYPE, /* neither type explains the motion, or both do */
    GRRL_REASON_UNPROVEN,  /* independent motion explains it as well */
    GRRL_REASON_FAR,       /* they lie too far from the joint the motion suggests */
    GRRL_REASON_SIZES,     /* their relative size changes: they are not in one plane */
    GRRL_REASON_STRUCTURE, /* the other joints leave no room for this one */
};

/* The evidence from the motion of two bodies alone; the three probabilities sum to 1. They are a
 * third each if the motion does not discriminate. The overall structure may reject what a pair
 * suggests. */
struct grrl_pair {
    uint8_t relation; /* enum grrl_relation */
    uint8_t reason;   /* enum grrl_reason */
    float p_revolute;
    float p_prismatic;
    float p_disconnected;
    float
        turned_rad; /* how far they moved apart so far: min_turn_rad or min_slide_m tell a joint */
    float slid_m;
};

/* The current estimate. Bodies and joints are in order of discovery. */
struct grrl_model {
    uint8_t n_bodies;
    uint8_t n_joints;
    uint16_t n_features;
    struct grrl_body body[GRRL_MAX_LINKS];
    struct grrl_joint joint[GRRL_MAX_JOINTS];
    int32_t feature_id[GRRL_MAX_FEATURES];
    struct grrl_vec2 feature_m[GRRL_MAX_FEATURES]; /* current, or where it was last seen */
    uint8_t feature_body[GRRL_MAX_FEATURES];       /* a body's index or GRRL_FEATURE_.. */
};

struct grrl_perception_counts {
    uint32_t frames;
    uint32_t outliers;       /* points that jumped, dropped */
    uint32_t refused;        /* points that were not finite or beyond table_m */
    uint32_t overflow;       /* features beyond GRRL_MAX_FEATURES, dropped */
    uint32_t thinned;        /* keyframes dropped to make room for newer ones */
    uint16_t features_high;  /* most features at a time */
    uint16_t keyframes_high; /* most keyframes at a time */
};

/* private: points being averaged */
struct grrl_perception_sum {
    float x;
    float y;
    uint8_t n;
};

/* private: each feature's points of a window, in two clusters: an outlier starts its own */
struct grrl_perception_window {
    struct grrl_perception_sum heap[2][GRRL_MAX_FEATURES];
    uint8_t frames;
};

/* private: one averaged snapshot of all features */
struct grrl_perception_keyframe {
    struct grrl_vec2 point[GRRL_MAX_FEATURES];
    uint8_t weight[GRRL_MAX_FEATURES]; /* frames averaged; 0: not seen */
    bool at_rest;
    bool examined; /* for outliers */
};

/* private: a body's pose in one keyframe, in units of one frame's noise */
struct grrl_perception_pose {
    struct grrl_pose pose;
    float weight;  /* sum of its features' weights; 0: not seen */
    float inertia; /* sum of weight times squared distance from the centroid, m^2 */
    float growth;  /* how much larger it appears than its shape; 0: same size */
};

struct grrl_perception {
    struct grrl_perception_config config;
    struct grrl_perception_counts counts;

    /* private: tracks, by slot */
    uint16_t n_slots;
    uint16_t slot_of_hash[4 * GRRL_MAX_FEATURES]; /* open addressing by id, slot + 1 */
    int32_t id[GRRL_MAX_FEATURES];
    struct grrl_vec2 last[GRRL_MAX_FEATURES];
    struct grrl_vec2 before[GRRL_MAX_FEATURES]; /* the last, where it was seen */
    uint32_t last_frame[GRRL_MAX_FEATURES];
    uint8_t jumps[GRRL_MAX_FEATURES];
    uint8_t body_of[GRRL_MAX_FEATURES];
    uint8_t blob_of[GRRL_MAX_FEATURES]; /* dense group in the first keyframe; 0: none */
    float
        reach2_m2; /* squared: in the first keyframe, features of one object lie closer together */
    bool has_moved[GRRL_MAX_FEATURES]; /* at any time since the first keyframe */

    /* private: keyframes */
    struct grrl_perception_window window;
    bool moving;
    uint8_t n_keyframes;
    bool rest_open; /* the last keyframe is at rest and still being averaged */
    struct grrl_perception_keyframe keyframe[GRRL_MAX_KEYFRAMES];

    /* private: bodies */
    uint8_t n_bodies;
    uint16_t n_numbers;
    bool is_assigned; /* no body has changed since every feature was last found where it belongs */
    uint16_t number[GRRL_MAX_LINKS];
    struct grrl_vec2 shape[GRRL_MAX_FEATURES]; /* in the frame of the feature's body */
    struct grrl_perception_pose pose[GRRL_MAX_KEYFRAMES][GRRL_MAX_LINKS];
    float rest_error_m;            /* of points at rest beyond noise and model error; 0: none */
    float bend_m2[GRRL_MAX_LINKS]; /* variance of a body's residuals beyond noise, per axis */

    /* private: the answer */
    struct grrl_model model;
};

/* A tracker in metres above a table, with a background at rest. */
void grrl_perception_config_default(struct grrl_perception_config *config);

/*
 * For a camera that may move: points in pixels, passed as if a pixel were pixel_m metres wide
 * (0.001 will do). Perspective and depth violate the planar rigid model slightly, hence a larger
 * model error, slack, and no static background.
 */
void grrl_perception_config_camera(struct grrl_perception_config *config, float pixel_m);

/* GRRL_ERR_ARGUMENT for a configuration that is not finite or out of range. */
GRRL_MUST_USE enum grrl_status grrl_perception_init(struct grrl_perception *perception,
                                                    const struct grrl_perception_config *config);

/* Forgets the object: a new one follows. The counts go on. */
void grrl_perception_reset(struct grrl_perception *perception);

/*
 * Takes one frame. pushing: the robot is acting, so things may move. Points that are not finite or
 * beyond table_m are refused and counted; they are never an error. Cost: linear in the points.
 */
void grrl_perception_observe(struct grrl_perception *perception, const struct grrl_frame *frame,
                             bool pushing);

/*
 * Computes bodies and joints from all keyframes, including the frames at rest since the last push.
 * GRRL_ERR_NONE: no feature seen yet. Cost: a few passes over features x bodies x keyframes.
 */
GRRL_MUST_USE enum grrl_status grrl_perception_update(struct grrl_perception *perception);

/* The result of the last update; empty before the first. */
const struct grrl_model *grrl_perception_model(const struct grrl_perception *perception);

/*
 * What the last update knows about bodies a and b (indices of the model). GRRL_ERR_ARGUMENT: a and
 * b are not two bodies of the model. Call it before further frames. Cost: linear in keyframes and
 * features.
 */
GRRL_MUST_USE enum grrl_status grrl_perception_pair(const struct grrl_perception *perception,
                                                    uint8_t a, uint8_t b, struct grrl_pair *pair);

/*
 * The relative change in size of a body (index of the model) over the trial, beyond what noise
 * explains; 0 for a planar body that a camera sees from above at a constant distance, or if there
 * is no such body. A body that changes by a tenth is split into slices unless sizes_change is set.
 * Call it before further frames. Cost: linear in keyframes and features.
 */
float grrl_perception_size_change(const struct grrl_perception *perception, uint8_t body);

GRRL_API_END

#endif
