/* handle.h: a file with the trajectory of one point: rows x y, x y z or poses, separated by blanks.
 */
#ifndef GRRL_PERCEIVE_HANDLE_H
#define GRRL_PERCEIVE_HANDLE_H

#include <stdbool.h>
#include <stdio.h>

#include "tracks.h"

#include "grrl/perception/trajectory.h"

/* A trajectory and the storage of its rows, which grrl_handle_free releases. */
struct grrl_handle {
    struct grrl_trajectory trajectory;
    float *rows_m;
};

/* scale: metres per unit of the file. Empty lines and lines that begin with # are skipped. Of a
 * pose (x y z and a quaternion with its components in any order), only the position is used. */
bool grrl_handle_read(FILE *file, const char *path, float scale, struct grrl_handle *handle,
                      struct grrl_tracks_error *error);
void grrl_handle_free(struct grrl_handle *handle);

/* per_metre: units of the file per metre. */
void grrl_handle_print(FILE *file, const struct grrl_trajectory_fit *fit, uint32_t n,
                       const char *unit, double per_metre, bool json);

#endif
