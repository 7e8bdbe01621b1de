/* Terms to graphs and back, refusals, and full stores. */
#include "support.h"

#include "grrl/structure/canonical.h"

enum { N_NODES = 12 * GRRL_MAX_LINKS + 8 * GRRL_MAX_JOINTS };

struct fixture {
    struct grrl_term_node nodes[N_NODES];
    struct grrl_term_store store;
};

static int setup(void **state)
{
    static struct fixture fixture;
    grrl_term_store_init(&fixture.store, fixture.nodes, N_NODES);
    *state = &fixture;
    return 0;
}

static struct grrl_term_store *store_of(void **state)
{
    return &((struct fixture *)*state)->store;
}

struct structure {
    struct grrl_graph graph;
    struct grrl_name names[GRRL_MAX_LINKS];
    struct grrl_edge edges[GRRL_MAX_JOINTS];
    uint8_t n_edges;
};

static struct structure read_structure(struct grrl_term_store *store, grrl_term term)
{
    struct structure s;
    struct grrl_term_error error;
    if (grrl_graph_from_term(store, term, &s.graph, s.names, s.edges, &s.n_edges, &error) !=
        GRRL_OK)
        fail_msg("%s", error.message);
    return s;
}

static uint8_t vertex_of(const struct structure *s, struct grrl_name name)
{
    for (uint8_t i = 0; i < s->graph.n; i++)
        if (s->names[i].kind == name.kind && s->names[i].number == name.number)
            return i;
    fail_msg("no link %u:%u", name.kind, name.number);
    return 0;
}

/* The same links by name, with the same labels and joints. */
static void assert_same(const struct structure *a, const struct structure *b)
{
    assert_int_equal(a->graph.n, b->graph.n);
    uint8_t order[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < a->graph.n; i++)
        order[i] = vertex_of(b, a->names[i]);
    struct grrl_graph permuted;
    grrl_graph_permute(&b->graph, order, &permuted);
    assert_true(grrl_graph_equal(&a->graph, &permuted, GRRL_ALL_PROPERTIES));
}

/* Texts that describe one structure, up to the names being the same. */
static void test_equivalent_terms(void **state)
{
    static const char *const cases[][2] = {
        {"D(lb, R(l1, l2))", "R(l2, l1)"},
        {"D(lb, R(l4, R(l3, P(l1, l2))))", "R(l4, l3) & R(l3, l1) & P(l1, l2)"},
        {"D(P(l4, R(R(l1, l2), l3)), lb)", "P(l4, l1) & R(l1, l2) & R(l2, l3)"},
        {"D(P(l4, R(R(l1, l2), l3)), lb)", "R(l3, R(l2, P(l1, l4)))"},
        {"D(lb, R(l1, R(l5, R(l4, R(l3, R(l2, l1))))))",
         "R(l1, l2) & R(l2, l3) & R(l3, l4) & R(l4, l5) & R(l5, l1)"},
        {"R(R(L(l, f1), L(s, f2)), L(l, f3))", "R(L(l, f3), R(L(s, f2), L(l, f1)))"},
        {"R(l1, l2, l3)", "R(l1, l2) & R(l1, l3)"},
        {"R(P(l1, l2), P(l3, l4), l5)", "P(l1, l2) & P(l3, l4) & R(l2, l3) & R(l2, l5)"},
        {"R(l1 & l2, l3 & l4)", "D(R(l2, l3), l1, l4)"},
        {"R(l1, L(s, red, l2)) & L(l, l1)", "R(L(l, l1), l2) & L(s, red, l2) & l2"},
        {"L(_, red, l1) & lb", "D(lb, L(_, red, l1))"},
        {"R(lb, l1)", "D(lb, R(l1, lb))"},
        {"D(lb, R(L(s, l), R(s, P)))", "R(l, s) & R(s, P) & L(s, l)"},
        {"R(R, L(l, R1)) & P(R1, lb)", "P(lb, R(L(l, R1), R))"},
        {"R(L(s, l1), l2) & L(s, l1)", "R(L(s, l1), l2)"},
    };
    struct grrl_term_store *store = store_of(state);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct structure a = read_structure(store, support_parse(store, cases[i][0]));
        struct structure b = read_structure(store, support_parse(store, cases[i][1]));
        assert_same(&a, &b);
        grrl_term_release(store, 1);
    }
}

