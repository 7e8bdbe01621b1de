/* The evidence for a joint, against the definitions in double precision: normal equations solved as
 * they stand, extremes listed. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "slow_near.h"

struct slow_relative {
    struct placed r; /* b in a */
    struct placed a; /* a in the world */
    double turn;     /* from the mean */
    double wa;
    double wb;
    double ia;
    double ib;
    bool at_rest;
};

static struct slow_relative at[GRRL_MAX_KEYFRAMES];
static int n_at;
static double bend_a;
static double bend_b;

static void slow_collect(int a, int b)
{
    struct point sum = {0.0, 0.0};
    n_at = 0;
    bend_a = (double)scene.bend_m2[a];
    bend_b = (double)scene.bend_m2[b];
    for (int k = 0; k < scene.n_keyframes; k++) {
        const struct grrl_perception_pose *pa = &scene.pose[k][a];
        const struct grrl_perception_pose *pb = &scene.pose[k][b];
        if (!(pa->weight > 0.0f && pb->weight > 0.0f))
            continue;
        at[n_at] = (struct slow_relative){.r = seen_from(placed_of(pa->pose), placed_of(pb->pose)),
                                          .a = placed_of(pa->pose),
                                          .wa = (double)pa->weight,
                                          .wb = (double)pb->weight,
                                          .ia = (double)pa->inertia,
                                          .ib = (double)pb->inertia,
                                          .at_rest = scene.keyframe[k].at_rest};
        sum = (struct point){sum.x + at[n_at].r.c, sum.y + at[n_at].r.s};
        n_at++;
    }
    double mean = atan2(sum.y, sum.x);
    for (int i = 0; i < n_at; i++)
        at[i].turn = remainder(atan2(at[i].r.s, at[i].r.c) - mean, 6.283185307179586);
}

/* Variance per axis of the distance of a point on a and one on b. */
static double distance_variance(const struct slow_relative *r, double lever_a2, double lever_b2)
{
    double model = (double)scene.config.model_error_m;
    return noise_square() / r->wa + noise_square() / r->wb +
           noise_square() * lever_a2 / (2.0 * r->ia) + noise_square() * lever_b2 / (2.0 * r->ib) +
           2.0 * model * model + bend_a + bend_b;
}

static double turn_variance(const struct slow_relative *r)
{
    double model = (double)scene.config.model_error_m;
    double single = noise_square() + 4.0 * model * model;
    return single / r->ia + single / r->ib + bend_a * r->wa / r->ia + bend_b * r->wb / r->ib;
}

/* Solves n equations, the right side in column n; the matrix is symmetric and positive. */
static void solve(int n, double m[4][5], double *x)
{
    for (int i = 0; i < n; i++)
        for (int r = i + 1; r < n; r++)
            for (int c = n; c >= i; c--)
                m[r][c] -= m[r][i] / m[i][i] * m[i][c];
    for (int i = n - 1; i >= 0; i--) {
        x[i] = m[i][n];
        for (int c = i + 1; c < n; c++)
            x[i] -= m[i][c] * x[c];
        x[i] /= m[i][i];
    }
}

/* Normal equations of a - R b = d in both axes of all keyframes, and of the priors. */
static void pivot_equations(double sa, double sb, double lever_a2, double lever_b2, double m[4][5])
{
    memset(m, 0, 4 * sizeof m[0]);
    for (int i = 0; i < n_at; i++) {
        double w = 1.0 / distance_variance(&at[i], lever_a2, lever_b2);
        double rows[2][5] = {{1.0, 0.0, -at[i].r.c, at[i].r.s, at[i].r.p.x},
                             {0.0, 1.0, -at[i].r.s, -at[i].r.c, at[i].r.p.y}};
        for (int row = 0; row < 2; row++)
            for (int r = 0; r < 4; r++)
                for (int c = 0; c < 5; c++)
                    m[r][c] += w * rows[row][r] * rows[row][c];
    }
    for (int r = 0; r < 4; r++)
        m[r][r] += r < 2 ? 1.0 / (sa * sa) : 1.0 / (sb * sb);
}

