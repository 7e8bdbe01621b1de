/* grrl_c.hpp: the library's C headers, as C++ sees them. */
#ifndef GRRL_SIM_GRRL_C_HPP
#define GRRL_SIM_GRRL_C_HPP

/* A C struct and a function may share a name (grrl_term_node); in C++ one hides the other. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
extern "C" {
#include "grrl/config.h"
#include "grrl/graph.h"
#include "grrl/match.h"
#include "grrl/random.h"
#include "grrl/status.h"
#include "grrl/term.h"
}
#pragma GCC diagnostic pop

#endif