static void test_contents(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct structure s = read_structure(
        store, support_parse(store, "D(lb, R(L(s, l4), R(L(l, wet, l3), P(l1, l2))))"));
    assert_int_equal(s.graph.n, 4);
    assert_int_equal(s.names[0].number, 4);
    assert_int_equal(s.graph.label[0], GRRL_PROPERTY_SMALL);
    assert_int_equal(s.graph.label[1], GRRL_PROPERTY_LARGE | 3u << 8);
    assert_int_equal(s.graph.label[2], 0);
    assert_int_equal(s.n_edges, 3);
    const struct grrl_edge expected[3] = {
        {2, 3, GRRL_PRISMATIC}, {1, 2, GRRL_REVOLUTE}, {0, 1, GRRL_REVOLUTE}};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(s.edges[i].a, expected[i].a);
        assert_int_equal(s.edges[i].b, expected[i].b);
        assert_int_equal(s.edges[i].type, expected[i].type);
    }
    struct structure background = read_structure(store, support_parse(store, "P(l1, lb)"));
    assert_int_equal(background.graph.n, 2);
    assert_int_equal(background.names[1].kind, GRRL_NAME_BACKGROUND);
    assert_true(background.graph.label[1] == GRRL_LABEL_BACKGROUND);
    assert_int_equal(read_structure(store, support_parse(store, "lb")).graph.n, 0);
}

static void test_rejected_terms(void **state)
{
    static const struct {
        const char *text;
        const char *message;
    } cases[] = {
        {"A(l1, 45)", "an action is not a structure"},
        {"L(v1, l1)", "link l1 has a variable as a property"},
        {"L(v0, l1)", "link l1 has a variable as a property"},
        {"R(l1, l1)", "link l1 is joined to itself"},
        {"R(blade1, tip, blade1)", "link blade1 is joined to itself"},
        {"R(blade1, R(tip, blade1))", "link blade1 is joined twice to tip"},
        {"R(L(s, tip), l2) & L(l, tip)", "link tip has two sets of properties"},
        {"R(l1, R(l2, l1))", "link l1 is joined twice to l2"},
        {"R(l1, R(l1, l2))", "link l1 is joined to itself"},
        {"R(l1, l2) & P(l2, l1)", "link l2 is joined twice to l1"},
        {"R(l1, l2, l2)", "link l1 is joined twice to l2"},
        {"R(L(s, l1), l2) & L(l, l1)", "link l1 has two sets of properties"},
        {"R(L(s, lb), l2)", "link lb is the background"},
        {"P(lb, lb)", "link lb is joined to itself"},
    };
    struct grrl_term_store *store = store_of(state);
    struct structure s;
    struct grrl_term_error error;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        grrl_term term = support_parse(store, cases[i].text);
        enum grrl_status status =
            grrl_graph_from_term(store, term, &s.graph, s.names, NULL, NULL, &error);
        assert_int_equal(status, GRRL_ERR_STRUCTURE);
        assert_non_null(strstr(error.message, cases[i].message));
        assert_int_equal(error.line, 0);
        assert_int_equal(grrl_graph_from_term(store, term, &s.graph, s.names, NULL, NULL, NULL),
                         status);
    }
    assert_int_equal(grrl_graph_from_term(store, 0, &s.graph, s.names, NULL, NULL, &error),
                     GRRL_ERR_ARGUMENT);
}

static void test_full(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    for (int i = 0; i < GRRL_MAX_LINKS; i++)
        assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
    assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_ERR_FULL);
    unsigned n_joints = 0;
    enum grrl_status status = GRRL_OK;
    for (uint8_t b = 0; b < GRRL_MAX_LINKS && status == GRRL_OK; b++) {
        for (uint8_t a = 0; a < b && status == GRRL_OK; a++) {
            status = grrl_graph_add_joint(&graph, a, b, GRRL_REVOLUTE);
            n_joints += status == GRRL_OK;
        }
    }
    assert_int_equal(status, GRRL_ERR_FULL);
    assert_int_equal(n_joints, GRRL_MAX_JOINTS);
    assert_int_equal(grrl_graph_joint_count(&graph), GRRL_MAX_JOINTS);

    grrl_term links[GRRL_MAX_LINKS + 1];
    for (uint16_t i = 0; i <= GRRL_MAX_LINKS; i++) {
        struct grrl_name name = {GRRL_NAME_FEATURES, i};
        assert_int_equal(grrl_term_make_link(store, name, NULL, 0, &links[i]), GRRL_OK);
    }
    grrl_term all;
    assert_int_equal(grrl_term_make(store, GRRL_TERM_AND, links, GRRL_MAX_LINKS + 1, &all),
                     GRRL_OK);
    struct structure s;
    struct grrl_term_error error;
    assert_int_equal(grrl_graph_from_term(store, all, &s.graph, s.names, NULL, NULL, &error),
                     GRRL_ERR_FULL);
    assert_non_null(strstr(error.message, "exceeds the maximum number of links"));
}

