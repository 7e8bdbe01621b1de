/*
 * object.hpp: describes the objects on the table, without physics.
 *
 * object_from_text turns a description into an ObjectSpec:
 *   RPRPRPR                       a serial chain, one letter a joint
 *   R(l1, R(l5, R(l4, ..)))       a relational term: branches, loops, sizes, several objects; its
 *                                 links have any names a term takes, R(blade1, blade2)
 *   scissors.grrl                 a file with a term and dimensions (object_file.hpp)
 * World takes an ObjectSpec. Metres, kilograms, newtons, radians throughout.
 */
#ifndef GRRL_SIM_OBJECT_HPP
#define GRRL_SIM_OBJECT_HPP

#include <string>
#include <vector>

#include "geometry.hpp"
#include "grrl/structure/graph.h"
#include "result.hpp"

namespace grrl_sim
{

/* A link: a rectangle whose frame has its origin in the centre and x along the link. */
struct LinkSpec {
    std::string name;
    double half_length_m = 0.065;
    double half_width_m = 0.0175;
    double mass_kg = 0.13;
    grrl_property size = 0; /* 0, GRRL_PROPERTY_SMALL or GRRL_PROPERTY_LARGE */
    bool fixed = false;     /* lb: fixed to the table, neither seen nor touched */
    int features_min = 8;   /* its number of features is drawn from this range */
    int features_max = 14;
};

/*
 * A joint. At value 0 the two anchors coincide and b is rotated by angle_rad relative to a. The
 * value of a revolute joint (rad) rotates b about the anchor; that of a prismatic joint (m) moves
 * b's anchor along the axis.
 */
struct JointSpec {
    grrl_joint_type type = GRRL_REVOLUTE;
    int a = 0;
    int b = 0;
    Vec2 anchor_a_m; /* in a's frame */
    Vec2 anchor_b_m; /* in b's frame */
    double angle_rad = 0.0;
    double axis_rad = 0.0; /* of sliding, in a's frame */
    double lower = 0.0;
    double upper = 0.0;
    double friction = 0.0;      /* N m or N, Coulomb */
    double initial_lower = 0.0; /* the initial value is drawn from this range */
    double initial_upper = 0.0;
    bool given = false; /* a file fixed the geometry, so the layout must not change it */
};

struct ObjectSpec {
    std::vector<LinkSpec> links;   /* link i is vertex i of truth */
    std::vector<JointSpec> joints; /* each joint of truth once */
    grrl_graph truth;
};

/*
 * The defaults of links and joints. A joint moves only if the table holds the part beyond it more
 * firmly than the joint does: one link is held by 0.4 * 0.13 kg * g = 0.5 N, or 3.3 N cm about its
 * end. With these frictions random pushes discover RPRPRPR in about 20 pushes, as in the paper.
 * With 6 N cm and 2 N the joints near the ends hardly ever move. One push on a loop must move at
 * least four joints at once, so joints on loops have less friction.
 */
constexpr double small_half_length_m = 0.045;
constexpr double large_half_length_m = 0.085;
constexpr double revolute_limit_rad = radians(120.0);
constexpr double revolute_initial_rad = radians(20.0);
constexpr double revolute_friction_n_m = 0.03;
constexpr double prismatic_limit_m = 0.03;
constexpr double prismatic_initial_m = 0.015;
constexpr double prismatic_friction_n = 0.95;
constexpr double loop_friction_share = 1.0 / 3.0;

/* An unnamed link of this size, with a number of features that suits its length. */
LinkSpec default_link(grrl_property size);

/* Sets the range of features from the link's area: about 11 on a standard link, at least 6. */
void set_feature_range(LinkSpec &link);

/* A joint without geometry, with the limits and friction of its type. */
JointSpec default_joint(grrl_joint_type type, int a, int b);

/* Makes a link longer and wider; its mass and its number of features follow the area. */
void resize_link(LinkSpec &link, double length, double width);

/* An object as it would be in another world; the factors are 1 in the default one. */
struct ObjectScale {
    double length = 1.0;   /* of every link, with its mass and number of features */
    double features = 1.0; /* of their number on every link */
    double friction = 1.0; /* of every joint */
    /* Friction follows the size of the smaller of a joint's links: the mass for sliding, mass times
     * length for turning, as the table's friction does. Sliding joints move in proportion to its
     * length. So an object of any size moves like its larger twin. */
    bool similar = false;
};

/* n letters R and P give n joints between n + 1 links in a row. */
Result<ObjectSpec> object_from_chain(const std::string &letters, const ObjectScale &scale = {});

/* Accepts any term that is a kinematic structure; errors carry line and column. */
Result<ObjectSpec> object_from_term(const std::string &term, const ObjectScale &scale = {});

/* A chain, a term, the path of a file, or the name of an object that comes with grrl. */
Result<ObjectSpec> object_from_text(const std::string &text, const ObjectScale &scale = {});

/*
 * Parts of object_from_term, for object_file.cpp. The first makes the links and joints of a term
 * with default dimensions and no geometry; the caller may prefix its errors, for example with
 * "file:3:". The second scales, adds the geometry and checks the loops; it returns what is wrong.
 */
struct TermPosition {
    unsigned line = 1;
    unsigned column = 1;
};
Result<ObjectSpec> links_and_joints(const std::string &term, TermPosition *error_position);
std::string finish_object(ObjectSpec &object, const ObjectScale &scale = {});

} // namespace grrl_sim

#endif
