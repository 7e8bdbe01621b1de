/*
 * grid.hpp: which conditions a study has.
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

/* Recordings that are alike but for the seed. */
struct Cell {
    std::string conditions; /* "usual", "camera=roll", "camera=roll,rate=3" */
    const NamedObject *object;
    Conditions what;
};

/*
 * Axes between semicolons, each with its levels or alone, for all: "camera=roll,zoom; objects=R".
 * Axes that are named are crossed; the others stay as usual, but for the objects: all. A moving or
 * leaning camera needs pictures, so that it is not crossed with sizes in mm or m.
 */
grrl_sim::Result<std::vector<Cell>> make_grid(const std::string &text);

/* The axes and their levels, for --help. */
std::string grid_help();

} // namespace grrl_experiment::recordings

#endif
