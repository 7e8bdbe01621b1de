/* Parses a term with an explicit stack, and reports where it is wrong. */
#include <string.h>

#include "structure/term_private.h"

enum { MAX_FOUND_BYTES = 24 }; /* longest quote of a word in a message */

/* A relation whose arguments are being read, or the whole text. */
struct frame {
    grrl_term relation; /* 0 for the whole text */
    grrl_term last;     /* the last complete argument; 0 if there is none */
    uint16_t n_arguments;
    grrl_term current;   /* the argument being read: a term, or the conjunction so far */
    grrl_term last_part; /* the last part of that conjunction; 0 if there is none */
};

struct parser {
    struct grrl_term_store *store;
    const char *text;
    size_t length;
    size_t at;
    struct grrl_term_error *error;
    struct frame frames[GRRL_MAX_TERM_DEPTH + 1];
    int depth;
};

/* Fills in the position. The caller appends the message to the returned text. */
static struct grrl_text error_at(struct parser *parser, size_t at)
{
    struct grrl_term_error *error = parser->error;
    error->offset = at;
    error->line = 1;
    error->column = 1;
    for (size_t i = 0; i < at; i++) {
        if (parser->text[i] == '\n') {
            error->line++;
            error->column = 1;
        } else if (((unsigned char)parser->text[i] & 0xc0u) != 0x80u) {
            error->column++; /* counts characters, not continuation bytes */
        }
    }
    return grrl_text_begin(error->message, sizeof error->message);
}

static size_t word_end(const struct parser *parser, size_t at)
{
    while (at < parser->length && grrl_is_word(parser->text[at]))
        at++;
    return at;
}

static void describe_found(const struct parser *parser, size_t at, struct grrl_text *message)
{
    static const char hex[] = "0123456789abcdef";
    if (at >= parser->length) {
        grrl_text_string(message, "the end of the text");
        return;
    }
    unsigned char c = (unsigned char)parser->text[at];
    if (c == '\0') {
        grrl_text_string(message, "a zero byte");
    } else if (c < ' ' || c > '~') {
        grrl_text_string(message, "the byte 0x");
        grrl_text_char(message, hex[c >> 4]);
        grrl_text_char(message, hex[c & 15u]);
    } else {
        size_t end = word_end(parser, at);
        size_t n = end > at ? end - at : 1;
        grrl_text_char(message, '\'');
        grrl_text_bytes(message, parser->text + at, n < MAX_FOUND_BYTES ? n : MAX_FOUND_BYTES);
        grrl_text_string(message, n <= MAX_FOUND_BYTES ? "'" : "..'");
    }
}

static enum grrl_status reject(struct parser *parser, size_t at, enum grrl_status status,
                               const char *why)
{
    struct grrl_text message = error_at(parser, at);
    grrl_text_string(&message, why);
    return status;
}

static enum grrl_status unexpected(struct parser *parser, size_t at, const char *expected)
{
    struct grrl_text message = error_at(parser, at);
    grrl_text_string(&message, "expected ");
    grrl_text_string(&message, expected);
    grrl_text_string(&message, ", found ");
    describe_found(parser, at, &message);
    return GRRL_ERR_SYNTAX;
}

static enum grrl_status holds_only(struct parser *parser, size_t at, uint32_t n, const char *what)
{
    struct grrl_text message = error_at(parser, at);
    grrl_text_string(&message, "the term store is full: it holds ");
    grrl_text_number(&message, n);
    grrl_text_string(&message, what);
    return GRRL_ERR_FULL;
}

static enum grrl_status store_full(struct parser *parser, size_t at)
{
    return holds_only(parser, at, parser->store->capacity - 1u, " nodes");
}

static enum grrl_status too_long(struct parser *parser, size_t at, const char *what)
{
    struct grrl_text message = error_at(parser, at);
    grrl_text_string(&message, "the word is too long for ");
    grrl_text_string(&message, what);
    grrl_text_string(&message, ", which has at most ");
    grrl_text_number(&message, GRRL_SYMBOL_BYTES - 1u);
    grrl_text_string(&message, " characters");
    return GRRL_ERR_SYNTAX;
}

