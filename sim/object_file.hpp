/*
 * object_file.hpp: objects with dimensions, one statement a line, # starts a comment.
 *
 *   term D(lb, R(blade1, blade2))
 *       the structure, once, before the lines that refer to it; the links are named freely (term.h)
 *   link NAME length_m width_m mass_kg
 *       the rectangle of a link; others keep the default
 *   joint A B lower upper friction anchor_a_x anchor_a_y anchor_b_x anchor_b_y [axis [angle]]
 *       the joint between A and B: limits in degrees (revolute) or metres (prismatic), friction in
 *       N m or N, the anchors in metres from the links' centres, the sliding axis in degrees
 *       against A's length, and by how many degrees B is turned against A at value 0. Joints
 *       without a line keep the geometry they have in a term alone.
 */
#ifndef GRRL_SIM_OBJECT_FILE_HPP
#define GRRL_SIM_OBJECT_FILE_HPP

#include <string>

#include "object.hpp"

namespace grrl_sim
{

/* Errors start with path:line:column. */
Result<ObjectSpec> object_from_file(const std::string &path, const ObjectScale &scale = {});

/* Reads from a text instead; `path` appears only in errors. */
Result<ObjectSpec> object_from_file_text(const std::string &text, const std::string &path,
                                         const ObjectScale &scale = {});

} // namespace grrl_sim

#endif
