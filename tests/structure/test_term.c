/* Terms: parse and print, refusals at each byte. */
#include "support.h"

enum { N_NODES = 400 + 4 * GRRL_MAX_TERM_DEPTH };

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

/* A text and how it is printed again. */
static void test_parse_print(void **state)
{
    static const char *const cases[][2] = {
        {"D(lb, R(l1, l2))", "D(lb, R(l1, l2))"},
        {"D(lb, R(l4, R(l3, P(l1, l2))))", "D(lb, R(l4, R(l3, P(l1, l2))))"},
        {"D(P(l4, R(R(l1, l2), l3)), lb)", "D(P(l4, R(R(l1, l2), l3)), lb)"},
        {"D(lb, R(l1, R(l5, R(l4, R(l3, R(l2, l1))))))",
         "D(lb, R(l1, R(l5, R(l4, R(l3, R(l2, l1))))))"},
        {"D(lb, R(L(s, f4), R(L(s, f3), P(L(s, f1), L(s, f2)))))",
         "D(lb, R(L(s, f4), R(L(s, f3), P(L(s, f1), L(s, f2)))))"},
        {"R(R(L(l,f1),L(s,f2)),L(l,f3))", "R(R(L(l, f1), L(s, f2)), L(l, f3))"},
        {"R(R(L(s, v1), L(s, v2)), L(s, v3))", "R(R(L(s, v1), L(s, v2)), L(s, v3))"},
        {"R(L(l, f3), R(L(s, f2), L(l, f1)))", "R(L(l, f3), R(L(s, f2), L(l, f1)))"},
        {"A(v3, 45\xc2\xb0)", "A(v3, 45)"},
        {"A(l1, 0)", "A(l1, 0)"},
        {"A(l1, 000)", "A(l1, 0)"},
        {"A(l1, 90)", "A(l1, 90)"},
        {"A(l1, 180)", "A(l1, 180)"},
        {"A(l1, 225)", "A(l1, 225)"},
        {"A( L( s , red, f3 ) ,270 \xc2\xb0 ) ", "A(L(s, red, f3), 270)"},
        {"\n\tR \r( l1\v,\f l2 , l3 )\n", "R(l1, l2, l3)"},
        {"l1 & R(l1&l2,l3 & P(l4,l5)&l6)", "l1 & R(l1 & l2, l3 & P(l4, l5) & l6)"},
        {"l007", "l7"},
        {"L(f0)", "f0"},
        {"L(v5, v127, v65535)", "L(v5, v127, v65535)"},
        {"L(_, wet, f1)", "L(_, wet, f1)"},
        {"L(s, _, _, f1)", "L(s, f1)"},
        {"L(a2_Bc, lbx, ff1, fx, f65535)", "L(a2_Bc, lbx, ff1, fx, f65535)"},
        {"lb", "lb"},
        {"R(blade1, blade2)", "R(blade1, blade2)"},
        {"D(lb, P(Left, R(L(s, mid_3), right)))", "D(lb, P(Left, R(L(s, mid_3), right)))"},
        {"L(s, small)", "L(s, small)"},
        {"L(s, l)", "L(s, l)"},
        {"L(s, s) & s & L(s)", "L(s, s) & s & s"},
        {"R(s, l)", "R(s, l)"},
        {"R (R, P) & L & L(L) & A", "R(R, P) & L & L & A"},
        {"A(A, 45)", "A(A, 45)"},
        {"D(D\n, L(v1, _, v))", "D(D, L(v1, v))"},
        {"f & v & l1a & f_1 & lb_ & LB & l1_ & L1", "f & v & l1a & f_1 & lb_ & LB & l1_ & L1"},
        {"R(abcdefghijklmno, L(abcdefghijklmno, x))", "R(abcdefghijklmno, L(abcdefghijklmno, x))"},
    };
    struct grrl_term_store *store = store_of(state);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        grrl_term_store_init(store, ((struct fixture *)*state)->nodes, N_NODES);
        support_assert_prints(store, support_parse(store, cases[i][0]), cases[i][1]);
        support_assert_prints(store, support_parse(store, cases[i][1]), cases[i][1]);
    }
}

struct malformed {
    const char *text;
    size_t length; /* 0: that of the string */
    size_t offset;
    uint32_t line;
    uint32_t column;
    enum grrl_status status;
    const char *message;
};

#define SYNTAX GRRL_ERR_SYNTAX

