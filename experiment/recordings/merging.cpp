/* merging.cpp: bodies by agglomeration, joints by relative poses. */
#include "merging.hpp"

#include <algorithm>
#include <cmath>

#include "joint_error.hpp"

namespace grrl_experiment::recordings
{

using grrl_sim::Pose;
using grrl_sim::Vec2;

namespace
{

enum { GROUP = 3, ROUNDS = 3, LEAST_BODY = 4 };

constexpr double pose_numbers = 3.0; /* parameters of a pose in the plane */

constexpr double max_sigmas = 3.0; /* for a constant distance */

using Rows = std::vector<size_t>;

/* The pose of a body in a frame, if at least two of its points are visible. */
struct Placed {
    bool known = false;
    Pose pose;
    int n = 0;
    double inertia_m2 = 0.0;
};

struct Fit {
    std::vector<Vec2> shape; /* of each row of the body */
    std::vector<Placed> placed;
    double cost = 0.0; /* squared residuals over sigma^2, plus the poses' share of the BIC */
};

class Merging
{
public:
    Merging(const Pictures &pictures, double sigma_m) : pictures_(pictures), sigma_m_(sigma_m)
    {
        double n = 0.0;
        for (const auto &places : pictures.places)
            for (const auto &place : places)
                n += 2.0 * place.seen;
        log_n_ = std::log(std::max(n, 2.0));
    }

    Estimate estimate();

private:
    double variation(size_t a, size_t b) const;
    std::vector<Rows> groups() const;
    void place(const Rows &rows, Fit &fit) const;
    void reshape(const Rows &rows, Fit &fit) const;
    Fit fit(const Rows &rows) const;
    void merge(std::vector<Rows> &bodies) const;
    bool relate(const Fit &a, const Fit &b, EstimatedJoint &joint) const;

