/*
 * joint_pictures.c: evidence for a slide seen by a camera that may move.
 *
 * Two things that slide past each other are joined if they turn together as they slide, or slide
 * back the same way. A rolling camera turns everything together, so only turns relative to a
 * background count.
 */
#include "perception/perception_internal.h"

/* A background is this many times as wide as the bodies in front of it. */
#define WIDE 2.0f

/* Share of min_slide_m from either end of a slide: closer to it, a hand may hold or carry. */
#define END_SHARE 0.5f

/* Limit on the evidence from one return: of a hundred things that move by themselves, one goes back
 * and forth on a line (2 ln 100). */
#define RETURN_EVIDENCE_MAX 9.0f

static float smaller(float a, float b)
{
    return a < b ? a : b;
}

static float larger(float a, float b)
{
    return a > b ? a : b;
}

static float absolute(float x)
{
    return x < 0.0f ? -x : x;
}

/* The mean squared distance of the features seen in a keyframe from their centroid: a single
 * misplaced one hardly counts. */
static float width2(const struct grrl_perception_pose *pose)
{
    return pose->weight > 0.0f ? pose->inertia / pose->weight : 0.0f;
}

/* The body that reveals the camera's own motion: the widest, if it is wide enough to lie behind a
 * and b rather than beside them. GRRL_MAX_LINKS: there is none. */
static uint8_t background_of(const struct grrl_perception *p,
                             const struct grrl_perception_pose *poses, uint8_t a, uint8_t b)
{
    float widest2 = WIDE * WIDE * larger(width2(&poses[a]), width2(&poses[b]));
    uint8_t background = GRRL_MAX_LINKS;
    for (uint8_t c = 0; c < p->n_bodies; c++) {
        if (width2(&poses[c]) > widest2) {
            widest2 = width2(&poses[c]);
            background = c;
        }
    }
    return background;
}

/* b as seen from a. */
static struct grrl_pose turn_from(const struct grrl_pose *a, const struct grrl_pose *b)
{
    return (struct grrl_pose){.c = a->c * b->c + a->s * b->s, .s = a->c * b->s - a->s * b->c};
}

/* Variance of a body's turn in a keyframe: noise, model error and bending (see joints.c). */
static float turn_variance(const struct grrl_perception *p, uint8_t k, uint8_t body)
{
    const struct grrl_perception_pose *pose = &p->pose[k][body];
    float noise = p->config.noise_m;
    float model = grrl_perception_model_error(p);
    return (noise * noise + 4.0f * model * model + p->bend_m2[body] * pose->weight) /
           (pose->inertia + GRRL_LEAST_INERTIA);
}

/* Position of b along the sliding axis, in the frame of a. */
static float slid(const struct grrl_perception_pose *poses, const struct grrl_joint_evidence *e)
{
    return grrl_vec2_dot(grrl_origin_in(&poses[e->a], &poses[e->b]), e->fit.axis_in_a);
}

/* What a pair slid along its line, and how far off it. */
struct path {
    uint8_t first; /* keyframe that saw both */
    float low;     /* positions along the line: between these it is away from both ends */
    float high;
    float variance; /* of the positions across */
};

/* The variance expected counts as much as two keyframes, which a line may take to itself. */
static struct path path_of(const struct grrl_perception *p, const struct grrl_joint_evidence *e,
                           float expected)
{
    struct path path = {0, 1e9f, -1e9f, 0.0f};
    struct grrl_vec2 first = {0.0f, 0.0f};
    float n = 0.0f;
    float sum = 0.0f;
    float sum2 = 2.0f * expected;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        const struct grrl_perception_pose *poses = p->pose[k];
        if (!grrl_perception_sees_both(p, k, e->a, e->b))
            continue;
        struct grrl_vec2 at = grrl_origin_in(&poses[e->a], &poses[e->b]);
        if (!(n > 0.0f)) {
            path.first = k;
            first = at;
        }
        float along = grrl_vec2_dot(at, e->fit.axis_in_a);
        float across = grrl_vec2_cross(e->fit.axis_in_a, grrl_vec2_sub(at, first));
        path.low = smaller(path.low, along);
        path.high = larger(path.high, along);
        sum += across;
        sum2 += across * across;
        n += 1.0f;
    }
    path.low += END_SHARE * p->config.min_slide_m;
    path.high -= END_SHARE * p->config.min_slide_m;
    path.variance = (sum2 - sum * sum / n) / n;
    return path;
}