static const struct malformed malformed[] = {
    {" ", 0, 1, 1, 2, SYNTAX, "expected a link or one of R, P, D, A, found the end of the text"},
    {"9a", 0, 0, 1, 1, SYNTAX, "expected a link or one of R, P, D, A, found '9a'"},
    {"_", 0, 0, 1, 1, SYNTAX, "expected a link or one of R, P, D, A, found '_'"},
    {"R(_a, l2)", 0, 2, 1, 3, SYNTAX, "expected a link or one of R, P, D, A, found '_a'"},
    {"X(l1, l2)", 0, 0, 1, 1, SYNTAX, "expected R, P, D, L or A before '(', found 'X'"},
    {"RR(l1, l2)", 0, 0, 1, 1, SYNTAX, "found 'RR'"},
    {"R(blade1 (l1), l2)", 0, 2, 1, 3, SYNTAX, "before '(', found 'blade1'"},
    {"l1 & l2(s)", 0, 5, 1, 6, SYNTAX, "before '(', found 'l2'"},
    {"R l1", 0, 2, 1, 3, SYNTAX, "expected '&' or the end of the text, found 'l1'"},
    {"R(l1)", 0, 4, 1, 5, SYNTAX, "expected ',' and another argument"},
    {"R()", 0, 2, 1, 3, SYNTAX, "expected a link or one of R, P, D, A, found ')'"},
    {"R(l1, )", 0, 6, 1, 7, SYNTAX, "found ')'"},
    {"R(l1,\n  l2", 0, 10, 2, 5, SYNTAX, "expected ',', ')' or '&' after an argument"},
    {"R(l1 l2)", 0, 5, 1, 6, SYNTAX, "after an argument of a relation, found 'l2'"},
    {"R(l1, l2))", 0, 9, 1, 10, SYNTAX, "expected '&' or the end of the text, found ')'"},
    {"l1 &", 0, 4, 1, 5, SYNTAX, "found the end of the text"},
    {"l1, l2", 0, 2, 1, 3, SYNTAX, "expected '&' or the end of the text, found ','"},
    {"A s", 0, 2, 1, 3, SYNTAX, "expected '&' or the end of the text, found 's'"},
    {"L()", 0, 2, 1, 3, SYNTAX, "expected a property or the name of a link, found ')'"},
    {"L(s, x y)", 0, 7, 1, 8, SYNTAX,
     "expected ',' after a property or ')' after a name, found 'y'"},
    {"L(s, f1 y)", 0, 8, 1, 9, SYNTAX, "',' after a property or ')' after a name, found 'y'"},
    {"L(_)", 0, 2, 1, 3, SYNTAX,
     "expected a name such as f1, v1, l1 or blade1 at the end of a link, found '_'"},
    {"L(s, 9)", 0, 5, 1, 6, SYNTAX, "at the end of a link, found '9'"},
    {"L(s, x(y))", 0, 6, 1, 7, SYNTAX, "found '('"},
    {"L(abcdefghijklmnop)", 0, 2, 1, 3, SYNTAX, "too long for a name"},
    {"L(f1, s, f2)", 0, 2, 1, 3, SYNTAX, "expected a property (the name comes last"},
    {"L(lb, f2)", 0, 2, 1, 3, SYNTAX, "expected a property (the name comes last"},
    {"L(S, f2)", 0, 2, 1, 3, SYNTAX,
     "a property, which begins with a lower-case letter, found 'S'"},
    {"L(9, f2)", 0, 2, 1, 3, SYNTAX, "begins with a lower-case letter, found '9'"},
    {"L(v128, f2)", 0, 2, 1, 3, SYNTAX, "at most 127"},
    {"L(v4294967297, f2)", 0, 2, 1, 3, SYNTAX, "at most 127"},
    {"L(s, f65536)", 0, 5, 1, 6, SYNTAX, "at most 65535"},
    {"l99999999999999999999", 0, 0, 1, 1, SYNTAX, "at most 65535"},
    {"L(abcdefghijklmnop, f1)", 0, 2, 1, 3, SYNTAX, "too long for a property"},
    {"L(a,a,a,a,a,a,a,a,a,f1)", 0, 18, 1, 19, GRRL_ERR_FULL, "too many properties"},
    {"A(f1, 46)", 0, 6, 1, 7, SYNTAX, "a direction: 0, 45, 90, 180, 225 or 270, found '46'"},
    {"A(f1, 4294967341)", 0, 6, 1, 7, SYNTAX, "found '4294967341'"},
    {"A(f1, 45x)", 0, 6, 1, 7, SYNTAX, "found '45x'"},
    {"A(f1, )", 0, 6, 1, 7, SYNTAX, "a direction: 0, 45, 90, 180, 225 or 270, found ')'"},
    {"A(f1, 0x)", 0, 6, 1, 7, SYNTAX, "a direction: 0, 45, 90, 180, 225 or 270, found '0x'"},
    {"A(f1, x)", 0, 6, 1, 7, SYNTAX, "a direction: 0, 45, 90, 180, 225 or 270, found 'x'"},
    {"A(f1, 45\xc2\xb1)", 0, 8, 1, 9, SYNTAX, "expected ')' after the direction"},
    {"A(f1, /)", 0, 6, 1, 7, SYNTAX, "found '/'"},
    {"R(l1, l2{)", 0, 8, 1, 9, SYNTAX, "found '{'"},
    {"R(l1, \x01)", 0, 6, 1, 7, SYNTAX, "found the byte 0x01"},
    {"R(l1, \x1f)", 0, 6, 1, 7, SYNTAX, "found the byte 0x1f"},
    {"R(l1, \x7f)", 0, 6, 1, 7, SYNTAX, "found the byte 0x7f"},
    {"R(l1, ~)", 0, 6, 1, 7, SYNTAX, "found '~'"},
    {"A(f1, 45\xc2\xb0", 0, 10, 1, 10, SYNTAX, "of an action, found the end of the text"},
    {"A(f1)", 0, 4, 1, 5, SYNTAX, "expected ',' after the link of an action, found ')'"},
    {"A(X(f1), 45)", 0, 2, 1, 3, SYNTAX, "expected a link as the first argument of A, found 'X'"},
    {"A(R(f1, f2), 45)", 0, 2, 1, 3, SYNTAX, "expected a link as the first argument of A"},
    {"A(f1, 45\xc2\xb0 7)", 0, 11, 1, 11, SYNTAX, "expected ')' after the direction"},
    {"A(f1, 45\xc2", 0, 8, 1, 9, SYNTAX,
     "expected ')' after the direction of an action, found the "
     "byte 0xc2"},
    {"A(f1, 45) & l1", 0, 10, 1, 11, SYNTAX, "expected the end of the text after an action"},
    {"l1 & A(f1, 45)", 0, 5, 1, 6, SYNTAX, "an action cannot be part of another term"},
    {"R(A(f1, 45), l1)", 0, 2, 1, 3, SYNTAX, "an action cannot be part of another term"},
    {"R(l1, l\xc3\xa4)", 0, 7, 1, 8, SYNTAX, "found the byte 0xc3"},
    {"R(l1\xc3\xa4)", 0, 4, 1, 5, SYNTAX, "found the byte 0xc3"},
    {"l1\0 ", 4, 2, 1, 3, SYNTAX, "expected '&' or the end of the text, found a zero byte"},
    {"\0", 1, 0, 1, 1, SYNTAX, "found a zero byte"},
    {"aVeryLongWordThatIsNoTermAtAll", 0, 0, 1, 1, SYNTAX,
     "the word is too long for a name, which has at most 15 characters"},
    {"R(l1 aVeryLongWordThatIsNoTermAtAll)", 0, 5, 1, 6, SYNTAX,
     "found 'aVeryLongWordThatIsNoTer..'"},
};

