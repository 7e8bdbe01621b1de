/*
 * joint_place.c: where a joint lies, as evidence for it.
 *
 * Joined bodies lie side by side, and a pivot lies on both. How large they are follows from their
 * features: a fixed distance would reject a door and accept a toy.
 */
#include "perception/perception_internal.h"

/* Evidence, as seen by a camera, from a pivot that lies on both bodies: that of independent motions
 * lies anywhere within a few lengths of them, in 20 times the area of a body. */
#define ON_BODIES 6.0f

/* A pivot is off a body if the third nearest feature is farther away than this share of half the
 * body's extent. With ten features along a link, the third nearest to its end is half as far. */
#define OFF_BODY 0.9f

/* A pivot farther from a body than this many times half its visible extent is rejected: a car in a
 * bend has a pivot, too. */
#define FAR_BODY 2.2f

/* On a table, a pivot farther than gap_m from a body's features may be this many times half the
 * body's extent farther away. A door seen only in its outer two thirds needs 1; with 2.2, joints
 * between separate objects appear in 0.2% of the states with two objects. */
#define FAR_ON_TABLE 1.5f

/* A joint that beats independent motion by this much in chi squared may lie farther from its bodies
 * than gap_m: odds of 3 million to 1 (exp(30 / 2)) outweigh the prior that a pivot lies on both. */
#define CERTAIN 30.0f

/* If a pivot is farther than this from its bodies, in units of gap_m, any nearer body counts as
 * holding it: two ends of a chain may turn about a point that is on neither of them, nor on the
 * links between. */
#define FAR_PIVOT 1.5f

/* Distance from its bodies, in units of gap_m, that lowers a joint's order by 1: 40 mm, the width
 * of a link. */
#define ORDER_SCALE 0.4f

float grrl_joint_half_extent(const struct grrl_perception *p, uint8_t body)
{
    float far2 = 0.0f;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] == body) {
            float d2 = grrl_vec2_dot(p->shape[i], p->shape[i]);
            far2 = d2 > far2 ? d2 : far2;
        }
    }
    return grrl_sqrt(far2);
}

/* The squared distance from a point in a body's frame to the third nearest of its features: a few
 * features near a joint may be assigned to the wrong body. */
static float third_nearest2(const struct grrl_perception *p, const uint16_t *slots, uint16_t n,
                            struct grrl_vec2 local)
{
    float nearest2[3] = {1e9f, 1e9f, 1e9f};
    for (uint16_t i = 0; i < n; i++) {
        float d2 = grrl_vec2_distance2(p->shape[slots[i]], local);
        for (int at = 0; at < 3; at++) {
            if (d2 < nearest2[at]) {
                float t = nearest2[at];
                nearest2[at] = d2;
                d2 = t;
            }
        }
    }
    return nearest2[2];
}

static float distance_to_body(const struct grrl_perception *p, uint8_t body, struct grrl_vec2 local)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n = grrl_rigid_slots(p, body, slots);
    return grrl_sqrt(third_nearest2(p, slots, n, local));
}

/* Distance between two bodies in keyframe k: the smallest from a feature of b to the third nearest
 * of a. */
static float gap_between(const struct grrl_perception *p, uint8_t a, uint8_t b, uint8_t k)
{
    uint16_t slots[GRRL_MAX_FEATURES];
    uint16_t n = grrl_rigid_slots(p, a, slots);
    float best2 = 1e18f;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] == b) {
            struct grrl_vec2 world = grrl_to_world(&p->pose[k][b], p->shape[i]);
            float d2 = third_nearest2(p, slots, n, grrl_to_local(&p->pose[k][a], world));
            best2 = d2 < best2 ? d2 : best2;
        }
    }
    return grrl_sqrt(best2);
}

/* Whether a third body holds the pivot: it lies closer than `distance` in the last keyframe that
 * saw it. One that passes by does not hold it: the pivot does not stay in place there. */
static bool holds_pivot(const struct grrl_perception *p, const struct grrl_joint_evidence *e,
                        uint8_t body, float distance)
{
    float gap = p->config.gap_m;
    float reach = GRRL_PIN_REACH * gap;
    struct grrl_vec2 first = {0.0f, 0.0f};
    struct grrl_vec2 at = {0.0f, 0.0f};
    bool seen = false;
    bool stays = true;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        if (!grrl_perception_sees_both(p, k, e->a, body))
            continue;
        struct grrl_vec2 world = grrl_to_world(&p->pose[k][e->a], e->fit.in_a);
        at = grrl_to_local(&p->pose[k][body], world);
        first = seen ? first : at;
        seen = true;
        stays = stays && grrl_vec2_distance2(at, first) < reach * reach;
    }
    return seen && (stays || distance > FAR_PIVOT * gap) &&
           distance_to_body(p, body, at) < distance;
}

