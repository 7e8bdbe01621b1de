/*
 * sparse_cut.hpp: finds where a graph is held together by few edges.
 *
 * The phases of Stoer and Wagner's minimum cut (1997) propose cuts; the plain minimum would cut off
 * single vertices, so the cut with the smallest share of its possible edges is taken.
 */
#ifndef GRRL_EXPERIMENT_PERCEPTION_SPARSE_CUT_HPP
#define GRRL_EXPERIMENT_PERCEPTION_SPARSE_CUT_HPP

#include <cstddef>
#include <vector>

namespace grrl_experiment::perception
{

struct SparseCut {
    double density;                 /* share of all edges between the sides that exist; 2: no cut */
    std::vector<std::size_t> apart; /* the vertices on one side */
};

/* edges[i][j] = edges[j][i] is 0 or 1. Either side of the cut has at least `least` vertices. Cost:
 * cubic in the vertices. */
SparseCut sparse_cut(std::vector<std::vector<int>> edges, std::size_t least);

} // namespace grrl_experiment::perception

#endif