/* One link too many because a joint asks for the background, at either end, and one joint too many:
 * the message names the link. */
static void test_full_by_joints(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct structure s;
    struct grrl_term_error error;
    for (int end = 0; end < 2; end++) {
        grrl_term_release(store, 1);
        grrl_term parts[GRRL_MAX_LINKS + 1];
        for (uint16_t i = 0; i < GRRL_MAX_LINKS; i++) {
            struct grrl_name name = {GRRL_NAME_FEATURES, i};
            assert_int_equal(grrl_term_make_link(store, name, NULL, 0, &parts[i]), GRRL_OK);
        }
        parts[GRRL_MAX_LINKS] = support_parse(store, end == 0 ? "R(lb, f0)" : "R(f0, lb)");
        grrl_term all;
        assert_int_equal(grrl_term_make(store, GRRL_TERM_AND, parts, GRRL_MAX_LINKS + 1, &all),
                         GRRL_OK);
        assert_int_equal(grrl_graph_from_term(store, all, &s.graph, s.names, NULL, NULL, &error),
                         GRRL_ERR_FULL);
        assert_string_equal(error.message, "link lb exceeds the maximum number of links");
    }

    grrl_term_release(store, 1);
    grrl_term joints[GRRL_MAX_JOINTS + 1];
    uint16_t n = 0;
    for (uint16_t b = 0; b < GRRL_MAX_LINKS; b++) {
        for (uint16_t a = 0; a < b && n <= GRRL_MAX_JOINTS; a++) {
            grrl_term ends[2];
            struct grrl_name name_a = {GRRL_NAME_LINK, a};
            struct grrl_name name_b = {GRRL_NAME_LINK, b};
            assert_int_equal(grrl_term_make_link(store, name_a, NULL, 0, &ends[0]), GRRL_OK);
            assert_int_equal(grrl_term_make_link(store, name_b, NULL, 0, &ends[1]), GRRL_OK);
            assert_int_equal(grrl_term_make(store, GRRL_TERM_PRISMATIC, ends, 2, &joints[n++]),
                             GRRL_OK);
        }
    }
    grrl_term all;
    assert_int_equal(grrl_term_make(store, GRRL_TERM_AND, joints, n, &all), GRRL_OK);
    assert_int_equal(grrl_graph_from_term(store, all, &s.graph, s.names, NULL, NULL, &error),
                     GRRL_ERR_FULL);
    assert_non_null(strstr(error.message, "exceeds the maximum number of joints"));
    assert_int_equal(grrl_graph_joint_count(&s.graph), GRRL_MAX_JOINTS);
}

/* A graph as a term in a store that is too small by any number of nodes: it stays as it was. */
static void test_small_stores(void **state)
{
    static const char *const cases[] = {
        "R(l1, l2) & P(l3, l4) & R(l1, l3)",
        "R(L(s, l1), L(l, l2)) & R(L(s, l3), l4) & P(l2, l5) & R(l4, l2)",
        "R(l1, l2) & R(l2, l3) & R(l3, l4) & R(l4, l2)",
        "R(l1, l2, l3, l4)",
        "R(l1, l2) & R(l2, l3) & R(l3, l1) & P(l4, l2) & P(l4, l3)",
        "D(l1, L(s, l2), R(l3, l4))",
        "R(lb, l1, l2)",
    };
    struct grrl_term_store *store = store_of(state);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        grrl_term_release(store, 1);
        struct structure s = read_structure(store, support_parse(store, cases[i]));
        uint16_t wanted = 0;
        for (uint16_t capacity = 2; wanted == 0; capacity++) {
            struct grrl_term_node nodes[64];
            struct grrl_term_store small;
            assert_true(capacity <= 64);
            grrl_term_store_init(&small, nodes, capacity);
            grrl_term term;
            enum grrl_status status =
                grrl_graph_to_term(&small, &s.graph, s.names, s.edges, s.n_edges, true, &term);
            if (status == GRRL_OK) {
                wanted = capacity;
                struct structure again = read_structure(&small, term);
                assert_same(&s, &again);
            } else {
                assert_int_equal(status, GRRL_ERR_FULL);
                assert_int_equal(grrl_term_mark(&small), 1);
                assert_int_equal(small.high_water, capacity);
            }
        }
        assert_true(wanted > s.graph.n);
    }
}