    const Pictures &pictures_;
    double sigma_m_;
    double log_n_;
};

/* How much the distance of two tracks varies, in sigmas, plus a small share of the distance itself;
 * infinite if it varies more than noise, or if they are hardly ever visible together. */
double Merging::variation(size_t a, size_t b) const
{
    double n = 0.0, sum = 0.0, squares = 0.0;
    for (const auto &places : pictures_.places) {
        if (!places[a].seen || !places[b].seen)
            continue;
        double d = length(places[a].at_m - places[b].at_m);
        n += 1.0;
        sum += d;
        squares += d * d;
    }
    if (n < 2.0)
        return HUGE_VAL;
    double sd = std::sqrt(std::max(squares / n - sum / n * sum / n, 0.0)) / sigma_m_;
    return sd > max_sigmas ? HUGE_VAL : sd + 0.02 * sum / n / sigma_m_;
}

/* Groups each track with the two whose distance to it varies least, as long as there are free ones.
 */
std::vector<Rows> Merging::groups() const
{
    size_t n = pictures_.id.size();
    std::vector<bool> taken(n, false);
    std::vector<Rows> groups;
    for (size_t i = 0; i < n; i++) {
        if (taken[i])
            continue;
        std::vector<std::pair<double, size_t>> others;
        for (size_t j = i + 1; j < n; j++)
            if (!taken[j] && std::isfinite(variation(i, j)))
                others.push_back({variation(i, j), j});
        std::sort(others.begin(), others.end());
        Rows group{i};
        for (size_t k = 0; k < others.size() && group.size() < GROUP; k++)
            group.push_back(others[k].second);
        for (size_t row : group)
            taken[row] = true;
        groups.push_back(std::move(group));
    }
    return groups;
}

/* Poses by least squares, from the shape. */
void Merging::place(const Rows &rows, Fit &fit) const
{
    fit.placed.assign(pictures_.places.size(), {});
    for (size_t f = 0; f < fit.placed.size(); f++) {
        const auto &places = pictures_.places[f];
        Placed &placed = fit.placed[f];
        Vec2 from, to;
        for (size_t i = 0; i < rows.size(); i++) {
            if (places[rows[i]].seen) {
                from = from + fit.shape[i];
                to = to + places[rows[i]].at_m;
                placed.n++;
            }
        }
        if (placed.n < 2)
            continue;
        from = (1.0 / placed.n) * from;
        to = (1.0 / placed.n) * to;
        double c = 0.0, s = 0.0;
        for (size_t i = 0; i < rows.size(); i++) {
            if (places[rows[i]].seen) {
                Vec2 a = fit.shape[i] - from;
                Vec2 b = places[rows[i]].at_m - to;
                c += dot(a, b);
                s += cross(a, b);
                placed.inertia_m2 += dot(a, a);
            }
        }
        double angle = std::atan2(s, c);
        placed.pose = {to - rotate(from, angle), angle};
        placed.known = true;
    }
}

/* Each point of the shape is the mean of its positions by the poses; a point without any stays. */
void Merging::reshape(const Rows &rows, Fit &fit) const
{
    for (size_t i = 0; i < rows.size(); i++) {
        Vec2 sum;
        double n = 0.0;
        for (size_t f = 0; f < fit.placed.size(); f++) {
            const auto &place = pictures_.places[f][rows[i]];
            if (place.seen && fit.placed[f].known) {
                sum = sum + transform(inverse(fit.placed[f].pose), place.at_m);
                n += 1.0;
            }
        }
        if (n > 0.0)
            fit.shape[i] = (1.0 / n) * sum;
    }
}

Fit Merging::fit(const Rows &rows) const
{
    Fit fit;
    size_t best = 0, most = 0;
    for (size_t f = 0; f < pictures_.places.size(); f++) {
        size_t n = 0;
        for (size_t row : rows)
            n += pictures_.places[f][row].seen;
        if (n > most) {
            best = f;
            most = n;
        }
    }
    for (size_t row : rows) { /* one not visible there starts where it is first visible */
        Vec2 at = pictures_.places[best][row].at_m;
        for (size_t f = 0; f < pictures_.places.size() && !pictures_.places[best][row].seen; f++) {
            if (pictures_.places[f][row].seen) {
                at = pictures_.places[f][row].at_m;
                break;
            }
        }
        fit.shape.push_back(at);
    }
    Vec2 centre; /* the body's origin, so that position and angle are nearly uncorrelated */
    for (Vec2 at : fit.shape)
        centre = centre + (1.0 / static_cast<double>(rows.size())) * at;
    for (Vec2 &at : fit.shape)
        at = at - centre;
    for (int round = 0; round < ROUNDS; round++) {
        place(rows, fit);
        reshape(rows, fit);
    }
    for (size_t f = 0; f < fit.placed.size(); f++) {
        double free = 0.0;
        for (size_t i = 0; i < rows.size(); i++) {
            const auto &place = pictures_.places[f][rows[i]];
            if (!place.seen)
                continue;
            free += 2.0;
            if (fit.placed[f].known) {
                Vec2 off = place.at_m - transform(fit.placed[f].pose, fit.shape[i]);
                fit.cost += dot(off, off) / (sigma_m_ * sigma_m_);
            }
        }
        fit.cost += std::min(free, pose_numbers) * log_n_;
    }
    return fit;
}

/* Merges the pair that lowers the BIC most, as long as there is one. */
void Merging::merge(std::vector<Rows> &bodies) const
{
    auto joined = [](const Rows &a, const Rows &b) {
        Rows both = a;
        both.insert(both.end(), b.begin(), b.end());
        return both;
    };
    std::vector<double> cost;
    for (const Rows &rows : bodies)
        cost.push_back(fit(rows).cost);
    std::vector<std::vector<double>> change(bodies.size());
    auto evaluate = [&](size_t a, size_t b) {
        return fit(joined(bodies[a], bodies[b])).cost - cost[a] - cost[b];
    };
    for (size_t a = 0; a < bodies.size(); a++)
        for (size_t b = 0; b < a; b++)
            change[a].push_back(evaluate(a, b));
    for (;;) {
        size_t at_a = 0, at_b = 0;
        double best = 0.0;
        for (size_t a = 0; a < bodies.size(); a++) {
            for (size_t b = 0; b < a; b++) {
                if (change[a][b] < best) {
                    best = change[a][b];
                    at_a = a;
                    at_b = b;
                }
            }
        }
        if (best >= 0.0)
            return;
        bodies[at_b] = joined(bodies[at_b], bodies[at_a]);
        cost[at_b] += cost[at_a] + best;
        bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(at_a));
        cost.erase(cost.begin() + static_cast<std::ptrdiff_t>(at_a));
        change.erase(change.begin() + static_cast<std::ptrdiff_t>(at_a));
        for (size_t a = at_a; a < bodies.size(); a++)
            change[a].erase(change[a].begin() + static_cast<std::ptrdiff_t>(at_a));
        for (size_t other = 0; other < bodies.size(); other++)
            if (other != at_b)
                change[std::max(other, at_b)][std::min(other, at_b)] =
                    evaluate(std::max(other, at_b), std::min(other, at_b));
    }
}

/* The BIC of three models of the relative poses: no joint (three parameters per frame), a pivot or
 * an axis (one parameter per frame, and four or three for the joint). false: no joint is best. */
bool Merging::relate(const Fit &a, const Fit &b, EstimatedJoint &joint) const
{
    std::vector<Pose> poses;
    double arm_n = 0.0, angle_n = 0.0; /* variances over sigma^2: of a position, of an angle */
    for (size_t f = 0; f < a.placed.size(); f++) {
        const Placed &in_a = a.placed[f];
        const Placed &in_b = b.placed[f];
        if (!in_a.known || !in_b.known)
            continue;
        poses.push_back(compose(inverse(in_a.pose), in_b.pose));
        arm_n += 1.0 / in_a.n + 1.0 / in_b.n;
        angle_n += 1.0 / std::max(in_a.inertia_m2, 1e-12) + 1.0 / std::max(in_b.inertia_m2, 1e-12);
    }
    double n = static_cast<double>(poses.size());
    if (n < 3.0)
        return false;
    JointErrors errors = joint_errors(poses);
    double reach2 = errors.reach_m * errors.reach_m;
    double place_m2 = sigma_m_ * sigma_m_ * (arm_n / n + reach2 * angle_n / n);
    double angle_rad2 = sigma_m_ * sigma_m_ * angle_n / n;
    double free = pose_numbers * (n - 1.0) * log_n_;
    double pivot = n * errors.pivot_m * errors.pivot_m / place_m2 + (n - 1.0 + 4.0) * log_n_;
    double axis = n * errors.line_m * errors.line_m / place_m2 +
                  n * errors.turn_rad * errors.turn_rad / angle_rad2 + (n - 1.0 + 3.0) * log_n_;
    double least = std::min(std::min(pivot, axis), free);
    double p_pivot = std::exp(-0.5 * (pivot - least));
    double p_axis = std::exp(-0.5 * (axis - least));
    double p_free = std::exp(-0.5 * (free - least));
    joint.type = p_pivot > p_axis ? GRRL_REVOLUTE : GRRL_PRISMATIC;
    joint.probability = std::max(p_pivot, p_axis) / (p_pivot + p_axis + p_free);
    return joint.probability > 0.5;
}

Estimate Merging::estimate()
{
    std::vector<Rows> bodies = groups();
    merge(bodies);
    Estimate estimate;
    std::vector<Fit> fits;
    for (const Rows &rows : bodies) {
        bool large = rows.size() >= LEAST_BODY;
        for (size_t row : rows)
            estimate.features.push_back(
                {static_cast<int32_t>(row), large ? estimate.links : static_cast<int>(no_link)});
        if (large) {
            estimate.links++;
            fits.push_back(fit(rows));
        }
    }
    for (int i = 0; i < estimate.links; i++) {
        for (int j = i + 1; j < estimate.links; j++) {
            EstimatedJoint joint{i, j, GRRL_REVOLUTE, 0.0};
            if (relate(fits[static_cast<size_t>(i)], fits[static_cast<size_t>(j)], joint))
                estimate.joints.push_back(joint);
        }
    }
    return estimate;
}

} // namespace

Estimate merge_by_bic(const Pictures &pictures, double sigma_m)
{
    return Merging(pictures, sigma_m).estimate();
}

} // namespace grrl_experiment::recordings
