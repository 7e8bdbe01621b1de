/* grrl.h: everything, in the order the modules build on one another. */
#ifndef GRRL_GRRL_H
#define GRRL_GRRL_H

#include "grrl/config.h"
#include "grrl/random.h"
#include "grrl/status.h"
/* structures */
#include "grrl/canonical.h"
#include "grrl/graph.h"
#include "grrl/match.h"
#include "grrl/signature.h"
#include "grrl/term.h"
/* the world */
#include "grrl/geometry.h"
#include "grrl/grounding.h"
#include "grrl/noise.h"
#include "grrl/perception.h"
#include "grrl/trajectory.h"
/* learning */
#include "grrl/case_base.h"
#include "grrl/context.h"
#include "grrl/experience.h"
#include "grrl/learner.h"
#include "grrl/policy.h"

#endif
