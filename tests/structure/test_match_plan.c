/* Plans of graphs: colours, counts and order, against the definitions of these. */
#include "structure/match_private.h"
#include "support.h"

enum { ROUNDS = 4 }; /* of colour refinement */

static struct grrl_graph random_graph(struct grrl_random *random)
{
    uint8_t n = (uint8_t)grrl_random_below(random, GRRL_MAX_LINKS + 1);
    uint32_t loops = n > 1 ? grrl_random_below(random, 6) : 0;
    return support_graph(random, n, 4 + grrl_random_below(random, 5), loops,
                         grrl_random_below(random, 3));
}

static bool is_joined(const struct grrl_graph *graph, uint8_t a, uint8_t b)
{
    return a != b && grrl_graph_joint(graph, a, b) != GRRL_NO_JOINT;
}

static unsigned joints_at(const struct grrl_graph *graph, uint8_t link, int type)
{
    unsigned n = 0;
    for (uint8_t i = 0; i < graph->n; i++)
        n += i != link && grrl_graph_joint(graph, link, i) == type;
    return n;
}

/* Whether two vertices have as many neighbours of each class by each type of joint. */
static bool same_neighbours(const struct grrl_graph *graph, const uint8_t *class, uint8_t a,
                            uint8_t b)
{
    for (uint8_t c = 0; c < graph->n; c++) {
        for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
            int difference = 0;
            for (uint8_t i = 0; i < graph->n; i++) {
                if (class[i] != c)
                    continue;
                difference += i != a && grrl_graph_joint(graph, a, i) == type;
                difference -= i != b && grrl_graph_joint(graph, b, i) == type;
            }
            if (difference != 0)
                return false;
        }
    }
    return true;
}

/* Classes by label and degrees, then by the classes of the neighbours, some times; a class is named
 * by its first vertex. */
static void naive_classes(const struct grrl_graph *graph, grrl_label mask, uint8_t *class)
{
    for (uint8_t i = 0; i < graph->n; i++) {
        uint8_t j = 0;
        while (grrl_label_masked(graph->label[i], mask) !=
                   grrl_label_masked(graph->label[j], mask) ||
               joints_at(graph, i, GRRL_REVOLUTE) != joints_at(graph, j, GRRL_REVOLUTE) ||
               joints_at(graph, i, GRRL_PRISMATIC) != joints_at(graph, j, GRRL_PRISMATIC))
            j++;
        class[i] = j;
    }
    for (int round = 0; round < ROUNDS; round++) {
        uint8_t finer[GRRL_MAX_LINKS];
        for (uint8_t i = 0; i < graph->n; i++) {
            uint8_t j = 0;
            while (class[i] != class[j] || !same_neighbours(graph, class, i, j))
                j++;
            finer[i] = j;
        }
        memcpy(class, finer, graph->n);
    }
}

static void test_colours(void **state)
{
    (void)state;
    struct grrl_random random = support_random("colours");
    for (int i = 0; i < 1500; i++) {
        struct grrl_graph graph = random_graph(&random);
        grrl_label mask = grrl_random_below(&random, 2) ? GRRL_ALL_PROPERTIES : GRRL_NO_PROPERTIES;
        struct grrl_match_plan plan;
        uint8_t class[GRRL_MAX_LINKS];
        grrl_match_plan_of(&plan, &graph, mask);
        naive_classes(&graph, mask, class);
        uint32_t in_cells = 0;
        for (uint8_t a = 0; a < graph.n; a++) {
            assert_true(plan.label[a] == grrl_label_masked(graph.label[a], mask));
            for (uint8_t b = 0; b < graph.n; b++) {
                assert_int_equal(plan.rank[a] == plan.rank[b], class[a] == class[b]);
                assert_int_equal((plan.cell[plan.rank[a]] >> b & 1u) != 0, class[a] == class[b]);
                if (plan.rank[a] < plan.rank[b])
                    assert_true(plan.colour[a] < plan.colour[b]);
            }
            in_cells |= plan.cell[a];
        }
        assert_int_equal(in_cells, grrl_bits_below(graph.n));
    }
}

/* The same plan, but for the names of the vertices, for each order of them; another for another
 * structure. */
