/* placement.hpp: a random configuration of the object at a random place on the table. */
#ifndef GRRL_SIM_PLACEMENT_HPP
#define GRRL_SIM_PLACEMENT_HPP

#include <vector>

#include "object.hpp"
#include "random.hpp"

namespace grrl_sim
{

/*
 * Draws poses of all links: joint values within their initial ranges, loops closed, no links
 * overlapping, everything on the table. If a structure is too crowded or too long for that, its
 * joints may bend up to their limits. If it still does not fit, it may overlap itself or extend
 * over the edge.
 */
std::vector<Pose> random_poses(const ObjectSpec &object, Vec2 table_m, Random &random);

} // namespace grrl_sim

#endif
