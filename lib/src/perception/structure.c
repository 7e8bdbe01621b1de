/*
 * structure.c: chooses the joints between all bodies and fills the model.
 *
 * The joints form a maximum spanning forest over the evidence; a joint that closes a loop of at
 * least four links needs more evidence (a triangle of joints could not move).
 */
#include "perception/perception_internal.h"

/* Subtracted from the order of a slide that a parallelogram explains. The order of a joint is at
 * most WELL_SUPPORTED (6, joints.c), so such a slide comes after all well supported, near joints.
 */
#define PARALLELOGRAM_COST 20.0f

/* A slide below this many times min_slide_m (9 mm) may be an artefact of bent bodies. Half a
 * parallelogram whose joints turned less than min_turn_rad seems to slide by min_turn_rad times the
 * length of a link, about 5 mm; twice that is safe. */
#define SHORT_SLIDE 5.0f

/* z-score of undetected joints in two bodies, summed over both. Noise alone sums to less in nearly
 * all pairs. On a 4R loop at twice the noise this lowered wrong states from 4.1 to 0.3% (seed
 * 47000). */
#define HIDDEN_SIGMAS 3.5f

/* The usual confidence level: below it two bodies are undetermined, not disconnected. */
#define SURE_DISCONNECTED 0.95f

/* Chi squared by which a joint that closes a loop must beat free motion: five times TYPE_MARGIN of
 * joints.c, since a loop is rare a priori and the forest explains the motion without it. It must
 * stay well below FREE_COST_MAX (140), the largest possible gain. */
#define LOOP_COST 40.0f

/* The number of links on the shortest path from a to b over the joints so far; 0: not connected. */
static unsigned links_between(const uint32_t *joined, uint8_t a, uint8_t b)
{
    uint32_t reached = UINT32_C(1) << a;
    for (unsigned links = 1; links <= GRRL_MAX_LINKS; links++) {
        if ((reached >> b & 1u) != 0)
            return links;
        uint32_t next = reached;
        for (uint8_t i = 0; i < GRRL_MAX_LINKS; i++)
            next |= (reached >> i & 1u) != 0 ? joined[i] : 0u;
        if (next == reached)
            return 0;
        reached = next;
    }
    return 0;
}

/* Whether two revolute joints have a body in common and their pivots on it lie within reach. */
static bool is_same_pin(const struct grrl_joint_evidence *t, const struct grrl_joint_evidence *e,
                        float reach)
{
    struct grrl_vec2 d;
    if (t->a == e->a || t->b == e->a)
        d = grrl_vec2_sub(t->a == e->a ? t->fit.in_a : t->fit.in_b, e->fit.in_a);
    else if (t->a == e->b || t->b == e->b)
        d = grrl_vec2_sub(t->a == e->b ? t->fit.in_a : t->fit.in_b, e->fit.in_b);
    else
        return false;
    return grrl_vec2_length(d) < reach;
}

bool grrl_structure_move_as_one(const struct grrl_perception *p, uint8_t a, uint8_t b)
{
    for (uint8_t c = 0; c < p->n_bodies; c++) {
        struct grrl_joint_evidence ac;
        struct grrl_joint_evidence bc;
        if (c == a || c == b)
            continue;
        bool near_a = grrl_joints_weigh(p, a < c ? a : c, a < c ? c : a, &ac);
        bool near_b = grrl_joints_weigh(p, b < c ? b : c, b < c ? c : b, &bc);
        bool both_told = ac.told && bc.told && (near_a || near_b) && ac.type == bc.type;
        if (both_told &&
            (ac.type == GRRL_REVOLUTE ? is_same_pin(&ac, &bc, GRRL_PIN_REACH * p->config.gap_m)
                                      : grrl_apart_never_moved(p, a, b)))
            return true;
    }
    return false;
}

/* n links on one pin are connected by n - 1 joints: a further joint at the pivot of an accepted one
 * closes no loop. */
static bool shares_a_pin(const struct grrl_joint_evidence *taken, uint8_t n,
                         const struct grrl_joint_evidence *e, float reach)
{
    for (uint8_t i = 0; i < n && e->type == GRRL_REVOLUTE; i++)
        if (taken[i].type == GRRL_REVOLUTE && is_same_pin(&taken[i], e, reach))
            return true;
    return false;
}

