/* csv.c: lines with any ending, fields with one separator, quotes removed in place. */
#define _POSIX_C_SOURCE 200809L

#include "csv.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const char blanks[] = " \t";

bool grrl_csv_fail(struct grrl_csv *csv, int column, const char *what, const char *text)
{
    (void)snprintf(csv->error->text, sizeof csv->error->text, "%.150s:%zu:%d: %.60s%s%.280s",
                   csv->path, csv->line, column, text, *text != '\0' ? ": " : "", what);
    return false;
}

static bool put(struct grrl_csv *csv, size_t at, int byte)
{
    if (at == csv->capacity) {
        size_t capacity = csv->capacity == 0 ? 256 : 2 * csv->capacity;
        char *grown = realloc(csv->text, capacity);
        if (grown == NULL)
            return grrl_csv_fail(csv, 1, "out of memory", "");
        csv->text = grown;
        csv->capacity = capacity;
    }
    csv->text[at] = (char)byte;
    return true;
}

static bool refuse_zero_byte(struct grrl_csv *csv, size_t length)
{
    bool utf16 = length > 0 && ((unsigned char)csv->text[0] & 0xfe) == 0xfe;
    return grrl_csv_fail(csv, 1,
                         utf16 ? "this is UTF-16; save it as UTF-8 or plain text"
                               : "this is not text: it contains a zero byte",
                         "");
}

/* Reads one line, blank or not, without its ending. */
static enum grrl_csv_status read_line(struct grrl_csv *csv)
{
    size_t length = 0;
    int byte = getc_unlocked(csv->file);
    csv->line++;
    if (byte == EOF && ferror(csv->file) != 0) {
        (void)grrl_csv_fail(csv, 1, strerror(errno), "");
        return GRRL_CSV_BAD;
    }
    if (byte == EOF)
        return GRRL_CSV_END;
    for (; byte != EOF && byte != '\n' && byte != '\r'; byte = getc_unlocked(csv->file)) {
        if (byte == '\0') {
            (void)refuse_zero_byte(csv, length);
            return GRRL_CSV_BAD;
        }
        if (!put(csv, length++, byte))
            return GRRL_CSV_BAD;
    }
    if (byte == '\r' && (byte = getc_unlocked(csv->file)) != '\n' && byte != EOF)
        (void)ungetc(byte, csv->file);
    return put(csv, length, '\0') ? GRRL_CSV_LINE : GRRL_CSV_BAD;
}

enum grrl_csv_status grrl_csv_next_line(struct grrl_csv *csv)
{
    enum grrl_csv_status status;
    do {
        status = read_line(csv);
        if (status == GRRL_CSV_LINE && csv->line == 1 && strncmp(csv->text, "\xef\xbb\xbf", 3) == 0)
            memmove(csv->text, csv->text + 3, strlen(csv->text + 3) + 1); /* a byte order mark */
    } while (status == GRRL_CSV_LINE && csv->text[strspn(csv->text, blanks)] == '\0');
    return status;
}

void grrl_csv_find_separator(struct grrl_csv *csv)
{
    static const char candidates[] = ",;\t";
    size_t count[] = {0, 0, 0};
    bool quoted = false;
    for (const char *at = csv->text; *at != '\0'; at++) {
        const char *found = quoted ? NULL : strchr(candidates, *at);
        quoted = quoted != (*at == '"');
        if (found != NULL)
            count[found - candidates]++;
    }
    size_t best = 0;
    for (size_t i = 1; i < sizeof count / sizeof count[0]; i++)
        best = count[i] > count[best] ? i : best;
    csv->separator = candidates[best];
}

/* Removes the quotes of a field in place, starting at its opening quote. Returns the byte after the
 * closing quote; NULL: not closed. */
static char *unquote(char *at)
{
    char *to = at;
    char *from = at + 1;
    for (; *from != '\0' && (*from != '"' || from[1] == '"'); from++) {
        from += *from == '"';
        *to++ = *from;
    }
    if (*from == '\0')
        return NULL;
    *to = '\0';
    return from + 1;
}

static char *skip_blanks(const struct grrl_csv *csv, char *at)
{
    while ((*at == ' ' || *at == '\t') && *at != csv->separator)
        at++;
    return at;
}

/* Reads one field. Returns its end (a separator or the end of the line); NULL: malformed. */
static char *take_field(struct grrl_csv *csv, char *at, struct grrl_csv_field *field)
{
    char *begin = skip_blanks(csv, at);
    const char ends[] = {csv->separator, '\0'};
    *field = (struct grrl_csv_field){begin, (int)(begin - csv->text) + 1};
    if (*begin == '"') {
        char *end = unquote(begin);
        end = end == NULL ? NULL : skip_blanks(csv, end);
        if (end != NULL && (*end == '\0' || *end == csv->separator))
            return end;
        (void)grrl_csv_fail(csv, field->column,
                            end == NULL ? "a quote that is not closed in this line"
                                        : "text after a closing quote",
                            "");
        return NULL;
    }
    char *end = begin + strcspn(begin, ends);
    char *behind = end;
    while (behind > begin && (behind[-1] == ' ' || behind[-1] == '\t'))
        behind--;
    if (behind < end)
        *behind = '\0';
    return end;
}

int grrl_csv_split(struct grrl_csv *csv, struct grrl_csv_field *fields)
{
    int n = 0;
    char *at = csv->text;
    for (;;) {
        if (n == GRRL_CSV_MAX_FIELDS) {
            (void)grrl_csv_fail(csv, (int)(at - csv->text) + 1,
                                "more than 1024 columns; a row must have one point of one frame",
                                "");
            return -1;
        }
        char *end = take_field(csv, at, &fields[n]);
        if (end == NULL)
            return -1;
        bool last = *end == '\0';
        *end = '\0';
        n++;
        if (last) {
            csv->past_end = (int)(end - csv->text) + 1;
            return n;
        }
        at = end + 1;
    }
}

void grrl_csv_free(struct grrl_csv *csv)
{
    free(csv->text);
    csv->text = NULL;
    csv->capacity = 0;
}
