/*
 * grrl-term: relational terms on the command line, using the library's term, graph, match and
 * canonical modules.
 *
 * Exit status: 0 success (match: a match), 1 no match, or an error in a term, 2 wrong usage.
 */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/options.h"
#include "grrl/structure/canonical.h"
#include "grrl/structure/graph.h"
#include "grrl/structure/match.h"
#include "grrl/structure/term.h"
#include "term_store.h"

enum { EXIT_FINE = 0, EXIT_NO = 1 };
enum { MAX_TEXT_BYTES = 65536, MAX_NODES = 16384 };

/* The command, up to 32 stores and a new one. */
enum { MAX_ARGUMENTS = 34 };

/* Far more than any structure of 32 links needs, unless it was designed to be hard. */
enum { MATCH_BUDGET = 10000000 };

static const struct grrl_program program = {
    .name = "grrl-term",
    .usage = "grrl-term parse TERM\n"
             "       grrl-term graph [--dot] TERM\n"
             "       grrl-term canonical [--ignore-properties] TERM\n"
             "       grrl-term match [--all] A B\n"
             "       grrl-term rules STORE\n"
             "       grrl-term merge STORE STORE.. OUT",
    .intro =
        "\n"
        "parse      the term in its normal form\n"
        "graph      its links with their properties, and its joints, first discovered first\n"
        "canonical  one term and hash for all terms of the same structure\n"
        "match      whether A and B are the same structure, or one contains the other: with all\n"
        "           properties, then with properties dropped from the last place to the first;\n"
        "           the links of A with those of B in the first mapping\n"
        "rules      what a store of the policy learn says about pushes, as few rules: how many of "
        "how\n"
        "           many pushes revealed something, and how many links and joints a push revealed\n"
        "merge      stores of learn as one, in a new file: what all their objects have in common\n",
    .outro = "TERM is a term or - for standard input:\n"
             "  L(s, f1)  f1  v1  l1  lb     links: small, by features, variable, by number, "
             "background\n"
             "  blade1  L(s, blade1)         links by any other name; the last word in L(..) is "
             "the name\n"
             "  R(x, y)  P(x, y)  D(x, y)    revolute, prismatic, disconnected\n"
             "  x & y                        and\n"
             "  A(x, 45)                     an action: push link x from 45 degrees\n\n"
             "Exit status: 0 success, 1 no match or an error in a term, 2 wrong usage.\n",
    .max_arguments = MAX_ARGUMENTS,
    .arguments = "one term too many",
};

static struct grrl_term_node nodes[MAX_NODES];
static struct grrl_term_store store;

struct options {
    bool dot;
    bool ignore_properties;
    bool all;
    char **terms; /* or files */
    int n_terms;
};

/* A term from the command line as a structure. */
struct structure {
    struct grrl_graph graph;
    struct grrl_name names[GRRL_MAX_LINKS];
    struct grrl_edge edges[GRRL_MAX_JOINTS];
    uint8_t n_edges;
};

/* --- reading ---------------------------------------------------------------------------------- */

/* Prints the line with the error and a caret under the character; control characters as '?'. */
static void show_error(const char *text, size_t length, const struct grrl_term_error *error)
{
    fprintf(stderr, "grrl-term: %u:%u: %s\n", (unsigned)error->line, (unsigned)error->column,
            error->message);
    size_t begin = error->offset;
    while (begin > 0 && text[begin - 1] != '\n')
        begin--;
    fputs("  ", stderr);
    for (size_t i = begin; i < length && text[i] != '\n'; i++) {
        unsigned char c = (unsigned char)text[i];
        fputc((c < ' ' && c != '\t') || c == 127 ? '?' : c, stderr);
    }
    fputs("\n  ", stderr);
    for (size_t i = begin; i < error->offset; i++)
        if (((unsigned char)text[i] & 0xc0u) != 0x80u)
            fputc(text[i] == '\t' ? '\t' : ' ', stderr);
    fputs("^\n", stderr);
}