/*
 * How far a pair turned together at most while sliding, in chi squared. Turns at other times do not
 * count: a thing that is carried and then leaves in a straight line turns first and slides
 * afterwards. Both bodies must turn in the image, which rules out a third body turning by itself,
 * and relative to the background, which rules out the camera. If one body of the pair is the
 * background, its turn cannot be distinguished from that of the camera.
 */
static float turn_while_sliding(const struct grrl_perception *p,
                                const struct grrl_joint_evidence *e, const struct path *path)
{
    uint8_t ground = background_of(p, p->pose[path->first], e->a, e->b);
    float in_picture[2] = {0.0f, 0.0f};
    float on_ground[2] = {0.0f, 0.0f};
    const struct grrl_perception_pose *before = NULL;
    float at_before = 0.0f;
    float most = 0.0f;
    float most_variance = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes && ground < GRRL_MAX_LINKS; k++) {
        const struct grrl_perception_pose *now = p->pose[k];
        if (!grrl_perception_sees_both(p, k, e->a, e->b) || !(now[ground].weight > 0.0f))
            continue;
        float at = slid(now, e);
        float halfway = 0.5f * (at + at_before);
        if (before != NULL && halfway > path->low && halfway < path->high) {
            struct grrl_pose moved = turn_from(&before[ground].pose, &now[ground].pose);
            float variance = 0.0f;
            float least = GRRL_PI;
            for (int i = 0; i < 2; i++) {
                uint8_t body = i == 0 ? e->a : e->b;
                struct grrl_pose turn = turn_from(&before[body].pose, &now[body].pose);
                in_picture[i] += turn.s;
                on_ground[i] += moved.c * turn.s - moved.s * turn.c;
                least = smaller(least, smaller(absolute(in_picture[i]), absolute(on_ground[i])));
                variance += turn_variance(p, k, body);
            }
            most = larger(most, least);
            most_variance = larger(most_variance, variance);
        }
        before = now;
        at_before = at;
    }
    return most_variance > 0.0f ? most * most / most_variance : 0.0f;
}

/*
 * Evidence, in chi squared, from a slide that comes back along its line over this distance. A thing
 * on its own may leave in any direction, with a density of 1 / (2 pi). On the line, the direction
 * has the standard error s, a density of 1 / (sqrt(2 pi) s). Both ends of both strokes scatter
 * across the line by `variance`, so s^2 = 4 variance / distance^2.
 */
static float return_evidence(float distance, float variance)
{
    float evidence = grrl_log(0.5f * GRRL_PI * distance * distance / variance);
    return smaller(larger(evidence, 0.0f), RETURN_EVIDENCE_MAX);
}

/* Adds up the evidence of all returns. A return counts over the shorter of its stroke and the one
 * before. */
static float evidence_of_returns(const struct grrl_perception *p,
                                 const struct grrl_joint_evidence *e, float variance)
{
    float before = 0.0f; /* length of the last stroke */
    float from = 0.0f;   /* the present one */
    float to = 0.0f;
    float sum = 0.0f;
    bool begun = false;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        if (!grrl_perception_sees_both(p, k, e->a, e->b))
            continue;
        float at = slid(p->pose[k], e);
        if (!begun)
            from = to = at;
        begun = true;
        if ((at - to) * (to - from) >= 0.0f) {
            to = at;
        } else if (absolute(at - to) > p->config.min_slide_m) {
            float stroke = absolute(to - from);
            sum += return_evidence(smaller(before, stroke), variance);
            before = stroke;
            from = to;
            to = at;
        }
    }
    float stroke = absolute(to - from);
    return sum + return_evidence(smaller(before, stroke), variance);
}

float grrl_joint_slide_in_pictures(const struct grrl_perception *p,
                                   const struct grrl_joint_evidence *e, float variance)
{
    struct path path = path_of(p, e, variance);
    return smaller(turn_while_sliding(p, e, &path), GRRL_TURN_EVIDENCE_MAX) +
           evidence_of_returns(p, e, path.variance);
}