static struct slow_fit slow_revolute(int a, int b)
{
    struct slow_fit fit = {.lower = 0.0, .upper = 0.0};
    double ha = slow_half_extent(a);
    double hb = slow_half_extent(b);
    double sa = (double)scene.config.pivot_scale_m + ha;
    double sb = (double)scene.config.pivot_scale_m + hb;
    double lever_a2 = ha * ha;
    double lever_b2 = hb * hb;
    double least_variance = 1e9;
    for (int round = 0; round < 2; round++) {
        double m[4][5];
        double x[4];
        pivot_equations(sa, sb, lever_a2, lever_b2, m);
        double w = m[0][0];
        solve(4, m, x);
        fit.in_a = (struct point){x[0], x[1]};
        fit.in_b = (struct point){x[2], x[3]};
        pivot_equations(sa, sb, lever_a2, lever_b2, m);
        for (int r = 0; r < 4; r++)
            m[r][4] = r == 2 ? 1.0 : 0.0;
        solve(4, m, x);
        fit.point_variance = x[2];
        fit.determined =
            round == 0 ? 1.0 / x[2] > 3e-3 * w : fit.determined && 1.0 / x[2] > 3e-3 * w;
        lever_a2 = square(fit.in_a);
        lever_b2 = square(fit.in_b);
    }
    double chi2 = lever_a2 / (sa * sa) + lever_b2 / (sb * sb);
    for (int i = 0; i < n_at; i++) {
        struct point miss = minus(fit.in_a, to_world(at[i].r, fit.in_b));
        double missed = square(miss) / distance_variance(&at[i], lever_a2, lever_b2);
        if (!at[i].at_rest && above(missed, 14.0)) {
            chi2 += 14.0;
            continue;
        }
        chi2 += missed;
        double turn = remainder(at[i].turn - at[0].turn, 6.283185307179586);
        fit.lower = fmin(fit.lower, turn);
        fit.upper = fmax(fit.upper, turn);
        least_variance = fmin(least_variance, turn_variance(&at[i]));
    }
    fit.excess = chi2 - (2.0 * n_at - 4.0);
    double range = fit.upper - fit.lower;
    bool far = above(range, (double)scene.config.min_turn_rad);
    bool sure = above(range, 5.0 * sqrt(least_variance));
    fit.excited = far && sure;
    return fit;
}

/* Where b's origin would be in a's frame, half of the turn taken back. */
static struct point slow_slide_point(int i, struct point middle)
{
    double turn = sin(at[i].turn);
    return (struct point){at[i].r.p.x - 0.5 * (middle.x - turn * middle.y),
                          at[i].r.p.y - 0.5 * (middle.y + turn * middle.x)};
}

static struct point mean_shift(void)
{
    struct point mean = {0.0, 0.0};
    for (int i = 0; i < n_at; i++)
        mean = (struct point){mean.x + at[i].r.p.x / n_at, mean.y + at[i].r.p.y / n_at};
    return mean;
}

