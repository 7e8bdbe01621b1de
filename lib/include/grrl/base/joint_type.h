/*
 * joint_type.h: the two joint types of planar mechanisms, shared by perception and structures.
 * There are two by design (docs/design.md).
 */
#ifndef GRRL_BASE_JOINT_TYPE_H
#define GRRL_BASE_JOINT_TYPE_H

enum grrl_joint_type { GRRL_REVOLUTE = 0, GRRL_PRISMATIC = 1, GRRL_JOINT_TYPES = 2 };

#endif