static void test_malformed(void **state)
{
    struct grrl_term_store *store = store_of(state);
    for (size_t i = 0; i < sizeof malformed / sizeof malformed[0]; i++) {
        const struct malformed *c = &malformed[i];
        struct grrl_term_error error;
        memset(&error, 0xff, sizeof error);
        grrl_term term = 77;
        struct grrl_term_store before = *store;
        size_t length = c->length > 0 ? c->length : strlen(c->text);
        enum grrl_status status = grrl_term_parse(store, c->text, length, &term, &error);
        if (status != c->status || error.offset != c->offset || error.line != c->line ||
            error.column != c->column || strstr(error.message, c->message) == NULL)
            fail_msg("%s: status %d, offset %zu, %u:%u: %s", c->text, status, error.offset,
                     error.line, error.column, error.message);
        assert_true(memchr(error.message, '\0', sizeof error.message) != NULL);
        assert_int_equal(term, 77);
        assert_int_equal(store->used, before.used);
        assert_int_equal(store->n_symbols, before.n_symbols);
        assert_int_equal(store->n_names, before.n_names);
        assert_int_equal(grrl_term_parse(store, c->text, length, &term, NULL), status);
    }
}

/* Every proper prefix of a term without an '&' or a number at its end is no term, but for its first
 * letter, which alone is a link's name. */
