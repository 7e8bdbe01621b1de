/*
 * kinematics.hpp: poses from joint values, and joint values that close loops.
 *
 * A spanning forest carries the poses: the values of its joints are free. Every joint outside the
 * forest closes a loop and asks two conditions of them.
 */
#ifndef GRRL_SIM_KINEMATICS_HPP
#define GRRL_SIM_KINEMATICS_HPP

#include <vector>

#include "object.hpp"

namespace grrl_sim
{

struct Forest {
    std::vector<int> tree;      /* joints in an order in which one link is placed already .. */
    std::vector<bool> from_a;   /* .. a (or else b), for each of them */
    std::vector<int> closing;   /* the other joints */
    std::vector<int> roots;     /* one link for each component, the background if it is in it */
    std::vector<int> component; /* of each link, an index into roots */
};

Forest spanning_forest(const ObjectSpec &object);

/* Poses of all links for values of the forest's joints (indexed like joints), roots at zero. */
std::vector<Pose> link_poses(const ObjectSpec &object, const Forest &forest,
                             const std::vector<double> &values);

/* The value of a joint between links at these poses. */
double joint_value(const JointSpec &joint, const Pose &a, const Pose &b);

/*
 * Moves the values of the forest's joints to the nearest solution that closes every loop
 * (Levenberg-Marquardt) and fills in those of the closing joints. False when it finds none.
 */
bool close_loops(const ObjectSpec &object, const Forest &forest, std::vector<double> &values);

/* For each joint, whether it can move at first order while all loops stay closed. */
std::vector<bool> movable_joints(const ObjectSpec &object, const Forest &forest,
                                 const std::vector<double> &values);

/* The rectangles of links that do not share a joint come nearer than the margin. */
bool links_overlap(const ObjectSpec &object, const std::vector<Pose> &poses, double margin_m);

/* The shape of a link at a pose. */
Rectangle link_rectangle(const LinkSpec &link, const Pose &pose);

} // namespace grrl_sim

#endif
