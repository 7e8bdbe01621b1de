/* term_store.c: reads, merges and writes stores of the policy learn. */
#include "term_store.h"

#include <stdio.h>

enum { MAX_CASES = 8192 };

/* Of all stores of a merge together. */
enum { MAX_CASES_OF_ALL = 65536 };

/* A merged store holds as many cases as grrl-agent remembers by default. */
enum { MERGED_CASES = 1000 };

static int read_bytes(void *context, void *bytes, size_t size)
{
    return fread(bytes, 1, size, context) == size ? 0 : -1;
}

static int write_bytes(void *context, const void *bytes, size_t size)
{
    return fwrite(bytes, 1, size, context) == size ? 0 : -1;
}

static bool load(const char *path, struct grrl_case_base *base)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        fprintf(stderr, "grrl-term: cannot read %s\n", path);
        return false;
    }
    const struct grrl_io io = {.context = file, .read = read_bytes};
    uint32_t lost;
    enum grrl_status status = grrl_cases_load(base, &io, &lost);
    bool more = status == GRRL_OK && fgetc(file) != EOF;
    (void)fclose(file);
    if (status == GRRL_OK && !more)
        return true;
    fprintf(stderr, "grrl-term: %s: %s; a store that grrl-agent --policy learn wrote is required\n",
            path, more ? "more bytes than the store has" : grrl_status_text(status));
    return false;
}

bool term_store_rules(const char *path)
{
    static struct grrl_case cases[MAX_CASES];
    struct grrl_case_base base;
    grrl_cases_init(&base, cases, MAX_CASES);
    if (!load(path, &base))
        return false;
    return term_rules_print(&base);
}

static bool save(const char *path, const struct grrl_case_base *base)
{
    FILE *file = fopen(path, "wbx"); /* never over another store */
    bool fine = file != NULL;
    if (fine) {
        const struct grrl_io io = {.context = file, .write = write_bytes};
        fine = grrl_cases_save(base, &io) == GRRL_OK;
        fine = fclose(file) == 0 && fine;
    }
    if (!fine)
        fprintf(stderr, "grrl-term: cannot write %s; a new file in a folder is required\n", path);
    return fine;
}

bool term_store_merge(char *const *paths, int n, const char *out)
{
    static struct grrl_case cases[MAX_CASES_OF_ALL];
    static struct grrl_case further[MAX_CASES];
    struct grrl_case_base all;
    struct grrl_case_config config;
    grrl_case_config_default(&config);
    grrl_cases_init(&all, cases, MAX_CASES_OF_ALL);
    if (!load(paths[0], &all))
        return false;
    for (int i = 1; i < n; i++) {
        struct grrl_case_base base;
        grrl_cases_init(&base, further, MAX_CASES);
        if (!load(paths[i], &base))
            return false;
        /* what is rare in each life may be frequent in all, so only the last merge drops cases */
        uint32_t most = i + 1 < n ? MAX_CASES_OF_ALL : MERGED_CASES;
        enum grrl_status status = grrl_cases_merge(&all, &base, &config, most);
        if (status != GRRL_OK) {
            fprintf(stderr, "grrl-term: %s: %s; at most %d cases in all can be merged\n", paths[i],
                    grrl_status_text(status), MAX_CASES_OF_ALL);
            return false;
        }
    }
    return save(out, &all);
}
