/*
 * term.h: relational terms in fixed memory (paper, section III).
 *
 *   link       L(p1, .., pk, name), k >= 0, or a bare name
 *   name       f3 (a grounding set of features), v3 (a variable), l3 (a link by number), lb
 *              (background), or any other identifier: blade1, Left
 *   property   an atom such as s (small) or l (large), a variable v3, or _ for none; its place is
 *              its meaning: the first property is the size
 *   relation   R(x, y, ..) revolute, P(x, y, ..) prismatic, D(x, y, ..) disconnected, n >= 2;
 *              R(x, y, z) means R(x, y) & R(x, z)
 *   and        x & y & ..
 *   action     A(link, direction), the direction one of 0, 45, 90, 180, 225, 270 degrees; it
 *              stands alone
 *
 * An identifier is a letter followed by letters, digits and underscores, shorter than
 * GRRL_SYMBOL_BYTES. Its place determines its role. The last word in L(..) is the name, as is a
 * word without L(..); the words before it are properties. So L(s, l) is a small link named l, while
 * L(s) and s are a link named s. A letter is a relation only before '(': R(R, P) joins the links R
 * and P.
 *
 * A joint connects the link written last in its first argument with the link written first in each
 * further argument. graph.h converts a term to the graph it describes, and back.
 *
 * Order of calls: grrl_term_store_init, then parse or make, print, unify, substitute. A store is a
 * stack of nodes: grrl_term_mark returns its height, and grrl_term_release removes everything
 * newer. A term is the number of a node in its store; zero is no term.
 */
#ifndef GRRL_TERM_H
#define GRRL_TERM_H

#include <stddef.h>
#include <stdint.h>

#include "grrl/base/api.h"
#include "grrl/base/config.h"
#include "grrl/base/status.h"

GRRL_API_BEGIN

#define grrl_term_store_init GRRL_SIZED(grrl_term_store_init)

typedef uint16_t grrl_term;

enum grrl_term_kind {
    GRRL_TERM_LINK = 1,
    GRRL_TERM_REVOLUTE,
    GRRL_TERM_PRISMATIC,
    GRRL_TERM_DISCONNECTED,
    GRRL_TERM_AND,
    GRRL_TERM_ACTION
};

enum grrl_name_kind {
    GRRL_NAME_NONE = 0,
    GRRL_NAME_LINK,       /* l3 */
    GRRL_NAME_FEATURES,   /* f3 */
    GRRL_NAME_VARIABLE,   /* v3 */
    GRRL_NAME_BACKGROUND, /* lb */
    GRRL_NAME_SYMBOL      /* blade1 */
};

/* Distinct identifiers a store can hold as names: enough for two structures to be matched. */
enum { GRRL_MAX_NAMES = 2 * GRRL_MAX_LINKS };

/* A name as text with the terminating zero: an identifier, or f65535. */
enum { GRRL_NAME_BYTES = GRRL_SYMBOL_BYTES > 7 ? GRRL_SYMBOL_BYTES : 7 };

/* The name of a link. The number is 0 for the background; for an identifier the
 * store assigns it. */
struct grrl_name {
    uint16_t kind; /* enum grrl_name_kind */
    uint16_t number;
};

/* A property: 0 is none, 1 .. 127 an atom of the store, 128 + n the variable vn (n <= 127). */
typedef uint8_t grrl_property;

/* The atoms that every store knows from the start, and how many there are. */
enum { GRRL_PROPERTY_SMALL = 1, GRRL_PROPERTY_LARGE, GRRL_BUILT_IN_ATOMS = GRRL_PROPERTY_LARGE };

/* The six directions of the paper, measured from the link's principal axis. */
enum { GRRL_DIRECTIONS = 6 };
extern const uint16_t grrl_direction_deg[GRRL_DIRECTIONS];

struct grrl_term_node {
    uint8_t kind; /* enum grrl_term_kind */
    uint8_t n_properties;
    uint8_t direction; /* of an action: an index into grrl_direction_deg */
    uint8_t depth;     /* relations nested in this term, itself included */
    grrl_property properties[GRRL_MAX_PROPERTIES];
    struct grrl_name name;
    grrl_term first_argument;
    grrl_term next_argument;
};

struct grrl_term_store {
    /* private */
    struct grrl_term_node *nodes; /* nodes[0] is never used */
    uint16_t capacity;
    uint16_t used;
    uint16_t high_water;
    uint8_t n_symbols;
    uint8_t n_names;
    char symbols[GRRL_MAX_SYMBOLS][GRRL_SYMBOL_BYTES];
    char names[GRRL_MAX_NAMES]
              [GRRL_SYMBOL_BYTES]; /* separate, so that names do not use up property numbers */
};

/* Where a text stops being a term: byte offset from 0, line and column (in characters) from 1. */
struct grrl_term_error {
    size_t offset;
    uint32_t line;
    uint32_t column;
    char message[120]; /* what was expected and what was found */
};

