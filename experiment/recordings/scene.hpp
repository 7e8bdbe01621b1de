/*
 * scene.hpp: the moving things in a synthetic recording: links, joints, independent bodies.
 *
 * Body 0 is the ground. A scene is a function of time from 0 to 1, independent of the camera. Links
 * without a joint never look joined: a scene in which a single pivot or a single axis explains
 * their relative motion is drawn again (except for a body that crosses in a straight line, a thing
 * that approaches, and a hand on a lever, whose purpose is to look nearly joined).
 */
#ifndef GRRL_EXPERIMENT_RECORDINGS_SCENE_HPP
#define GRRL_EXPERIMENT_RECORDINGS_SCENE_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "geometry.hpp"
#include "grrl/base/joint_type.h"

namespace grrl_experiment::recordings
{

/* The visible part of the table, in link lengths; a scene stays within it. */
constexpr double table_links[2] = {3.4, 1.9};

enum class Object { R, P, RR, RP, DOOR, DRAWER, TWO, THREE, FOUR, CROSSING, NEARER, SOLIDS, HAND };

/* The group in which an object is counted. */
enum class Kind { MECHANISM, INDEPENDENT, HAND };

struct NamedObject {
    Object object;
    Kind kind;
    const char *name;
    const char *what;
};
const std::vector<NamedObject> &all_objects();

/* Smooth transition from 0 at its begin to its size at its end. */
struct Ramp {
    double begin = 0.0;
    double end = 1.0;
    double size = 0.0;
    double at(double t) const;
};

/* Two sines; 0 at the beginning. */
struct Wave {
    double size[2] = {0.0, 0.0};
    double phase[2] = {0.0, 0.0};
    double cycles[2] = {1.0, 1.0};
    double at(double t) const;
};

/* A rectangle, or a box with a depth, and its motion. Without a joint its pose is start, moved by
 * waves and ramps. */
struct Body {
    double half_length_m = 0.0;
    double half_width_m = 0.0;
    double half_depth_m = 0.0;
    grrl_sim::Pose start;
    Wave x_m, y_m, turn_rad;
    Wave pitch_rad, yaw_rad; /* out of the table's plane, about its own axes */
    Ramp cross_x_m, cross_y_m;
    Ramp growth;          /* of its scale in the image: it approaches */
    bool carried = false; /* a hand: moves with the end of the lever while touching it */
};

/* A joint to a body with a smaller index. */
struct Joint {
    int a = 0;
    int b = 1;
    grrl_joint_type type = GRRL_REVOLUTE;
    grrl_sim::Vec2
        at_a_m; /* the pivot in each body; for a prismatic joint the position of b in a */
    grrl_sim::Vec2 at_b_m;
    double angle_rad = 0.0;  /* of b in a at rest */
    std::vector<Ramp> ramps; /* of the joint's value; the axis is the x axis of a */
    double value(double t) const;
};

struct Placed {
    grrl_sim::Pose pose;
    double scale = 1.0;
    double pitch_rad = 0.0; /* first about the body's x axis, */
    double yaw_rad = 0.0;   /* then about its y axis, then the pose */
};

/* A place on the table and the height above it. */
struct Place {
    grrl_sim::Vec2 table_m;
    double height_m = 0.0;
};

/* Where a point of a body is, given in the body's frame. */
Place transform(const Placed &placed, const Place &in_body);

struct Scene {
    double link_m = 0.3;      /* length of a link */
    std::vector<Body> bodies; /* [0] is the ground with the frame of a door on it */
    std::vector<Joint> joints;
    std::vector<Placed> at(double t) const;
};

Scene make_scene(Object object, double link_m, uint64_t seed);

} // namespace grrl_experiment::recordings

#endif
