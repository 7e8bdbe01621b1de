/*
 * controller.h: the learner in a fixed amount of memory, driven by packets.
 *
 * Everything it believes, decides and learns goes into hashes, so that runs on different machines
 * can be compared, and what each step costs is counted.
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

/* The policies that the controller offers, pointers with a comma behind each; what is not named
 * here is not linked. The build sets both (onboard/CMakeLists.txt). */
#ifndef ONBOARD_POLICIES
#define ONBOARD_POLICIES &grrl_policy_learn, &grrl_policy_paper,
#endif

/* Memory for the largest of them. */
#ifndef ONBOARD_POLICY_BYTES
#define ONBOARD_POLICY_BYTES GRRL_PAPER_POLICY_BYTES(ONBOARD_ENTRIES)
#endif

/* Nodes and characters for the believed structure as a term. */
enum { ONBOARD_TERM_NODES = 128, ONBOARD_TERM_BYTES = 1024 };

enum onboard_step {
    ONBOARD_STEP_FRAME,    /* a frame taken in */
    ONBOARD_STEP_PERCEIVE, /* bodies and joints from all keyframes */
    ONBOARD_STEP_CHOOSE,   /* recall, policy and push */
    ONBOARD_STEP_LEARN,    /* recall and update */
    ONBOARD_STEPS
};

/* In units of the counter given to onboard_controller_init. */
struct onboard_cost {
    uint64_t sum;
    uint32_t n;
    uint32_t most;
};

struct onboard_hashes {
    uint64_t models; /* with the structure as a term */
    uint64_t decisions;
    uint64_t updates;
};

struct onboard_controller {
    struct grrl_learner learner;
    union {
        max_align_t aligned;
        uint8_t bytes[ONBOARD_POLICY_BYTES];
    } policy;                     /* memory for any of ONBOARD_POLICIES */
    struct onboard_points points; /* of the frame being taken in */
    struct grrl_term_store terms;
    struct grrl_term_node nodes[ONBOARD_TERM_NODES];
    char text[ONBOARD_TERM_BYTES];
    struct onboard_packet answer;
    struct onboard_hashes hashes;
    uint64_t store_hash;  /* of what the policy learned as a file, after CLOSE */
    uint32_t store_bytes; /* of it */
    struct onboard_cost cost[ONBOARD_STEPS];
    uint32_t (*count)(void); /* NULL: nothing is counted */
    bool open;
};

/* count: a free-running counter of 32 bits, or NULL. */
void onboard_controller_init(struct onboard_controller *controller, uint32_t (*count)(void));

/*
 * Does what the packet says. The answer is in controller->answer: REFUSED after a failure.
 * GRRL_ERR_FORMAT: no such packet, or not of its length; GRRL_ERR_VERSION: a run of other
 * capacities; GRRL_ERR_NONE: a policy that this controller does not have; GRRL_ERR_ORDER: not open;
 * GRRL_ERR_CORRUPT: the hashes so far are not the expected ones. What the learner itself says is no
 * failure but the status in the answer.
 */
GRRL_MUST_USE enum grrl_status onboard_controller_take(struct onboard_controller *controller,
                                                       struct onboard_packet *packet);

GRRL_API_END

#endif