static void test_hash(void **state)
{
    (void)state;
    struct grrl_random random = support_random("hash");
    unsigned n_joined = 0;
    for (int i = 0; i < 1000; i++) {
        struct grrl_graph graph = random_graph(&random);
        uint8_t order[GRRL_MAX_LINKS];
        struct grrl_graph other = support_relabel(&random, &graph, order);
        struct grrl_match_plan plans[2];
        grrl_match_plan_of(&plans[0], &graph, GRRL_ALL_PROPERTIES);
        grrl_match_plan_of(&plans[1], &other, GRRL_ALL_PROPERTIES);
        assert_int_equal(plans[0].hash, plans[1].hash);
        for (uint8_t k = 0; k < graph.n; k++)
            assert_int_equal(plans[1].rank[k], plans[0].rank[order[k]]);
        if (graph.n < 2 || is_joined(&other, 0, 1) || grrl_graph_joint_count(&other) == 0)
            continue;
        assert_int_equal(grrl_graph_add_joint(&other, 0, 1, GRRL_REVOLUTE), GRRL_OK);
        grrl_match_plan_of(&plans[1], &other, GRRL_ALL_PROPERTIES);
        assert_int_not_equal(plans[0].hash, plans[1].hash);
        n_joined++;
    }
    assert_true(n_joined > 100);
}

/* Joints by type, links within two joints, the most joints of a neighbour. */
static void test_growing_counts(void **state)
{
    (void)state;
    struct grrl_random random = support_random("growing counts");
    for (int i = 0; i < 1500; i++) {
        struct grrl_graph graph = random_graph(&random);
        struct grrl_match_plan plan;
        unsigned joints[GRRL_JOINT_TYPES] = {0};
        grrl_match_plan_of(&plan, &graph, GRRL_ALL_PROPERTIES);
        for (uint8_t v = 0; v < graph.n; v++) {
            unsigned within = 0;
            unsigned most = 0;
            for (uint8_t w = 0; w < graph.n; w++) {
                bool near = w == v || is_joined(&graph, v, w);
                for (uint8_t u = 0; u < graph.n; u++)
                    near = near || (is_joined(&graph, v, u) && is_joined(&graph, u, w));
                within += near;
                unsigned degree =
                    joints_at(&graph, w, GRRL_REVOLUTE) + joints_at(&graph, w, GRRL_PRISMATIC);
                if (is_joined(&graph, v, w) && degree > most)
                    most = degree;
            }
            unsigned r = joints_at(&graph, v, GRRL_REVOLUTE);
            unsigned p = joints_at(&graph, v, GRRL_PRISMATIC);
            assert_int_equal(plan.growing[v], r | p << 8 | within << 16 | most << 24);
            joints[GRRL_REVOLUTE] += r;
            joints[GRRL_PRISMATIC] += p;
        }
        for (int type = 0; type < GRRL_JOINT_TYPES; type++)
            assert_int_equal(plan.joints[type], joints[type] / 2);
    }
}

static void test_degrees(void **state)
{
    (void)state;
    struct grrl_random random = support_random("degrees");
    for (int i = 0; i < 500; i++) {
        struct grrl_graph graph = random_graph(&random);
        struct grrl_match_plan plan;
        grrl_match_plan_of(&plan, &graph, GRRL_ALL_PROPERTIES);
        for (unsigned k = 0; k < GRRL_MATCH_DEGREES; k++) {
            uint32_t expected = 0;
            for (uint8_t v = 0; v < graph.n; v++)
                expected |= (uint32_t)(joints_at(&graph, v, GRRL_REVOLUTE) >= k / 4 &&
                                       joints_at(&graph, v, GRRL_PRISMATIC) >= k % 4)
                            << v;
            assert_int_equal(plan.at_least[k], expected);
        }
    }
}

/* Each vertex once, with what the search wants to know of its earlier neighbours. */
static void assert_steps(const struct grrl_graph *graph, const struct grrl_match_step *steps)
{
    uint32_t earlier = 0;
    for (uint8_t depth = 0; depth < graph->n; depth++) {
        const struct grrl_match_step *step = &steps[depth];
        assert_true(step->vertex < graph->n && (earlier >> step->vertex & 1u) == 0);
        uint8_t parent = GRRL_UNMAPPED; /* of the earlier neighbours, the one placed first */
        uint32_t back = 0;
        for (uint8_t k = depth; k-- > 0;) {
            if (is_joined(graph, step->vertex, steps[k].vertex)) {
                parent = steps[k].vertex;
                back |= UINT32_C(1) << parent;
            }
        }
        assert_int_equal(step->parent, parent);
        assert_int_equal(step->ties, back == 0 ? 0 : back & ~(UINT32_C(1) << parent));
        if (parent != GRRL_UNMAPPED)
            assert_int_equal(step->type, grrl_graph_joint(graph, step->vertex, parent));
        earlier |= UINT32_C(1) << step->vertex;
    }
}

