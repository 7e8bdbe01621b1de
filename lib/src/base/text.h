/*
 * text.h (private): appends to a caller's buffer without stdio.
 *
 * The text is always terminated. `length` counts the whole text, so a caller detects truncation by
 * comparing it with the capacity.
 */
#ifndef GRRL_TEXT_H
#define GRRL_TEXT_H

#include <stddef.h>
#include <stdint.h>

struct grrl_text {
    char *bytes;
    size_t capacity; /* at least 1 */
    size_t length;
};

static inline struct grrl_text grrl_text_begin(char *bytes, size_t capacity)
{
    bytes[0] = '\0';
    return (struct grrl_text){bytes, capacity, 0};
}

static inline void grrl_text_char(struct grrl_text *text, char c)
{
    if (text->length + 1 < text->capacity) {
        text->bytes[text->length] = c;
        text->bytes[text->length + 1] = '\0';
    }
    text->length++;
}

static inline void grrl_text_bytes(struct grrl_text *text, const char *bytes, size_t n)
{
    for (size_t i = 0; i < n; i++)
        grrl_text_char(text, bytes[i]);
}

static inline void grrl_text_string(struct grrl_text *text, const char *string)
{
    for (; *string != '\0'; string++)
        grrl_text_char(text, *string);
}

static inline void grrl_text_number(struct grrl_text *text, uint32_t number)
{
    char digits[10];
    int n = 0;
    do {
        digits[n++] = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    while (n > 0)
        grrl_text_char(text, digits[--n]);
}

#endif
