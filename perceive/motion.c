/*
 * motion.c: poses of the bodies from their features, frame by frame, by least squares.
 *
 * A body's shape starts with the frame that shows most of its features. From there, forward and
 * backward, the pose of the known features places new ones in the shape. So a body can be followed
 * while features come and go, as long as two of them overlap.
 */
#include "motion.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "tracks.h"

/* A pose ignores points with a larger residual, in units of noise + model error. */
#define OUTLIER 5.0f

enum { NOT_IN_A_BODY = 0xffff };

struct body_pose {
    struct grrl_pose pose;
    bool known;
};

struct motion {
    const struct grrl_report *report;
    const struct grrl_tracks *tracks;
    float limit2_m2;
    uint16_t *feature;      /* for each point of the recording, its index in the model */
    struct body_pose *pose; /* by frame, then body */
    struct grrl_vec2 shape[GRRL_MAX_FEATURES];
    bool placed[GRRL_MAX_FEATURES];
};

/* Sums for a least-squares fit of a pose: world = R shape + p. */
struct fit {
    double n;
    double from[2];
    double to[2];
    double cosine;
    double sine;
};

static struct grrl_vec2 point_at(const struct motion *motion, size_t i)
{
    return (struct grrl_vec2){motion->tracks->x[i], motion->tracks->y[i]};
}

static bool is_of_body(const struct motion *motion, size_t i, unsigned body)
{
    return motion->feature[i] != NOT_IN_A_BODY &&
           motion->report->model->feature_body[motion->feature[i]] == body;
}

static struct body_pose *pose_of(const struct motion *motion, size_t frame, unsigned body)
{
    return &motion->pose[frame * motion->report->model->n_bodies + body];
}

struct id_index {
    int32_t id;
    uint16_t index;
};

static int by_id(const void *left, const void *right)
{
    const struct id_index *a = left;
    const struct id_index *b = right;
    return a->id < b->id ? -1 : a->id > b->id;
}

static void find_features(struct motion *motion)
{
    const struct grrl_model *model = motion->report->model;
    struct id_index index[GRRL_MAX_FEATURES];
    for (uint16_t i = 0; i < model->n_features; i++)
        index[i] = (struct id_index){model->feature_id[i], i};
    qsort(index, model->n_features, sizeof *index, by_id);
    for (size_t i = 0; i < motion->tracks->n_points; i++) {
        struct id_index key = {motion->tracks->id[i], 0};
        const struct id_index *found =
            bsearch(&key, index, model->n_features, sizeof *index, by_id);
        motion->feature[i] = found != NULL ? found->index : NOT_IN_A_BODY;
    }
}

static void fit_add(struct fit *fit, struct grrl_vec2 from, struct grrl_vec2 to)
{
    fit->n += 1.0;
    fit->from[0] += (double)from.x;
    fit->from[1] += (double)from.y;
    fit->to[0] += (double)to.x;
    fit->to[1] += (double)to.y;
    fit->cosine += (double)from.x * (double)to.x + (double)from.y * (double)to.y;
    fit->sine += (double)from.x * (double)to.y - (double)from.y * (double)to.x;
}

/* The pose of a fit to at least two points that do not coincide; else unknown. */
static struct body_pose fit_pose(const struct fit *fit)
{
    struct body_pose answer = {{{0.0f, 0.0f}, 1.0f, 0.0f}, false};
    if (fit->n < 2.0)
        return answer;
    double c = fit->cosine - (fit->from[0] * fit->to[0] + fit->from[1] * fit->to[1]) / fit->n;
    double s = fit->sine - (fit->from[0] * fit->to[1] - fit->from[1] * fit->to[0]) / fit->n;
    float angle = grrl_atan2((float)s, (float)c);
    if (c == 0.0 && s == 0.0)
        return answer;
    answer.pose.c = grrl_cos(angle);
    answer.pose.s = grrl_sin(angle);
    struct grrl_vec2 turned =
        grrl_rotate(answer.pose, (struct grrl_vec2){(float)(fit->from[0] / fit->n),
                                                    (float)(fit->from[1] / fit->n)});
    answer.pose.p = grrl_vec2_sub(
        (struct grrl_vec2){(float)(fit->to[0] / fit->n), (float)(fit->to[1] / fit->n)}, turned);
    answer.known = true;
    return answer;
}

/* Sums over the features that have a place in the shape; with `rough`, only those that fit it. */
static struct fit sum_up(const struct motion *motion, const struct grrl_tracks_frame *frame,
                         unsigned body, const struct body_pose *rough)
{
    struct fit fit = {.n = 0.0};
    for (size_t i = frame->first; i < frame->first + frame->n; i++) {
        if (!is_of_body(motion, i, body) || !motion->placed[motion->feature[i]])
            continue;
        struct grrl_vec2 from = motion->shape[motion->feature[i]];
        struct grrl_vec2 to = point_at(motion, i);
        struct grrl_vec2 off = {0.0f, 0.0f};
        if (rough != NULL)
            off = grrl_vec2_sub(to, grrl_transform(rough->pose, from));
        if (grrl_vec2_dot(off, off) <= motion->limit2_m2)
            fit_add(&fit, from, to);
    }
    return fit;
}

