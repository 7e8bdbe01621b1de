/*
 * term_rules.c: the cases of learn as rules that a person can read.
 *
 * The rules are the leaves of a regression tree over the parts of a context (Breiman et al.,
 * Classification and Regression Trees, 1984). The leaf whose split explains most is split next.
 */
#include <stdio.h>

#include "term_store.h"

/* More rules explain fewer choices of the learner: leaves as good as each other compete. */
enum { MAX_RULES = 12, MAX_VALUES = 8 };

/* A rule holds for at least this share of all pushes. */
#define LEAST_SHARE 0.01

/* Which values each part may have, as bits. */
struct rule {
    uint8_t values[GRRL_CONTEXT_PARTS];
};

struct sum {
    double pushes;
    double found;
    double reward;
};

struct split {
    unsigned part;
    uint8_t values; /* of one side */
    double gain;
};

static bool holds(const struct rule *rule, const struct grrl_case *met)
{
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        if ((rule->values[i] >> grrl_context_part(met->key, i) & 1u) == 0)
            return false;
    return true;
}

static struct sum sum_of(const struct grrl_case_base *base, const struct rule *rule)
{
    struct sum sum = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < base->n; i++) {
        const struct grrl_case *met = &base->cases[i];
        if (holds(rule, met)) {
            sum.pushes += met->n_all;
            sum.found += met->n_found;
            sum.reward += (double)met->n_all * (double)met->value_all;
        }
    }
    return sum;
}

static double explained(const struct sum *sum)
{
    return sum->pushes > 0.0 ? sum->reward * sum->reward / sum->pushes : 0.0;
}

/* The split of a rule by one part that explains most. */
static void try_part(const struct grrl_case_base *base, const struct rule *rule, unsigned part,
                     double least, struct split *best)
{
    struct sum whole = sum_of(base, rule);
    for (unsigned kind = 0; kind < 2; kind++) { /* one value, or all up to one */
        for (unsigned value = 0; value < grrl_context_max[part]; value++) {
            struct rule side = *rule;
            unsigned bits = kind == 0 ? 1u << value : (2u << value) - 1u;
            side.values[part] = (uint8_t)(rule->values[part] & bits);
            struct sum in = sum_of(base, &side);
            struct sum out = {whole.pushes - in.pushes, 0.0, whole.reward - in.reward};
            double gain = explained(&in) + explained(&out) - explained(&whole);
            if (in.pushes >= least && out.pushes >= least && gain > best->gain)
                *best = (struct split){part, side.values[part], gain};
        }
    }
}

static struct split best_split(const struct grrl_case_base *base, const struct rule *rule,
                               double least)
{
    struct split best = {0, 0, 0.0};
    for (unsigned part = 0; part < GRRL_CONTEXT_PARTS; part++)
        try_part(base, rule, part, least, &best);
    return best;
}

static unsigned grow(const struct grrl_case_base *base, double least, struct rule *rules)
{
    struct split split[MAX_RULES];
    unsigned n = 1;
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        rules[0].values[i] = (uint8_t)((2u << grrl_context_max[i]) - 1u);
    split[0] = best_split(base, &rules[0], least);
    while (n < MAX_RULES) {
        unsigned best = 0;
        for (unsigned i = 1; i < n; i++)
            best = split[i].gain > split[best].gain ? i : best;
        if (split[best].gain <= 0.0)
            break;
        unsigned part = split[best].part;
        rules[n] = rules[best];
        rules[n].values[part] &= (uint8_t)~split[best].values;
        rules[best].values[part] = split[best].values;
        split[best] = best_split(base, &rules[best], least);
        split[n] = best_split(base, &rules[n], least);
        n++;
    }
    return n;
}

/* --- printing --------------------------------------------------------------------------------- */

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
static bool print_part(const struct rule *rule, unsigned part, const char *before)
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

static void print_rule(const struct rule *rule, const struct sum *sum)
{
    printf("%3.0f%% of %5.0f  %5.2f  ", 100.0 * sum->found / sum->pushes, sum->pushes,
           sum->reward / sum->pushes);
    if (!print_part(rule, GRRL_CONTEXT_DIRECTION, ""))
        fputs("A(x, any)", stdout);
    const char *before = " if ";
    for (unsigned part = GRRL_CONTEXT_DIRECTION + 1; part < GRRL_CONTEXT_PARTS; part++)
        if (print_part(rule, part, before))
            before = ", ";
    putchar('\n');
}

static double explained_by_cases(const struct grrl_case_base *base)
{
    double all = 0.0;
    for (uint32_t i = 0; i < base->n; i++)
        all += (double)base->cases[i].n_all * (double)base->cases[i].value_all *
               (double)base->cases[i].value_all;
    return all;
}

void term_rules_print(const struct grrl_case_base *base)
{
    struct rule rules[MAX_RULES];
    struct sum sums[MAX_RULES];
    struct sum all = {0.0, 0.0, 0.0};
    double by_rules = 0.0;
    for (uint32_t i = 0; i < base->n; i++) {
        all.pushes += base->cases[i].n_all;
        all.reward += (double)base->cases[i].n_all * (double)base->cases[i].value_all;
    }
    unsigned n = base->n > 0 ? grow(base, LEAST_SHARE * all.pushes, rules) : 0;
    for (unsigned i = 0; i < n; i++) {
        sums[i] = sum_of(base, &rules[i]);
        by_rules += explained(&sums[i]);
    }
    bool printed[MAX_RULES] = {false};
    puts("found something  reward  push");
    for (unsigned k = 0; k < n; k++) {
        unsigned best = n;
        for (unsigned i = 0; i < n; i++)
            if (!printed[i] && (best == n || sums[i].reward * sums[best].pushes >
                                                 sums[best].reward * sums[i].pushes))
                best = i;
        printed[best] = true;
        print_rule(&rules[best], &sums[best]);
    }
    double between = explained_by_cases(base) - explained(&all);
    printf("%u rules for %u cases of %.0f pushes; of what differs between the cases they explain "
           "%.0f%%\n",
           n, (unsigned)base->n, all.pushes,
           between > 0.0 ? 100.0 * (by_rules - explained(&all)) / between : 100.0);
}
