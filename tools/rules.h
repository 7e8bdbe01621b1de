/*
 * rules.h: the cases of the policy learn as a few rules that a person can read.
 *
 * The rules are the leaves of a regression tree over the parts of a context (Breiman et al.,
 * Classification and Regression Trees, 1984). It is fitted to the logarithm of what the learner
 * expects of each case, since what makes one push better than another is a ratio: fitted to plain
 * rewards, most splits tell large clusters of links from small ones, of which a scene has one.
 */
#ifndef GRRL_TOOLS_RULES_H
#define GRRL_TOOLS_RULES_H

#include "grrl/learner/cases/case_base.h"

GRRL_API_BEGIN

/* More rules explain fewer choices of the learner: leaves as good as each other compete. */
enum { GRRL_MAX_RULES = 4 };

struct grrl_rule {
    uint8_t values[GRRL_CONTEXT_PARTS]; /* that each part may have, as bits */
    double pushes;                      /* that fall under it */
    double found;                       /* of these, how many revealed something */
    double reward;                      /* of all of them */
};

/* Whether the context with this key falls under a rule. */
bool grrl_rule_holds(const struct grrl_rule *rule, uint32_t key);

/* Finds the rules, the one with the highest mean reward first; each context falls under one of
 * them. Returns how many, 0 without cases, or -1 without memory. */
int grrl_rules_of(const struct grrl_case_base *base, struct grrl_rule rules[GRRL_MAX_RULES]);

GRRL_API_END

#endif