static void test_every_prefix(void **state)
{
    static const char text[] = "D(lb, R(L(s, f4), R(L(s, f3), P(L(s, f1), L(s, f2)))))";
    struct grrl_term_store *store = store_of(state);
    for (size_t length = 0; length + 1 < sizeof text; length++) {
        if (length == 1)
            continue;
        grrl_term term;
        struct grrl_term_error error;
        assert_int_equal(grrl_term_parse(store, text, length, &term, &error), GRRL_ERR_SYNTAX);
        assert_true(error.offset <= length);
        assert_int_equal(grrl_term_mark(store), 1);
    }
}

static void test_depth(void **state)
{
    struct grrl_term_store *store = store_of(state);
    char text[16 * (GRRL_MAX_TERM_DEPTH + 1)];
    for (size_t depth = GRRL_MAX_TERM_DEPTH; depth <= GRRL_MAX_TERM_DEPTH + 1; depth++) {
        char *end = text;
        for (size_t i = 0; i < depth; i++)
            end += sprintf(end, "l1 & R(l1, ");
        end += sprintf(end, "l2");
        for (size_t i = 0; i < depth; i++)
            end += sprintf(end, ")");
        grrl_term_release(store, 1);
        grrl_term term;
        struct grrl_term_error error;
        enum grrl_status status = grrl_term_parse(store, text, (size_t)(end - text), &term, &error);
        if (depth == GRRL_MAX_TERM_DEPTH) {
            assert_int_equal(status, GRRL_OK);
            support_assert_prints(store, term, text);
            grrl_term parts[2] = {support_parse(store, "l1"), term};
            grrl_term more;
            assert_int_equal(grrl_term_make(store, GRRL_TERM_REVOLUTE, parts, 2, &more),
                             GRRL_ERR_FULL);
            assert_int_equal(grrl_term_make(store, GRRL_TERM_AND, parts, 2, &more), GRRL_OK);
        } else {
            assert_int_equal(status, GRRL_ERR_FULL);
            assert_int_equal(error.offset, 11 * GRRL_MAX_TERM_DEPTH + 5);
            assert_non_null(strstr(error.message, "too deeply"));
        }
    }
}

/* With any number of nodes too few, parsing fails and leaves nothing; with just enough it fits. */
static void test_capacity(void **state)
{
    (void)state;
    static const char text[] = "R(l1, L(s, l2) & P(l3, l4))";
    struct grrl_term_node nodes[8];
    struct grrl_term_store store;
    grrl_term term;
    struct grrl_term_error error;
    for (uint16_t capacity = 2; capacity <= 8; capacity++) {
        grrl_term_store_init(&store, nodes, capacity);
        enum grrl_status status = grrl_term_parse(&store, text, sizeof text - 1, &term, &error);
        assert_int_equal(status, capacity < 8 ? GRRL_ERR_FULL : GRRL_OK);
        if (status != GRRL_OK) {
            assert_int_equal(grrl_term_mark(&store), 1);
            char expected[64];
            (void)snprintf(expected, sizeof expected, "the term store is full: it holds %u nodes",
                           capacity - 1u);
            assert_string_equal(error.message, expected);
            assert_int_equal(store.high_water, capacity);
        }
    }
    struct grrl_substitution none = {.n = 0};
    grrl_term copy;
    assert_int_equal(grrl_term_substitute(&store, term, &none, &copy), GRRL_ERR_FULL);
    assert_int_equal(grrl_term_mark(&store), 8);

    grrl_term_store_init(&store, nodes, 2);
    assert_int_equal(grrl_term_parse(&store, "l1", 2, &term, NULL), GRRL_OK);
    assert_int_equal(grrl_term_parse(&store, "l1", 2, &term, NULL), GRRL_ERR_FULL);
    grrl_term made;
    assert_int_equal(grrl_term_make_action(&store, term, 0, &made), GRRL_ERR_FULL);
    grrl_term_store_init(&store, nodes, 2);
    assert_int_equal(grrl_term_parse(&store, "A(l1, 0)", 8, &term, &error), GRRL_ERR_FULL);
    assert_int_equal(error.offset, 0);
    assert_int_equal(grrl_term_mark(&store), 1);
}

