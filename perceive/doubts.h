/* doubts.h: what makes the answer for a recording doubtful. */
#ifndef GRRL_PERCEIVE_DOUBTS_H
#define GRRL_PERCEIVE_DOUBTS_H

#include "camera.h"
#include "report.h"
#include "tracks.h"
#include "warnings.h"

/* Lost points of a CSV file; damage and sessions of a log. */
void grrl_doubt_input(const struct grrl_tracks *tracks, struct grrl_warnings *warnings);

/* What the camera added to the motion, and was undone. */
void grrl_doubt_camera(const struct grrl_camera *camera, struct grrl_warnings *warnings);

/* Positions, in metres, that suggest a unit other than report->unit; said: the user named the unit.
 */
void grrl_doubt_unit(const struct grrl_tracks *tracks, const struct grrl_report *report, bool said,
                     struct grrl_warnings *warnings);

/* Points that scatter more, in metres, than the noise that was assumed. */
void grrl_doubt_noise(const struct grrl_report *report, double noise_m,
                      struct grrl_warnings *warnings);

/* Points that perception could not use, and their share if it is at least a third. */
void grrl_doubt_losses(const struct grrl_report *report, struct grrl_warnings *warnings);

#endif
