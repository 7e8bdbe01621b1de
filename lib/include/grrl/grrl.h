/* grrl.h: all public headers, module by module; each module uses only those above it. */
#ifndef GRRL_GRRL_H
#define GRRL_GRRL_H

#include "grrl/base/config.h"
#include "grrl/base/geometry.h"
#include "grrl/base/io.h"
#include "grrl/base/joint_type.h"
#include "grrl/base/random.h"
#include "grrl/base/settling.h"
#include "grrl/base/status.h"

#include "grrl/perception/noise.h"
#include "grrl/perception/perception.h"
#include "grrl/perception/trajectory.h"

#include "grrl/structure/canonical.h"
#include "grrl/structure/graph.h"
#include "grrl/structure/match.h"
#include "grrl/structure/signature.h"
#include "grrl/structure/term.h"

#include "grrl/learner/grounding.h"
#include "grrl/learner/learner.h"
#include "grrl/learner/policy.h"
#include "grrl/learner/relational_state.h"

#include "grrl/learner/cases/case_base.h"
#include "grrl/learner/cases/context.h"
#include "grrl/learner/cases/learn_policy.h"

#include "grrl/learner/relational_q/experience.h"
#include "grrl/learner/relational_q/paper_policy.h"

#include "grrl/policies.h"

#endif