static const struct grrl_joint_evidence *find_revolute(const struct grrl_joint_evidence *e,
                                                       uint16_t n, uint8_t a, uint8_t b)
{
    for (uint16_t i = 0; i < n; i++) {
        bool is_pair = (e[i].a == a && e[i].b == b) || (e[i].a == b && e[i].b == a);
        if (is_pair && e[i].type == GRRL_REVOLUTE)
            return &e[i];
    }
    return NULL;
}

/*
 * Whether two pivots on a third body explain why these two slide past each other without turning,
 * like opposite links of a parallelogram: the third body turns relative to both, and its turn times
 * the distance of its pivots accounts for the slide.
 */
static bool is_parallelogram(const struct grrl_perception *p, const struct grrl_joint_evidence *all,
                             uint16_t n, const struct grrl_joint_evidence *slide)
{
    float slid = slide->fit.upper - slide->fit.lower;
    for (uint8_t c = 0; c < p->n_bodies; c++) {
        const struct grrl_joint_evidence *ac = find_revolute(all, n, slide->a, c);
        const struct grrl_joint_evidence *bc = find_revolute(all, n, slide->b, c);
        if (ac == NULL || bc == NULL)
            continue;
        struct grrl_vec2 pa = ac->a == c ? ac->fit.in_a : ac->fit.in_b;
        struct grrl_vec2 pb = bc->a == c ? bc->fit.in_a : bc->fit.in_b;
        float turned = ac->fit.upper - ac->fit.lower;
        if (grrl_vec2_length(grrl_vec2_sub(pa, pb)) * turned > 0.5f * slid)
            return true;
    }
    return false;
}

/*
 * Joints that turned too little to be detected bend the bodies they are in, and bent bodies seem to
 * slide: half a parallelogram past the other half. So a short slide counts only between straight
 * bodies.
 */
static bool is_slide_of_bent_bodies(const struct grrl_perception *p,
                                    const struct grrl_joint_evidence *e)
{
    bool is_short = e->fit.upper - e->fit.lower < SHORT_SLIDE * p->config.min_slide_m;
    if (e->type != GRRL_PRISMATIC || !is_short)
        return false;
    float hidden = grrl_cut_hidden_joint(p, e->a);
    return hidden > HIDDEN_SIGMAS || hidden + grrl_cut_hidden_joint(p, e->b) > HIDDEN_SIGMAS;
}

/* Moves the accepted evidence to the front, best first (Kruskal's maximum spanning forest, then
 * loops); returns how many. */
static uint8_t choose_structure(const struct grrl_perception *p, struct grrl_joint_evidence *e,
                                uint16_t n)
{
    uint32_t joined[GRRL_MAX_LINKS] = {0};
    for (uint16_t i = 1; i < n; i++) {
        struct grrl_joint_evidence moving = e[i];
        uint16_t j = i;
        while (j > 0 && e[j - 1].order < moving.order) {
            e[j] = e[j - 1];
            j--;
        }
        e[j] = moving;
    }
    uint8_t accepted = 0;
    for (int loops = 0; loops < 2; loops++) {
        for (uint16_t i = accepted; i < n && accepted < GRRL_MAX_JOINTS; i++) {
            unsigned links = links_between(joined, e[i].a, e[i].b);
            bool take = loops == 0 ? links == 0
                                   : links >= 4 && e[i].weight > LOOP_COST &&
                                         !shares_a_pin(e, accepted, &e[i],
                                                       GRRL_PIN_REACH * p->config.gap_m);
            if (take) {
                struct grrl_joint_evidence taken = e[i];
                joined[taken.a] |= UINT32_C(1) << taken.b;
                joined[taken.b] |= UINT32_C(1) << taken.a;
                e[i] = e[accepted];
                e[accepted++] = taken;
            }
        }
    }
    return accepted;
}

/* The last keyframe that saw a body: later ones say nothing about its joints. */
static uint8_t last_seen(const struct grrl_perception *p, uint8_t body)
{
    uint8_t k = (uint8_t)(p->n_keyframes - 1);
    while (k > 0 && !(p->pose[k][body].weight > 0.0f))
        k--;
    return k;
}

