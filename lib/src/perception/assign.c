/*
 * assign.c: which body a feature moves with.
 *
 * The cost of a feature in a body is the sum of its squared residuals over all keyframes, in units
 * of their variance; each contributes 2 on average. A feature goes where it costs least, if noise
 * can explain that cost.
 */
#include "perception/perception_internal.h"

/* A feature may belong to a body up to this many standard deviations above the expected cost, plus
 * 4 because chi squared has a longer tail for few keyframes: noise exceeds the limit in one case of
 * 1,100 with one keyframe, of 3,600 with ten. */
#define LIMIT_SIGMAS 4.0f
#define LIMIT_BASE 4.0f

/* Chi squared by which another body must beat a feature's own, the expected cost of one keyframe: a
 * feature near a joint fits both links and must not change sides by chance. */
#define OWN_COST 2.0f

/* Chi squared that a feature may lose in another body and still count as fitting there: four
 * standard deviations (of 2 each) of the two residuals of one keyframe. */
#define ELSEWHERE_COST 8.0f

/* More than rounding adds to the sum of a cost and its limit. */
#define ROUNDING_COST 0.01f

/* The cost over n keyframes above which a feature does not belong; the margin is relatively larger
 * for few keyframes. */
static float cost_limit(const struct grrl_perception *p, uint16_t n)
{
    float limit = 2.0f * (float)n + LIMIT_SIGMAS * grrl_sqrt(4.0f * (float)n) + LIMIT_BASE;
    return limit * grrl_sqrt(p->config.slack);
}

bool grrl_assign_moves(const struct grrl_perception *p, uint16_t slot)
{
    struct grrl_vec2 mean = {0.0f, 0.0f};
    float weight = 0.0f;
    uint16_t n = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        float w = (float)p->keyframe[k].weight[slot];
        mean = grrl_vec2_add(mean, grrl_vec2_scale(p->keyframe[k].point[slot], w));
        weight += w;
        n = (uint16_t)(n + (w > 0.0f ? 1 : 0));
    }
    if (n == 0)
        return false;
    mean = grrl_vec2_scale(mean, 1.0f / weight);
    float limit = cost_limit(p, n);
    float cost = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes && cost < limit; k++) {
        uint8_t w = p->keyframe[k].weight[slot];
        if (w > 0) {
            float d2 = grrl_vec2_distance2(p->keyframe[k].point[slot], mean) /
                       grrl_perception_variance(p, w);
            cost += d2 < GRRL_COST_CAP ? d2 : GRRL_COST_CAP;
        }
    }
    return cost >= limit;
}

void grrl_assign_find_origins(const struct grrl_perception *p, struct grrl_assign_origins *origins)
{
    int16_t balance[GRRL_MAX_LINKS] = {0};
    *origins = (struct grrl_assign_origins){{0}, {0}};
    for (uint16_t i = p->n_slots; i-- > 0;) {
        uint8_t body = p->body_of[i];
        if (body < p->n_bodies) {
            balance[body] = (int16_t)(balance[body] + (p->has_moved[i] ? 1 : -1));
            origins->has_moved[body] = balance[body] > 0;
            origins->blob[body] = p->blob_of[i] != 0 ? p->blob_of[i] : origins->blob[body];
        }
    }
}

bool grrl_assign_body_has_moved(const struct grrl_perception *p, uint8_t body)
{
    int balance = 0;
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == body)
            balance += p->has_moved[i] ? 1 : -1;
    return balance > 0;
}

static uint8_t blob_of_body(const struct grrl_perception *p, uint8_t body)
{
    for (uint16_t i = 0; i < p->n_slots; i++)
        if (p->body_of[i] == body && p->blob_of[i] != 0)
            return p->blob_of[i];
    return 0;
}

/* Separate blobs stay separate until motion joins them: whatever has never moved looks rigid with
 * everything else that has never moved. */
static bool may_share(const struct grrl_assign_origins *origins, uint8_t blob, bool moved,
                      uint8_t body)
{
    uint8_t other = origins->blob[body];
    return blob == 0 || other == 0 || blob == other || (moved && origins->has_moved[body]);
}

bool grrl_assign_bodies_may_share(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    uint8_t one = blob_of_body(p, a);
    uint8_t other = blob_of_body(p, b);
    return one == 0 || other == 0 || one == other ||
           (grrl_assign_body_has_moved(p, a) && grrl_assign_body_has_moved(p, b));
}

/*
 * Whether a feature deviates from its body by less than the joint detection threshold on average. A
 * body bent by a joint that moved less keeps its features, though their residuals exceed the noise.
 */
static bool stays_close(const struct grrl_perception *p, uint16_t slot)
{
    uint8_t body = p->body_of[slot];
    float limit2 = p->config.min_slide_m * p->config.min_slide_m;
    float sum = 0.0f;
    float n = 0.0f;
    for (uint8_t k = 0; k < p->n_keyframes; k++) {
        if (p->keyframe[k].weight[slot] > 0 && p->pose[k][body].weight > 0.0f) {
            struct grrl_vec2 at = grrl_to_world(&p->pose[k][body], p->shape[slot]);
            sum += grrl_vec2_distance2(p->keyframe[k].point[slot], at);
            n += 1.0f;
        }
    }
    return sum < limit2 * n;
}