static bool read_standard_input(char *buffer, size_t *length)
{
    *length = fread(buffer, 1, MAX_TEXT_BYTES, stdin);
    if (ferror(stdin)) {
        fputs("grrl-term: cannot read standard input\n", stderr);
        return false;
    }
    if (*length == MAX_TEXT_BYTES) {
        fprintf(stderr, "grrl-term: a term on standard input must be shorter than %d bytes\n",
                MAX_TEXT_BYTES);
        return false;
    }
    while (*length > 0 && buffer[*length - 1] == '\n')
        --*length; /* so that an error at the end is shown in the last line */
    return true;
}

static bool read_term(const char *argument, grrl_term *term)
{
    static char buffer[MAX_TEXT_BYTES];
    const char *text = argument;
    size_t length = strlen(argument);
    if (strcmp(argument, "-") == 0) {
        text = buffer;
        if (!read_standard_input(buffer, &length))
            return false;
    }
    struct grrl_term_error error;
    if (grrl_term_parse(&store, text, length, term, &error) == GRRL_OK)
        return true;
    show_error(text, length, &error);
    return false;
}

static bool read_structure(const char *argument, struct structure *structure)
{
    grrl_term term;
    if (!read_term(argument, &term))
        return false;
    struct grrl_term_error error;
    if (grrl_graph_from_term(&store, term, &structure->graph, structure->names, structure->edges,
                             &structure->n_edges, &error) == GRRL_OK)
        return true;
    fprintf(stderr, "grrl-term: %s\n", error.message);
    return false;
}

/* --- writing ---------------------------------------------------------------------------------- */

static int fail(enum grrl_status status)
{
    fprintf(stderr, "grrl-term: %s\n", grrl_status_text(status));
    return EXIT_NO;
}

static int write_term(grrl_term term)
{
    /* a node needs at most its properties, a name and punctuation */
    static char text[MAX_NODES * 8 + MAX_TEXT_BYTES * 2];
    enum grrl_status status = grrl_term_print(&store, term, sizeof text, text, NULL);
    if (status != GRRL_OK)
        return fail(status);
    puts(text);
    return EXIT_FINE;
}

static void write_name(struct grrl_name name)
{
    char text[GRRL_NAME_BYTES];
    fputs(grrl_term_name_text(&store, name, text), stdout);
}

/* Writes each property after a space, up to the last one that exists. */
static void write_properties(grrl_label label)
{
    if (label == GRRL_LABEL_BACKGROUND)
        return;
    for (; label != 0; label >>= 8) {
        const char *symbol = grrl_term_symbol(&store, (grrl_property)(label & 0xffu));
        printf(" %s", symbol != NULL ? symbol : "_");
    }
}

static char joint_letter(const struct grrl_edge *edge)
{
    return edge->type == GRRL_REVOLUTE ? 'R' : 'P';
}

/* --- commands --------------------------------------------------------------------------------- */

static int run_parse(const struct options *options)
{
    grrl_term term;
    return read_term(options->terms[0], &term) ? write_term(term) : EXIT_NO;
}

/* Quoted, because a link may be named node or graph. */
static void write_dot_name(struct grrl_name name)
{
    putchar('"');
    write_name(name);
    putchar('"');
}

static void write_dot(const struct structure *s)
{
    puts("graph structure {");
    for (uint8_t i = 0; i < s->graph.n; i++) {
        fputs("  ", stdout);
        write_dot_name(s->names[i]);
        fputs(" [label=\"", stdout);
        write_name(s->names[i]);
        write_properties(s->graph.label[i]);
        puts("\"];");
    }
    for (uint8_t i = 0; i < s->n_edges; i++) {
        fputs("  ", stdout);
        write_dot_name(s->names[s->edges[i].a]);
        fputs(" -- ", stdout);
        write_dot_name(s->names[s->edges[i].b]);
        printf(" [label=\"%c\"];\n", joint_letter(&s->edges[i]));
    }
    puts("}");
}