static void skip_space(struct parser *parser)
{
    while (parser->at < parser->length) {
        char c = parser->text[parser->at];
        if (c != ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\v' && c != '\f')
            return;
        parser->at++;
    }
}

/* The next character after white space; '\0' at the end (and for a zero byte, which is never
 * valid). */
static char peek(struct parser *parser)
{
    skip_space(parser);
    if (parser->at == parser->length)
        return '\0';
    return parser->text[parser->at];
}

static bool accept(struct parser *parser, char c)
{
    if (c != peek(parser))
        return false;
    parser->at++;
    return true;
}

/* The digits from..end as a number; limit + 1 for any number above the limit. */
static uint32_t read_number(const struct parser *parser, size_t from, size_t end, uint32_t limit)
{
    uint32_t number = 0;
    for (size_t i = from; i < end && number <= limit; i++)
        number = number * 10 + (uint32_t)(parser->text[i] - '0');
    return number <= limit ? number : limit + 1;
}

static enum grrl_status read_identifier(struct parser *parser, size_t from, size_t end,
                                        const char *expected, struct grrl_name *name)
{
    if (end == from || !grrl_is_letter(parser->text[from]))
        return unexpected(parser, from, expected);
    switch (grrl_term_intern_name(parser->store, parser->text + from, end - from, name)) {
    case GRRL_OK:
        return GRRL_OK;
    case GRRL_ERR_FULL:
        return holds_only(parser, from, GRRL_MAX_NAMES, " identifiers as names");
    default:
        return too_long(parser, from, "a name");
    }
}

/* Reads a name from the word from..end; `expected` describes what the message asks
 * for otherwise. */
static enum grrl_status read_name(struct parser *parser, size_t from, size_t end,
                                  const char *expected, struct grrl_name *name)
{
    enum grrl_name_kind kind = grrl_term_name_form(parser->text + from, end - from);
    if (kind == GRRL_NAME_NONE)
        return read_identifier(parser, from, end, expected, name);
    uint32_t number = 0;
    if (kind != GRRL_NAME_BACKGROUND)
        number = read_number(parser, from + 1, end, UINT16_MAX);
    if (number > UINT16_MAX)
        return reject(parser, from, GRRL_ERR_SYNTAX, "the number of a name is at most 65535");
    name->kind = (uint16_t)kind;
    name->number = (uint16_t)number;
    return GRRL_OK;
}

/* Reads a property from the word from..end: an atom, a variable or "_". */
static enum grrl_status read_property(struct parser *parser, size_t from, size_t end,
                                      grrl_property *property)
{
    const char *word = parser->text + from;
    enum grrl_name_kind kind = grrl_term_name_form(word, end - from);
    if (kind == GRRL_NAME_VARIABLE) {
        uint32_t number = read_number(parser, from + 1, end, GRRL_MAX_PROPERTY_VARIABLE);
        if (number > GRRL_MAX_PROPERTY_VARIABLE)
            return reject(parser, from, GRRL_ERR_SYNTAX,
                          "the number of a property variable is at most 127");
        *property = (grrl_property)(GRRL_PROPERTY_VARIABLE + number);
        return GRRL_OK;
    }
    if (kind != GRRL_NAME_NONE)
        return unexpected(parser, from, "a property (the name comes last in a link)");
    if (end - from == 1 && word[0] == '_') {
        *property = 0;
        return GRRL_OK;
    }
    if (!grrl_is_lower(word[0]))
        return unexpected(parser, from, "a property, which begins with a lower-case letter");
    switch (grrl_term_intern(parser->store, word, end - from, property)) {
    case GRRL_OK:
        return GRRL_OK;
    case GRRL_ERR_FULL:
        return reject(parser, from, GRRL_ERR_FULL, "the store has no room for another property");
    default:
        return too_long(parser, from, "a property");
    }
}

static enum grrl_status make_link(struct parser *parser, size_t at, struct grrl_name name,
                                  const grrl_property *properties, uint8_t n, grrl_term *term)
{
    if (grrl_term_make_link(parser->store, name, properties, n, term) != GRRL_OK)
        return store_full(parser, at);
    return GRRL_OK;
}

/* Reads what follows "L(": properties, the name and a ')'. */
static enum grrl_status read_link(struct parser *parser, size_t begin, grrl_term *term)
{
    grrl_property properties[GRRL_MAX_PROPERTIES];
    uint8_t n = 0;
    for (;;) {
        skip_space(parser);
        size_t from = parser->at;
        size_t end = word_end(parser, from);
        if (end == from)
            return unexpected(parser, from, "a property or the name of a link");
        parser->at = end;
        if (accept(parser, ',')) {
            if (n == GRRL_MAX_PROPERTIES)
                return reject(parser, from, GRRL_ERR_FULL, "too many properties for one link");
            enum grrl_status status = read_property(parser, from, end, &properties[n]);
            if (status != GRRL_OK)
                return status;
            n++;
            continue;
        }
        if (!accept(parser, ')'))
            return unexpected(parser, parser->at, "',' after a property or ')' after a name");
        struct grrl_name name;
        enum grrl_status status = read_name(
            parser, from, end, "a name such as f1, v1, l1 or blade1 at the end of a link", &name);
        return status != GRRL_OK ? status : make_link(parser, begin, name, properties, n, term);
    }
}

/* A word at the start of a term. If '(' follows, the word is a head and must be a relation's
 * letter. */
struct word {
    size_t from;
    size_t end;
    bool is_head;
    char letter; /* of a one-letter head, '\0' otherwise */
};

/* Reads the word, and the '(' of a head. */
static struct word read_word(struct parser *parser)
{
    skip_space(parser);
    struct word word = {.from = parser->at, .end = word_end(parser, parser->at)};
    parser->at = word.end;
    word.is_head = word.end > word.from && accept(parser, '(');
    if (word.is_head && word.end - word.from == 1)
        word.letter = parser->text[word.from];
    return word;
}

/* Reads the word as L(..) or a bare name. */
static enum grrl_status read_link_or_name(struct parser *parser, struct word word,
                                          const char *expected, grrl_term *term)
{
    if (word.letter == 'L')
        return read_link(parser, word.from, term);
    if (word.is_head)
        return unexpected(parser, word.from, expected);
    struct grrl_name name;
    enum grrl_status status = read_name(parser, word.from, word.end, expected, &name);
    return status != GRRL_OK ? status : make_link(parser, word.from, name, NULL, 0, term);
}

static enum grrl_status read_direction(struct parser *parser, uint8_t *direction)
{
    static const char expected[] = "a direction: 0, 45, 90, 180, 225 or 270";
    skip_space(parser);
    size_t from = parser->at;
    size_t end = from;
    while (end < parser->length && grrl_is_digit(parser->text[end]))
        end++;
    uint32_t degrees = read_number(parser, from, end, 360);
    *direction = 0;
    while (*direction < GRRL_DIRECTIONS && grrl_direction_deg[*direction] != degrees)
        (*direction)++;
    if (end == from || end != word_end(parser, from) || *direction == GRRL_DIRECTIONS)
        return unexpected(parser, from, expected);
    parser->at = end;
    if (peek(parser) == '\xc2' && parser->length - parser->at >= 2 &&
        parser->text[parser->at + 1] == '\xb0')
        parser->at += 2; /* the degree sign in UTF-8 */
    return GRRL_OK;
}

/* Reads what follows the "A(" of an action, which must be the whole text. */
static enum grrl_status read_action(struct parser *parser, size_t begin, grrl_term *term)
{
    if (parser->depth > 0 || parser->frames[0].current != 0)
        return reject(parser, begin, GRRL_ERR_SYNTAX, "an action cannot be part of another term");
    grrl_term link;
    enum grrl_status status =
        read_link_or_name(parser, read_word(parser), "a link as the first argument of A", &link);
    if (status != GRRL_OK)
        return status;
    if (!accept(parser, ','))
        return unexpected(parser, parser->at, "',' after the link of an action");
    uint8_t direction;
    status = read_direction(parser, &direction);
    if (status != GRRL_OK)
        return status;
    if (!accept(parser, ')'))
        return unexpected(parser, parser->at, "')' after the direction of an action");
    if (grrl_term_make_action(parser->store, link, direction, term) != GRRL_OK)
        return store_full(parser, begin);
    peek(parser);
    if (parser->at < parser->length)
        return unexpected(parser, parser->at, "the end of the text after an action");
    return GRRL_OK;
}

static enum grrl_term_kind relation_of(char letter)
{
    switch (letter) {
    case 'R':
        return GRRL_TERM_REVOLUTE;
    case 'P':
        return GRRL_TERM_PRISMATIC;
    case 'D':
        return GRRL_TERM_DISCONNECTED;
    default:
        return GRRL_TERM_AND;
    }
}

/* Reads links and opens relations until one term is complete. */
static enum grrl_status read_operand(struct parser *parser, grrl_term *term)
{
    for (;;) {
        struct word word = read_word(parser);
        if (word.letter == 'A')
            return read_action(parser, word.from, term);
        if (word.is_head && word.letter != 'L' && relation_of(word.letter) == GRRL_TERM_AND)
            return unexpected(parser, word.from, "R, P, D, L or A before '('");
        if (relation_of(word.letter) == GRRL_TERM_AND)
            return read_link_or_name(parser, word, "a link or one of R, P, D, A", term);
        if (parser->depth == GRRL_MAX_TERM_DEPTH)
            return reject(parser, word.from, GRRL_ERR_FULL, "relations nest too deeply");
        struct frame *frame = &parser->frames[++parser->depth];
        memset(frame, 0, sizeof *frame);
        frame->relation = grrl_term_new(parser->store, relation_of(word.letter));
        if (frame->relation == 0)
            return store_full(parser, word.from);
    }
}

/* Makes a complete term the current argument, or adds it to the conjunction after an '&'. */
static enum grrl_status take_operand(struct parser *parser, grrl_term term)
{
    struct frame *frame = &parser->frames[parser->depth];
    if (frame->current == 0) {
        frame->current = term;
        return GRRL_OK;
    }
    if (frame->last_part == 0) {
        grrl_term conjunction = grrl_term_new(parser->store, GRRL_TERM_AND);
        if (conjunction == 0)
            return store_full(parser, parser->at);
        grrl_term_append(parser->store, conjunction, &frame->last_part, frame->current);
        frame->current = conjunction;
    }
    grrl_term_append(parser->store, frame->current, &frame->last_part, term);
    return GRRL_OK;
}

/* Ends the current argument: appends it to its relation. */
static void end_argument(struct parser *parser)
{
    struct frame *frame = &parser->frames[parser->depth];
    grrl_term_append(parser->store, frame->relation, &frame->last, frame->current);
    frame->n_arguments++;
    frame->current = 0;
    frame->last_part = 0;
}

/* Closes every relation that ends here and sets *done at the end of the text. Otherwise an operand
 * follows. */
static enum grrl_status read_punctuation(struct parser *parser, bool *done)
{
    for (;;) {
        *done = false;
        if (accept(parser, '&'))
            return GRRL_OK;
        if (parser->depth == 0) {
            *done = true;
            if (parser->at < parser->length)
                return unexpected(parser, parser->at, "'&' or the end of the text");
            return GRRL_OK;
        }
        if (accept(parser, ',')) {
            end_argument(parser);
            return GRRL_OK;
        }
        size_t at = parser->at;
        if (!accept(parser, ')'))
            return unexpected(parser, at, "',', ')' or '&' after an argument of a relation");
        end_argument(parser);
        const struct frame *frame = &parser->frames[parser->depth];
        if (frame->n_arguments < 2)
            return unexpected(parser, at, "',' and another argument: a relation has two or more");
        parser->depth--;
        enum grrl_status status = take_operand(parser, frame->relation);
        if (status != GRRL_OK)
            return status;
    }
}

static enum grrl_status parse(struct parser *parser)
{
    bool done = false;
    while (!done) {
        grrl_term term;
        enum grrl_status status = read_operand(parser, &term);
        if (status == GRRL_OK)
            status = take_operand(parser, term);
        if (status == GRRL_OK)
            status = read_punctuation(parser, &done);
        if (status != GRRL_OK)
            return status;
    }
    return GRRL_OK;
}

enum grrl_status grrl_term_parse(struct grrl_term_store *store, const char *text, size_t length,
                                 grrl_term *term, struct grrl_term_error *error)
{
    struct grrl_term_error unwanted;
    struct parser parser = {
        .store = store, .text = text, .length = length, .error = error != NULL ? error : &unwanted};
    uint16_t mark = grrl_term_mark(store);
    uint8_t n_symbols = store->n_symbols;
    uint8_t n_names = store->n_names;
    enum grrl_status status = parse(&parser);
    if (status != GRRL_OK) {
        grrl_term_release(store, mark);
        store->n_symbols = n_symbols;
        store->n_names = n_names;
        return status;
    }
    *term = parser.frames[0].current;
    return GRRL_OK;
}
