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

/* Share of min_slide_m from keyframe to keyframe: less does not count as sliding during a turn. */
#define STEP_SHARE 0.5f

/* Limit on the evidence from a common turn, as in joints.c, and the evidence from each further
 * stroke. */
#define TURN_EVIDENCE_MAX 30.0f
#define PUSH_EVIDENCE 4.0f

/* The body that reveals the camera's own motion: the widest, if it is wide enough to lie behind a
 * and b rather than beside them. GRRL_MAX_LINKS: there is none. */
static uint8_t background_of(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    uint8_t widest = 0;
    for (uint8_t c = 1; c < p->n_bodies; c++)
        if (grrl_joint_half_extent(p, c) > grrl_joint_half_extent(p, widest))
            widest = c;
    float width = grrl_joint_half_extent(p, widest);
    bool is_wide = width > WIDE * grrl_joint_half_extent(p, a) &&
                   width > WIDE * grrl_joint_half_extent(p, b); /* neither of them */
    return is_wide ? widest : GRRL_MAX_LINKS;
}

/* b as seen from a. */
static struct grrl_pose turn_from(const struct grrl_pose *a, const struct grrl_pose *b)
{
    return (struct grrl_pose){.c = a->c * b->c + a->s * b->s, .s = a->c * b->s - a->s * b->c};
}

static float least_step2(const struct grrl_perception *p)
{
    float step = STEP_SHARE * p->config.min_slide_m;
    return step * step;
}

static float smaller(float a, float b)
{
    return a * a < b * b ? a : b;
}

/* How far both bodies of a pair turned while sliding. */
struct turns {
    float in_picture[2];
    float on_ground[2];
    float variance; /* the largest */
};

static void add_turns(struct turns *turns, const struct grrl_perception_pose *from,
                      const struct grrl_perception_pose *to, const struct grrl_pose *ground, int of)
{
    struct grrl_pose turn = turn_from(&from->pose, &to->pose);
    turns->in_picture[of] += turn.s;
    turns->on_ground[of] += ground->c * turn.s - ground->s * turn.c;
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
static float slid(const struct grrl_perception *p, uint8_t k, const struct grrl_joint_evidence *e)
{
    struct grrl_vec2 d = grrl_origin_in(&p->pose[k][e->a], &p->pose[k][e->b]);
    return grrl_vec2_dot(d, e->fit.axis_in_a);
}

static bool sees_both(const struct grrl_perception *p, uint8_t k,
                      const struct grrl_joint_evidence *e)
{
    return p->pose[k][e->a].weight > 0.0f && p->pose[k][e->b].weight > 0.0f;
}

/*
 * How far a pair turned together at most while sliding, in chi squared. Turns at other times do not
 * count: a thing that is carried and then leaves in a straight line turns first and slides
 * afterwards. Both bodies must turn in the image, which rules out a third body turning by itself,
 * and relative to the background, which rules out the camera. If one body of the pair is the
 * background, its turn cannot be distinguished from that of the camera.
 */
static float turn_while_sliding(const struct grrl_perception *p,
                                const struct grrl_joint_evidence *e)
{
    uint8_t ground = background_of(p, e->a, e->b);
    struct turns turns = {.variance = 0.0f};
    uint8_t last = GRRL_MAX_KEYFRAMES;
    float most2 = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes && ground < GRRL_MAX_LINKS; k++) {
        const struct grrl_perception_pose *now = p->pose[k];
        if (!sees_both(p, k, e) || !(now[ground].weight > 0.0f))
            continue;
        float step = last < GRRL_MAX_KEYFRAMES ? slid(p, k, e) - slid(p, last, e) : 0.0f;
        if (step * step > least_step2(p)) {
            const struct grrl_perception_pose *before = p->pose[last];
            struct grrl_pose moved = turn_from(&before[ground].pose, &now[ground].pose);
            add_turns(&turns, &before[e->a], &now[e->a], &moved, 0);
            add_turns(&turns, &before[e->b], &now[e->b], &moved, 1);
            float v = turn_variance(p, k, e->a) + turn_variance(p, k, e->b);
            turns.variance = v > turns.variance ? v : turns.variance;
            float turned = smaller(smaller(turns.in_picture[0], turns.in_picture[1]),
                                   smaller(turns.on_ground[0], turns.on_ground[1]));
            most2 = turned * turned > most2 ? turned * turned : most2;
        }
        last = k;
    }
    return turns.variance > 0.0f ? most2 / turns.variance : 0.0f;
}

/* Strokes of a slide, back and forth: independent things do not return the same way. */
static float count_strokes(const struct grrl_perception *p, const struct grrl_joint_evidence *e)
{
    float low = 0.0f; /* since the last turning point */
    float high = 0.0f;
    float direction = 0.0f;
    float strokes = 0.0f;
    float first = 0.0f;
    bool begun = false;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        if (!sees_both(p, k, e))
            continue;
        first = begun ? first : slid(p, k, e);
        begun = true;
        float at = slid(p, k, e) - first;
        high = at > high ? at : high;
        low = at < low ? at : low;
        bool forth = direction <= 0.0f && at - low > p->config.min_slide_m;
        bool back = direction >= 0.0f && high - at > p->config.min_slide_m;
        if (forth || back) {
            direction = forth ? 1.0f : -1.0f;
            high = at;
            low = at;
            strokes += 1.0f;
        }
    }
    return strokes;
}

float grrl_joint_slide_in_pictures(const struct grrl_perception *p,
                                   const struct grrl_joint_evidence *e)
{
    float turned = turn_while_sliding(p, e);
    float strokes = count_strokes(p, e) - 1.0f;
    turned = turned < TURN_EVIDENCE_MAX ? turned : TURN_EVIDENCE_MAX;
    return turned + (strokes > 0.0f ? PUSH_EVIDENCE * strokes : 0.0f);
}
