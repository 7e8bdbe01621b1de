/* motion.h: how far each joint has turned or slid in each frame of a recording. */
#ifndef GRRL_PERCEIVE_MOTION_H
#define GRRL_PERCEIVE_MOTION_H

#include "report.h"

/*
 * Writes CSV (frame,a,b,type,value,unit), a row for each joint of the model in each frame that
 * shows at least two points of both bodies. The value is the angle of b relative to a in degrees,
 * positive from x to y, or the travel of b along the joint's axis; 0 in the first such frame.
 * false: out of memory. Cost: a few passes over all points.
 */
bool grrl_motion_write(FILE *file, const struct grrl_report *report);

#endif
