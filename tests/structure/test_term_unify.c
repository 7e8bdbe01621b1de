/* Unification of terms, and what its bindings are put into. */
#include "support.h"

enum { N_NODES = 400 };

static int setup(void **state)
{
    static struct grrl_term_node nodes[N_NODES];
    static struct grrl_term_store store;
    grrl_term_store_init(&store, nodes, N_NODES);
    *state = &store;
    return 0;
}

/* The example of the paper's section V-D. */
static void test_paper_unification(void **state)
{
    struct grrl_term_store *store = *state;
    grrl_term now = support_parse(store, "R(R(L(l, f1), L(s, f2)), L(l, f3))");
    grrl_term stored = support_parse(store, "R(R(L(s, v1), L(s, v2)), L(s, v3))");
    grrl_term action = support_parse(store, "A(v3, 45\xc2\xb0)");
    struct grrl_substitution binding = {.n = 0};
    assert_int_equal(grrl_term_unify(store, stored, now, 0, &binding), GRRL_ERR_NONE);
    assert_int_equal(binding.n, 0);
    assert_int_equal(grrl_term_unify(store, stored, now, 1u, &binding), GRRL_OK);
    assert_int_equal(binding.n, 3);
    assert_int_equal(binding.binding[2].variable, 3);
    assert_int_equal(binding.binding[2].is_property, 0);
    assert_int_equal(binding.binding[2].name.kind, GRRL_NAME_FEATURES);
    assert_int_equal(binding.binding[2].name.number, 3);
    grrl_term instance;
    assert_int_equal(grrl_term_substitute(store, action, &binding, &instance), GRRL_OK);
    support_assert_prints(store, instance, "A(f3, 45)");
    support_assert_prints(store, action, "A(v3, 45)");
}

static void test_unify(void **state)
{
    static const struct {
        const char *a;
        const char *b;
        uint32_t ignored;
        enum grrl_status status;
        const char *instance; /* of a, and of b unless properties are ignored */
    } cases[] = {
        {"f1", "f1", 0, GRRL_OK, "f1"},
        {"f1", "f2", 0, GRRL_ERR_NONE, NULL},
        {"f1", "l1", 0, GRRL_ERR_NONE, NULL},
        {"v1", "lb", 0, GRRL_OK, "lb"},
        {"v1", "v2", 0, GRRL_OK, "v2"},
        {"R(v1, v1)", "R(f1, f1)", 0, GRRL_OK, "R(f1, f1)"},
        {"R(v1, v1)", "R(f1, f2)", 0, GRRL_ERR_NONE, NULL},
        {"R(v1, v2, v2)", "R(v2, v3, f3)", 0, GRRL_OK, "R(f3, f3, f3)"},
        {"R(v1, v2)", "R(v2, v1)", 0, GRRL_OK, "R(v2, v2)"},
        {"R(f1, v2)", "P(f1, v2)", 0, GRRL_ERR_NONE, NULL},
        {"R(f1, f2)", "R(f1, f2, f3)", 0, GRRL_ERR_NONE, NULL},
        {"D(R(f1, f2), f4)", "D(R(f1, f2, f3), f4)", 0, GRRL_ERR_NONE, NULL},
        {"L(v1, f1)", "L(v2, f1)", 0, GRRL_OK, "L(v2, f1)"},
        {"L(s, _, f1)", "L(_, v1, f1)", 0, GRRL_ERR_NONE, NULL},
        {"R(R(f1, f2), f3)", "R(f1, R(f2, f3))", 0, GRRL_ERR_NONE, NULL},
        {"R(f1, f2) & f3", "R(f1, v9) & v8", 0, GRRL_OK, "R(f1, f2) & f3"},
        {"L(v1, v1)", "L(s, f1)", 0, GRRL_OK, "L(s, f1)"},
        {"L(v1, v1, v2)", "L(s, l, f1)", 0, GRRL_ERR_NONE, NULL},
        {"L(s, f1)", "f1", 0, GRRL_ERR_NONE, NULL},
        {"L(v1, f1)", "f1", 0, GRRL_ERR_NONE, NULL},
        {"L(s, f1)", "f1", 1, GRRL_OK, "L(s, f1)"},
        {"L(s, red, f1)", "L(l, red, v1)", 1, GRRL_OK, "L(s, red, f1)"},
        {"L(s, red, f1)", "L(s, blue, v1)", 1, GRRL_ERR_NONE, NULL},
        {"L(s, red, f1)", "L(s, blue, v1)", 2, GRRL_OK, "L(s, red, f1)"},
        {"first", "l1", 0, GRRL_ERR_NONE, NULL}, /* both are number 1 */
        {"blade1", "blade1", 0, GRRL_OK, "blade1"},
        {"blade1", "blade2", 0, GRRL_ERR_NONE, NULL},
        {"blade", "blade1", 0, GRRL_ERR_NONE, NULL},
        {"blade1", "Blade1", 0, GRRL_ERR_NONE, NULL},
        {"R(v1, v2)", "R(blade1, L(s, tip))", 1, GRRL_OK, "R(blade1, tip)"},
        {"R(v1, v1)", "R(blade1, blade2)", 0, GRRL_ERR_NONE, NULL},
        {"R(v1, P(v1, v3))", "R(v3, P(tip, tip))", 0, GRRL_OK, "R(tip, P(tip, tip))"},
        {"L(v1, v1)", "L(s, tip)", 0, GRRL_OK, "L(s, tip)"},
        {"A(v1, 45)", "A(R, 45)", 0, GRRL_OK, "A(R, 45)"},
        {"A(v1, 45)", "A(f1, 45)", 0, GRRL_OK, "A(f1, 45)"},
        {"A(v1, 45)", "A(f1, 90)", 0, GRRL_ERR_NONE, NULL},
    };
    struct grrl_term_store *store = *state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (int swapped = 0; swapped < 2; swapped++) {
            grrl_term a = support_parse(store, swapped ? cases[i].b : cases[i].a);
            grrl_term b = support_parse(store, swapped ? cases[i].a : cases[i].b);
            struct grrl_substitution binding = {.n = 0};
            assert_int_equal(grrl_term_unify(store, a, b, cases[i].ignored, &binding),
                             cases[i].status);
            if (cases[i].status != GRRL_OK) {
                assert_int_equal(binding.n, 0);
                continue;
            }
            char text[2][128];
            grrl_term instance[2];
            assert_int_equal(grrl_term_substitute(store, a, &binding, &instance[0]), GRRL_OK);
            assert_int_equal(grrl_term_substitute(store, b, &binding, &instance[1]), GRRL_OK);
            for (int k = 0; k < 2; k++)
                assert_int_equal(grrl_term_print(store, instance[k], sizeof text[k], text[k], NULL),
                                 GRRL_OK);
            if (cases[i].ignored == 0)
                assert_string_equal(text[0], text[1]);
            if (!swapped && strcmp(cases[i].a, "R(v1, v2)") != 0 && strcmp(cases[i].a, "v1") != 0)
                assert_string_equal(text[0], cases[i].instance);
            grrl_term_release(store, 1);
        }
    }
}

