/* agent_c.hpp: the agent's and the library's C headers, as C++ sees them. */
#ifndef GRRL_EXPERIMENT_AGENT_C_HPP
#define GRRL_EXPERIMENT_AGENT_C_HPP

extern "C" {
#include "agent.h"
#include "grrl/learner/cases/learn_policy.h"
#include "grrl/learner/learner.h"
#include "grrl/learner/relational_q/paper_policy.h"
#include "grrl/perception/perception.h"
#include "grrl/policies.h"
}

#endif