/* A chain or loop becomes one nested relation, as deep as it has joints. */
static void test_chains_and_loops_nest(void **state)
{
    (void)state;
    static struct grrl_term_node nodes[1024];
    struct grrl_term_store store;
    for (int closed = 0; closed < 2; closed++) {
        for (uint8_t n = 3; n <= GRRL_MAX_LINKS; n++) {
            grrl_term_store_init(&store, nodes, 1024);
            struct structure s = {.n_edges = 0};
            for (uint8_t i = 0; i < n; i++) {
                assert_int_equal(grrl_graph_add_link(&s.graph, 0, NULL), GRRL_OK);
                s.names[i] = (struct grrl_name){GRRL_NAME_LINK, i};
            }
            for (uint8_t i = 0; i < n - !closed; i++) {
                uint8_t next = (uint8_t)((i + 1) % n);
                s.edges[s.n_edges++] = (struct grrl_edge){i, next, GRRL_REVOLUTE};
                assert_int_equal(grrl_graph_add_joint(&s.graph, i, next, GRRL_REVOLUTE), GRRL_OK);
            }
            grrl_term term;
            assert_int_equal(
                grrl_graph_to_term(&store, &s.graph, s.names, s.edges, s.n_edges, true, &term),
                GRRL_OK);
            struct structure again = read_structure(&store, term);
            assert_same(&s, &again);
            unsigned depth = grrl_term_node_at(&store, term)->depth;
            unsigned joints = s.n_edges + 1u; /* and the D around them */
            assert_int_equal(depth, joints < GRRL_MAX_TERM_DEPTH ? joints : GRRL_MAX_TERM_DEPTH);
        }
    }
}

static void test_joints(void **state)
{
    (void)state;
    struct grrl_graph graph;
    grrl_graph_clear(&graph);
    for (int i = 0; i < 5 && i < GRRL_MAX_LINKS; i++)
        assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
    assert_int_equal(grrl_graph_add_joint(&graph, 0, 1, GRRL_REVOLUTE), GRRL_OK);
    assert_int_equal(grrl_graph_add_joint(&graph, 3, 1, GRRL_PRISMATIC), GRRL_OK);
    assert_int_equal(grrl_graph_add_joint(&graph, 1, 3, GRRL_REVOLUTE), GRRL_ERR_STRUCTURE);
    assert_int_equal(grrl_graph_add_joint(&graph, 2, 2, GRRL_REVOLUTE), GRRL_ERR_STRUCTURE);
    assert_int_equal(grrl_graph_add_joint(&graph, 2, 5, GRRL_REVOLUTE), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_graph_add_joint(&graph, 5, 2, GRRL_REVOLUTE), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_graph_add_joint(&graph, 0, 2, (enum grrl_joint_type)GRRL_JOINT_TYPES),
                     GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_graph_joint(&graph, 1, 0), GRRL_REVOLUTE);
    assert_int_equal(grrl_graph_joint(&graph, 1, 3), GRRL_PRISMATIC);
    assert_int_equal(grrl_graph_joint(&graph, 0, 3), GRRL_NO_JOINT);
    assert_int_equal(grrl_graph_neighbours(&graph, 1), 1u << 0 | 1u << 3);
    assert_int_equal(grrl_graph_component(&graph, 3), 1u << 0 | 1u << 1 | 1u << 3);
    assert_int_equal(grrl_graph_component(&graph, 4), 1u << 4);
    struct grrl_graph relabelled = graph;
    relabelled.label[2] = GRRL_PROPERTY_SMALL;
    assert_false(grrl_graph_equal(&graph, &relabelled, GRRL_ALL_PROPERTIES));
    assert_true(grrl_graph_equal(&graph, &relabelled, 0xff00));
    relabelled.label[2] = GRRL_LABEL_BACKGROUND;
    assert_false(grrl_graph_equal(&graph, &relabelled, GRRL_NO_PROPERTIES));
}