static void follow_body(struct motion *motion, size_t f, unsigned body)
{
    const struct grrl_tracks_frame *frame = &motion->tracks->frame[f];
    struct fit all = sum_up(motion, frame, body, NULL);
    struct body_pose pose = fit_pose(&all);
    if (pose.known) {
        struct fit good = sum_up(motion, frame, body, &pose);
        if (2.0 * good.n >= all.n && good.n >= 2.0)
            pose = fit_pose(&good);
    }
    *pose_of(motion, f, body) = pose;
    for (size_t i = frame->first; pose.known && i < frame->first + frame->n; i++) {
        if (is_of_body(motion, i, body) && !motion->placed[motion->feature[i]]) {
            motion->shape[motion->feature[i]] = grrl_untransform(pose.pose, point_at(motion, i));
            motion->placed[motion->feature[i]] = true;
        }
    }
}

/* The frame that shows most features of a body. */
static size_t best_frame(const struct motion *motion, unsigned body)
{
    size_t best = 0;
    unsigned most = 0;
    for (size_t f = 0; f < motion->tracks->n_frames; f++) {
        const struct grrl_tracks_frame *frame = &motion->tracks->frame[f];
        unsigned n = 0;
        for (size_t i = frame->first; i < frame->first + frame->n; i++)
            n += is_of_body(motion, i, body);
        best = n > most ? f : best;
        most = n > most ? n : most;
    }
    return best;
}

static void track_body(struct motion *motion, unsigned body)
{
    size_t best = best_frame(motion, body);
    const struct grrl_tracks_frame *frame = &motion->tracks->frame[best];
    for (size_t i = frame->first; i < frame->first + frame->n; i++) {
        if (is_of_body(motion, i, body)) {
            motion->shape[motion->feature[i]] = point_at(motion, i);
            motion->placed[motion->feature[i]] = true;
        }
    }
    for (size_t f = best; f < motion->tracks->n_frames; f++)
        follow_body(motion, f, body);
    for (size_t f = best; f > 0; f--)
        follow_body(motion, f - 1, body);
}

static float angle_of(const struct grrl_pose *pose)
{
    return grrl_atan2(pose->s, pose->c);
}

/* The joint's sliding axis as body a has it: the model tells how it lies at the end. */
static struct grrl_vec2 axis_of(const struct motion *motion, const struct grrl_joint *joint)
{
    for (size_t f = motion->tracks->n_frames; f > 0; f--)
        if (pose_of(motion, f - 1, joint->a)->known)
            return grrl_unrotate(pose_of(motion, f - 1, joint->a)->pose, joint->axis);
    return joint->axis;
}

/* The centroid of a body's shape, where its pose is known best. */
static struct grrl_vec2 middle_of(const struct motion *motion, unsigned body)
{
    const struct grrl_model *model = motion->report->model;
    struct grrl_vec2 sum = {0.0f, 0.0f};
    float n = 0.0f;
    for (uint16_t i = 0; i < model->n_features; i++) {
        if (model->feature_body[i] == body && motion->placed[i]) {
            sum = grrl_vec2_add(sum, motion->shape[i]);
            n += 1.0f;
        }
    }
    return n > 0.0f ? grrl_vec2_scale(sum, 1.0f / n) : sum;
}

static void write_joint(FILE *file, const struct motion *motion, const struct grrl_joint *joint)
{
    const struct grrl_body *body = motion->report->model->body;
    bool slides = joint->type == GRRL_PRISMATIC;
    double scale = slides ? motion->report->per_metre : 180.0 / (double)GRRL_PI;
    struct grrl_vec2 axis = axis_of(motion, joint);
    struct grrl_vec2 middle = middle_of(motion, joint->b);
    float first = 0.0f;
    float before = 0.0f;
    bool begun = false;
    for (size_t f = 0; f < motion->tracks->n_frames; f++) {
        const struct body_pose *a = pose_of(motion, f, joint->a);
        const struct body_pose *b = pose_of(motion, f, joint->b);
        if (!a->known || !b->known)
            continue;
        struct grrl_vec2 there = grrl_untransform(a->pose, grrl_transform(b->pose, middle));
        float value = slides ? grrl_vec2_dot(axis, there) : angle_of(&b->pose) - angle_of(&a->pose);
        if (!slides && begun) /* continues beyond half a turn */
            value = before + grrl_wrap_rad(value - before);
        first = begun ? first : value;
        before = value;
        begun = true;
        (void)fprintf(file, "%" PRId64 ",f%u,f%u,%s,%.6g,%s\n", motion->tracks->frame[f].number,
                      (unsigned)body[joint->a].number, (unsigned)body[joint->b].number,
                      slides ? "prismatic" : "revolute", (double)(value - first) * scale,
                      slides ? motion->report->unit : "degrees");
    }
}

bool grrl_motion_write(FILE *file, const struct grrl_report *report)
{
    const struct grrl_tracks *tracks = report->recording;
    const struct grrl_perception_config *config = &report->perception->config;
    struct motion motion = {.report = report, .tracks = tracks};
    float limit = OUTLIER * (config->noise_m + config->model_error_m);
    motion.limit2_m2 = limit * limit;
    motion.feature = calloc(tracks->n_points + 1, sizeof *motion.feature);
    motion.pose = calloc(tracks->n_frames * report->model->n_bodies + 1, sizeof *motion.pose);
    bool good = motion.feature != NULL && motion.pose != NULL;
    if (good) {
        find_features(&motion);
        for (unsigned body = 0; body < report->model->n_bodies; body++)
            track_body(&motion, body);
        (void)fputs("frame,a,b,type,value,unit\n", file);
        for (unsigned i = 0; i < report->model->n_joints; i++)
            write_joint(file, &motion, &report->model->joint[i]);
    }
    free(motion.feature);
    free(motion.pose);
    return good;
}
