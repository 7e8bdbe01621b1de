/*
 * grid.hpp: the conditions of a study.
 *
 * An axis (objects, camera, tracks, points, rate, size) has levels, the first of which is the usual
 * one. Without a choice each axis is varied alone, for all objects.
 */
#ifndef GRRL_EXPERIMENT_RECORDINGS_GRID_HPP
#define GRRL_EXPERIMENT_RECORDINGS_GRID_HPP

#include <string>
#include <vector>

#include "recording.hpp"
#include "result.hpp"

namespace grrl_experiment::recordings
{

/* Recordings that differ only in the seed. */
struct Cell {
    std::string conditions; /* "usual", "camera=roll", "camera=roll,rate=3" */
    const NamedObject *object;
    Conditions what;
};

/*
 * Axes separated by semicolons, each with its levels or alone for all of them: "camera=roll,zoom;
 * objects=R". The named axes are crossed; the others keep their usual level, except that all
 * objects take part. A moving or tilted camera needs images, so it is not crossed with sizes in mm
 * or m.
 */
grrl_sim::Result<std::vector<Cell>> make_grid(const std::string &text);

/* The axes and their levels, for --help. */
std::string grid_help();

} // namespace grrl_experiment::recordings

#endif
