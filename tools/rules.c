/* rules.c: grows a regression tree; the leaf whose split explains most is split next. */
#include "rules.h"

#include <math.h>
#include <stdlib.h>

/* A rule holds for at least this share of all pushes. */
#define LEAST_SHARE 0.01

/* The least expected reward, so that it has a logarithm. */
#define LEAST_REWARD 0.05

/* A case in the eyes of the tree. */
struct point {
    uint32_t key;
    double pushes;
    double value; /* what the learner expects, as a logarithm */
};

struct points {
    struct point *point;
    uint32_t n;
};

struct sum {
    double pushes;
    double value;
};

struct split {
    unsigned part;
    uint8_t values; /* of one side */
    double gain;
};

bool grrl_rule_holds(const struct grrl_rule *rule, uint32_t key)
{
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        if ((rule->values[i] >> grrl_context_part(key, i) & 1u) == 0)
            return false;
    return true;
}

static struct sum sum_of(const struct points *points, const struct grrl_rule *rule)
{
    struct sum sum = {0.0, 0.0};
    for (uint32_t i = 0; i < points->n; i++) {
        const struct point *point = &points->point[i];
        if (grrl_rule_holds(rule, point->key)) {
            sum.pushes += point->pushes;
            sum.value += point->pushes * point->value;
        }
    }
    return sum;
}

static double explained(const struct sum *sum)
{
    return sum->pushes > 0.0 ? sum->value * sum->value / sum->pushes : 0.0;
}

/* The split of a rule by one part that explains most. */
static void try_part(const struct points *points, const struct grrl_rule *rule, unsigned part,
                     double least, struct split *best)
{
    struct sum whole = sum_of(points, rule);
    for (unsigned kind = 0; kind < 2; kind++) { /* one value, or all up to one */
        for (unsigned value = 0; value < grrl_context_max[part]; value++) {
            struct grrl_rule side = *rule;
            unsigned bits = kind == 0 ? 1u << value : (2u << value) - 1u;
            side.values[part] = (uint8_t)(rule->values[part] & bits);
            struct sum in = sum_of(points, &side);
            struct sum out = {whole.pushes - in.pushes, whole.value - in.value};
            double gain = explained(&in) + explained(&out) - explained(&whole);
            if (in.pushes >= least && out.pushes >= least && gain > best->gain)
                *best = (struct split){part, side.values[part], gain};
        }
    }
}

static struct split best_split(const struct points *points, const struct grrl_rule *rule,
                               double least)
{
    struct split best = {0, 0, 0.0};
    for (unsigned part = 0; part < GRRL_CONTEXT_PARTS; part++)
        try_part(points, rule, part, least, &best);
    return best;
}

static unsigned grow(const struct points *points, double least, struct grrl_rule *rules)
{
    struct split split[GRRL_MAX_RULES];
    unsigned n = 1;
    for (unsigned i = 0; i < GRRL_CONTEXT_PARTS; i++)
        rules[0].values[i] = (uint8_t)((2u << grrl_context_max[i]) - 1u);
    split[0] = best_split(points, &rules[0], least);
    while (n < GRRL_MAX_RULES) {
        unsigned best = 0;
        for (unsigned i = 1; i < n; i++)
            best = split[i].gain > split[best].gain ? i : best;
        if (split[best].gain <= 0.0)
            break;
        unsigned part = split[best].part;
        rules[n] = rules[best];
        rules[n].values[part] &= (uint8_t)~split[best].values;
        rules[best].values[part] = split[best].values;
        split[best] = best_split(points, &rules[best], least);
        split[n] = best_split(points, &rules[n], least);
        n++;
    }
    return n;
}

/* What was met under a rule. */
static void add_up(const struct grrl_case_base *base, struct grrl_rule *rule)
{
    rule->pushes = rule->found = rule->reward = 0.0;
    for (uint32_t i = 0; i < base->n; i++) {
        const struct grrl_case *met = &base->cases[i];
        if (grrl_rule_holds(rule, met->key)) {
            rule->pushes += met->n_all;
            rule->found += met->n_found;
            rule->reward += (double)met->n_all * (double)met->value_all;
        }
    }
}

static int by_mean(const void *a, const void *b)
{
    const struct grrl_rule *x = a;
    const struct grrl_rule *y = b;
    double of_x = x->reward * y->pushes;
    double of_y = y->reward * x->pushes;
    return (of_x < of_y) - (of_x > of_y);
}

int grrl_rules_of(const struct grrl_case_base *base, struct grrl_rule rules[GRRL_MAX_RULES])
{
    struct grrl_case_config config;
    double pushes = 0.0;
    grrl_case_config_default(&config);
    if (base->n == 0)
        return 0;
    struct points points = {calloc(base->n, sizeof *points.point), base->n};
    if (points.point == NULL)
        return -1;
    for (uint32_t i = 0; i < base->n; i++) {
        struct grrl_estimate estimate;
        grrl_cases_estimate(base, &config, base->cases[i].key, &estimate);
        points.point[i] = (struct point){base->cases[i].key, base->cases[i].n_all,
                                         log(fmax((double)estimate.value, LEAST_REWARD))};
        pushes += base->cases[i].n_all;
    }
    unsigned n = grow(&points, LEAST_SHARE * pushes, rules);
    free(points.point);
    for (unsigned i = 0; i < n; i++)
        add_up(base, &rules[i]);
    qsort(rules, n, sizeof rules[0], by_mean);
    return (int)n;
}
