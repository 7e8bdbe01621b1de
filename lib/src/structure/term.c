/* The store of terms: makes and checks nodes, and walks over them. */
#include <assert.h>
#include <string.h>

#include "structure/term_private.h"

const uint16_t grrl_direction_deg[GRRL_DIRECTIONS] = {0, 45, 90, 180, 225, 270};

void grrl_term_store_init(struct grrl_term_store *store, struct grrl_term_node *nodes,
                          uint16_t capacity)
{
    assert(nodes != NULL && capacity >= 2);
    memset(store, 0, sizeof *store);
    store->nodes = nodes;
    store->capacity = capacity;
    store->used = 1;
    store->high_water = 1;
    store->symbols[GRRL_PROPERTY_SMALL - 1][0] = 's';
    store->symbols[GRRL_PROPERTY_LARGE - 1][0] = 'l';
    store->n_symbols = GRRL_BUILT_IN_ATOMS;
}

uint16_t grrl_term_mark(const struct grrl_term_store *store)
{
    return store->used;
}

void grrl_term_release(struct grrl_term_store *store, uint16_t mark)
{
    assert(mark >= 1 && mark <= store->used);
    store->used = mark;
}

const struct grrl_term_node *grrl_term_node_at(const struct grrl_term_store *store, grrl_term term)
{
    assert(grrl_term_valid(store, term));
    return &store->nodes[term];
}

enum grrl_name_kind grrl_term_name_form(const char *text, size_t length)
{
    if (length == 2 && text[0] == 'l' && text[1] == 'b')
        return GRRL_NAME_BACKGROUND;
    if (length < 2)
        return GRRL_NAME_NONE;
    for (size_t i = 1; i < length; i++)
        if (!grrl_is_digit(text[i]))
            return GRRL_NAME_NONE;
    switch (text[0]) {
    case 'l':
        return GRRL_NAME_LINK;
    case 'f':
        return GRRL_NAME_FEATURES;
    case 'v':
        return GRRL_NAME_VARIABLE;
    default:
        return GRRL_NAME_NONE;
    }
}

/* Whether this is an identifier that fits the store and has no reserved meaning. */
static bool is_symbol(const char *text, size_t length)
{
    if (length == 0 || length >= GRRL_SYMBOL_BYTES || !grrl_is_letter(text[0]) ||
        grrl_term_name_form(text, length) != GRRL_NAME_NONE)
        return false;
    for (size_t i = 1; i < length; i++)
        if (!grrl_is_word(text[i]))
            return false;
    return true;
}

/* Finds or adds a symbol in a table of *n and returns its number, counting from 1; 0 when the table
 * is full. */
static uint8_t find_or_add(char (*table)[GRRL_SYMBOL_BYTES], uint8_t capacity, uint8_t *n,
                           const char *text, size_t length)
{
    for (uint8_t i = 0; i < *n; i++)
        if (memcmp(table[i], text, length) == 0 && table[i][length] == '\0')
            return (uint8_t)(i + 1);
    if (*n == capacity)
        return 0;
    memcpy(table[*n], text, length);
    table[*n][length] = '\0';
    return ++*n;
}

enum grrl_status grrl_term_intern(struct grrl_term_store *store, const char *text, size_t length,
                                  grrl_property *property)
{
    if (!is_symbol(text, length) || !grrl_is_lower(text[0]))
        return GRRL_ERR_SYNTAX;
    uint8_t number = find_or_add(store->symbols, GRRL_MAX_SYMBOLS, &store->n_symbols, text, length);
    if (number == 0)
        return GRRL_ERR_FULL;
    *property = number;
    return GRRL_OK;
}

enum grrl_status grrl_term_intern_name(struct grrl_term_store *store, const char *text,
                                       size_t length, struct grrl_name *name)
{
    if (!is_symbol(text, length))
        return GRRL_ERR_SYNTAX;
    uint8_t number = find_or_add(store->names, GRRL_MAX_NAMES, &store->n_names, text, length);
    if (number == 0)
        return GRRL_ERR_FULL;
    *name = (struct grrl_name){GRRL_NAME_SYMBOL, number};
    return GRRL_OK;
}

const char *grrl_term_symbol(const struct grrl_term_store *store, grrl_property property)
{
    if (property == 0 || property > store->n_symbols)
        return NULL;
    return store->symbols[property - 1];
}

grrl_term grrl_term_new(struct grrl_term_store *store, enum grrl_term_kind kind)
{
    if (store->used == store->capacity)
        return 0;
    grrl_term term = store->used++;
    if (store->high_water < store->used)
        store->high_water = store->used;
    memset(&store->nodes[term], 0, sizeof store->nodes[term]);
    store->nodes[term].kind = (uint8_t)kind;
    return term;
}

void grrl_term_append(struct grrl_term_store *store, grrl_term parent, grrl_term *last,
                      grrl_term argument)
{
    struct grrl_term_node *node = &store->nodes[parent];
    if (*last == 0)
        node->first_argument = argument;
    else
        store->nodes[*last].next_argument = argument;
    *last = argument;
    uint8_t own = node->kind == GRRL_TERM_AND ? 0 : 1;
    uint8_t depth = (uint8_t)(store->nodes[argument].depth + own);
    if (node->depth < depth)
        node->depth = depth;
}

