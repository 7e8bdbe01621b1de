/*
 * supervisor.hpp: knows the true structure and ends a trial when the robot has found it (paper,
 * section VII). It compares only links and joints, not link properties.
 */
#ifndef GRRL_SIM_SUPERVISOR_HPP
#define GRRL_SIM_SUPERVISOR_HPP

#include <string>

#include "grrl/structure/graph.h"

namespace grrl_sim
{

/* The difference between the estimated and the true structure: positive is missing, negative too
 * many. */
struct Verdict {
    bool correct = false;   /* isomorphic to the truth */
    bool undecided = false; /* the search budget ran out; treated as not correct */
    int missing_links = 0;
    int missing_revolute = 0;
    int missing_prismatic = 0;
};

/* "correct", or for example "2 links missing, 1 prismatic joint too many". */
std::string verdict_text(const Verdict &verdict);

class Supervisor
{
public:
    explicit Supervisor(const grrl_graph &truth) : truth_(truth) {}

    Verdict judge(const grrl_graph &estimated) const;

private:
    grrl_graph truth_;
};

} // namespace grrl_sim

#endif
