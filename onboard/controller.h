/*
 * controller.h: the learner in a fixed amount of memory, driven by packets.
 *
 * It hashes everything it estimates, decides and learns, so that runs on different machines can be
 * compared, and it counts the cost of each step.
 *
 * Order of calls: onboard_controller_init, then onboard_controller_take for each packet.
 */
#ifndef ONBOARD_CONTROLLER_H
#define ONBOARD_CONTROLLER_H

#include <stddef.h>

#include "grrl/learner/cases/learn_policy.h"
#include "grrl/learner/relational_q/paper_policy.h"
#include "grrl/policies.h"
#include "packet.h"

GRRL_API_BEGIN

/* The policies that the controller offers: pointers, each followed by a comma. Others are not
 * linked. The build sets both macros (onboard/CMakeLists.txt). */
#ifndef ONBOARD_POLICIES
#define ONBOARD_POLICIES &grrl_policy_learn, &grrl_policy_paper,
#endif

/* Memory for the largest of them. */
#ifndef ONBOARD_POLICY_BYTES
#define ONBOARD_POLICY_BYTES GRRL_PAPER_POLICY_BYTES(ONBOARD_ENTRIES)
#endif

/* Nodes and characters for the estimated structure as a term. */
enum { ONBOARD_TERM_NODES = 128, ONBOARD_TERM_BYTES = 1024 };

enum onboard_step {
    ONBOARD_STEP_FRAME,    /* process a frame */
    ONBOARD_STEP_PERCEIVE, /* bodies and joints from all keyframes */
    ONBOARD_STEP_CHOOSE,   /* recall, policy and push */
    ONBOARD_STEP_LEARN,    /* recall and update */
    ONBOARD_STEPS
};

/* In ticks of the counter given to onboard_controller_init. */
struct onboard_cost {
    uint64_t sum;
    uint32_t n;
    uint32_t most;
};

struct onboard_hashes {
    uint64_t models; /* including the structure as a term */
    uint64_t decisions;
    uint64_t updates;
};

struct onboard_controller {
    struct grrl_learner learner;
    union {
        max_align_t aligned;
        uint8_t bytes[ONBOARD_POLICY_BYTES];
    } policy;                     /* memory for any of ONBOARD_POLICIES */
    struct onboard_points points; /* of the current frame */
    struct grrl_term_store terms;
    struct grrl_term_node nodes[ONBOARD_TERM_NODES];
    char text[ONBOARD_TERM_BYTES];
    struct onboard_packet answer;
    struct onboard_hashes hashes;
    uint64_t store_hash;  /* after CLOSE: of the file of what the policy learned */
    uint32_t store_bytes; /* length of that file */
    struct onboard_cost cost[ONBOARD_STEPS];
    uint32_t (*count)(void); /* NULL: costs are not counted */
    bool open;
};

/* count: a free-running 32-bit counter, or NULL. */
void onboard_controller_init(struct onboard_controller *controller, uint32_t (*count)(void));

/*
 * Executes the packet. The answer is in controller->answer; it is REFUSED after a failure.
 * GRRL_ERR_FORMAT: unknown packet, or wrong length; GRRL_ERR_VERSION: a run with other capacities;
 * GRRL_ERR_NONE: a policy that this controller does not have; GRRL_ERR_ORDER: not open;
 * GRRL_ERR_CORRUPT: the hashes so far differ from the expected ones. A failure of the learner
 * itself is not one of these; its status is in the answer.
 */
GRRL_MUST_USE enum grrl_status onboard_controller_take(struct onboard_controller *controller,
                                                       struct onboard_packet *packet);

GRRL_API_END

#endif
