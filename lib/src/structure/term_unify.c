/* Unifies two terms, and substitutes variables. */
#include "structure/term_private.h"

static bool same_name(struct grrl_name a, struct grrl_name b)
{
    return a.kind == b.kind && a.number == b.number;
}

/* The index of a variable's binding; n if it is free. */
static uint16_t find_binding(const struct grrl_substitution *substitution, uint16_t variable,
                             bool is_property)
{
    uint16_t i = 0;
    while (i < substitution->n && (substitution->binding[i].variable != variable ||
                                   (substitution->binding[i].is_property != 0) != is_property))
        i++;
    return i;
}

/* Follows bindings to a name that is not a bound variable. Unification produces no cycles; the
 * counter stops the loop for a hand-made substitution with one. */
static struct grrl_name resolve_name(const struct grrl_substitution *substitution,
                                     struct grrl_name name)
{
    for (uint16_t step = 0; step < substitution->n && name.kind == GRRL_NAME_VARIABLE; step++) {
        uint16_t i = find_binding(substitution, name.number, false);
        if (i == substitution->n)
            break;
        name = substitution->binding[i].name;
    }
    return name;
}

static grrl_property resolve_property(const struct grrl_substitution *substitution,
                                      grrl_property property)
{
    for (uint16_t step = 0; step < substitution->n && property >= GRRL_PROPERTY_VARIABLE; step++) {
        uint16_t variable = (uint16_t)(property - GRRL_PROPERTY_VARIABLE);
        uint16_t i = find_binding(substitution, variable, true);
        if (i == substitution->n)
            break;
        property = substitution->binding[i].property;
    }
    return property;
}

enum { MAX_BINDINGS = 2 * GRRL_MAX_LINKS };

static enum grrl_status unify_names(struct grrl_substitution *substitution, struct grrl_name a,
                                    struct grrl_name b)
{
    a = resolve_name(substitution, a);
    b = resolve_name(substitution, b);
    if (same_name(a, b))
        return GRRL_OK;
    if (a.kind != GRRL_NAME_VARIABLE) {
        struct grrl_name other = a;
        a = b;
        b = other;
    }
    if (a.kind != GRRL_NAME_VARIABLE)
        return GRRL_ERR_NONE;
    if (substitution->n == MAX_BINDINGS)
        return GRRL_ERR_FULL;
    uint16_t i = substitution->n++;
    substitution->binding[i].variable = a.number;
    substitution->binding[i].is_property = 0;
    substitution->binding[i].property = 0;
    substitution->binding[i].name = b;
    return GRRL_OK;
}

/* A variable stands for an existing property, so it does not unify with none. */
static enum grrl_status unify_properties(struct grrl_substitution *substitution, grrl_property a,
                                         grrl_property b)
{
    a = resolve_property(substitution, a);
    b = resolve_property(substitution, b);
    if (a == b)
        return GRRL_OK;
    if (a < GRRL_PROPERTY_VARIABLE) {
        grrl_property other = a;
        a = b;
        b = other;
    }
    if (a < GRRL_PROPERTY_VARIABLE || b == 0)
        return GRRL_ERR_NONE;
    if (substitution->n == MAX_BINDINGS)
        return GRRL_ERR_FULL;
    uint16_t i = substitution->n++;
    substitution->binding[i].variable = (uint16_t)(a - GRRL_PROPERTY_VARIABLE);
    substitution->binding[i].is_property = 1;
    substitution->binding[i].property = b;
    substitution->binding[i].name = (struct grrl_name){GRRL_NAME_NONE, 0};
    return GRRL_OK;
}

static enum grrl_status unify_nodes(struct grrl_substitution *substitution,
                                    const struct grrl_term_node *a, const struct grrl_term_node *b,
                                    uint32_t ignored_properties)
{
    if (a->kind != b->kind || a->direction != b->direction)
        return GRRL_ERR_NONE;
    if (a->kind != GRRL_TERM_LINK)
        return GRRL_OK;
    for (uint8_t i = 0; i < a->n_properties || i < b->n_properties; i++) {
        if ((ignored_properties >> i & 1u) != 0)
            continue;
        grrl_property in_a = i < a->n_properties ? a->properties[i] : 0;
        grrl_property in_b = i < b->n_properties ? b->properties[i] : 0;
        enum grrl_status status = unify_properties(substitution, in_a, in_b);
        if (status != GRRL_OK)
            return status;
    }
    return unify_names(substitution, a->name, b->name);
}

enum grrl_status grrl_term_unify(const struct grrl_term_store *store, grrl_term a, grrl_term b,
                                 uint32_t ignored_properties,
                                 struct grrl_substitution *substitution)
{
    if (!grrl_term_valid(store, a) || !grrl_term_valid(store, b))
        return GRRL_ERR_ARGUMENT;
    uint16_t n_before = substitution->n;
    struct grrl_walk in_a;
    struct grrl_walk in_b;
    grrl_term_walk_begin(&in_a, store, a);
    grrl_term_walk_begin(&in_b, store, b);
    for (;;) {
        bool more = grrl_term_walk_next(&in_a);
        if (!grrl_term_walk_next(&in_b) || !more)
            return GRRL_OK; /* both terms have the same shape, so both walks end together */
        enum grrl_status status = GRRL_OK;
        if (in_a.depth != in_b.depth || in_a.entering != in_b.entering)
            status = GRRL_ERR_NONE; /* different number of arguments */
        else if (in_a.entering)
            status = unify_nodes(substitution, grrl_walk_node(&in_a), grrl_walk_node(&in_b),
                                 ignored_properties);
        if (status != GRRL_OK) {
            substitution->n = n_before;
            return status;
        }
    }
}

static void substitute_link(struct grrl_term_node *node,
                            const struct grrl_substitution *substitution)
{
    node->name = resolve_name(substitution, node->name);
    for (uint8_t i = 0; i < node->n_properties; i++)
        node->properties[i] = resolve_property(substitution, node->properties[i]);
}

enum grrl_status grrl_term_substitute(struct grrl_term_store *store, grrl_term term,
                                      const struct grrl_substitution *substitution, grrl_term *copy)
{
    if (!grrl_term_valid(store, term))
        return GRRL_ERR_ARGUMENT;
    uint16_t mark = grrl_term_mark(store);
    grrl_term made[GRRL_WALK_DEPTH]; /* per node on the path: the copy and its last argument */
    grrl_term last[GRRL_WALK_DEPTH];
    struct grrl_walk walk;
    grrl_term_walk_begin(&walk, store, term);
    while (grrl_term_walk_next(&walk)) {
        if (!walk.entering)
            continue;
        const struct grrl_term_node *node = grrl_walk_node(&walk);
        grrl_term fresh = grrl_term_new(store, (enum grrl_term_kind)node->kind);
        if (fresh == 0) {
            grrl_term_release(store, mark);
            return GRRL_ERR_FULL;
        }
        store->nodes[fresh] = *node;
        store->nodes[fresh].first_argument = 0;
        store->nodes[fresh].next_argument = 0;
        if (node->kind == GRRL_TERM_LINK)
            substitute_link(&store->nodes[fresh], substitution);
        made[walk.depth] = fresh;
        last[walk.depth] = 0;
        if (walk.depth > 0) {
            int parent = walk.depth - 1;
            if (last[parent] == 0)
                store->nodes[made[parent]].first_argument = fresh;
            else
                store->nodes[last[parent]].next_argument = fresh;
            last[parent] = fresh;
        }
    }
    *copy = made[0];
    return GRRL_OK;
}
