/* Converts terms to graphs, and graphs to terms that nest where possible. */
#include <string.h>

#include "base/bits.h"
#include "grrl/structure/graph.h"
#include "structure/term_private.h"

/* --- a term as a graph ------------------------------------------------------------------------ */

struct reader {
    const struct grrl_term_store *store;
    struct grrl_graph *graph;
    struct grrl_name *names;
    struct grrl_edge *edges;
    uint8_t n_edges;
    uint32_t described; /* vertices whose properties have appeared */
    struct grrl_term_error *error;
};

static struct grrl_text complain(struct reader *reader, struct grrl_name name, const char *what)
{
    struct grrl_term_error *error = reader->error;
    error->offset = 0;
    error->line = 0;
    error->column = 0;
    struct grrl_text message = grrl_text_begin(error->message, sizeof error->message);
    if (name.kind != GRRL_NAME_NONE) {
        grrl_text_string(&message, "link ");
        grrl_term_print_name(reader->store, &message, name);
        grrl_text_char(&message, ' ');
    }
    grrl_text_string(&message, what);
    return message;
}

static enum grrl_status reject(struct reader *reader, enum grrl_status status,
                               struct grrl_name name, const char *what)
{
    (void)complain(reader, name, what);
    return status;
}

/* Finds the vertex with this name, or adds it. */
static enum grrl_status find_vertex(struct reader *reader, struct grrl_name name, uint8_t *vertex)
{
    struct grrl_graph *graph = reader->graph;
    for (uint8_t i = 0; i < graph->n; i++) {
        if (reader->names[i].kind == name.kind && reader->names[i].number == name.number) {
            *vertex = i;
            return GRRL_OK;
        }
    }
    grrl_label label = name.kind == GRRL_NAME_BACKGROUND ? GRRL_LABEL_BACKGROUND : 0;
    if (grrl_graph_add_link(graph, label, vertex) != GRRL_OK)
        return reject(reader, GRRL_ERR_FULL, name, "exceeds the maximum number of links");
    reader->names[*vertex] = name;
    return GRRL_OK;
}

static enum grrl_status read_link(struct reader *reader, const struct grrl_term_node *node)
{
    if (node->name.kind == GRRL_NAME_BACKGROUND) {
        if (node->n_properties > 0)
            return reject(reader, GRRL_ERR_STRUCTURE, node->name,
                          "is the background, without "
                          "properties");
        return GRRL_OK; /* it becomes a vertex only when a joint needs it */
    }
    uint8_t vertex;
    enum grrl_status status = find_vertex(reader, node->name, &vertex);
    if (status != GRRL_OK || node->n_properties == 0)
        return status;
    grrl_label label = 0;
    for (uint8_t i = 0; i < node->n_properties; i++) {
        if (node->properties[i] >= GRRL_PROPERTY_VARIABLE)
            return reject(reader, GRRL_ERR_STRUCTURE, node->name,
                          "has a variable as a property, which a graph cannot hold");
        label |= (grrl_label)node->properties[i] << (8 * i);
    }
    if ((reader->described & grrl_bit(vertex)) != 0 && reader->graph->label[vertex] != label)
        return reject(reader, GRRL_ERR_STRUCTURE, node->name, "has two sets of properties");
    reader->described |= grrl_bit(vertex);
    reader->graph->label[vertex] = label;
    return GRRL_OK;
}

static enum grrl_status join(struct reader *reader, struct grrl_name from, struct grrl_name to,
                             enum grrl_joint_type type)
{
    uint8_t a;
    uint8_t b;
    enum grrl_status status = find_vertex(reader, from, &a);
    if (status == GRRL_OK)
        status = find_vertex(reader, to, &b);
    if (status != GRRL_OK)
        return status;
    status = grrl_graph_add_joint(reader->graph, a, b, type);
    if (status == GRRL_ERR_FULL)
        return reject(reader, status, from, "exceeds the maximum number of joints");
    if (status != GRRL_OK) {
        struct grrl_text message =
            complain(reader, from, a == b ? "is joined to itself" : "is joined twice to ");
        if (a != b)
            grrl_term_print_name(reader->store, &message, to);
        return status;
    }
    if (reader->edges != NULL)
        reader->edges[reader->n_edges] = (struct grrl_edge){a, b, (uint8_t)type};
    reader->n_edges++;
    return GRRL_OK;
}

/* Adds the joints of a relation. They lead from the link written last in its first argument (the
 * last argument at every level down) to the link written first in each further argument. */