static void describe_joint(const struct grrl_perception *p, const struct grrl_joint_evidence *e,
                           struct grrl_joint *joint)
{
    const struct grrl_perception_pose *a = &p->pose[last_seen(p, e->a)][e->a];
    float v = e->fit.point_variance;
    struct grrl_vec2 axis = grrl_rotate(a->pose, e->fit.axis_in_a);
    bool slides = e->type == GRRL_PRISMATIC;
    *joint = (struct grrl_joint){
        .a = e->a,
        .b = e->b,
        .type = e->type,
        .probability = e->p[e->type],
        .p_revolute = e->p[0],
        .p_prismatic = e->p[1],
        .p_disconnected = e->p[2],
        .point_m = grrl_to_world(a, e->fit.in_a),
        .point_cov_m2 = {slides ? v * axis.y * axis.y : v, slides ? -v * axis.x * axis.y : 0.0f,
                         slides ? v * axis.x * axis.x : v},
        .axis = axis,
        .axis_sd_rad = grrl_sqrt(e->fit.axis_variance),
        .lower = e->fit.lower,
        .upper = e->fit.upper,
    };
}

/* The number of a body's features and their mean. */
static void describe_place(const struct grrl_perception *p, uint8_t body,
                           const struct grrl_model *model, struct grrl_body *out)
{
    struct grrl_vec2 sum = {0.0f, 0.0f};
    float n = 0.0f;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] == body) {
            sum = grrl_vec2_add(sum, model->feature_m[i]);
            n += 1.0f;
        }
    }
    out->n_features = (uint16_t)n;
    out->centroid_m = grrl_vec2_scale(sum, 1.0f / n);
}

/* The axis along which the features of a body spread most. */
static void describe_axis(const struct grrl_perception *p, uint8_t body,
                          const struct grrl_model *model, struct grrl_body *out)
{
    float xx = 0.0f;
    float xy = 0.0f;
    float yy = 0.0f;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] == body) {
            struct grrl_vec2 d = grrl_vec2_sub(model->feature_m[i], out->centroid_m);
            xx += d.x * d.x;
            xy += d.x * d.y;
            yy += d.y * d.y;
        }
    }
    float major;
    float minor;
    grrl_principal_axes(xx, xy, yy, &major, &minor, &out->axis);
}

/* The extent of the features along the axis and across. Both ranges contain 0, the centroid. */
static void describe_extent(const struct grrl_perception *p, uint8_t body,
                            const struct grrl_model *model, struct grrl_body *out)
{
    float along[2] = {1e9f, -1e9f};
    float across[2] = {1e9f, -1e9f};
    for (uint16_t i = 0; i < p->n_slots; i++) {
        if (p->body_of[i] == body) {
            struct grrl_vec2 d = grrl_vec2_sub(model->feature_m[i], out->centroid_m);
            float x = grrl_vec2_dot(out->axis, d);
            float y = grrl_vec2_cross(out->axis, d);
            along[0] = x < along[0] ? x : along[0];
            along[1] = x > along[1] ? x : along[1];
            across[0] = y < across[0] ? y : across[0];
            across[1] = y > across[1] ? y : across[1];
        }
    }
    out->length_m = along[1] - along[0];
    out->width_m = across[1] - across[0];
}

/* A body of the model. It has at least one feature: see bodies.c. */
static void describe_body(const struct grrl_perception *p, uint8_t body,
                          const struct grrl_model *model, struct grrl_body *out)
{
    out->number = p->number[body];
    describe_place(p, body, model, out);
    describe_axis(p, body, model, out);
    describe_extent(p, body, model, out);
}

/* Places features by the pose of their body in the last keyframe; those without a body, or whose
 * body that keyframe did not see, where they were last seen. */
static void describe_features(const struct grrl_perception *p, struct grrl_model *model)
{
    const struct grrl_perception_pose *poses = p->pose[p->n_keyframes - 1];
    model->n_features = p->n_slots;
    for (uint16_t i = 0; i < p->n_slots; i++) {
        uint8_t body = p->body_of[i];
        bool in_body = body < p->n_bodies && poses[body].weight > 0.0f;
        model->feature_id[i] = p->id[i];
        model->feature_body[i] = body;
        model->feature_m[i] = in_body ? grrl_to_world(&poses[body], p->shape[i]) : p->last[i];
    }
}

