/* The search without plans: what it rules out before its first step, against the definition of
 * that, and how straight it goes. */
#include "structure/match_private.h"
#include "support.h"

enum { LOOKS = 2 * GRRL_JOINT_TYPES };

static struct grrl_graph random_graph(struct grrl_random *random, uint32_t n_atoms)
{
    uint8_t n = (uint8_t)(1 + grrl_random_below(random, GRRL_MAX_LINKS));
    uint32_t loops = n > 1 ? grrl_random_below(random, 4) : 0;
    return support_graph(random, n, 5 + grrl_random_below(random, 4), loops, n_atoms);
}

/* Of each type of joint: one to a vertex labelled like the reference, and two. */
static void look_at(const struct grrl_graph *graph, grrl_label reference, uint8_t vertex,
                    bool *look)
{
    for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
        unsigned n_alike = 0;
        unsigned n_any = 0;
        for (uint8_t i = 0; i < graph->n; i++) {
            if (i == vertex || grrl_graph_joint(graph, vertex, i) != type)
                continue;
            n_alike += graph->label[i] == reference;
            n_any++;
        }
        look[2 * type] = n_alike > 0;
        look[2 * type + 1] = n_any > 1;
    }
}

static bool looks_like(const struct grrl_graph *pattern, uint8_t vertex,
                       const struct grrl_graph *target, uint8_t image, bool exact)
{
    bool of_vertex[LOOKS];
    bool of_image[LOOKS];
    grrl_label reference = pattern->label[0];
    look_at(pattern, reference, vertex, of_vertex);
    look_at(target, reference, image, of_image);
    bool alike = (pattern->label[vertex] == reference) == (target->label[image] == reference);
    for (int k = 0; k < LOOKS; k++)
        alike = alike && (exact ? of_vertex[k] == of_image[k] : !of_vertex[k] || of_image[k]);
    return alike;
}

/* For isomorphism: as many vertices with each look among those labelled like the reference, and
 * among the others, and as many joints of each type. */
static bool same_totals(const struct grrl_graph *pattern, const struct grrl_graph *target)
{
    int difference[2][LOOKS + 1] = {{0}};
    int joints[GRRL_JOINT_TYPES] = {0};
    for (int side = 0; side < 2; side++) {
        const struct grrl_graph *graph = side == 0 ? pattern : target;
        int sign = side == 0 ? 1 : -1;
        for (uint8_t v = 0; v < graph->n; v++) {
            bool look[LOOKS];
            int alike = graph->label[v] == pattern->label[0];
            look_at(graph, pattern->label[0], v, look);
            difference[alike][LOOKS] += sign;
            for (int k = 0; k < LOOKS; k++)
                difference[alike][k] += look[k] ? sign : 0;
            for (uint8_t w = 0; w < v; w++)
                if (grrl_graph_joint(graph, v, w) != GRRL_NO_JOINT)
                    joints[grrl_graph_joint(graph, v, w)] += sign;
        }
    }
    for (int k = 0; k <= LOOKS; k++)
        if (difference[0][k] != 0 || difference[1][k] != 0)
            return false;
    return joints[GRRL_REVOLUTE] == 0 && joints[GRRL_PRISMATIC] == 0;
}

static bool may_match(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                      const struct grrl_graph *target)
{
    bool exact = kind == GRRL_MATCH_ISOMORPHISM;
    if (exact ? pattern->n != target->n : pattern->n > target->n)
        return false;
    if (exact && !same_totals(pattern, target))
        return false;
    for (uint8_t v = 0; v < pattern->n; v++) {
        bool has_target = false;
        for (uint8_t t = 0; t < target->n; t++)
            has_target = has_target || looks_like(pattern, v, target, t, exact);
        if (!has_target)
            return false;
    }
    return true;
}

/* Away with a joint, or with another type, or with another label: by chance still the same. */
static struct grrl_graph changed(struct grrl_random *random, const struct grrl_graph *graph)
{
    uint8_t order[GRRL_MAX_LINKS];
    struct grrl_graph other = support_relabel(random, graph, order);
    uint8_t a = (uint8_t)grrl_random_below(random, other.n);
    uint8_t b = (uint8_t)grrl_random_below(random, other.n);
    switch (grrl_random_below(random, 4)) {
    case 0:
        other.label[a] = grrl_random_below(random, 3);
        break;
    case 1:
    case 2:
        for (int type = 0; type < GRRL_JOINT_TYPES; type++) {
            other.joined[type][a] &= ~grrl_bit(b);
            other.joined[type][b] &= ~grrl_bit(a);
        }
        if (a != b && grrl_random_below(random, 2) == 0)
            assert_int_equal(grrl_graph_add_joint(&other, a, b, GRRL_PRISMATIC), GRRL_OK);
        break;
    default:
        break;
    }
    return other;
}

/* What a search without plans answers within a budget. */
static enum grrl_status answer(enum grrl_match_kind kind, const struct grrl_graph *pattern,
                               const struct grrl_graph *target, uint32_t budget)
{
    struct grrl_match match;
    uint8_t map[GRRL_MAX_LINKS];
    grrl_match_begin(&match, kind, pattern, target, GRRL_ALL_PROPERTIES, budget);
    return grrl_match_next(&match, map);
}

static void test_what_is_ruled_out(void **state)
{
    (void)state;
    struct grrl_random random = support_random("ruled out");
    unsigned n_out[2] = {0, 0};
    for (int i = 0; i < 4000; i++) {
        struct grrl_graph target = random_graph(&random, grrl_random_below(&random, 3));
        struct grrl_graph pattern = changed(&random, &target);
        if (i % 3 == 0)
            pattern = random_graph(&random, grrl_random_below(&random, 2));
        for (int kind = 0; kind <= GRRL_MATCH_MONOMORPHISM; kind++) {
            enum grrl_match_kind k = (enum grrl_match_kind)kind;
            bool may = may_match(k, &pattern, &target);
            assert_int_equal(answer(k, &pattern, &target, 0),
                             may ? GRRL_ERR_UNDECIDED : GRRL_ERR_NONE);
            n_out[kind] += !may;
        }
    }
    assert_true(n_out[0] > 1000 && n_out[1] > 500 && n_out[0] < 3500 && n_out[1] < 3500);
}

/* A structure among its like: most answers take one step a link. */
static void test_goes_straight(void **state)
{
    (void)state;
    struct grrl_random random = support_random("goes straight");
    unsigned n_straight[2] = {0, 0};
    enum { TIMES = 2000 };
    for (int i = 0; i < TIMES; i++) {
        struct grrl_graph target = random_graph(&random, 2);
        struct grrl_graph pattern = changed(&random, &target);
        for (int kind = 0; kind <= GRRL_MATCH_MONOMORPHISM; kind++) {
            n_straight[kind] += answer((enum grrl_match_kind)kind, &pattern, &target, pattern.n) !=
                                GRRL_ERR_UNDECIDED;
        }
    }
    print_message("%u and %u of %d\n", n_straight[0], n_straight[1], TIMES);
    assert_true(n_straight[0] > 1600 && n_straight[1] > 1350);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_ruled_out),
        cmocka_unit_test(test_goes_straight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
