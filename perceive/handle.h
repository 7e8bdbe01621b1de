/* handle.h: a file with the trajectory of one point: rows x y, x y z or poses, between blanks. */
#ifndef GRRL_PERCEIVE_HANDLE_H
#define GRRL_PERCEIVE_HANDLE_H

#include <stdbool.h>
#include <stdio.h>

#include "tracks.h"

#include "grrl/perception/trajectory.h"

/* A trajectory with the storage its rows point to, which grrl_handle_free releases. */
struct grrl_handle {
    struct grrl_trajectory trajectory;
    float *rows_m;
};

/* scale: metres in a unit of the file. Empty lines and lines that begin with # are left out. Of a
 * pose (x y z and a quaternion, in any order of its four) the position counts. */
bool grrl_handle_read(FILE *file, const char *path, float scale, struct grrl_handle *handle,
                      struct grrl_tracks_error *error);
void grrl_handle_free(struct grrl_handle *handle);

/* per_metre: units of the file in a metre. */
void grrl_handle_print(FILE *file, const struct grrl_trajectory_fit *fit, uint32_t n,
                       const char *unit, double per_metre, bool json);

#endif
