/* settling.h: when a scene counts as settled, for all code that drives a learner. */
#ifndef GRRL_SETTLING_H
#define GRRL_SETTLING_H

/*
 * A scene has settled after this many consecutive frames without motion, both at the start of a
 * trial and after each push. Perception averages these frames into a keyframe: ten reduce the noise
 * of a point to a third. Then call grrl_learner_perceive.
 */
enum { GRRL_SETTLING_FRAMES = 10 };

#endif