/* Whether any third body holds the pivot. */
static bool is_held_by_third(const struct grrl_perception *p, const struct grrl_joint_evidence *e,
                             float distance)
{
    for (uint8_t c = 0; c < p->n_bodies; c++)
        if (c != e->a && c != e->b && holds_pivot(p, e, c, distance))
            return true;
    return false;
}

/*
 * The pivot of joined bodies is near both. Bodies with few features may have none close to it: if
 * the motion leaves no doubt and no other body lies nearer, the pivot may be farther away,
 * depending on their size. A camera gives no scale, so that only the size counts there.
 */
static bool is_pivot_near(const struct grrl_perception *p, const struct grrl_joint_evidence *e,
                          float support)
{
    bool table = grrl_perception_on_table(p);
    float gap = table ? p->config.gap_m : 0.0f;
    float share = table ? FAR_ON_TABLE : FAR_BODY;
    float da = distance_to_body(p, e->a, e->fit.in_a);
    float db = distance_to_body(p, e->b, e->fit.in_b);
    if (table && da < gap && db < gap)
        return true;
    if (!(da < gap + share * grrl_joint_half_extent(p, e->a)) ||
        !(db < gap + share * grrl_joint_half_extent(p, e->b)))
        return false;
    return !table || (support > CERTAIN && !is_held_by_third(p, e, da > db ? da : db));
}

/* Whether a third body lies closer to both than they are to each other in keyframe k. */
static bool stands_between(const struct grrl_perception *p, uint8_t a, uint8_t b, uint8_t k,
                           float gap)
{
    for (uint8_t c = 0; c < p->n_bodies; c++)
        if (c != a && c != b && p->pose[k][c].weight > 0.0f && gap_between(p, a, c, k) < gap &&
            gap_between(p, b, c, k) < gap)
            return true;
    return false;
}

/* Bodies that slide along each other lie side by side at rest; as for a pivot, those with few
 * features may seem farther apart if the motion leaves no doubt and no other body lies between. */
static bool is_slide_near(const struct grrl_perception *p, const struct grrl_joint_evidence *e,
                          float support)
{
    float near = p->config.gap_m;
    near += e->fit.upper - e->fit.lower; /* fully extended, they are that much farther apart */
    float far = near;
    if (support > CERTAIN || !grrl_perception_on_table(p))
        far += grrl_joint_half_extent(p, e->a) + grrl_joint_half_extent(p, e->b);
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        bool both_rest = p->keyframe[k].at_rest && grrl_perception_sees_both(p, k, e->a, e->b);
        float gap = both_rest ? gap_between(p, e->a, e->b, k) : 0.0f;
        if (gap > far ||
            (gap > near && grrl_perception_on_table(p) && stands_between(p, e->a, e->b, k, gap)))
            return false;
    }
    return true;
}

bool grrl_joint_is_near(const struct grrl_perception *p, const struct grrl_joint_evidence *e,
                        float support)
{
    return e->type == GRRL_REVOLUTE ? is_pivot_near(p, e, support) : is_slide_near(p, e, support);
}

float grrl_joint_place_evidence(const struct grrl_perception *p,
                                const struct grrl_joint_evidence *e)
{
    float da =
        distance_to_body(p, e->a, e->fit.in_a) / (OFF_BODY * grrl_joint_half_extent(p, e->a));
    float db =
        distance_to_body(p, e->b, e->fit.in_b) / (OFF_BODY * grrl_joint_half_extent(p, e->b));
    float off = da > db ? da : db;
    return off < 1.0f ? ON_BODIES * (1.0f - off * off) : 0.0f;
}

float grrl_joint_distance_cost(const struct grrl_perception *p, const struct grrl_joint_evidence *e)
{
    float scale = ORDER_SCALE * p->config.gap_m;
    float da = distance_to_body(p, e->a, e->fit.in_a);
    float db = distance_to_body(p, e->b, e->fit.in_b);
    if (e->type == GRRL_PRISMATIC) {
        uint8_t k = p->n_keyframes;
        while (k > 1 && !grrl_perception_sees_both(p, (uint8_t)(k - 1), e->a, e->b))
            k--;
        da = gap_between(p, e->a, e->b, (uint8_t)(k - 1));
        db = 0.0f;
    }
    return (da * da + db * db) / (scale * scale);
}