/* Joints as (link number, link number, type) in order of discovery, and the term they give. */
static void test_order_of_discovery(void **state)
{
    static const struct {
        uint8_t joints[8][3];
        uint8_t n_joints;
        uint8_t n_links;
        bool with_background;
        const char *expected;
    } cases[] = {
        {{{1, 2, 1}, {3, 1, 0}, {4, 3, 0}}, 3, 4, true, "D(lb, R(l4, R(l3, P(l1, l2))))"},
        {{{2, 1, 0}, {3, 2, 0}, {4, 3, 0}, {5, 4, 0}, {1, 5, 0}},
         5,
         5,
         false,
         "R(l1, R(l5, R(l4, R(l3, R(l2, l1)))))"},
        {{{2, 1, 0}, {3, 2, 0}, {4, 3, 0}, {5, 4, 0}, {5, 1, 0}},
         5,
         5,
         true,
         "D(lb, R(l1, R(l5, R(l4, R(l3, R(l2, l1))))))"},
        {{{1, 2, 0}, {2, 3, 0}}, 2, 3, false, "R(R(l1, l2), l3)"},
        {{{1, 2, 0}, {1, 3, 0}}, 2, 3, false, "R(l3, R(l1, l2))"},
        {{{1, 2, 0}, {3, 4, 1}, {2, 3, 0}}, 3, 4, false, "R(R(l1, l2), P(l3, l4))"},
        {{{1, 2, 0}, {3, 4, 1}, {4, 1, 0}}, 3, 4, false, "R(P(l3, l4), R(l1, l2))"},
        {{{1, 2, 0}, {3, 4, 1}, {1, 3, 0}}, 3, 4, false, "R(l1, l2) & P(l3, l4) & R(l1, l3)"},
        {{{1, 2, 0}, {2, 3, 0}, {2, 4, 1}}, 3, 4, false, "R(R(l1, l2), l3) & P(l2, l4)"},
        {{{1, 2, 0}, {2, 3, 0}, {3, 1, 0}}, 3, 3, false, "R(l3, R(R(l1, l2), l3))"},
        {{{1, 2, 0}}, 1, 4, true, "D(lb, R(l1, l2), l3, l4)"},
        {{{4, 3, 0}, {1, 2, 0}}, 2, 4, false, "D(R(l1, l2), R(l4, l3))"},
        {{{0}}, 0, 1, false, "l1"},
        {{{0}}, 0, 0, false, "lb"},
        {{{0}}, 0, 0, true, "lb"},
    };
    struct grrl_term_store *store = store_of(state);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct grrl_graph graph;
        struct grrl_name names[8];
        struct grrl_edge edges[8];
        grrl_graph_clear(&graph);
        for (uint8_t k = 0; k < cases[i].n_links; k++) {
            assert_int_equal(grrl_graph_add_link(&graph, 0, NULL), GRRL_OK);
            names[k] = (struct grrl_name){GRRL_NAME_LINK, (uint16_t)(k + 1)};
        }
        for (uint8_t k = 0; k < cases[i].n_joints; k++) {
            const uint8_t *joint = cases[i].joints[k];
            edges[k] =
                (struct grrl_edge){(uint8_t)(joint[0] - 1), (uint8_t)(joint[1] - 1), joint[2]};
            assert_int_equal(grrl_graph_add_joint(&graph, edges[k].a, edges[k].b,
                                                  (enum grrl_joint_type)edges[k].type),
                             GRRL_OK);
        }
        grrl_term term;
        assert_int_equal(grrl_graph_to_term(store, &graph, names, edges, cases[i].n_joints,
                                            cases[i].with_background, &term),
                         GRRL_OK);
        support_assert_prints(store, term, cases[i].expected);
        grrl_term_release(store, 1);
    }
}

/* Names that are identifiers keep their vertices, and neither they nor how many there are change
 * the labels and the canonical form. */