static struct slow_fit slow_prismatic(void)
{
    struct slow_fit fit = {.lower = 0.0, .upper = 0.0};
    struct point middle = mean_shift();
    double lever2 = square(middle) / 4.0;
    struct point mean = {0.0, 0.0};
    double w = 0.0;
    for (int i = 0; i < n_at; i++) {
        double wi = 1.0 / distance_variance(&at[i], lever2, lever2);
        struct point q = slow_slide_point(i, middle);
        mean = (struct point){mean.x + wi * q.x, mean.y + wi * q.y};
        w += wi;
    }
    mean = (struct point){mean.x / w, mean.y / w};
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
    for (int i = 0; i < n_at; i++) {
        double wi = 1.0 / distance_variance(&at[i], lever2, lever2);
        struct point q = minus(slow_slide_point(i, middle), mean);
        xx += wi * q.x * q.x;
        xy += wi * q.x * q.y;
        yy += wi * q.y * q.y;
    }
    double angle = 0.5 * atan2(2.0 * xy, xx - yy);
    fit.axis = (struct point){cos(angle), sin(angle)};
    double difference = sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy);
    double major = 0.5 * (xx + yy + difference);
    fit.determined = difference > 0.1 * major && fit.axis.x > 1e-3;
    double chi2 = 0.0;
    struct point first = slow_slide_point(0, middle);
    for (int i = 0; i < n_at; i++) {
        struct point q = minus(slow_slide_point(i, middle), mean);
        double across = fit.axis.x * q.y - fit.axis.y * q.x;
        double missed = across * across / distance_variance(&at[i], lever2, lever2) +
                        at[i].turn * at[i].turn / turn_variance(&at[i]);
        if (!at[i].at_rest && above(missed, 14.0)) {
            chi2 += 14.0;
            continue;
        }
        chi2 += missed;
        struct point d = minus(slow_slide_point(i, middle), first);
        fit.lower = fmin(fit.lower, d.x * fit.axis.x + d.y * fit.axis.y);
        fit.upper = fmax(fit.upper, d.x * fit.axis.x + d.y * fit.axis.y);
    }
    fit.excess = chi2 - (2.0 * n_at - 3.0);
    double range = fit.upper - fit.lower;
    bool far = above(range, (double)scene.config.min_slide_m);
    bool sure = above(range, 5.0 * sqrt(n_at / w));
    fit.excited = far && sure;
    fit.in_a = mean;
    fit.point_variance = 1.0 / w;
    fit.axis_variance = 1.0 / (major + 1.0);
    return fit;
}

static double slow_free_cost(void)
{
    struct point mean = mean_shift();
    double lever2 = square(mean) / 4.0;
    double cost = 0.0;
    for (int i = 0; i < n_at; i++) {
        double rigid = square(minus(at[i].r.p, mean)) / distance_variance(&at[i], lever2, lever2) +
                       at[i].turn * at[i].turn / turn_variance(&at[i]);
        cost += fmin(rigid, 14.0);
    }
    return fmin(cost, 140.0);
}

/* What is left of half the squared turn after the best line through it, times the lever. */
static double slow_curvature(const struct slow_fit *fit)
{
    double w = 0.0;
    double mt = 0.0;
    double mh = 0.0;
    double weight[GRRL_MAX_KEYFRAMES];
    for (int i = 0; i < n_at; i++) {
        weight[i] = 1.0 / distance_variance(&at[i], square(fit->in_a), square(fit->in_b));
        w += weight[i];
        mt += weight[i] * at[i].turn;
        mh += weight[i] * 0.5 * at[i].turn * at[i].turn;
    }
    double tt = 0.0;
    double th = 0.0;
    double left = 0.0;
    for (int i = 0; i < n_at; i++) {
        double t = at[i].turn - mt / w;
        double h = 0.5 * at[i].turn * at[i].turn - mh / w;
        tt += weight[i] * t * t;
        th += weight[i] * t * h;
    }
    for (int i = 0; i < n_at && tt > 0.0; i++) {
        double t = at[i].turn - mt / w;
        double h = 0.5 * at[i].turn * at[i].turn - mh / w;
        left += weight[i] * (h - th / tt * t) * (h - th / tt * t);
    }
    return fmax(square(fit->in_a), square(fit->in_b)) * left;
}

/* Turns together, and further pushes that slid. */
static double slow_sliding(const struct slow_fit *fit)
{
    double turned = 0.0;
    int pushes = 0;
    double last = at[0].r.p.x * fit->axis.x + at[0].r.p.y * fit->axis.y;
    for (int i = 1; i < n_at; i++) {
        double turn = seen_from(at[0].a, at[i].a).s;
        turned += turn * turn / turn_variance(&at[i]);
        double now = at[i].r.p.x * fit->axis.x + at[i].r.p.y * fit->axis.y;
        if (at[i].at_rest) {
            pushes += above(fabs(now - last), (double)scene.config.min_slide_m);
            last = now;
        }
    }
    return fmin(turned, 30.0) + (pushes > 1 ? 4.0 * (pushes - 1) : 0.0);
}

struct slow_evidence {
    bool accepted;
    bool revolute;
    double weight;
    double odds;
    double order;
    double p[3];
    struct slow_fit fit;
    bool both_determined;
};

