/*
 * physics.hpp: links, joints, dry friction and the finger as Box2D bodies.
 *
 * One Box2D unit is 1 cm: in metres its 5 mm slop would be a third of a link's width. Everything
 * outside physics.cpp is in metres, newtons and radians.
 */
#ifndef GRRL_SIM_PHYSICS_HPP
#define GRRL_SIM_PHYSICS_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "object.hpp"

namespace grrl_sim
{

constexpr double step_s = 1.0 / 120.0;

class Physics
{
public:
    Physics(const ObjectSpec &object, const std::vector<Pose> &poses, double table_friction,
            double finger_radius_m);
    ~Physics();
    Physics(const Physics &) = delete;
    Physics &operator=(const Physics &) = delete;

    /* Links of the same object that cross one another there may cross here. */
    void keep_levels(const Physics &other);

    /* Multiplies the friction of link i against the table and that in joint j. */
    void scale_friction(const std::vector<double> &links, const std::vector<double> &joints);

    /* The finger on a straight guide, driven at a speed with limited force. */
    void lower_finger(Vec2 at, Vec2 along, double speed_m_s, double force_n);
    void lift_finger();
    bool finger_touches() const;
    double finger_travel_m() const; /* along the guide, from where it came down */
    std::optional<Vec2> finger_position() const;

    void step();

    /* The highest speed of any link's centre or end, m/s. */
    double greatest_speed() const;
    void stop_links();

    std::vector<Pose> poses() const;
    double joint_value(int joint) const;
    double loop_gap_m(int joint) const; /* how far the joint's parts have separated */
    uint64_t hash() const;

private:
    struct Bodies;
    std::unique_ptr<Bodies> bodies_;
};

} // namespace grrl_sim

#endif
