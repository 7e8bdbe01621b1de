/* joint_error.cpp: least-squares residuals over all pivots and all axes. */
#include "joint_error.hpp"

#include <algorithm>
#include <cmath>

namespace grrl_experiment::recordings
{

using grrl_sim::Pose;
using grrl_sim::Vec2;

namespace
{

struct Sums {
    Vec2 mean;
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
};

Sums spread(const std::vector<Vec2> &points)
{
    Sums sums;
    for (Vec2 p : points)
        sums.mean = sums.mean + (1.0 / static_cast<double>(points.size())) * p;
    for (Vec2 p : points) {
        Vec2 d = p - sums.mean;
        sums.xx += d.x * d.x;
        sums.xy += d.x * d.y;
        sums.yy += d.y * d.y;
    }
    return sums;
}

/* The residual across the main axis of the points. */
double error_of_a_line(const std::vector<Vec2> &points)
{
    Sums sums = spread(points);
    double half = 0.5 * (sums.xx + sums.yy);
    double root = std::hypot(0.5 * (sums.xx - sums.yy), sums.xy);
    return std::sqrt(std::max(half - root, 0.0) / static_cast<double>(points.size()));
}

/*
 * A point p of b is fixed in a: without the means, it minimises the sum of |(R - mean R) p + t -
 * mean t|^2. R - mean R is a scaled rotation, so the normal equations are diagonal.
 */
void error_of_a_pivot(const std::vector<Pose> &poses, JointErrors &errors)
{
    double n = static_cast<double>(poses.size());
    Vec2 mean_turn;
    Vec2 mean_place;
    for (const Pose &pose : poses) {
        mean_turn = mean_turn + (1.0 / n) * grrl_sim::direction(pose.angle);
        mean_place = mean_place + (1.0 / n) * pose.position;
    }
    double h = 1e-12;
    double rest = 0.0;
    Vec2 g;
    for (const Pose &pose : poses) {
        Vec2 turn = grrl_sim::direction(pose.angle) - mean_turn;
        Vec2 place = pose.position - mean_place;
        h += dot(turn, turn);
        g = g + Vec2{dot(turn, place), cross(turn, place)};
        rest += dot(place, place);
    }
    errors.pivot_m = std::sqrt(std::max(rest - dot(g, g) / h, 0.0) / n);
    errors.reach_m = length(g) / h;
}

/* Angles accumulated from one pose to the next, so that they may exceed half a turn. */
double spread_of_turns(const std::vector<Pose> &poses)
{
    std::vector<Vec2> turns;
    double angle = 0.0;
    for (size_t i = 0; i < poses.size(); i++) {
        angle += i > 0 ? grrl_sim::wrap_angle(poses[i].angle - poses[i - 1].angle) : 0.0;
        turns.push_back({angle, 0.0});
    }
    return std::sqrt(spread(turns).xx / static_cast<double>(turns.size()));
}

} // namespace

JointErrors joint_errors(const std::vector<Pose> &poses)
{
    JointErrors errors{};
    std::vector<Vec2> places;
    for (const Pose &pose : poses)
        places.push_back(pose.position);
    errors.line_m = error_of_a_line(places);
    errors.turn_rad = spread_of_turns(poses);
    error_of_a_pivot(poses, errors);
    return errors;
}

} // namespace grrl_experiment::recordings