static int run_graph(const struct options *options)
{
    struct structure s;
    if (!read_structure(options->terms[0], &s))
        return EXIT_NO;
    if (options->dot) {
        write_dot(&s);
        return EXIT_FINE;
    }
    for (uint8_t i = 0; i < s.graph.n; i++) {
        fputs("link ", stdout);
        write_name(s.names[i]);
        write_properties(s.graph.label[i]);
        putchar('\n');
    }
    for (uint8_t i = 0; i < s.n_edges; i++) {
        printf("joint %c ", joint_letter(&s.edges[i]));
        write_name(s.names[s.edges[i].a]);
        putchar(' ');
        write_name(s.names[s.edges[i].b]);
        putchar('\n');
    }
    return EXIT_FINE;
}

static int run_canonical(const struct options *options)
{
    struct structure s;
    if (!read_structure(options->terms[0], &s))
        return EXIT_NO;
    struct grrl_canonical canonical;
    grrl_label mask = options->ignore_properties ? GRRL_NO_PROPERTIES : GRRL_ALL_PROPERTIES;
    enum grrl_status status = grrl_canonical_of(&s.graph, mask, GRRL_CANONICAL_BUDGET, &canonical);
    if (status != GRRL_OK)
        return fail(status);
    struct grrl_name names[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < s.graph.n; i++) {
        bool background = canonical.graph.label[i] == GRRL_LABEL_BACKGROUND;
        names[i].kind = background ? GRRL_NAME_BACKGROUND : GRRL_NAME_VARIABLE;
        names[i].number = background ? 0 : (uint16_t)(i + 1);
    }
    grrl_term term;
    status = grrl_graph_to_term(&store, &canonical.graph, names, NULL, 0, false, &term);
    if (status != GRRL_OK)
        return fail(status);
    int result = write_term(term);
    printf("hash %08x\n", (unsigned)canonical.hash);
    return result;
}

/* The number of places at which some link of the graph has a property. */
static int count_places(const struct grrl_graph *graph)
{
    int n = 0;
    for (uint8_t i = 0; i < graph->n; i++)
        if (graph->label[i] != GRRL_LABEL_BACKGROUND)
            while (n < GRRL_MAX_PROPERTIES && graph->label[i] >> (8 * n) != 0)
                n++;
    return n;
}

static grrl_label keep_places(int n)
{
    return n >= 8 ? GRRL_ALL_PROPERTIES : (UINT64_C(1) << (8 * n)) - 1u;
}

/* Writes which link of A corresponds to which of B; the search's pattern is A unless swapped. */
static void write_mapping(const struct structure *a, const struct structure *b, const uint8_t *map,
                          bool swapped)
{
    const struct structure *pattern = swapped ? b : a;
    for (uint8_t i = 0; i < pattern->graph.n; i++) {
        write_name(swapped ? a->names[map[i]] : a->names[i]);
        fputs(" <-> ", stdout);
        write_name(swapped ? b->names[i] : b->names[map[i]]);
        putchar('\n');
    }
}

struct attempt {
    enum grrl_match_kind kind;
    bool swapped;
    const char *result;
};

/* Tries one kind of match with the first n_kept of n_places properties. */
static enum grrl_status try_match(const struct attempt *attempt, const struct structure *a,
                                  const struct structure *b, int n_kept, int n_places, bool all)
{
    struct grrl_match match;
    uint8_t map[GRRL_MAX_LINKS];
    grrl_match_begin(&match, attempt->kind, attempt->swapped ? &b->graph : &a->graph,
                     attempt->swapped ? &a->graph : &b->graph, keep_places(n_kept), MATCH_BUDGET);
    enum grrl_status status = grrl_match_next(&match, map);
    if (status != GRRL_OK)
        return status;
    fputs(attempt->result, stdout);
    if (n_kept < n_places)
        fputs(n_places - n_kept > 1 ? ", ignoring properties" : ", ignoring property", stdout);
    for (int place = n_places; place > n_kept; place--)
        printf(" %d", place);
    putchar('\n');
    write_mapping(a, b, map, attempt->swapped);
    while (all && (status = grrl_match_next(&match, map)) == GRRL_OK) {
        puts("or");
        write_mapping(a, b, map, attempt->swapped);
    }
    return status == GRRL_ERR_UNDECIDED ? status : GRRL_OK;
}

static int run_rules(const struct options *options)
{
    return term_store_rules(options->terms[0]) ? EXIT_FINE : EXIT_NO;
}