static void test_identifiers(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct structure plain =
        read_structure(store, support_parse(store, "R(l1, P(L(s, wet, l2), L(red, l3)))"));
    grrl_term_store_init(store, ((struct fixture *)*state)->nodes, N_NODES);
    struct structure named =
        read_structure(store, support_parse(store, "R(wet, P(L(s, wet, red), L(red, Tip)))"));
    assert_true(grrl_graph_equal(&plain.graph, &named.graph, GRRL_ALL_PROPERTIES));
    struct grrl_canonical a;
    struct grrl_canonical b;
    assert_int_equal(grrl_canonical_of(&plain.graph, GRRL_ALL_PROPERTIES, 10000, &a), GRRL_OK);
    assert_int_equal(grrl_canonical_of(&named.graph, GRRL_ALL_PROPERTIES, 10000, &b), GRRL_OK);
    assert_int_equal(a.hash, b.hash);
    static const char *const words[] = {"wet", "red", "Tip"};
    for (uint8_t i = 0; i < 3; i++) {
        char text[GRRL_NAME_BYTES];
        assert_int_equal(named.names[i].kind, GRRL_NAME_SYMBOL);
        assert_string_equal(grrl_term_name_text(store, named.names[i], text), words[i]);
    }
    grrl_term term;
    assert_int_equal(grrl_graph_to_term(store, &named.graph, named.names, named.edges,
                                        named.n_edges, true, &term),
                     GRRL_OK);
    support_assert_prints(store, term, "D(lb, R(wet, P(L(s, wet, red), L(red, Tip))))");
    named.names[2].number = 4; /* not known to the store */
    assert_int_equal(grrl_graph_to_term(store, &named.graph, named.names, named.edges,
                                        named.n_edges, true, &term),
                     GRRL_ERR_ARGUMENT);
}

/* Without an order of discovery a chain or loop becomes one nested relation. */
static void test_own_order(void **state)
{
    static const char *const cases[][2] = {
        {"R(l3, l1) & P(l1, l4) & R(l2, l4)", "R(l2, P(l4, R(l1, l3)))"},
        {"R(l1, l2) & R(l3, l4) & R(l2, l3) & P(l4, l1)", "P(l1, R(l4, R(l3, R(l2, l1))))"},
        {"R(l1, l2) & R(l2, l3) & R(l3, l4) & R(l4, l2)", "R(l2, R(l4, R(l3, R(l2, l1))))"},
        {"R(l1, l2, l3, l4)", "R(l3, R(l1, l2)) & R(l1, l4)"},
        {"R(l1, l2, P(l3, l4)) & D(l5, l6)", "D(P(l4, R(l3, R(l1, l2))), l5, l6)"},
        /* a link has its properties once */
        {"R(L(s, l1), L(l, l2)) & R(l2, l3) & R(l3, l1)", "R(l1, R(l3, R(L(l, l2), L(s, l1))))"},
        {"R(L(s, l1), l2, l3, l4)", "R(l3, R(L(s, l1), l2)) & R(l1, l4)"},
    };
    struct grrl_term_store *store = store_of(state);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct structure s = read_structure(store, support_parse(store, cases[i][0]));
        grrl_term term;
        assert_int_equal(grrl_graph_to_term(store, &s.graph, s.names, NULL, 0, false, &term),
                         GRRL_OK);
        support_assert_prints(store, term, cases[i][1]);
        grrl_term_release(store, 1);
    }
}

