/*
 * term_private.h (private): shared by the files of the term module, with the walk that replaces
 * recursion.
 */
#ifndef GRRL_TERM_PRIVATE_H
#define GRRL_TERM_PRIVATE_H

#include <stdbool.h>

#include "base/text.h"
#include "grrl/structure/term.h"

/* The variable vn as a property is GRRL_PROPERTY_VARIABLE + n. */
enum { GRRL_PROPERTY_VARIABLE = 128, GRRL_MAX_PROPERTY_VARIABLE = 127 };

/* Maximum nodes on a path from the root. Conjunctions do not nest directly, so at most one is above
 * each relation and above the link or action at the end. */
enum { GRRL_WALK_DEPTH = 2 * GRRL_MAX_TERM_DEPTH + 3 };

/* Visits a term in reading order: enters each node, and leaves it after its arguments. */
struct grrl_walk {
    const struct grrl_term_store *store;
    grrl_term path[GRRL_WALK_DEPTH];
    int depth; /* path[depth] is the current node */
    bool entering;
    bool started;
};

void grrl_term_walk_begin(struct grrl_walk *walk, const struct grrl_term_store *store,
                          grrl_term term);

/* Moves to the next visit; false after leaving the root. */
bool grrl_term_walk_next(struct grrl_walk *walk);

static inline const struct grrl_term_node *grrl_walk_node(const struct grrl_walk *walk)
{
    return &walk->store->nodes[walk->path[walk->depth]];
}

/* Whether this is a term of the store. */
static inline bool grrl_term_valid(const struct grrl_term_store *store, grrl_term term)
{
    return term != 0 && term < store->used;
}

/* Makes a zeroed node of this kind; 0 when the store is full. */
grrl_term grrl_term_new(struct grrl_term_store *store, enum grrl_term_kind kind);

/* Appends an argument and updates the depth. *last is the previous argument or 0. */
void grrl_term_append(struct grrl_term_store *store, grrl_term parent, grrl_term *last,
                      grrl_term argument);

/* The number of places up to the last that is not "none". */
uint8_t grrl_term_trim(const grrl_property *properties, uint8_t n);

static inline bool grrl_is_lower(char c)
{
    return c >= 'a' && c <= 'z';
}

static inline bool grrl_is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static inline bool grrl_is_letter(char c)
{
    return grrl_is_lower(c) || (c >= 'A' && c <= 'Z');
}

static inline bool grrl_is_word(char c)
{
    return grrl_is_letter(c) || grrl_is_digit(c) || c == '_';
}

/* Which of the forms l3, f3, v3 and lb this word has; GRRL_NAME_NONE for any other word. */
enum grrl_name_kind grrl_term_name_form(const char *text, size_t length);

void grrl_term_print_name(const struct grrl_term_store *store, struct grrl_text *text,
                          struct grrl_name name);

#endif