static enum grrl_status read_relation(struct reader *reader, const struct grrl_term_node *node)
{
    const struct grrl_term_node *nodes = reader->store->nodes;
    if (node->kind != GRRL_TERM_REVOLUTE && node->kind != GRRL_TERM_PRISMATIC)
        return GRRL_OK;
    const struct grrl_term_node *from = &nodes[node->first_argument];
    while (from->first_argument != 0) {
        from = &nodes[from->first_argument];
        while (from->next_argument != 0)
            from = &nodes[from->next_argument];
    }
    grrl_term argument = nodes[node->first_argument].next_argument;
    for (; argument != 0; argument = nodes[argument].next_argument) {
        const struct grrl_term_node *to = &nodes[argument];
        while (to->first_argument != 0)
            to = &nodes[to->first_argument];
        enum grrl_status status =
            join(reader, from->name, to->name,
                 node->kind == GRRL_TERM_REVOLUTE ? GRRL_REVOLUTE : GRRL_PRISMATIC);
        if (status != GRRL_OK)
            return status;
    }
    return GRRL_OK;
}

enum grrl_status grrl_graph_from_term(const struct grrl_term_store *store, grrl_term term,
                                      struct grrl_graph *graph, struct grrl_name *names,
                                      struct grrl_edge *edges, uint8_t *n_edges,
                                      struct grrl_term_error *error)
{
    struct grrl_term_error unwanted;
    struct reader reader = {.store = store,
                            .graph = graph,
                            .names = names,
                            .edges = edges,
                            .error = error != NULL ? error : &unwanted};
    struct grrl_name no_name = {GRRL_NAME_NONE, 0};
    if (!grrl_term_valid(store, term))
        return reject(&reader, GRRL_ERR_ARGUMENT, no_name, "not a term of this store");
    if (store->nodes[term].kind == GRRL_TERM_ACTION)
        return reject(&reader, GRRL_ERR_STRUCTURE, no_name, "an action is not a structure");
    grrl_graph_clear(graph);
    struct grrl_walk walk;
    grrl_term_walk_begin(&walk, store, term);
    enum grrl_status status = GRRL_OK;
    while (status == GRRL_OK && grrl_term_walk_next(&walk)) {
        const struct grrl_term_node *node = grrl_walk_node(&walk);
        if (walk.entering && node->kind == GRRL_TERM_LINK)
            status = read_link(&reader, node);
        else if (!walk.entering)
            status = read_relation(&reader, node); /* after the joints nested in it */
    }
    if (n_edges != NULL)
        *n_edges = reader.n_edges;
    return status;
}

/* --- a graph as a term ------------------------------------------------------------------------ */

/* The term for one connected set of links written so far. */
struct piece {
    grrl_term term; /* 0: a single link not written yet */
    uint8_t first;  /* the links that appear first and last in the term */
    uint8_t last;
};

struct writer {
    struct grrl_term_store *store;
    const struct grrl_graph *graph;
    const struct grrl_name *names;
    uint32_t written;                 /* links that already appear in a term */
    uint8_t piece_of[GRRL_MAX_LINKS]; /* an index into pieces */
    struct piece pieces[GRRL_MAX_LINKS];
};

/* Writes a link in full the first time, and by its bare name afterwards. */
static enum grrl_status write_link(struct writer *writer, uint8_t vertex, grrl_term *term)
{
    grrl_property properties[GRRL_MAX_PROPERTIES] = {0};
    grrl_label label = grrl_label_masked(writer->graph->label[vertex], GRRL_ALL_PROPERTIES);
    uint8_t n = 0;
    if (label != GRRL_LABEL_BACKGROUND && (writer->written & grrl_bit(vertex)) == 0)
        for (n = 0; n < GRRL_MAX_PROPERTIES; n++)
            properties[n] = (grrl_property)(label >> (8 * n) & 0xffu);
    writer->written |= grrl_bit(vertex);
    return grrl_term_make_link(writer->store, writer->names[vertex], properties, n, term);
}

static enum grrl_status write_piece(struct writer *writer, struct piece *piece)
{
    return piece->term != 0 ? GRRL_OK : write_link(writer, piece->first, &piece->term);
}

static enum grrl_status make_pair(struct writer *writer, enum grrl_term_kind kind, grrl_term a,
                                  grrl_term b, grrl_term *term)
{
    const grrl_term arguments[2] = {a, b};
    return grrl_term_make(writer->store, kind, arguments, 2, term);
}

/* Whether one more relation around a piece, and the D around everything, stay within the depth. */
static bool may_nest(const struct writer *writer, const struct piece *piece)
{
    return piece->term == 0 || writer->store->nodes[piece->term].depth + 2 <= GRRL_MAX_TERM_DEPTH;
}