static struct slow_evidence slow_weigh(int a, int b)
{
    struct slow_evidence e = {.accepted = false};
    slow_collect(a, b);
    struct slow_fit revolute = slow_revolute(a, b);
    struct slow_fit prismatic = slow_prismatic();
    double free = slow_free_cost();
    e.revolute = above(prismatic.excess, revolute.excess);
    e.fit = e.revolute ? revolute : prismatic;
    e.both_determined = revolute.determined && prismatic.determined;
    e.weight = free - e.fit.excess;
    e.odds = fabs(prismatic.excess - revolute.excess);
    double tested = e.revolute ? slow_curvature(&e.fit) : slow_sliding(&e.fit);
    double untied = fmin(free, e.fit.excess + tested + 2.0);
    double chi2[3] = {revolute.excess, prismatic.excess, untied};
    for (int i = 0; i < 3; i++) {
        e.p[i] = 1.0;
        for (int j = 1; j < 3; j++)
            e.p[i] += exp(0.5 * (chi2[i] - chi2[(i + j) % 3]));
        e.p[i] = 1.0 / e.p[i];
    }
    double scale = 0.4 * (double)scene.config.gap_m;
    int last = 0; /* keyframe that saw both */
    for (int k = 0; k < scene.n_keyframes; k++)
        last = scene.pose[k][a].weight > 0.0f && scene.pose[k][b].weight > 0.0f ? k : last;
    double away = e.revolute ? hypot(slow_distance(a, e.fit.in_a), slow_distance(b, e.fit.in_b))
                             : slow_gap(a, b, last);
    e.order = fmin(untied - e.fit.excess, 6.0) - away * away / (scale * scale) -
              0.1 * fmax(e.fit.excess, 0.0);
    bool fits = !above(e.fit.excess, 10.0 + 10.0 * sqrt((double)n_at));
    bool better = above(e.odds, 8.0);
    bool needed = above(e.weight, 8.0);
    bool near = slow_is_near(a, b, e.revolute, &e.fit, untied - e.fit.excess);
    bool believed = above(e.p[e.revolute ? 0 : 1], 0.5);
    e.accepted = believed && fits && better && needed && near && e.fit.excited;
    return e;
}

/* --- scenes -------------------------------------------------------------------------------------
 */

enum { RIGID, REVOLUTE, PRISMATIC, FREE, MOTIONS };

/* Body 2 moves against body 1 as told; body 0 stands aside or passes by. */
static void make_pair(int motion, int n_features, int n_keyframes, double size, double noise)
{
    n_keyframes = scene_start(n_keyframes);
    (void)scene_add_body(3);
    (void)scene_add_body(n_features);
    (void)scene_add_body(n_features);
    for (int k = 0; k < n_keyframes; k++)
        scene.keyframe[k].at_rest = scene_chance(0.4);
    scene_wander(0, scene_chance(0.5) ? 0.02 : 0.0, 0.0);
    scene_wander(1, 0.02, scene_chance(0.5) ? 0.2 : 0.0);
    scene.config.pivot_scale_m = (float)scene_uniform(0.05, 0.2);
    scene.config.model_error_m = (float)scene_uniform(0.0001, 0.0003);
    scene.config.gap_m = (float)scene_uniform(0.05, 0.15);
    double aside = scene_uniform(0.02, 0.09);
    double angle = scene_uniform(-0.5, 0.5);
    double x = 0.0;
    double y = 0.0;
    double turn = 0.0;
    for (int k = 0; k < n_keyframes; k++) {
        if (scene_chance(0.6)) {
            turn = motion == REVOLUTE || motion == FREE ? scene_uniform(-size, size) : 0.0;
            x = motion == PRISMATIC || motion == FREE ? scene_uniform(-size, size) / 10.0 : 0.0;
            y = motion == FREE ? scene_uniform(-size, size) / 10.0 : 0.0;
        }
        struct placed joint = then(place(aside, 0.0, angle + turn), place(aside + x, y, 0.0));
        scene_body[k][2] = then(scene_body[k][1], joint);
    }
    scene_see(noise, 0.1);
    for (int i = 0; i < scene.n_slots; i++)
        scene.has_moved[i] = true;
    for (int k = 0; k < n_keyframes; k++) { /* a body drawn aside in a push */
        double draw = scene_chance(0.1) ? 0.004 : 0.0;
        for (int i = 0; i < scene.n_slots && !scene.keyframe[k].at_rest; i++)
            scene.keyframe[k].point[i].x += scene.body_of[i] == 2 ? (float)draw : 0.0f;
    }
    scene_fit();
    for (int b = 1; b < 3; b++)
        scene.bend_m2[b] = scene_chance(0.3) ? (float)scene_uniform(0.0, 1e-7) : 0.0f;
}