static void test_to_term_checks(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct structure s = read_structure(store, support_parse(store, "R(L(s, l1), P(l2, l3))"));
    grrl_term_release(store, 1);
    grrl_term term;
    struct structure bad = s;
    bad.edges[1] = bad.edges[0];
    assert_int_equal(grrl_graph_to_term(store, &bad.graph, bad.names, bad.edges, 2, true, &term),
                     GRRL_ERR_ARGUMENT);
    bad = s;
    assert_int_equal(grrl_graph_to_term(store, &bad.graph, bad.names, bad.edges, 1, true, &term),
                     GRRL_ERR_ARGUMENT);
    bad.edges[0].type ^= 1u;
    assert_int_equal(grrl_graph_to_term(store, &bad.graph, bad.names, bad.edges, 2, true, &term),
                     GRRL_ERR_ARGUMENT);
    for (int end = 0; end < 2; end++) {
        bad = s;
        *(end == 0 ? &bad.edges[1].a : &bad.edges[1].b) = bad.graph.n;
        assert_int_equal(
            grrl_graph_to_term(store, &bad.graph, bad.names, bad.edges, 2, true, &term),
            GRRL_ERR_ARGUMENT);
    }
    bad = s;
    bad.names[1] = bad.names[0];
    assert_int_equal(grrl_graph_to_term(store, &bad.graph, bad.names, NULL, 0, true, &term),
                     GRRL_ERR_ARGUMENT);
    bad = s;
    bad.names[0] = (struct grrl_name){GRRL_NAME_BACKGROUND, 0};
    assert_int_equal(grrl_graph_to_term(store, &bad.graph, bad.names, NULL, 0, true, &term),
                     GRRL_ERR_ARGUMENT);
    bad.graph.label[0] = GRRL_LABEL_BACKGROUND;
    bad.names[0] = (struct grrl_name){GRRL_NAME_BACKGROUND, 0};
    assert_int_equal(grrl_graph_to_term(store, &bad.graph, bad.names, NULL, 0, true, &term),
                     GRRL_OK);
    grrl_term_release(store, 1);
    struct grrl_graph alone; /* the background without a joint */
    grrl_graph_clear(&alone);
    assert_int_equal(grrl_graph_add_link(&alone, GRRL_LABEL_BACKGROUND, NULL), GRRL_OK);
    assert_int_equal(grrl_graph_to_term(store, &alone, bad.names, NULL, 0, true, &term),
                     GRRL_ERR_ARGUMENT);
    struct grrl_graph crowded; /* more joints than grrl_graph_add_joint allows */
    grrl_graph_clear(&crowded);
    struct grrl_name names[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < GRRL_MAX_LINKS; i++) {
        assert_int_equal(grrl_graph_add_link(&crowded, 0, NULL), GRRL_OK);
        names[i] = (struct grrl_name){GRRL_NAME_LINK, i};
    }
    for (unsigned i = 0; i < GRRL_MAX_LINKS; i++)
        crowded.joined[GRRL_REVOLUTE][i] =
            (uint32_t)((UINT64_C(1) << GRRL_MAX_LINKS) - 1u) & ~(UINT32_C(1) << i);
    assert_int_equal(grrl_graph_to_term(store, &crowded, names, NULL, 0, true, &term),
                     GRRL_ERR_ARGUMENT);
    bad = s;
    bad.graph.label[0] = 100;
    assert_int_equal(grrl_graph_to_term(store, &bad.graph, bad.names, NULL, 0, true, &term),
                     GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_mark(store), 1);

    /* D(lb, R(P(l2, l3), l1)): seven nodes, and node 0 */
    struct grrl_term_node nodes[8];
    struct grrl_term_store small;
    for (uint16_t capacity = 2; capacity <= 8; capacity++) {
        grrl_term_store_init(&small, nodes, capacity);
        enum grrl_status status =
            grrl_graph_to_term(&small, &s.graph, s.names, s.edges, s.n_edges, true, &term);
        assert_int_equal(status, capacity < 8 ? GRRL_ERR_FULL : GRRL_OK);
        assert_int_equal(grrl_term_mark(&small), capacity < 8 ? 1 : 8);
    }
}

/* A name for link k that no other k has: f3 or Link_3. */
static struct grrl_name random_name(struct grrl_term_store *store, struct grrl_random *random,
                                    uint8_t k)
{
    struct grrl_name name = {GRRL_NAME_FEATURES, k};
    char word[GRRL_SYMBOL_BYTES];
    int length = snprintf(word, sizeof word, "Link_%u", (unsigned)k);
    if (grrl_random_below(random, 2) == 0)
        assert_int_equal(grrl_term_intern_name(store, word, (size_t)length, &name), GRRL_OK);
    return name;
}

/* Every structure survives being written as a term and read again, and its first joint is the most
 * deeply nested one as long as the term has no conjunction. */
