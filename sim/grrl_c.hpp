/* grrl_c.hpp: the library's C headers, as C++ sees them. */
#ifndef GRRL_SIM_GRRL_C_HPP
#define GRRL_SIM_GRRL_C_HPP

extern "C" {
#include "grrl/config.h"
#include "grrl/graph.h"
#include "grrl/match.h"
#include "grrl/random.h"
#include "grrl/status.h"
#include "grrl/term.h"
}

#endif
