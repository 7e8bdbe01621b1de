/* sparse_cut.cpp: Stoer and Wagner's phases, each of which proposes a cut. */
#include "sparse_cut.hpp"

#include <algorithm>

namespace grrl_experiment::perception
{

namespace
{

/* The last two vertices of an order in which each next vertex is the one most tightly connected to
 * those before it, and the connectivity of the last one. */
struct Phase {
    size_t before_last;
    size_t last;
    int edges;
};

Phase order_by_ties(const std::vector<std::vector<int>> &weight,
                    const std::vector<size_t> &vertices)
{
    std::vector<int> ties(weight.size(), 0);
    std::vector<bool> taken(weight.size(), false);
    Phase phase{vertices[0], vertices[0], 0};
    for (size_t i = 0; i < vertices.size(); i++) {
        size_t next = weight.size();
        for (size_t v : vertices)
            if (!taken[v] && (next == weight.size() || ties[v] > ties[next]))
                next = v;
        taken[next] = true;
        phase = {phase.last, next, ties[next]};
        for (size_t v : vertices)
            ties[v] += taken[v] ? 0 : weight[next][v];
    }
    return phase;
}

} // namespace

SparseCut sparse_cut(std::vector<std::vector<int>> edges, std::size_t least)
{
    std::vector<std::vector<int>> &weight = edges; /* of merged vertices the sum */
    const size_t n = edges.size();
    std::vector<size_t> vertices(weight.size());
    std::vector<std::vector<size_t>> merged(weight.size());
    for (size_t i = 0; i < vertices.size(); i++) {
        vertices[i] = i;
        merged[i] = {i};
    }
    SparseCut best{2.0, {}};
    while (vertices.size() > 1) {
        Phase phase = order_by_ties(weight, vertices);
        size_t side = merged[phase.last].size();
        double possible = static_cast<double>(side * (n - side));
        if (side >= least && n - side >= least && phase.edges / possible < best.density)
            best = {phase.edges / possible, merged[phase.last]};
        std::vector<size_t> &to = merged[phase.before_last];
        to.insert(to.end(), merged[phase.last].begin(), merged[phase.last].end());
        for (size_t v : vertices) {
            weight[phase.before_last][v] += weight[phase.last][v];
            weight[v][phase.before_last] = weight[phase.before_last][v];
        }
        vertices.erase(std::find(vertices.begin(), vertices.end(), phase.last));
    }
    return best;
}

} // namespace grrl_experiment::perception
