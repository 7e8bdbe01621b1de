/* term_rules.c: prints the rules of a store. */
#include <stdio.h>

#include "rules.h"
#include "term_store.h"

enum { MAX_VALUES = 8 };

static const struct {
    const char *name;
    const char *value[MAX_VALUES]; /* NULL beyond the largest, which no rule has */
} words[GRRL_CONTEXT_PARTS] = {
    [GRRL_CONTEXT_DIRECTION] = {"A", {"0|180", "45|225", "90|270"}},
    [GRRL_CONTEXT_LENGTH] = {"length", {"tiny", "short", "long", "longer", "longest"}},
    [GRRL_CONTEXT_TRIED] = {"tried", {"never", "once", "twice", "often"}},
    [GRRL_CONTEXT_NEIGHBOURS] = {"neighbours", {"beside", "ahead", "behind", "ahead and behind"}},
    [GRRL_CONTEXT_NEIGHBOUR_LENGTH] = {"neighbour",
                                       {"none", "tiny", "short", "long", "longer", "longest"}},
    [GRRL_CONTEXT_REVOLUTE] = {"revolute", {"0", "1", "2+"}},
    [GRRL_CONTEXT_PRISMATIC] = {"prismatic", {"0", "1", "2+"}},
    [GRRL_CONTEXT_OTHERS_TRIED] = {"other pushes", {"0", "1", "2+"}},
    [GRRL_CONTEXT_LONGER] = {"longer links", {"0", "1", "2+"}},
    [GRRL_CONTEXT_ASPECT] = {"shape", {"slender", "stout", "round"}},
    [GRRL_CONTEXT_SKEW] = {"thins out", {"neither way", "behind", "ahead"}},
    [GRRL_CONTEXT_ELSEWHERE] = {"known elsewhere",
                                {"nothing", "revolute", "prismatic", "both types"}},
};

/* Prints the values of a part, such as one|other; whether the part says anything at all. */
static bool print_part(const struct grrl_rule *rule, unsigned part, const char *before)
{
    uint8_t all = (uint8_t)((2u << grrl_context_max[part]) - 1u);
    if (rule->values[part] == all)
        return false;
    const char *between = "";
    fputs(before, stdout);
    printf(part == GRRL_CONTEXT_DIRECTION ? "%s(x, " : "%s(x) ", words[part].name);
    for (unsigned value = 0; value <= grrl_context_max[part]; value++) {
        const char *word = words[part].value[value];
        if ((rule->values[part] >> value & 1u) != 0 && word != NULL) {
            printf("%s%s", between, word);
            between = "|";
        }
    }
    if (part == GRRL_CONTEXT_DIRECTION)
        putchar(')');
    return true;
}

static void print_rule(const struct grrl_rule *rule)
{
    printf("%3.0f%% of %5.0f  %5.2f  ", 100.0 * rule->found / rule->pushes, rule->pushes,
           rule->reward / rule->pushes);
    if (!print_part(rule, GRRL_CONTEXT_DIRECTION, ""))
        fputs("A(x, any)", stdout);
    const char *before = " if ";
    for (unsigned part = GRRL_CONTEXT_DIRECTION + 1; part < GRRL_CONTEXT_PARTS; part++)
        if (print_part(rule, part, before))
            before = ", ";
    putchar('\n');
}

bool term_rules_print(const struct grrl_case_base *base)
{
    struct grrl_rule rules[GRRL_MAX_RULES];
    int n = grrl_rules_of(base, rules);
    double pushes = 0.0;
    if (n < 0) {
        fputs("grrl-term: no memory for the cases\n", stderr);
        return false;
    }
    puts("found something  reward  push");
    for (int i = 0; i < n; i++) {
        print_rule(&rules[i]);
        pushes += rules[i].pushes;
    }
    printf("%d rules for %u cases of %.0f pushes\n", n, (unsigned)base->n, pushes);
    return true;
}