/* Variables bound to names (of links) or to properties. */
struct grrl_substitution {
    uint16_t n;
    struct {
        uint16_t variable; /* the n of vn */
        uint8_t is_property;
        grrl_property property;
        struct grrl_name name;
    } binding[2 * GRRL_MAX_LINKS];
};

/* Initialises a store with `capacity` nodes of the caller, capacity >= 2; node 0 stays unused. Adds
 * the atoms s and l. */
void grrl_term_store_init(struct grrl_term_store *store, struct grrl_term_node *nodes,
                          uint16_t capacity);

uint16_t grrl_term_mark(const struct grrl_term_store *store);
void grrl_term_release(struct grrl_term_store *store, uint16_t mark);

/* The node of a term, which must belong to this store. */
const struct grrl_term_node *grrl_term_node_at(const struct grrl_term_store *store, grrl_term term);

/*
 * Finds the number of an atom. A new atom is added and kept until grrl_term_store_init. An atom is
 * an identifier that starts with a lower-case letter and is not of the form l3, f3, v3 or lb.
 * GRRL_ERR_SYNTAX, GRRL_ERR_FULL.
 */
GRRL_MUST_USE enum grrl_status grrl_term_intern(struct grrl_term_store *store, const char *text,
                                                size_t length, grrl_property *property);

/* The text of an atom; NULL for none or a variable. */
const char *grrl_term_symbol(const struct grrl_term_store *store, grrl_property property);

/*
 * Finds the name for an identifier. A new name is added and kept until grrl_term_store_init.
 * GRRL_ERR_SYNTAX, also for the forms l3, f3, v3 and lb, which need no store; GRRL_ERR_FULL at
 * GRRL_MAX_NAMES.
 */
GRRL_MUST_USE enum grrl_status grrl_term_intern_name(struct grrl_term_store *store,
                                                     const char *text, size_t length,
                                                     struct grrl_name *name);

/* Writes a name of this store as it appears in a term, or "?" if it is not one. Returns text. */
const char *grrl_term_name_text(const struct grrl_term_store *store, struct grrl_name name,
                                char text[GRRL_NAME_BYTES]);

/* Makes a link. properties may be NULL if n is 0; trailing "none" properties are dropped. */
GRRL_MUST_USE enum grrl_status grrl_term_make_link(struct grrl_term_store *store,
                                                   struct grrl_name name,
                                                   const grrl_property *properties, uint8_t n,
                                                   grrl_term *term);

/*
 * Makes a relation or conjunction over n >= 2 argument terms, and takes ownership of them. A node
 * has one parent, so an argument used twice must be made twice (or copied by substitution). A
 * conjunction inside a conjunction is flattened into the outer one. GRRL_ERR_ARGUMENT if an
 * argument is an action; GRRL_ERR_FULL, also beyond GRRL_MAX_TERM_DEPTH.
 */
GRRL_MUST_USE enum grrl_status grrl_term_make(struct grrl_term_store *store,
                                              enum grrl_term_kind kind, const grrl_term *arguments,
                                              uint16_t n, grrl_term *term);

/* Makes an action. direction: an index into grrl_direction_deg. */
GRRL_MUST_USE enum grrl_status grrl_term_make_action(struct grrl_term_store *store, grrl_term link,
                                                     uint8_t direction, grrl_term *term);

/*
 * Reads one term from `length` bytes of UTF-8. White space is ignored; a direction may carry a
 * degree sign. On failure the store is unchanged and *error, if not NULL, says where and what was
 * expected. GRRL_ERR_SYNTAX, GRRL_ERR_FULL. Cost: linear in length.
 */
GRRL_MUST_USE enum grrl_status grrl_term_parse(struct grrl_term_store *store, const char *text,
                                               size_t length, grrl_term *term,
                                               struct grrl_term_error *error);

/*
 * Writes the term with its terminating zero. *length is set to the length of the whole text without
 * the zero, even if `capacity` is too small (GRRL_ERR_FULL; the text is truncated). capacity >= 1;
 * length may be NULL.
 */
GRRL_MUST_USE enum grrl_status grrl_term_print(const struct grrl_term_store *store, grrl_term term,
                                               size_t capacity, char *text, size_t *length);

/*
 * Unifies two terms of the same shape: same relations, same arity, same order. Names and properties
 * must be equal, or one of the two must be a variable, which is then bound. Bit i of
 * ignored_properties drops the property at place i on both sides. Extends *substitution (start with
 * n = 0); on failure it is unchanged. GRRL_ERR_NONE if they do not unify. Paper, section V-D.
 */
GRRL_MUST_USE enum grrl_status grrl_term_unify(const struct grrl_term_store *store, grrl_term a,
                                               grrl_term b, uint32_t ignored_properties,
                                               struct grrl_substitution *substitution);

/* Copies the term, replacing every bound variable. */
GRRL_MUST_USE enum grrl_status grrl_term_substitute(struct grrl_term_store *store, grrl_term term,
                                                    const struct grrl_substitution *substitution,
                                                    grrl_term *copy);

GRRL_API_END

#endif
