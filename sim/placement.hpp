/* placement.hpp: a random configuration of the object at a random place on the table. */
#ifndef GRRL_SIM_PLACEMENT_HPP
#define GRRL_SIM_PLACEMENT_HPP

#include <vector>

#include "object.hpp"
#include "random.hpp"

namespace grrl_sim
{

/*
 * Poses of all links: joint values within their initial ranges, loops closed, no link on another
 * and everything on the table. A structure too crowded or too long for that is bent further, up to
 * its limits; what still does not fit may lie across itself or stick out.
 */
std::vector<Pose> random_poses(const ObjectSpec &object, Vec2 table_m, Random &random);

} // namespace grrl_sim

#endif
