// Boost Graph Library: vf2_graph_iso and vf2_subgraph_mono, as one would use them who matches a
// graph more than once: the order of its vertices is made with it and kept, and counts are compared
// first.
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/vf2_sub_graph_iso.hpp>

#include "bench.h"

namespace
{

struct Link {
    grrl_label label;
};
struct Joint {
    int type;
};
using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, Link, Joint>;

struct SameJoint {
    const Graph &a;
    const Graph &b;
    template <class E, class F> bool operator()(E e, F f) const { return a[e].type == b[f].type; }
};
struct SameLink {
    const Graph &a;
    const Graph &b;
    template <class V, class W> bool operator()(V v, W w) const { return a[v].label == b[w].label; }
};
struct First {
    template <class F, class B> bool operator()(F, B) const { return false; }
};

struct Prepared {
    Graph graph;
    std::vector<boost::graph_traits<Graph>::vertex_descriptor> order;
    std::size_t joints[GRRL_JOINT_TYPES] = {};

    explicit Prepared(uint8_t n) : graph(n) {}
};

bool counts_fit(grrl_match_kind kind, const Prepared &a, const Prepared &b)
{
    const bool exact = kind == GRRL_MATCH_ISOMORPHISM;
    auto fit = [exact](std::size_t m, std::size_t n) { return exact ? m == n : m <= n; };
    bool good = fit(num_vertices(a.graph), num_vertices(b.graph));
    for (int type = 0; type < GRRL_JOINT_TYPES; type++)
        good = good && fit(a.joints[type], b.joints[type]);
    return good;
}

void *build(const grrl_graph *graph)
{
    auto *prepared = new Prepared(graph->n);
    Graph *built = &prepared->graph;
    for (uint8_t i = 0; i < graph->n; i++) {
        (*built)[i].label = graph->label[i];
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            for (uint8_t j = 0; j < i; j++)
                if ((graph->joined[type][i] >> j & 1u) != 0) {
                    boost::add_edge(i, j, Joint{type}, *built);
                    prepared->joints[type]++;
                }
    }
    prepared->order = boost::vertex_order_by_mult(*built);
    return prepared;
}

void destroy(void *graph)
{
    delete static_cast<Prepared *>(graph);
}

int match(grrl_match_kind kind, const void *pattern, const void *target)
{
    const auto &from = *static_cast<const Prepared *>(pattern);
    const auto &to = *static_cast<const Prepared *>(target);
    if (!counts_fit(kind, from, to))
        return 0;
    const Graph &a = from.graph;
    const Graph &b = to.graph;
    const auto &order = from.order;
    SameJoint joints{a, b};
    SameLink links{a, b};
    if (kind == GRRL_MATCH_ISOMORPHISM)
        return boost::vf2_graph_iso(a, b, First(), order,
                                    boost::edges_equivalent(joints).vertices_equivalent(links));
    return boost::vf2_subgraph_mono(a, b, First(), order,
                                    boost::edges_equivalent(joints).vertices_equivalent(links));
}

} // namespace

extern "C" const bench_peer bench_boost = {"boost", build, destroy, match};
