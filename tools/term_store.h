/* term_store.h: what grrl-term does with the stores of the policy learn. False after an error,
 * which is printed. */
#ifndef GRRL_TOOLS_TERM_STORE_H
#define GRRL_TOOLS_TERM_STORE_H

#include <stdbool.h>

#include "grrl/learner/cases/case_base.h"

bool term_store_rules(const char *path);
/* Merges n >= 2 stores, one after another. */
bool term_store_merge(char *const *paths, int n, const char *out);

/* Prints the cases as rules, the best first. False without memory, which is printed. */
bool term_rules_print(const struct grrl_case_base *base);

#endif