/* Makes kind(a, b) the piece *joined. */
static enum grrl_status nest(struct writer *writer, enum grrl_term_kind kind, struct piece a,
                             struct piece b, struct piece *joined)
{
    enum grrl_status status = write_piece(writer, &a);
    if (status == GRRL_OK)
        status = write_piece(writer, &b);
    joined->first = a.first;
    joined->last = b.last;
    return status != GRRL_OK ? status : make_pair(writer, kind, a.term, b.term, &joined->term);
}

/* The joint closes a loop within one piece. If one of the piece's ends is one of the two links, it
 * nests the piece and writes that end again; otherwise the joint goes beside the piece. */
static enum grrl_status close_loop(struct writer *writer, enum grrl_term_kind kind, uint8_t u,
                                   uint8_t v, struct piece *piece)
{
    struct piece again_u = {0, u, u};
    struct piece again_v = {0, v, v};
    struct piece old = *piece;
    if (may_nest(writer, piece)) {
        if (old.first == v)
            return nest(writer, kind, again_u, old, piece);
        if (old.first == u)
            return nest(writer, kind, again_v, old, piece);
        if (old.last == u)
            return nest(writer, kind, old, again_v, piece);
        if (old.last == v)
            return nest(writer, kind, old, again_u, piece);
    }
    struct piece joint;
    enum grrl_status status = nest(writer, kind, again_u, again_v, &joint);
    return status != GRRL_OK ? status : nest(writer, GRRL_TERM_AND, old, joint, piece);
}

/* The joint connects two pieces: a contains u and b contains v. */
static enum grrl_status connect(struct writer *writer, enum grrl_term_kind kind, uint8_t u,
                                uint8_t v, struct piece a, struct piece b, struct piece *joined)
{
    if (may_nest(writer, &a) && may_nest(writer, &b)) {
        if (a.last == u && b.first == v)
            return nest(writer, kind, a, b, joined);
        if (b.last == v && a.first == u)
            return nest(writer, kind, b, a, joined);
    }
    struct piece together =
        a.term != 0 ? a : b; /* a single link need not be written beside the joint */
    enum grrl_status status = GRRL_OK;
    if (a.term != 0 && b.term != 0)
        status = nest(writer, GRRL_TERM_AND, a, b, &together);
    struct piece again_u = {0, u, u};
    struct piece again_v = {0, v, v};
    struct piece joint;
    if (status == GRRL_OK)
        status = nest(writer, kind, again_u, again_v, &joint);
    return status != GRRL_OK ? status : nest(writer, GRRL_TERM_AND, together, joint, joined);
}

static enum grrl_status write_joint(struct writer *writer, const struct grrl_edge *edge)
{
    enum grrl_term_kind kind =
        edge->type == GRRL_REVOLUTE ? GRRL_TERM_REVOLUTE : GRRL_TERM_PRISMATIC;
    uint8_t a = writer->piece_of[edge->a];
    uint8_t b = writer->piece_of[edge->b];
    if (a == b)
        return close_loop(writer, kind, edge->a, edge->b, &writer->pieces[a]);
    struct piece joined = {0, 0, 0};
    enum grrl_status status =
        connect(writer, kind, edge->a, edge->b, writer->pieces[a], writer->pieces[b], &joined);
    uint8_t kept = a < b ? a : b;
    writer->pieces[kept] = joined;
    for (uint8_t i = 0; i < writer->graph->n; i++)
        if (writer->piece_of[i] == a || writer->piece_of[i] == b)
            writer->piece_of[i] = kept;
    return status;
}

/* Joins all pieces into one term; each piece is stored at the index of its smallest link. */
static enum grrl_status write_all(struct writer *writer, bool with_background, grrl_term *term)
{
    grrl_term arguments[GRRL_MAX_LINKS + 1];
    uint16_t n = 0;
    enum grrl_status status = GRRL_OK;
    if (with_background) {
        struct grrl_name background = {GRRL_NAME_BACKGROUND, 0};
        status = grrl_term_make_link(writer->store, background, NULL, 0, &arguments[n++]);
    }
    for (uint8_t i = 0; status == GRRL_OK && i < writer->graph->n; i++) {
        if (writer->piece_of[i] != i)
            continue;
        status = write_piece(writer, &writer->pieces[i]);
        arguments[n++] = writer->pieces[i].term;
    }
    if (status != GRRL_OK)
        return status;
    if (n > 1)
        return grrl_term_make(writer->store, GRRL_TERM_DISCONNECTED, arguments, n, term);
    *term = arguments[0];
    return GRRL_OK;
}

