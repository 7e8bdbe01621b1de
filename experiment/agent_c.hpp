/* agent_c.hpp: the agent's and the library's C headers, as C++ sees them. */
#ifndef GRRL_EXPERIMENT_AGENT_C_HPP
#define GRRL_EXPERIMENT_AGENT_C_HPP

/* A C struct and a function may share a name (grrl_canonical); in C++ one hides the other. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
extern "C" {
#include "agent.h"
#include "grrl/experience.h"
#include "grrl/learner.h"
#include "grrl/perception.h"
}
#pragma GCC diagnostic pop

#endif
