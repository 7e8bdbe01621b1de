/*
 * kinematics.hpp: computes poses from joint values, and joint values that close loops.
 *
 * Poses follow from a spanning forest, whose joint values are free. Every joint outside the forest
 * closes a loop and imposes two conditions on them.
 */
#ifndef GRRL_SIM_KINEMATICS_HPP
#define GRRL_SIM_KINEMATICS_HPP

#include <vector>

#include "object.hpp"

namespace grrl_sim
{

struct Forest {
    std::vector<int> tree;      /* joints, ordered so that one of the two links is placed already */
    std::vector<bool> from_a;   /* whether that link is a (else b), for each of them */
    std::vector<int> closing;   /* the other joints */
    std::vector<int> roots;     /* one link per component; the background if it belongs to it */
    std::vector<int> component; /* of each link, an index into roots */
};

Forest spanning_forest(const ObjectSpec &object);

/* Poses of all links, given the values of the forest's joints (indexed like joints), with roots at
 * zero. */
std::vector<Pose> link_poses(const ObjectSpec &object, const Forest &forest,
                             const std::vector<double> &values);

/* The value of a joint between links at these poses. */
double joint_value(const JointSpec &joint, const Pose &a, const Pose &b);

/*
 * Moves the values of the forest's joints to the nearest solution that closes every loop
 * (Levenberg-Marquardt), and computes the values of the closing joints. False if it finds none.
 */
bool close_loops(const ObjectSpec &object, const Forest &forest, std::vector<double> &values);

/* For each joint, whether it can move to first order while all loops stay closed. */
std::vector<bool> movable_joints(const ObjectSpec &object, const Forest &forest,
                                 const std::vector<double> &values);

/* Whether the rectangles of two links without a common joint are closer than the margin. */
bool links_overlap(const ObjectSpec &object, const std::vector<Pose> &poses, double margin_m);

/* The shape of a link at a pose. */
Rectangle link_rectangle(const LinkSpec &link, const Pose &pose);

} // namespace grrl_sim

#endif