/* Whether the names are distinct, and the background has its label and a joint. */
static bool names_fit(const struct grrl_graph *graph, const struct grrl_name *names,
                      bool *has_background)
{
    *has_background = false;
    for (uint8_t i = 0; i < graph->n; i++) {
        bool background = names[i].kind == GRRL_NAME_BACKGROUND;
        if (background != (graph->label[i] == GRRL_LABEL_BACKGROUND) ||
            (background && grrl_graph_neighbours(graph, i) == 0))
            return false;
        *has_background = *has_background || background;
        for (uint8_t j = 0; j < i; j++)
            if (names[i].kind == names[j].kind && names[i].number == names[j].number)
                return false;
    }
    return true;
}

/* Whether the edges are exactly the joints of the graph, each once. */
static bool edges_fit(const struct grrl_graph *graph, const struct grrl_edge *edges,
                      uint8_t n_edges)
{
    if (n_edges != grrl_graph_joint_count(graph))
        return false;
    uint32_t seen[GRRL_MAX_LINKS] = {0};
    for (uint8_t i = 0; i < n_edges; i++) {
        uint8_t a = edges[i].a;
        uint8_t b = edges[i].b;
        if (a >= graph->n || b >= graph->n || grrl_graph_joint(graph, a, b) != edges[i].type ||
            (seen[a] & grrl_bit(b)) != 0)
            return false;
        seen[a] |= grrl_bit(b);
        seen[b] |= grrl_bit(a);
    }
    return true;
}

/* Picks where the next trail of joints begins: at a link on an earlier trail, so that a component
 * is finished first, else at an end of a new component. GRRL_MAX_LINKS when no joint is left. */
static uint8_t begin_trail(uint8_t n, const uint32_t *left, uint32_t on_trail)
{
    uint8_t best = GRRL_MAX_LINKS;
    unsigned fewest = GRRL_MAX_LINKS;
    for (uint8_t i = 0; i < n; i++) {
        unsigned joints = grrl_bit_count(left[i]);
        if (joints > 0 && (on_trail & grrl_bit(i)) != 0)
            return i;
        if (joints > 0 && joints < fewest) {
            best = i;
            fewest = joints;
        }
    }
    return best;
}

/*
 * Lists all joints as trails from link to link, which nest without a conjunction. The first trail
 * of a component grows at the front, R(l3, R(l2, l1)); a branch grows at the end, and its first
 * joint stands beside the rest.
 */
static uint8_t list_edges(const struct grrl_graph *graph, struct grrl_edge *edges)
{
    uint32_t left[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < graph->n; i++)
        left[i] = grrl_graph_neighbours(graph, i);
    uint32_t on_trail = 0;
    uint8_t n = 0;
    for (;;) {
        uint8_t at = begin_trail(graph->n, left, on_trail);
        if (at == GRRL_MAX_LINKS)
            return n;
        bool is_branch = (on_trail & grrl_bit(at)) != 0;
        on_trail |= grrl_bit(at);
        while (left[at] != 0) {
            uint8_t next = grrl_first_bit(left[at]);
            left[at] &= ~grrl_bit(next);
            left[next] &= ~grrl_bit(at);
            on_trail |= grrl_bit(next);
            edges[n].a = is_branch ? at : next;
            edges[n].b = is_branch ? next : at;
            edges[n++].type = (uint8_t)grrl_graph_joint(graph, at, next);
            at = next;
        }
    }
}

enum grrl_status grrl_graph_to_term(struct grrl_term_store *store, const struct grrl_graph *graph,
                                    const struct grrl_name *names, const struct grrl_edge *edges,
                                    uint8_t n_edges, bool with_background, grrl_term *term)
{
    bool has_background;
    if (!names_fit(graph, names, &has_background) ||
        grrl_graph_joint_count(graph) > GRRL_MAX_JOINTS ||
        (edges != NULL && !edges_fit(graph, edges, n_edges)))
        return GRRL_ERR_ARGUMENT;
    struct grrl_edge listed[GRRL_MAX_JOINTS];
    if (edges == NULL) {
        n_edges = list_edges(graph, listed);
        edges = listed;
    }
    struct writer writer = {.store = store, .graph = graph, .names = names};
    for (uint8_t i = 0; i < graph->n; i++) {
        writer.piece_of[i] = i;
        writer.pieces[i] = (struct piece){0, i, i};
    }
    uint16_t mark = grrl_term_mark(store);
    enum grrl_status status = GRRL_OK;
    for (uint8_t i = 0; status == GRRL_OK && i < n_edges; i++)
        status = write_joint(&writer, &edges[i]);
    if (status == GRRL_OK)
        status = write_all(&writer, (with_background && !has_background) || graph->n == 0, term);
    if (status != GRRL_OK)
        grrl_term_release(store, mark);
    return status;
}