uint8_t grrl_term_trim(const grrl_property *properties, uint8_t n)
{
    while (n > 0 && properties[n - 1] == 0)
        n--;
    return n;
}

static bool is_name(const struct grrl_term_store *store, struct grrl_name name)
{
    switch (name.kind) {
    case GRRL_NAME_LINK:
    case GRRL_NAME_FEATURES:
    case GRRL_NAME_VARIABLE:
        return true;
    case GRRL_NAME_BACKGROUND:
        return name.number == 0;
    case GRRL_NAME_SYMBOL:
        return name.number >= 1 && name.number <= store->n_names;
    default:
        return false;
    }
}

enum grrl_status grrl_term_make_link(struct grrl_term_store *store, struct grrl_name name,
                                     const grrl_property *properties, uint8_t n, grrl_term *term)
{
    if (!is_name(store, name) || n > GRRL_MAX_PROPERTIES)
        return GRRL_ERR_ARGUMENT;
    for (uint8_t i = 0; i < n; i++)
        if (properties[i] < GRRL_PROPERTY_VARIABLE && properties[i] > store->n_symbols)
            return GRRL_ERR_ARGUMENT;
    grrl_term made = grrl_term_new(store, GRRL_TERM_LINK);
    if (made == 0)
        return GRRL_ERR_FULL;
    struct grrl_term_node *node = &store->nodes[made];
    node->name = name;
    node->n_properties = n > 0 ? grrl_term_trim(properties, n) : 0;
    for (uint8_t i = 0; i < node->n_properties; i++)
        node->properties[i] = properties[i];
    *term = made;
    return GRRL_OK;
}

/* Whether these terms may become arguments of one node: each exists, is not an action and appears
 * once (a repeated node would make the list circular). */
static bool may_be_arguments(const struct grrl_term_store *store, const grrl_term *arguments,
                             uint16_t n)
{
    for (uint16_t i = 0; i < n; i++) {
        if (!grrl_term_valid(store, arguments[i]) ||
            store->nodes[arguments[i]].kind == GRRL_TERM_ACTION)
            return false;
        for (uint16_t j = 0; j < i; j++)
            if (arguments[j] == arguments[i])
                return false;
    }
    return true;
}

enum grrl_status grrl_term_make(struct grrl_term_store *store, enum grrl_term_kind kind,
                                const grrl_term *arguments, uint16_t n, grrl_term *term)
{
    if (kind < GRRL_TERM_REVOLUTE || kind > GRRL_TERM_AND || n < 2 ||
        !may_be_arguments(store, arguments, n))
        return GRRL_ERR_ARGUMENT;
    if (kind != GRRL_TERM_AND)
        for (uint16_t i = 0; i < n; i++)
            if (store->nodes[arguments[i]].depth >= GRRL_MAX_TERM_DEPTH)
                return GRRL_ERR_FULL;
    grrl_term made = grrl_term_new(store, kind);
    if (made == 0)
        return GRRL_ERR_FULL;
    grrl_term last = 0;
    for (uint16_t i = 0; i < n; i++) {
        const struct grrl_term_node *argument = &store->nodes[arguments[i]];
        store->nodes[arguments[i]].next_argument = 0;
        if (kind != GRRL_TERM_AND || argument->kind != GRRL_TERM_AND) {
            grrl_term_append(store, made, &last, arguments[i]);
            continue;
        }
        grrl_term part = argument->first_argument;
        while (part != 0) {
            grrl_term next = store->nodes[part].next_argument;
            grrl_term_append(store, made, &last, part);
            part = next;
        }
    }
    *term = made;
    return GRRL_OK;
}

enum grrl_status grrl_term_make_action(struct grrl_term_store *store, grrl_term link,
                                       uint8_t direction, grrl_term *term)
{
    if (!grrl_term_valid(store, link) || store->nodes[link].kind != GRRL_TERM_LINK ||
        direction >= GRRL_DIRECTIONS)
        return GRRL_ERR_ARGUMENT;
    grrl_term made = grrl_term_new(store, GRRL_TERM_ACTION);
    if (made == 0)
        return GRRL_ERR_FULL;
    store->nodes[link].next_argument = 0;
    store->nodes[made].direction = direction;
    store->nodes[made].first_argument = link;
    *term = made;
    return GRRL_OK;
}

void grrl_term_walk_begin(struct grrl_walk *walk, const struct grrl_term_store *store,
                          grrl_term term)
{
    walk->store = store;
    walk->path[0] = term;
    walk->depth = 0;
    walk->entering = true;
    walk->started = false;
}

bool grrl_term_walk_next(struct grrl_walk *walk)
{
    if (!walk->started) {
        walk->started = true;
        return true;
    }
    const struct grrl_term_node *node = grrl_walk_node(walk);
    if (walk->entering) {
        if (node->first_argument != 0) {
            assert(walk->depth + 1 < GRRL_WALK_DEPTH);
            walk->path[++walk->depth] = node->first_argument;
        } else {
            walk->entering = false;
        }
        return true;
    }
    if (walk->depth == 0)
        return false; /* a sibling of the root is not part of the term */
    if (node->next_argument != 0) {
        walk->path[walk->depth] = node->next_argument;
        walk->entering = true;
    } else {
        walk->depth--;
    }
    return true;
}