static void check_fit_fields(const struct grrl_joint_evidence *e, const struct slow_fit *slow)
{
    assert_near(e->fit.excess, slow->excess, slow->determined ? 0.02 : 0.5);
    assert_int_equal(e->fit.excited, slow->excited);
    double prior = (double)scene.config.pivot_scale_m + slow_half_extent(e->b);
    assert_true(e->fit.point_variance > 0.0f);
    assert_true((double)e->fit.point_variance <= 1.001 * prior * prior);
    if (!slow->determined)
        return;
    assert_near(1e3 * (double)e->fit.lower, 1e3 * slow->lower, 5e-3);
    assert_near(1e3 * (double)e->fit.upper, 1e3 * slow->upper, 5e-3);
    assert_at(e->fit.in_a, slow->in_a, 1e-4);
    assert_at(e->fit.in_b, slow->in_b, 1e-4);
    assert_at(e->fit.axis_in_a, slow->axis, 2e-3);
    assert_near((double)e->fit.point_variance / slow->point_variance, 1.0, 0.01);
    assert_near((double)e->fit.axis_variance, slow->axis_variance, 1e-3);
}

/* Compared unless a decision was so near that rounding may take the other side; whether it was. */
static bool check_weigh(uint8_t a, uint8_t b)
{
    struct grrl_joint_evidence e;
    bool accepted = grrl_joints_weigh(&scene, a, b, &e);
    doubt = 1.0;
    struct slow_evidence slow = slow_weigh(a, b);
    if (n_at < 2) {
        assert_false(accepted);
        return true;
    }
    if (doubt < 2e-3 || (!slow.both_determined && slow.odds < 1.0))
        return false;
    assert_int_equal(e.a, a);
    assert_int_equal(e.b, b);
    assert_int_equal(e.type, slow.revolute ? GRRL_REVOLUTE : GRRL_PRISMATIC);
    check_fit_fields(&e, &slow.fit);
    assert_near(e.weight, slow.weight, slow.fit.determined ? 0.02 : 0.5);
    if (slow.both_determined)
        assert_near(e.odds, slow.odds, 0.02);
    if (!slow.fit.determined)
        return true;
    if (accepted)
        assert_near(e.order, slow.order, 0.03);
    if (slow.both_determined || slow.odds > 40.0) { /* the other type does not count any more */
        assert_int_equal(accepted, slow.accepted);
        for (int i = 0; i < 3; i++)
            assert_near(e.p[i], slow.p[i], 0.03);
    }
    return true;
}

static void evidence_of_random_pairs(void **state)
{
    (void)state;
    scene_seed("evidence_of_random_pairs");
    int compared[MOTIONS] = {0};
    int accepted[MOTIONS] = {0};
    for (int run = 0; run < 1200; run++) {
        struct grrl_joint_evidence e;
        int motion = run % MOTIONS;
        make_pair(motion, scene_int(3, 12), scene_int(2, run % 8 < 4 ? 5 : 20),
                  pow(10.0, scene_uniform(-2.0, 0.3)),
                  run % 3 == 0 ? scene_uniform(1.0, 3.0) : 1.0);
        compared[motion] += check_weigh(1, 2);
        accepted[motion] += grrl_joints_weigh(&scene, 1, 2, &e);
    }
    for (int i = 0; i < MOTIONS; i++) {
        print_message("motion %d: %d of 300 compared, %d joints\n", i, compared[i], accepted[i]);
        assert_true(compared[i] > 200); /* most of them; fewer with fewer keyframes */
    }
    assert_true(accepted[REVOLUTE] > 50);
    assert_true(accepted[PRISMATIC] > 30);
}

