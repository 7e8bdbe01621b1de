/*
 * graph.h: kinematic structures as undirected labelled graphs (paper, section V-D).
 *
 * A vertex is a link with its properties, and an edge is a revolute or prismatic joint;
 * disconnected links have no edge. The background is not a vertex unless a joint connects something
 * to it.
 */
#ifndef GRRL_GRAPH_H
#define GRRL_GRAPH_H

#include <stdbool.h>
#include <stdint.h>

#include "grrl/base/api.h"
#include "grrl/base/config.h"
#include "grrl/base/joint_type.h"
#include "grrl/base/status.h"
#include "grrl/structure/term.h"

GRRL_API_BEGIN

#define grrl_graph_clear GRRL_SIZED(grrl_graph_clear)

/* What grrl_graph_joint returns if two links have no joint. */
enum { GRRL_NO_JOINT = -1 };

/* The properties of a link: byte i is the property at place i, or 0 if there is none. */
typedef uint64_t grrl_label;

/*
 * The label of the background when a joint makes it a vertex. No link has this label (its bytes
 * would be variables) and no mask changes it, so the background matches only the background.
 */
#define GRRL_LABEL_BACKGROUND UINT64_MAX

/* A mask over the bytes of a label selects the properties to compare. */
#define GRRL_ALL_PROPERTIES UINT64_MAX
#define GRRL_NO_PROPERTIES UINT64_C(0)

/* The part of a label to compare: two labels are equal under the mask if these
 * results are equal. */
static inline grrl_label grrl_label_masked(grrl_label label, grrl_label mask)
{
    return label == GRRL_LABEL_BACKGROUND ? label : label & mask;
}

struct grrl_graph {
    uint8_t n; /* links */
    uint32_t joined[GRRL_JOINT_TYPES]
                   [GRRL_MAX_LINKS]; /* bit j of joined[t][i]: i and j share a joint of type t */
    grrl_label label[GRRL_MAX_LINKS];
};

/* A joint between two links a and b of a graph. */
struct grrl_edge {
    uint8_t a;
    uint8_t b;
    uint8_t type; /* enum grrl_joint_type */
};

void grrl_graph_clear(struct grrl_graph *graph);

/* GRRL_ERR_FULL at GRRL_MAX_LINKS. index may be NULL. */
GRRL_MUST_USE enum grrl_status grrl_graph_add_link(struct grrl_graph *graph, grrl_label label,
                                                   uint8_t *index);

/* GRRL_ERR_STRUCTURE for a joint from a link to itself, or between links that already have one. */
GRRL_MUST_USE enum grrl_status grrl_graph_add_joint(struct grrl_graph *graph, uint8_t a, uint8_t b,
                                                    enum grrl_joint_type type);

/* The type of the joint between two links, or GRRL_NO_JOINT. */
int grrl_graph_joint(const struct grrl_graph *graph, uint8_t a, uint8_t b);

/* All links that share a joint with this one, as a bit mask. */
uint32_t grrl_graph_neighbours(const struct grrl_graph *graph, uint8_t link);

unsigned grrl_graph_joint_count(const struct grrl_graph *graph);

/* Permutes the vertices: new vertex i is old vertex order[i]. */
void grrl_graph_permute(const struct grrl_graph *graph, const uint8_t *order,
                        struct grrl_graph *permuted);

/* Whether both have the same vertices in the same order; labels are compared under the mask. */
bool grrl_graph_equal(const struct grrl_graph *a, const struct grrl_graph *b, grrl_label mask);

/* The links connected to `link` by joints, itself included, as a bit mask. */
uint32_t grrl_graph_component(const struct grrl_graph *graph, uint8_t link);

/*
 * Builds the structure that a term describes. names[i] (GRRL_MAX_LINKS of them) is set to the name
 * of vertex i, in order of first appearance (for the background, of its first joint). A link may
 * appear more than once, in full or as a bare name. edges (may be NULL; GRRL_MAX_JOINTS of them,
 * *n_edges filled) receives the joints, the most deeply nested first: the order of discovery.
 * GRRL_ERR_FULL; GRRL_ERR_STRUCTURE: an action, a property variable, a link joined to itself or
 * twice to another, two sets of properties for one name, or a background with properties. On
 * failure the graph and names are invalid and *error, if not NULL, holds a message; a term has no
 * position, so line and column are 0.
 */
GRRL_MUST_USE enum grrl_status grrl_graph_from_term(const struct grrl_term_store *store,
                                                    grrl_term term, struct grrl_graph *graph,
                                                    struct grrl_name *names,
                                                    struct grrl_edge *edges, uint8_t *n_edges,
                                                    struct grrl_term_error *error);

/*
 * Writes a term that describes the graph; every structure round-trips. edges lists the joints in
 * order of discovery, so that the first discovered is the most deeply nested (n_edges of them, each
 * joint of the graph once; NULL: an order that nests well). with_background wraps the term in D(lb,
 * ..), unless a joint makes the background a link; a graph without links is `lb`. The names must be
 * distinct. Uses at most 2 n + 4 joints + 2 nodes. GRRL_ERR_FULL; GRRL_ERR_ARGUMENT: names or edges
 * that do not fit the graph, a background without a joint, or a property the store does not know.
 */
GRRL_MUST_USE enum grrl_status grrl_graph_to_term(struct grrl_term_store *store,
                                                  const struct grrl_graph *graph,
                                                  const struct grrl_name *names,
                                                  const struct grrl_edge *edges, uint8_t n_edges,
                                                  bool with_background, grrl_term *term);

GRRL_API_END

#endif
