/* settling.h: when a scene has settled, for everyone who drives a learner. */
#ifndef GRRL_SETTLING_H
#define GRRL_SETTLING_H

/*
 * A scene has settled once so many frames in a row show nothing in motion, at the start of a trial
 * and after each push. Perception averages them into a keyframe: ten bring the noise of a point
 * down to a third. Then call grrl_learner_perceive.
 */
enum { GRRL_SETTLING_FRAMES = 10 };

#endif