static uint16_t keyframes_that_saw(const struct grrl_perception *p, uint16_t slot)
{
    uint16_t n = 0;
    for (uint8_t k = 0; k < p->n_keyframes; k++)
        n = (uint16_t)(n + (p->keyframe[k].weight[slot] > 0 ? 1 : 0));
    return n;
}

/* A body that a feature may belong to, and the feature's cost there above the limit. */
struct candidate {
    uint8_t body; /* GRRL_FEATURE_NONE: above the limit in every body tried */
    float excess;
};

/*
 * Replaces the best body so far if the feature costs less in this one; of equals the first stays.
 * max_limit is the limit for all keyframes that saw the feature: a sum that exceeds the best with
 * it is not finished.
 */
static void try_body(const struct grrl_perception *p, const struct grrl_assign_origins *origins,
                     uint16_t slot, uint8_t body, float max_limit, struct candidate *best)
{
    bool is_own = body == p->body_of[slot];
    struct grrl_vec2 local = p->shape[slot];
    uint16_t n = 0;
    float enough = best->excess + max_limit + (is_own ? OWN_COST : 0.0f) + ROUNDING_COST;
    if (!is_own && (!may_share(origins, p->blob_of[slot], p->has_moved[slot], body) ||
                    grrl_rigid_is_off(p, slot, &p->pose[0][body], GRRL_MAX_LINKS, enough) ||
                    !grrl_rigid_place(p, slot, &p->pose[0][body], GRRL_MAX_LINKS, &local)))
        return;
    float cost = grrl_rigid_cost(p, slot, local, &p->pose[0][body], GRRL_MAX_LINKS, enough, &n);
    if (n == 0)
        return;
    float excess = cost - cost_limit(p, n) - (is_own ? OWN_COST : 0.0f);
    if (excess < best->excess ||
        (excess == best->excess && body < best->body && best->body != GRRL_FEATURE_NONE))
        *best = (struct candidate){body, excess};
}

bool grrl_assign_follows(const struct grrl_perception *p, uint16_t slot, uint8_t body,
                         uint16_t least)
{
    struct grrl_vec2 local;
    uint16_t n = 0;
    if (!grrl_rigid_place(p, slot, &p->pose[0][body], GRRL_MAX_LINKS, &local))
        return false;
    float cost =
        grrl_rigid_cost(p, slot, local, &p->pose[0][body], GRRL_MAX_LINKS, GRRL_COST_ANY, &n);
    return n >= least && cost < cost_limit(p, n);
}

uint8_t grrl_assign_best(const struct grrl_perception *p, const struct grrl_assign_origins *origins,
                         uint16_t slot, uint32_t changed)
{
    uint8_t own = p->body_of[slot];
    uint32_t tried = own < p->n_bodies && (changed >> own & 1u) == 0 ? changed : UINT32_MAX;
    struct candidate cheapest = {GRRL_FEATURE_NONE, 0.0f};
    bool is_table = own == GRRL_FEATURE_BACKGROUND && p->blob_of[slot] == 0;
    float max_limit = cost_limit(p, keyframes_that_saw(p, slot));
    /* Its own body first: it is most often the best, and the others are then given up early. */
    if (own < p->n_bodies)
        try_body(p, origins, slot, own, max_limit, &cheapest);
    for (uint8_t b = 0; b < p->n_bodies && !is_table; b++) /* the table moves with nothing */
        if (b != own && (tried >> b & 1u) != 0)
            try_body(p, origins, slot, b, max_limit, &cheapest);
    uint8_t best = cheapest.body;
    if (best == GRRL_FEATURE_NONE && own < p->n_bodies && stays_close(p, slot))
        best = own;
    if (!p->has_moved[slot] && (p->blob_of[slot] == 0 || best == GRRL_FEATURE_NONE))
        best = GRRL_FEATURE_BACKGROUND;
    return best;
}

/*
 * Whether a feature would fit some other body as well. The pose of a body of n features follows
 * their noise, which reduces each residual by about 3 / (2 n).
 */
bool grrl_assign_fits_elsewhere(const struct grrl_perception *p,
                                const struct grrl_assign_origins *origins, uint16_t slot,
                                uint16_t n_own)
{
    uint16_t n = 0;
    uint8_t own = p->body_of[slot];
    float own_cost = grrl_rigid_cost(p, slot, p->shape[slot], &p->pose[0][own], GRRL_MAX_LINKS,
                                     GRRL_COST_ANY, &n);
    float leverage = 1.5f / (float)n_own;
    float allowed = own_cost + ELSEWHERE_COST +
                    2.0f * (float)n * (1.0f - (1.0f - leverage) / (1.0f + leverage));
    for (uint8_t b = 0; b < p->n_bodies; b++) {
        struct grrl_vec2 local;
        if (b != own && may_share(origins, p->blob_of[slot], p->has_moved[slot], b) &&
            !grrl_rigid_is_off(p, slot, &p->pose[0][b], GRRL_MAX_LINKS, allowed + ROUNDING_COST) &&
            grrl_rigid_place(p, slot, &p->pose[0][b], GRRL_MAX_LINKS, &local) &&
            grrl_rigid_cost(p, slot, local, &p->pose[0][b], GRRL_MAX_LINKS, allowed, &n) <= allowed)
            return true;
    }
    return false;
}