static unsigned earlier_neighbours(const struct grrl_graph *graph, uint32_t earlier, uint8_t vertex)
{
    unsigned n = 0;
    for (uint8_t i = 0; i < graph->n; i++)
        n += (earlier >> i & 1u) != 0 && is_joined(graph, vertex, i);
    return n;
}

/* What comes first, the smallest number: two or more earlier neighbours, one, none; then the rarest
 * colour, the most joints, the first vertex. */
static uint32_t naive_score(const struct grrl_graph *graph, const struct grrl_match_plan *plan,
                            uint32_t earlier, uint8_t vertex)
{
    unsigned n_back = earlier_neighbours(graph, earlier, vertex);
    unsigned n_alike = 0;
    unsigned n_joints = 0;
    for (uint8_t i = 0; i < graph->n; i++) {
        n_alike += plan->rank[i] == plan->rank[vertex];
        n_joints += is_joined(graph, vertex, i);
    }
    return (n_back < 2 ? 2 - n_back : 0) << 24 | n_alike << 16 | (32 - n_joints) << 8 | vertex;
}

static void test_order(void **state)
{
    (void)state;
    struct grrl_random random = support_random("order");
    for (int i = 0; i < 1500; i++) {
        struct grrl_graph graph = random_graph(&random);
        struct grrl_match_plan plan;
        grrl_match_plan_of(&plan, &graph, GRRL_ALL_PROPERTIES);
        assert_steps(&graph, plan.step);
        uint32_t earlier = 0;
        for (uint8_t depth = 0; depth < graph.n; depth++) {
            uint32_t best = UINT32_MAX;
            for (uint8_t v = 0; v < graph.n; v++) {
                uint32_t score = naive_score(&graph, &plan, earlier, v);
                if ((earlier >> v & 1u) == 0 && score < best)
                    best = score;
            }
            assert_int_equal(plan.step[depth].vertex, best & 0xffu);
            earlier |= UINT32_C(1) << plan.step[depth].vertex;
        }
    }
}

/* From any vertex outwards, each component from its first vertex. */
static void test_order_from(void **state)
{
    (void)state;
    struct grrl_random random = support_random("order from");
    for (int i = 0; i < 1500; i++) {
        struct grrl_graph graph = random_graph(&random);
        if (graph.n == 0)
            continue;
        struct grrl_match_step steps[GRRL_MAX_LINKS];
        uint8_t first = (uint8_t)grrl_random_below(&random, graph.n);
        grrl_match_order_from(steps, &graph, first);
        assert_steps(&graph, steps);
        assert_int_equal(steps[0].vertex, first);
        uint32_t earlier = grrl_bit(first);
        for (uint8_t depth = 1; depth < graph.n; depth++) {
            for (uint8_t v = 0; v < graph.n && steps[depth].parent == GRRL_UNMAPPED; v++)
                if ((earlier >> v & 1u) == 0) { /* nothing that was placed has a neighbour left */
                    assert_int_equal(earlier_neighbours(&graph, earlier, v), 0);
                    assert_true(v >= steps[depth].vertex);
                }
            earlier |= grrl_bit(steps[depth].vertex);
        }
    }
}

/* The different labels by value: which vertices have each, and one of them. */
static void test_labels(void **state)
{
    (void)state;
    struct grrl_random random = support_random("labels");
    for (int i = 0; i < 500; i++) {
        struct grrl_graph graph = random_graph(&random);
        grrl_label mask = grrl_random_below(&random, 2) ? GRRL_ALL_PROPERTIES : GRRL_NO_PROPERTIES;
        struct grrl_match_plan plan;
        grrl_match_plan_of(&plan, &graph, mask);
        uint32_t in_groups = 0;
        for (unsigned k = 0; k < plan.n_labels; k++) {
            grrl_label label = plan.label[plan.label_example[k]];
            if (k > 0)
                assert_true(plan.label[plan.label_example[k - 1]] < label);
            for (uint8_t v = 0; v < graph.n; v++)
                assert_int_equal((plan.labelled[k] >> v & 1u) != 0, plan.label[v] == label);
            in_groups |= plan.labelled[k];
        }
        assert_int_equal(in_groups, grrl_bits_below(graph.n));
        for (uint8_t v = 0; v < graph.n; v++)
            assert_true((plan.labelled[plan.label_group[v]] >> v & 1u) != 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_colours),        cmocka_unit_test(test_hash),
        cmocka_unit_test(test_growing_counts), cmocka_unit_test(test_degrees),
        cmocka_unit_test(test_order),          cmocka_unit_test(test_order_from),
        cmocka_unit_test(test_labels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