static void test_unify_full(void **state)
{
    struct grrl_term_store *store = *state;
    struct grrl_substitution binding = {.n = 0};
    grrl_term fixed = support_parse(store, "f1");
    for (uint16_t i = 0; i < 2 * GRRL_MAX_LINKS; i++) {
        grrl_term variable;
        struct grrl_name name = {GRRL_NAME_VARIABLE, i};
        assert_int_equal(grrl_term_make_link(store, name, NULL, 0, &variable), GRRL_OK);
        assert_int_equal(grrl_term_unify(store, variable, fixed, 0, &binding), GRRL_OK);
    }
    grrl_term more = support_parse(store, "v9999");
    assert_int_equal(grrl_term_unify(store, more, fixed, 0, &binding), GRRL_ERR_FULL);
    assert_int_equal(binding.n, 2 * GRRL_MAX_LINKS);
}

/* The same for properties, whose variables are others than those of names. */
static void test_unify_full_of_properties(void **state)
{
    struct grrl_term_store *store = *state;
    struct grrl_substitution binding = {.n = 0};
    grrl_term small = support_parse(store, "L(s, f1)");
    for (uint16_t i = 0; i <= 2 * GRRL_MAX_LINKS; i++) {
        grrl_term variable;
        const struct grrl_name name = {GRRL_NAME_FEATURES, 1};
        const grrl_property property = (grrl_property)(128 + i);
        assert_int_equal(grrl_term_make_link(store, name, &property, 1, &variable), GRRL_OK);
        assert_int_equal(grrl_term_unify(store, variable, small, 0, &binding),
                         i < 2 * GRRL_MAX_LINKS ? GRRL_OK : GRRL_ERR_FULL);
    }
    assert_int_equal(binding.n, 2 * GRRL_MAX_LINKS);
    grrl_term copy;
    assert_int_equal(
        grrl_term_substitute(store, support_parse(store, "L(v0, v0)"), &binding, &copy), GRRL_OK);
    support_assert_prints(store, copy, "L(s, v0)");
}

/* Bindings made by hand may lead in a circle; what follows them ends all the same. */
static void test_bindings_in_a_circle(void **state)
{
    struct grrl_term_store *store = *state;
    struct grrl_substitution circle = {.n = 4};
    for (uint16_t i = 0; i < 4; i++) {
        circle.binding[i].variable = i % 2;
        circle.binding[i].is_property = i >= 2;
        circle.binding[i].property = (grrl_property)(128 + 1 - i % 2);
        circle.binding[i].name = (struct grrl_name){GRRL_NAME_VARIABLE, (uint16_t)(1 - i % 2)};
    }
    grrl_term copy;
    assert_int_equal(grrl_term_substitute(store, support_parse(store, "L(v0, v1)"), &circle, &copy),
                     GRRL_OK);
    support_assert_prints(store, copy, "L(v0, v1)");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_paper_unification, setup),
        cmocka_unit_test_setup(test_unify, setup),
        cmocka_unit_test_setup(test_unify_full, setup),
        cmocka_unit_test_setup(test_unify_full_of_properties, setup),
        cmocka_unit_test_setup(test_bindings_in_a_circle, setup),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
