/* Compares each model with the true structure. */
#include "supervisor.hpp"

#include <cstdlib>

#include "grrl/structure/match.h"

namespace grrl_sim
{

namespace
{

int joints_of_type(const grrl_graph &graph, grrl_joint_type type)
{
    int ends = 0;
    for (int i = 0; i < graph.n; i++)
        for (uint32_t joined = graph.joined[type][i]; joined != 0; joined &= joined - 1)
            ends++;
    return ends / 2;
}

void add_difference(std::string &text, int missing, const char *what)
{
    if (missing == 0)
        return;
    int count = std::abs(missing);
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what +
            (count == 1 ? "" : "s") + (missing > 0 ? " missing" : " too many");
}

} // namespace

std::string verdict_text(const Verdict &verdict)
{
    if (verdict.correct)
        return "correct";
    std::string text;
    add_difference(text, verdict.missing_links, "link");
    add_difference(text, verdict.missing_revolute, "revolute joint");
    add_difference(text, verdict.missing_prismatic, "prismatic joint");
    if (!text.empty())
        return text;
    return verdict.undecided ? "too symmetric to compare within the search budget"
                             : "the right links and joints, joined differently";
}

Verdict Supervisor::judge(const grrl_graph &estimated) const
{
    Verdict verdict;
    verdict.missing_links = truth_.n - estimated.n;
    verdict.missing_revolute =
        joints_of_type(truth_, GRRL_REVOLUTE) - joints_of_type(estimated, GRRL_REVOLUTE);
    verdict.missing_prismatic =
        joints_of_type(truth_, GRRL_PRISMATIC) - joints_of_type(estimated, GRRL_PRISMATIC);
    if (verdict.missing_links != 0 || verdict.missing_revolute != 0 ||
        verdict.missing_prismatic != 0)
        return verdict;
    uint8_t map[GRRL_MAX_LINKS];
    grrl_status status = grrl_match_find(GRRL_MATCH_ISOMORPHISM, &truth_, &estimated,
                                         GRRL_NO_PROPERTIES, GRRL_MATCH_BUDGET, map);
    verdict.correct = status == GRRL_OK;
    verdict.undecided = status == GRRL_ERR_UNDECIDED;
    return verdict;
}

} // namespace grrl_sim
