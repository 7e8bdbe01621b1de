/* grrl_c.hpp: the library's C headers, as C++ sees them. */
#ifndef GRRL_SIM_GRRL_C_HPP
#define GRRL_SIM_GRRL_C_HPP

extern "C" {
#include "grrl/base/config.h"
#include "grrl/base/random.h"
#include "grrl/base/status.h"
#include "grrl/structure/graph.h"
#include "grrl/structure/match.h"
#include "grrl/structure/term.h"
}

#endif