/* Joints in order of discovery: those of the last model that still exist come first. */
static uint8_t order_of_discovery(const struct grrl_perception *p,
                                  const struct grrl_joint_evidence *e, uint8_t n, uint8_t *order)
{
    uint8_t count = 0;
    bool placed[GRRL_MAX_JOINTS] = {false};
    for (uint8_t j = 0; j < p->model.n_joints; j++) {
        uint16_t a = p->model.body[p->model.joint[j].a].number;
        uint16_t b = p->model.body[p->model.joint[j].b].number;
        for (uint8_t i = 0; i < n; i++) {
            uint16_t ea = p->number[e[i].a];
            uint16_t eb = p->number[e[i].b];
            if (!placed[i] && ((ea == a && eb == b) || (ea == b && eb == a))) {
                placed[i] = true;
                order[count++] = i;
            }
        }
    }
    for (uint8_t i = 0; i < n; i++)
        if (!placed[i])
            order[count++] = i;
    return count;
}

/* Collects the joints that the motion of each pair supports; returns how many. */
static uint16_t weigh_all(const struct grrl_perception *p, struct grrl_joint_evidence *e)
{
    uint16_t n = 0;
    for (uint8_t a = 0; a < p->n_bodies; a++) {
        for (uint8_t b = (uint8_t)(a + 1); b < p->n_bodies; b++)
            if (grrl_joints_weigh(p, a, b, &e[n]) && !is_slide_of_bent_bodies(p, &e[n]))
                n++;
    }
    for (uint16_t i = 0; i < n; i++)
        if (e[i].type == GRRL_PRISMATIC && is_parallelogram(p, e, n, &e[i]))
            e[i].order -= PARALLELOGRAM_COST;
    return n;
}

void grrl_structure_update(struct grrl_perception *p)
{
    struct grrl_joint_evidence e[GRRL_MAX_LINKS * (GRRL_MAX_LINKS - 1) / 2];
    uint16_t n = weigh_all(p, e);
    uint8_t accepted = choose_structure(p, e, n);
    uint8_t order[GRRL_MAX_JOINTS];
    (void)order_of_discovery(p, e, accepted, order);
    struct grrl_model *model = &p->model;
    model->n_bodies = p->n_bodies;
    model->n_joints = accepted;
    for (uint8_t i = 0; i < accepted; i++)
        describe_joint(p, &e[order[i]], &model->joint[i]);
    describe_features(p, model);
    for (uint8_t b = 0; b < p->n_bodies; b++)
        describe_body(p, b, model, &model->body[b]);
}

static bool is_joined(const struct grrl_model *model, uint8_t a, uint8_t b)
{
    for (uint8_t i = 0; i < model->n_joints; i++)
        if (model->joint[i].a == a && model->joint[i].b == b)
            return true;
    return false;
}

enum grrl_status grrl_perception_pair(const struct grrl_perception *perception, uint8_t a,
                                      uint8_t b, struct grrl_pair *pair)
{
    const struct grrl_model *model = &perception->model;
    uint8_t first = a < b ? a : b;
    uint8_t second = a < b ? b : a;
    if (first == second || second >= model->n_bodies)
        return GRRL_ERR_ARGUMENT;
    struct grrl_joint_evidence e = {.doubt = GRRL_REASON_LITTLE};
    (void)grrl_joints_weigh(perception, first, second, &e);
    *pair = (struct grrl_pair){
        .p_revolute = 1.0f / 3.0f, .p_prismatic = 1.0f / 3.0f, .p_disconnected = 1.0f / 3.0f};
    struct grrl_apart_range range = grrl_apart_range_between(perception, first, second);
    pair->turned_rad = range.turn;
    pair->slid_m = grrl_sqrt(range.shift2);
    if (e.fit.excited) {
        pair->p_revolute = e.p[0];
        pair->p_prismatic = e.p[1];
        pair->p_disconnected = e.p[2];
    }
    if (is_joined(model, first, second))
        pair->relation = GRRL_RELATION_JOINED;
    else if (pair->p_disconnected >= SURE_DISCONNECTED && e.doubt != GRRL_REASON_UNPROVEN)
        pair->relation = GRRL_RELATION_DISCONNECTED;
    else
        pair->reason = e.doubt == GRRL_REASON_NONE ? GRRL_REASON_STRUCTURE : e.doubt;
    return GRRL_OK;
}