static void test_random_round_trips(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct grrl_random random = support_random("round trips");
    unsigned n_nested = 0;
    for (int i = 0; i < 20000; i++) {
        grrl_term_release(store, 1);
        uint8_t n = (uint8_t)grrl_random_below(&random, GRRL_MAX_LINKS + 1);
        struct structure s = {.n_edges = 0};
        s.graph = support_graph(&random, n, 1 + grrl_random_below(&random, 8),
                                n > 1 ? grrl_random_below(&random, GRRL_MAX_JOINTS - n) : 0,
                                GRRL_BUILT_IN_ATOMS);
        for (uint8_t k = 0; k < n; k++)
            s.names[k] = random_name(store, &random, k);
        for (uint8_t b = 0; b < n; b++)
            for (uint8_t a = 0; a < b; a++)
                if (grrl_graph_joint(&s.graph, a, b) != GRRL_NO_JOINT)
                    s.edges[s.n_edges++] =
                        (struct grrl_edge){a, b, (uint8_t)grrl_graph_joint(&s.graph, a, b)};
        uint8_t order[GRRL_MAX_JOINTS];
        support_shuffle(&random, order, s.n_edges);
        struct grrl_edge edges[GRRL_MAX_JOINTS];
        for (uint8_t k = 0; k < s.n_edges; k++)
            edges[k] = s.edges[order[k]];
        if (n > 0 && grrl_random_below(&random, 4) == 0) {
            uint8_t k = (uint8_t)grrl_random_below(&random, n);
            if (grrl_graph_neighbours(&s.graph, k) != 0) {
                s.graph.label[k] = GRRL_LABEL_BACKGROUND;
                s.names[k] = (struct grrl_name){GRRL_NAME_BACKGROUND, 0};
            }
        }
        grrl_term term;
        assert_int_equal(grrl_graph_to_term(store, &s.graph, s.names,
                                            grrl_random_below(&random, 8) ? edges : NULL, s.n_edges,
                                            grrl_random_below(&random, 2), &term),
                         GRRL_OK);
        assert_true(grrl_term_mark(store) <= 2 * n + 4 * s.n_edges + 2 + 1);
        struct structure again = read_structure(store, term);
        assert_same(&s, &again);
        static char text[32 * N_NODES];
        assert_int_equal(grrl_term_print(store, term, sizeof text, text, NULL), GRRL_OK);
        struct structure parsed = read_structure(store, support_parse(store, text));
        assert_same(&s, &parsed);
        n_nested += strchr(text, '&') == NULL && s.n_edges > 2;
    }
    assert_true(n_nested > 100);
}

/* A chain discovered from one end outwards gives its joints back in that order. */
static void test_discovery_survives(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct grrl_random random = support_random("discovery");
    for (int i = 0; i < 500; i++) {
        grrl_term_release(store, 1);
        struct structure s = {.n_edges = 0};
        grrl_graph_clear(&s.graph);
        uint8_t ends[2] = {0, 0};
        uint8_t n = (uint8_t)(2 + grrl_random_below(&random, GRRL_MAX_LINKS - 1));
        for (uint8_t k = 0; k < n; k++) {
            assert_int_equal(grrl_graph_add_link(&s.graph, 0, NULL), GRRL_OK);
            s.names[k] = (struct grrl_name){GRRL_NAME_LINK, k};
            if (k == 0)
                continue;
            uint8_t *end = &ends[grrl_random_below(&random, 2)];
            s.edges[s.n_edges++] = (struct grrl_edge){*end, k, GRRL_REVOLUTE};
            assert_int_equal(grrl_graph_add_joint(&s.graph, *end, k, GRRL_REVOLUTE), GRRL_OK);
            *end = k;
        }
        grrl_term term;
        assert_int_equal(
            grrl_graph_to_term(store, &s.graph, s.names, s.edges, s.n_edges, true, &term), GRRL_OK);
        struct structure again = read_structure(store, term);
        assert_int_equal(again.n_edges, s.n_edges);
        for (uint8_t k = 0; k < s.n_edges; k++) {
            uint16_t a = again.names[again.edges[k].a].number;
            uint16_t b = again.names[again.edges[k].b].number;
            assert_true((a == s.edges[k].a && b == s.edges[k].b) ||
                        (a == s.edges[k].b && b == s.edges[k].a));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_equivalent_terms, setup),
        cmocka_unit_test_setup(test_contents, setup),
        cmocka_unit_test_setup(test_rejected_terms, setup),
        cmocka_unit_test_setup(test_full, setup),
        cmocka_unit_test_setup(test_full_by_joints, setup),
        cmocka_unit_test_setup(test_small_stores, setup),
        cmocka_unit_test_setup(test_chains_and_loops_nest, setup),
        cmocka_unit_test_setup(test_joints, setup),
        cmocka_unit_test_setup(test_order_of_discovery, setup),
        cmocka_unit_test_setup(test_identifiers, setup),
        cmocka_unit_test_setup(test_own_order, setup),
        cmocka_unit_test_setup(test_to_term_checks, setup),
        cmocka_unit_test_setup(test_random_round_trips, setup),
        cmocka_unit_test_setup(test_discovery_survives, setup),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