static int run_merge(const struct options *options)
{
    int n = options->n_terms - 1;
    bool merged = term_store_merge(options->terms, n, options->terms[n]);
    return merged ? EXIT_FINE : EXIT_NO;
}

static int run_match(const struct options *options)
{
    static const struct attempt attempts[] = {
        {GRRL_MATCH_ISOMORPHISM, false, "isomorphic"},
        {GRRL_MATCH_MONOMORPHISM, false, "A is a sub-structure of B"},
        {GRRL_MATCH_MONOMORPHISM, true, "B is a sub-structure of A"},
    };
    struct structure a;
    struct structure b;
    if (!read_structure(options->terms[0], &a) || !read_structure(options->terms[1], &b))
        return EXIT_NO;
    int places_a = count_places(&a.graph);
    int places_b = count_places(&b.graph);
    int n_places = places_a > places_b ? places_a : places_b;
    /* all isomorphisms before any monomorphism: a complete match is closer */
    for (size_t first = 0; first < 2; first++) {
        for (int n_kept = n_places; n_kept >= 0; n_kept--) {
            for (size_t i = first; i <= 2 * first; i++) {
                enum grrl_status status =
                    try_match(&attempts[i], &a, &b, n_kept, n_places, options->all);
                if (status == GRRL_OK)
                    return EXIT_FINE;
                if (status != GRRL_ERR_NONE)
                    return fail(status);
            }
        }
    }
    puts("no match");
    return EXIT_NO;
}

/* --- command line ----------------------------------------------------------------------------- */

struct command {
    const char *name;
    int n_terms; /* or files; merge takes more */
    int (*run)(const struct options *options);
};

static const struct command commands[] = {
    {"parse", 1, run_parse}, {"graph", 1, run_graph}, {"canonical", 1, run_canonical},
    {"match", 2, run_match}, {"rules", 1, run_rules}, {"merge", 3, run_merge},
};

static const struct command *find_command(const char *name)
{
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++)
        if (strcmp(name, commands[i].name) == 0)
            return &commands[i];
    return NULL;
}

/* The error in the command, its options or its terms, or NULL. */
static const char *wrong_usage(const struct command *command, const struct options *options)
{
    int n_terms = options->n_terms;
    if (command == NULL)
        return "the command is parse, graph, canonical, match, rules or merge";
    if (options->dot && command->run != run_graph)
        return "--dot requires graph";
    if (options->ignore_properties && command->run != run_canonical)
        return "--ignore-properties requires canonical";
    if (options->all && command->run != run_match)
        return "--all requires match";
    if (n_terms != command->n_terms && !(command->run == run_merge && n_terms > command->n_terms))
        return command->run == run_rules    ? "rules requires one store"
               : command->run == run_merge  ? "merge requires two or more stores and a new file"
               : n_terms < command->n_terms ? "too few terms"
                                            : "one term too many";
    if (n_terms == 2 && strcmp(options->terms[0], "-") == 0 && strcmp(options->terms[1], "-") == 0)
        return "only one term can come from standard input";
    return NULL;
}

int main(int argc, char **argv)
{
    struct options options = {0};
    const struct grrl_option rows[] = {
        grrl_option_flag("dot", "graph: for graphviz", &options.dot),
        grrl_option_flag("ignore-properties", "canonical: of the same kinematic structure",
                         &options.ignore_properties),
        grrl_option_flag("all", "match: every mapping of links", &options.all),
    };
    int first;
    enum grrl_options_result parsed =
        grrl_options_parse(&program, rows, sizeof rows / sizeof rows[0], argc, argv, &first);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    const struct command *command = first < argc ? find_command(argv[first]) : NULL;
    options.terms = argv + first + 1;
    options.n_terms = argc - first - 1;
    const char *wrong = wrong_usage(command, &options);
    if (wrong != NULL)
        return grrl_options_wrong(&program, wrong);
    grrl_term_store_init(&store, nodes, MAX_NODES);
    int result = command->run(&options);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fputs("grrl-term: cannot write standard output\n", stderr);
        return EXIT_NO;
    }
    return result;
}
