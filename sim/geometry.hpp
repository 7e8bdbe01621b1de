/* geometry.hpp: points, poses and rectangles of the table plane, in metres and radians. */
#ifndef GRRL_SIM_GEOMETRY_HPP
#define GRRL_SIM_GEOMETRY_HPP

#include <algorithm>
#include <cmath>

namespace grrl_sim
{

constexpr double pi = 3.14159265358979323846;

constexpr double radians(double degrees)
{
    return degrees * pi / 180.0;
}

struct Vec2 {
    double x = 0.0;
    double y = 0.0;
};

inline Vec2 operator+(Vec2 a, Vec2 b)
{
    return {a.x + b.x, a.y + b.y};
}
inline Vec2 operator-(Vec2 a, Vec2 b)
{
    return {a.x - b.x, a.y - b.y};
}
inline Vec2 operator*(double s, Vec2 a)
{
    return {s * a.x, s * a.y};
}
inline double dot(Vec2 a, Vec2 b)
{
    return a.x * b.x + a.y * b.y;
}
inline double cross(Vec2 a, Vec2 b)
{
    return a.x * b.y - a.y * b.x;
}
inline double length(Vec2 a)
{
    return std::sqrt(dot(a, a));
}
inline Vec2 direction(double angle)
{
    return {std::cos(angle), std::sin(angle)};
}

/* axis: the direction of the angle to rotate by */
inline Vec2 rotate(Vec2 v, Vec2 axis)
{
    return {axis.x * v.x - axis.y * v.y, axis.y * v.x + axis.x * v.y};
}

inline Vec2 rotate(Vec2 v, double angle)
{
    return rotate(v, direction(angle));
}

/* Wraps an angle into (-pi, pi]. */
inline double wrap_angle(double angle)
{
    return angle - 2.0 * pi * std::ceil(angle / (2.0 * pi) - 0.5);
}

/* The pose of one frame in another. */
struct Pose {
    Vec2 position;
    double angle = 0.0;
};

inline Vec2 transform(const Pose &pose, Vec2 v)
{
    return pose.position + rotate(v, pose.angle);
}

inline Pose compose(const Pose &outer, const Pose &inner)
{
    return {transform(outer, inner.position), outer.angle + inner.angle};
}

inline Pose inverse(const Pose &pose)
{
    return {rotate(-1.0 * pose.position, -pose.angle), -pose.angle};
}

struct Rectangle {
    Pose pose;
    double half_length = 0.0; /* along the x axis of its pose */
    double half_width = 0.0;
};

/* Distance from a point to the rectangle, 0 inside. */
inline double distance(const Rectangle &rectangle, Vec2 point)
{
    Vec2 local = transform(inverse(rectangle.pose), point);
    double dx = std::max(std::abs(local.x) - rectangle.half_length, 0.0);
    double dy = std::max(std::abs(local.y) - rectangle.half_width, 0.0);
    return std::sqrt(dx * dx + dy * dy);
}

/* Whether a line along one of a's axes separates the two by more than the margin. */
inline bool separated_by_axes_of(const Rectangle &a, const Rectangle &b, double margin)
{
    Vec2 centre = transform(inverse(a.pose), b.pose.position);
    Vec2 d = direction(b.pose.angle - a.pose.angle);
    double reach_x = std::abs(d.x) * b.half_length + std::abs(d.y) * b.half_width;
    double reach_y = std::abs(d.y) * b.half_length + std::abs(d.x) * b.half_width;
    return std::abs(centre.x) > a.half_length + reach_x + margin ||
           std::abs(centre.y) > a.half_width + reach_y + margin;
}

/* Whether two rectangles are closer than the margin (separating axes). */
inline bool overlap(const Rectangle &a, const Rectangle &b, double margin)
{
    return !separated_by_axes_of(a, b, margin) && !separated_by_axes_of(b, a, margin);
}

} // namespace grrl_sim

#endif
