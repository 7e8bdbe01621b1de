// Boost Graph Library: vf2_graph_iso and vf2_subgraph_mono.
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

void *build(const grrl_graph *graph)
{
    auto *built = new Graph(graph->n);
    for (uint8_t i = 0; i < graph->n; i++) {
        (*built)[i].label = graph->label[i];
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            for (uint8_t j = 0; j < i; j++)
                if ((graph->joined[type][i] >> j & 1u) != 0)
                    boost::add_edge(i, j, Joint{type}, *built);
    }
    return built;
}

void destroy(void *graph)
{
    delete static_cast<Graph *>(graph);
}

int match(grrl_match_kind kind, const void *pattern, const void *target)
{
    const auto &a = *static_cast<const Graph *>(pattern);
    const auto &b = *static_cast<const Graph *>(target);
    auto order = boost::vertex_order_by_mult(a);
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
