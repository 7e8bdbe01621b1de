/* Prints a term into a buffer of fixed size. */
#include "structure/term_private.h"

void grrl_term_print_name(const struct grrl_term_store *store, struct grrl_text *text,
                          struct grrl_name name)
{
    switch (name.kind) {
    case GRRL_NAME_LINK:
        grrl_text_char(text, 'l');
        break;
    case GRRL_NAME_FEATURES:
        grrl_text_char(text, 'f');
        break;
    case GRRL_NAME_VARIABLE:
        grrl_text_char(text, 'v');
        break;
    case GRRL_NAME_BACKGROUND:
        grrl_text_string(text, "lb");
        return;
    case GRRL_NAME_SYMBOL:
        grrl_text_string(text, name.number >= 1 && name.number <= store->n_names
                                   ? store->names[name.number - 1]
                                   : "?");
        return;
    default:
        grrl_text_char(text, '?');
        return;
    }
    grrl_text_number(text, name.number);
}

const char *grrl_term_name_text(const struct grrl_term_store *store, struct grrl_name name,
                                char text[GRRL_NAME_BYTES])
{
    struct grrl_text out = grrl_text_begin(text, GRRL_NAME_BYTES);
    grrl_term_print_name(store, &out, name);
    return text;
}

static void print_property(const struct grrl_term_store *store, struct grrl_text *text,
                           grrl_property property)
{
    if (property == 0) {
        grrl_text_char(text, '_');
    } else if (property >= GRRL_PROPERTY_VARIABLE) {
        grrl_text_char(text, 'v');
        grrl_text_number(text, property - (uint32_t)GRRL_PROPERTY_VARIABLE);
    } else {
        const char *symbol = grrl_term_symbol(store, property);
        grrl_text_string(text, symbol != NULL ? symbol : "?");
    }
}

static void print_link(const struct grrl_term_store *store, struct grrl_text *text,
                       const struct grrl_term_node *node)
{
    if (node->n_properties == 0) {
        grrl_term_print_name(store, text, node->name);
        return;
    }
    grrl_text_string(text, "L(");
    for (uint8_t i = 0; i < node->n_properties; i++) {
        print_property(store, text, node->properties[i]);
        grrl_text_string(text, ", ");
    }
    grrl_term_print_name(store, text, node->name);
    grrl_text_char(text, ')');
}

static void print_head(const struct grrl_term_store *store, struct grrl_text *text,
                       const struct grrl_term_node *node)
{
    switch (node->kind) {
    case GRRL_TERM_LINK:
        print_link(store, text, node);
        break;
    case GRRL_TERM_REVOLUTE:
        grrl_text_string(text, "R(");
        break;
    case GRRL_TERM_PRISMATIC:
        grrl_text_string(text, "P(");
        break;
    case GRRL_TERM_DISCONNECTED:
        grrl_text_string(text, "D(");
        break;
    case GRRL_TERM_ACTION:
        grrl_text_string(text, "A(");
        break;
    default:
        break;
    }
}

static void print_tail(struct grrl_text *text, const struct grrl_term_node *node)
{
    if (node->kind == GRRL_TERM_LINK || node->kind == GRRL_TERM_AND)
        return;
    if (node->kind == GRRL_TERM_ACTION) {
        grrl_text_string(text, ", ");
        grrl_text_number(text, grrl_direction_deg[node->direction]);
    }
    grrl_text_char(text, ')');
}

enum grrl_status grrl_term_print(const struct grrl_term_store *store, grrl_term term,
                                 size_t capacity, char *text, size_t *length)
{
    if (!grrl_term_valid(store, term) || capacity == 0)
        return GRRL_ERR_ARGUMENT;
    struct grrl_text out = grrl_text_begin(text, capacity);
    struct grrl_walk walk;
    grrl_term_walk_begin(&walk, store, term);
    while (grrl_term_walk_next(&walk)) {
        const struct grrl_term_node *node = grrl_walk_node(&walk);
        if (!walk.entering) {
            print_tail(&out, node);
            continue;
        }
        if (walk.depth > 0) {
            const struct grrl_term_node *parent = &store->nodes[walk.path[walk.depth - 1]];
            if (parent->first_argument != walk.path[walk.depth])
                grrl_text_string(&out, parent->kind == GRRL_TERM_AND ? " & " : ", ");
        }
        print_head(store, &out, node);
    }
    if (length != NULL)
        *length = out.length;
    return out.length < capacity ? GRRL_OK : GRRL_ERR_FULL;
}