static void test_symbols(void **state)
{
    struct grrl_term_store *store = store_of(state);
    grrl_property property;
    assert_int_equal(grrl_term_intern(store, "s", 1, &property), GRRL_OK);
    assert_int_equal(property, GRRL_PROPERTY_SMALL);
    assert_int_equal(grrl_term_intern(store, "l", 1, &property), GRRL_OK);
    assert_int_equal(property, GRRL_PROPERTY_LARGE);
    static const char *const bad[] = {"", "S", "1", "_a", "f1", "l12", "v0", "lb", "a b", "a-"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_int_equal(grrl_term_intern(store, bad[i], strlen(bad[i]), &property),
                         GRRL_ERR_SYNTAX);
    static const char broken[] = "L(gone, f1"; /* takes its new symbol back */
    static const char whole[] = "L(gone, f1)";
    grrl_term link;
    assert_int_equal(grrl_term_parse(store, broken, sizeof broken - 1, &link, NULL),
                     GRRL_ERR_SYNTAX);
    assert_int_equal(store->n_symbols, GRRL_BUILT_IN_ATOMS);
    support_assert_prints(store, support_parse(store, whole), whole);
    assert_int_equal(store->n_symbols, GRRL_BUILT_IN_ATOMS + 1);
    for (int i = GRRL_BUILT_IN_ATOMS + 2; i <= GRRL_MAX_SYMBOLS; i++) {
        char name[GRRL_SYMBOL_BYTES];
        int length = snprintf(name, sizeof name, "atom_%d", i);
        assert_int_equal(grrl_term_intern(store, name, (size_t)length, &property), GRRL_OK);
        assert_int_equal(property, i);
        assert_string_equal(grrl_term_symbol(store, property), name);
    }
    assert_int_equal(grrl_term_intern(store, "more", 4, &property), GRRL_ERR_FULL);
    assert_int_equal(grrl_term_intern(store, "atom", 4, &property), GRRL_ERR_FULL);
    assert_int_equal(grrl_term_intern(store, "gone", 4, &property), GRRL_OK);
    assert_int_equal(property, GRRL_BUILT_IN_ATOMS + 1);
    grrl_term term;
    struct grrl_term_error error;
    assert_int_equal(grrl_term_parse(store, "L(s,more,f1)", 12, &term, &error), GRRL_ERR_FULL);
    assert_int_equal(error.offset, 4);
    assert_null(grrl_term_symbol(store, 0));
    assert_null(grrl_term_symbol(store, 128));
}

/* The table of names: apart from that of properties, filled to the last, unchanged by a failure. */
static void test_names(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct grrl_name name = {GRRL_NAME_NONE, 77};
    static const char *const bad[] = {"",   "1",  "_",  "_a",  "f1",      "l12",
                                      "v0", "lb", "a ", "a-b", "\xc3\xa4"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_int_equal(grrl_term_intern_name(store, bad[i], strlen(bad[i]), &name),
                         GRRL_ERR_SYNTAX);
    assert_int_equal(grrl_term_intern_name(store, "abcdefghijklmnop", 16, &name), GRRL_ERR_SYNTAX);
    assert_int_equal(name.number, 77);
    for (uint16_t i = 1; i <= GRRL_MAX_NAMES; i++) {
        char word[GRRL_SYMBOL_BYTES];
        char text[GRRL_NAME_BYTES];
        int length = snprintf(word, sizeof word, "Blade_%u", (unsigned)i);
        assert_int_equal(grrl_term_intern_name(store, word, (size_t)length, &name), GRRL_OK);
        assert_int_equal(name.kind, GRRL_NAME_SYMBOL);
        assert_int_equal(name.number, i);
        assert_string_equal(grrl_term_name_text(store, name, text), word);
    }
    assert_int_equal(store->n_symbols, GRRL_BUILT_IN_ATOMS);
    assert_int_equal(grrl_term_intern_name(store, "Blade", 5, &name), GRRL_ERR_FULL);
    assert_int_equal(grrl_term_intern_name(store, "Blade_2", 7, &name), GRRL_OK);
    assert_int_equal(name.number, 2);
    support_assert_prints(store, support_parse(store, "R(Blade_2, L(s, red, Blade_3))"),
                          "R(Blade_2, L(s, red, Blade_3))");
    grrl_term term;
    struct grrl_term_error error;
    assert_int_equal(grrl_term_parse(store, "R(l1, L(s, blue, more))", 23, &term, &error),
                     GRRL_ERR_FULL);
    assert_int_equal(error.offset, 17);
    char expected[120];
    (void)snprintf(expected, sizeof expected, "the term store is full: it holds %d identifiers",
                   GRRL_MAX_NAMES);
    assert_non_null(strstr(error.message, expected));
    assert_int_equal(store->n_symbols, GRRL_BUILT_IN_ATOMS + 1);
    assert_int_equal(store->n_names, GRRL_MAX_NAMES);

    /* a text that fails at its end takes its names back */
    grrl_term_store_init(store, ((struct fixture *)*state)->nodes, N_NODES);
    assert_int_equal(grrl_term_parse(store, "R(a, L(red, b)", 14, &term, NULL), GRRL_ERR_SYNTAX);
    assert_int_equal(store->n_names, 0);
}

static void test_name_text(void **state)
{
    struct grrl_term_store *store = store_of(state);
    (void)support_parse(store, "abcdefghijklmno");
    static const struct {
        struct grrl_name name;
        const char *text;
    } cases[] = {
        {{GRRL_NAME_LINK, 0}, "l0"},      {{GRRL_NAME_FEATURES, 65535}, "f65535"},
        {{GRRL_NAME_VARIABLE, 3}, "v3"},  {{GRRL_NAME_BACKGROUND, 0}, "lb"},
        {{GRRL_NAME_SYMBOL, 0}, "?"},     {{GRRL_NAME_SYMBOL, 1}, "abcdefghijklmno"},
        {{GRRL_NAME_SYMBOL, 2}, "?"},     {{GRRL_NAME_NONE, 1}, "?"},
        {{GRRL_NAME_SYMBOL + 1, 1}, "?"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[GRRL_NAME_BYTES];
        assert_string_equal(grrl_term_name_text(store, cases[i].name, text), cases[i].text);
    }
}

static void test_make_checks(void **state)
{
    struct grrl_term_store *store = store_of(state);
    grrl_term link = support_parse(store, "l1");
    grrl_term action = support_parse(store, "A(l1, 90)");
    grrl_term made = 0;
    const grrl_term one[1] = {link};
    const grrl_term twice[2] = {link, link};
    const grrl_term acts[2] = {link, action};
    const grrl_term outside[2] = {link, N_NODES - 1};
    assert_int_equal(grrl_term_make(store, GRRL_TERM_REVOLUTE, one, 1, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make(store, GRRL_TERM_REVOLUTE, twice, 2, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make(store, GRRL_TERM_AND, acts, 2, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make(store, GRRL_TERM_AND, outside, 2, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make(store, GRRL_TERM_LINK, acts, 2, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make_action(store, action, 0, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make_action(store, link, GRRL_DIRECTIONS, &made), GRRL_ERR_ARGUMENT);
    const grrl_property unknown[1] = {100};
    struct grrl_name name = {GRRL_NAME_LINK, 1};
    struct grrl_name nobody = {GRRL_NAME_NONE, 0};
    assert_int_equal(grrl_term_make_link(store, name, unknown, 1, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make_link(store, nobody, NULL, 0, &made), GRRL_ERR_ARGUMENT);
    (void)support_parse(store, "blade1");
    static const struct grrl_name wrong[] = {{GRRL_NAME_SYMBOL, 0},
                                             {GRRL_NAME_SYMBOL, 2},
                                             {GRRL_NAME_SYMBOL + 1, 1},
                                             {GRRL_NAME_BACKGROUND, 1}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        assert_int_equal(grrl_term_make_link(store, wrong[i], NULL, 0, &made), GRRL_ERR_ARGUMENT);
    struct grrl_name beyond = {GRRL_NAME_BACKGROUND + 1, 0};
    struct grrl_name numbered = {GRRL_NAME_BACKGROUND, 1};
    const grrl_property many[GRRL_MAX_PROPERTIES + 1] = {0};
    assert_int_equal(grrl_term_make_link(store, beyond, NULL, 0, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make_link(store, numbered, NULL, 0, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make_link(store, name, many, GRRL_MAX_PROPERTIES + 1, &made),
                     GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make(store, GRRL_TERM_ACTION, outside, 2, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(
        grrl_term_make(store, (enum grrl_term_kind)(GRRL_TERM_AND + 1), outside, 2, &made),
        GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_make_action(store, 0, 0, &made), GRRL_ERR_ARGUMENT);
    struct grrl_substitution none = {.n = 0};
    assert_int_equal(grrl_term_substitute(store, 0, &none, &made), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_unify(store, 0, link, 0, &none), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_unify(store, link, 0, 0, &none), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_unify(store, link, N_NODES - 1, 0, &none), GRRL_ERR_ARGUMENT);
    assert_int_equal(made, 0);
}

static void test_conjunctions_merge(void **state)
{
    struct grrl_term_store *store = store_of(state);
    const grrl_term parts[3] = {support_parse(store, "l1 & l2"), support_parse(store, "l3"),
                                support_parse(store, "l4 & R(l5 & l6, l7)")};
    grrl_term all;
    assert_int_equal(grrl_term_make(store, GRRL_TERM_AND, parts, 3, &all), GRRL_OK);
    support_assert_prints(store, all, "l1 & l2 & l3 & l4 & R(l5 & l6, l7)");
    assert_int_equal(grrl_term_node_at(store, all)->depth, 1);
}

static void test_print_cut(void **state)
{
    struct grrl_term_store *store = store_of(state);
    static const char whole[] = "R(L(s, f1), P(f2, f3))";
    grrl_term term = support_parse(store, whole);
    for (size_t capacity = 1; capacity <= sizeof whole; capacity++) {
        char text[sizeof whole + 1];
        memset(text, '#', sizeof text);
        size_t length = 0;
        enum grrl_status status = grrl_term_print(store, term, capacity, text, &length);
        assert_int_equal(status, capacity == sizeof whole ? GRRL_OK : GRRL_ERR_FULL);
        assert_int_equal(length, sizeof whole - 1);
        assert_int_equal(strlen(text), capacity - 1);
        assert_memory_equal(text, whole, capacity - 1);
        assert_int_equal(text[capacity], '#');
    }
    char one[1];
    assert_int_equal(grrl_term_print(store, 0, 1, one, NULL), GRRL_ERR_ARGUMENT);
    assert_int_equal(grrl_term_print(store, term, 0, one, NULL), GRRL_ERR_ARGUMENT);
}

/* A name that could be taken for something else. */
static struct grrl_name random_symbol(struct grrl_term_store *store, struct grrl_random *random)
{
    static const char *const words[] = {"R", "P", "D", "L",  "A",  "s",   "l",      "f",
                                        "v", "S", "B", "l_", "f_", "lbb", "v1_a_B", "blade1"};
    const char *word = words[grrl_random_below(random, sizeof words / sizeof words[0])];
    struct grrl_name name;
    assert_int_equal(grrl_term_intern_name(store, word, strlen(word), &name), GRRL_OK);
    return name;
}

/* What no function makes is printed as a question mark. */
static void test_unknown_prints(void **state)
{
    struct fixture *fixture = *state;
    grrl_term term = support_parse(&fixture->store, "L(s, f1)");
    fixture->nodes[term].properties[0] = 127;
    fixture->nodes[term].name.kind = GRRL_NAME_NONE;
    support_assert_prints(&fixture->store, term, "L(?, ?)");
}

/* A random term built bottom up from a pool of terms. */
static grrl_term random_term(struct grrl_term_store *store, struct grrl_random *random)
{
    grrl_term pool[40];
    uint16_t n = (uint16_t)(1 + grrl_random_below(random, 40));
    for (uint16_t i = 0; i < n; i++) {
        struct grrl_name name = {(uint16_t)(1 + grrl_random_below(random, 5)), 0};
        if (name.kind == GRRL_NAME_SYMBOL)
            name = random_symbol(store, random);
        else if (name.kind != GRRL_NAME_BACKGROUND)
            name.number = (uint16_t)grrl_random_below(random, 65536);
        grrl_property properties[GRRL_MAX_PROPERTIES];
        uint8_t n_properties = (uint8_t)grrl_random_below(random, GRRL_MAX_PROPERTIES + 1);
        for (uint8_t k = 0; k < n_properties; k++)
            properties[k] = (grrl_property)(grrl_random_below(random, 2)
                                                ? grrl_random_below(random, 3)
                                                : 128 + grrl_random_below(random, 128));
        assert_int_equal(grrl_term_make_link(store, name, properties, n_properties, &pool[i]),
                         GRRL_OK);
    }
    while (n > 1) {
        uint16_t taken = (uint16_t)(2 + grrl_random_below(random, n - 1u < 3 ? n - 1u : 3));
        enum grrl_term_kind kind =
            (enum grrl_term_kind)(GRRL_TERM_REVOLUTE + grrl_random_below(random, 4));
        uint16_t from = (uint16_t)grrl_random_below(random, n - taken + 1u);
        for (uint16_t i = from; i < from + taken; i++)
            if (grrl_term_node_at(store, pool[i])->depth == GRRL_MAX_TERM_DEPTH)
                kind = GRRL_TERM_AND; /* no further relation may be around it */
        assert_int_equal(grrl_term_make(store, kind, pool + from, taken, &pool[from]), GRRL_OK);
        for (uint16_t i = (uint16_t)(from + 1); i + taken - 1 < n; i++)
            pool[i] = pool[i + taken - 1];
        n = (uint16_t)(n - taken + 1);
    }
    return pool[0];
}

static void test_random_round_trips(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct grrl_random random = support_random("round trips");
    struct grrl_substitution none = {.n = 0};
    for (int i = 0; i < 5000; i++) {
        grrl_term_release(store, 1);
        grrl_term term = random_term(store, &random);
        static char text[8192];
        assert_int_equal(grrl_term_print(store, term, sizeof text, text, NULL), GRRL_OK);
        grrl_term again = support_parse(store, text);
        grrl_term copy;
        assert_int_equal(grrl_term_substitute(store, term, &none, &copy), GRRL_OK);
        static char printed[8192];
        assert_int_equal(grrl_term_print(store, again, sizeof printed, printed, NULL), GRRL_OK);
        assert_string_equal(printed, text);
        assert_int_equal(grrl_term_print(store, copy, sizeof printed, printed, NULL), GRRL_OK);
        assert_string_equal(printed, text);
        assert_int_equal(grrl_term_node_at(store, term)->depth,
                         grrl_term_node_at(store, again)->depth);
        struct grrl_substitution binding = {.n = 0};
        assert_int_equal(grrl_term_unify(store, term, again, 0, &binding), GRRL_OK);
        assert_int_equal(binding.n, 0);
    }
}

/* Damaged texts never harm, and what is still a term prints as one. */
static void test_random_damage(void **state)
{
    struct grrl_term_store *store = store_of(state);
    struct grrl_random random = support_random("damage");
    static const char alphabet[] = "RPDAL(),& slfvb019_\n\xc2\xb0";
    unsigned n_terms = 0;
    unsigned n_failures = 0;
    for (int i = 0; i < 20000; i++) {
        char text[] = "D(lb, R(L(s, f4), R(L(s, f3), P(L(s, f1), v2 & L(l, f2)))))";
        size_t length = sizeof text - 1;
        for (uint32_t k = 1 + grrl_random_below(&random, 3); k > 0; k--)
            text[grrl_random_below(&random, (uint32_t)length)] =
                alphabet[grrl_random_below(&random, sizeof alphabet)];
        grrl_term term;
        struct grrl_term_error error;
        if (grrl_term_parse(store, text, length, &term, &error) == GRRL_OK) {
            char printed[256];
            assert_int_equal(grrl_term_print(store, term, sizeof printed, printed, NULL), GRRL_OK);
            support_assert_prints(store, support_parse(store, printed), printed);
            n_terms++;
        } else {
            assert_true(error.offset <= length);
            n_failures++;
        }
        grrl_term_store_init(store, ((struct fixture *)*state)->nodes, N_NODES);
    }
    assert_true(n_terms > 100 && n_failures > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_parse_print, setup),
        cmocka_unit_test_setup(test_malformed, setup),
        cmocka_unit_test_setup(test_every_prefix, setup),
        cmocka_unit_test_setup(test_depth, setup),
        cmocka_unit_test_setup(test_capacity, setup),
        cmocka_unit_test_setup(test_symbols, setup),
        cmocka_unit_test_setup(test_names, setup),
        cmocka_unit_test_setup(test_name_text, setup),
        cmocka_unit_test_setup(test_make_checks, setup),
        cmocka_unit_test_setup(test_conjunctions_merge, setup),
        cmocka_unit_test_setup(test_print_cut, setup),
        cmocka_unit_test_setup(test_unknown_prints, setup),
        cmocka_unit_test_setup(test_random_round_trips, setup),
        cmocka_unit_test_setup(test_random_damage, setup),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