static void evidence_at_capacity(void **state)
{
    (void)state;
    scene_seed("evidence_at_capacity");
    int compared = 0;
    for (int run = 0; run < 8; run++) {
        make_pair(1 + run % 3, (GRRL_MAX_FEATURES - 3) / 2, GRRL_MAX_KEYFRAMES, 0.3, 1.0);
        compared += check_weigh(1, 2);
    }
    assert_true(compared >= 6);
}

/* Two keyframes at least must have seen both. */
static void one_keyframe_tells_nothing(void **state)
{
    (void)state;
    scene_seed("one_keyframe_tells_nothing");
    struct grrl_joint_evidence e;
    make_pair(REVOLUTE, 8, 5, 0.3, 1.0);
    for (int k = 0; k < 5; k++)
        scene.pose[k][k % 2 == 0 ? 1 : 2].weight = k == 3 ? scene.pose[k][2].weight : 0.0f;
    assert_false(grrl_joints_weigh(&scene, 1, 2, &e));
}

/* Known truth: pivot and axis are where they were put. */
static void pivots_and_axes_are_found(void **state)
{
    (void)state;
    scene_seed("pivots_and_axes_are_found");
    int missed = 0;
    for (int run = 0; run < 40; run++) {
        struct grrl_joint_evidence e;
        bool revolute = run % 2 == 0;
        (void)scene_start(10);
        (void)scene_add_body(12);
        (void)scene_add_body(12);
        scene_wander(0, 0.02, 0.3);
        for (int k = 0; k < 10; k++) {
            double q = scene_uniform(-0.6, 0.6);
            struct placed turned = then(place(0.065, 0.0, q), place(0.065, 0.0, 0.0));
            scene_body[k][1] =
                then(scene_body[k][0], revolute ? turned : place(0.13 + 0.03 * q, 0.0, 0.0));
        }
        scene_see(1.0, 0.0);
        scene_fit();
        missed += !grrl_joints_weigh(&scene, 0, 1, &e);
        assert_int_equal(e.type, revolute ? GRRL_REVOLUTE : GRRL_PRISMATIC);
        struct placed believed = placed_of(scene.pose[9][0].pose);
        struct point pivot = to_world(believed, point_of(e.fit.in_a));
        struct point truth = to_world(scene_body[9][0], (struct point){0.065, 0.0});
        double axis =
            believed.c * (double)e.fit.axis_in_a.x - believed.s * (double)e.fit.axis_in_a.y;
        double axis_y =
            believed.s * (double)e.fit.axis_in_a.x + believed.c * (double)e.fit.axis_in_a.y;
        double along = axis * scene_body[9][0].c + axis_y * scene_body[9][0].s;
        assert_true(!revolute || square(minus(pivot, truth)) < 0.0015 * 0.0015);
        assert_true(revolute || fabs(along) > cos(0.06));
    }
    assert_true(missed <= 2);
}

/* Bodies that never moved apart are not parted in the first place; if they were, rests of sixty
 * frames would tell of no joint. */
static void rigid_pairs_have_no_joint(void **state)
{
    (void)state;
    scene_seed("rigid_pairs_have_no_joint");
    int joints = 0;
    for (int run = 0; run < 100; run++) {
        struct grrl_joint_evidence e;
        (void)scene_start(scene_int(2, GRRL_MAX_KEYFRAMES));
        (void)scene_add_body(10);
        (void)scene_add_body(10);
        scene_wander(0, 0.02, 0.3);
        for (int k = 0; k < scene.n_keyframes; k++) {
            scene_body[k][1] = then(scene_body[k][0], place(0.13, 0.0, 0.3));
            scene.keyframe[k].at_rest = true;
        }
        scene_see(1.0, 0.1);
        scene_fit();
        joints += grrl_joints_weigh(&scene, 0, 1, &e);
    }
    print_message("%d of 100 have one\n", joints);
    assert_true(joints <= 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(evidence_of_random_pairs),   cmocka_unit_test(evidence_at_capacity),
        cmocka_unit_test(one_keyframe_tells_nothing), cmocka_unit_test(rigid_pairs_have_no_joint),
        cmocka_unit_test(pivots_and_axes_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
