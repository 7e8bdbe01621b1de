/*
 * learner.h: the whole agent without its wires.
 *
 * Order of calls, for each trial:
 *
 *   grrl_learner_begin_trial
 *   grrl_learner_observe     every frame, at rest
 *   grrl_learner_perceive    the model before the first push
 *   repeat
 *       grrl_learner_choose  (or grrl_learner_adopt: somebody else chose)
 *       grrl_learner_observe every frame, while pushing and then at rest
 *       grrl_learner_perceive
 *       grrl_learner_learn   ended = false, or true when the supervisor ends the trial
 *   until ended, or grrl_learner_abandon_trial
 *
 * Time never enters; random numbers come from the seed and the trial's number, so that the same
 * frames and outcomes give the same choices, bit for bit.
 */
#ifndef GRRL_LEARNER_H
#define GRRL_LEARNER_H

#include "grrl/base/api.h"
#include "grrl/learner/cases/case_base.h"
#include "grrl/learner/cases/context.h"
#include "grrl/learner/grounding.h"
#include "grrl/learner/policy.h"
#include "grrl/learner/relational_q/experience.h"
#include "grrl/learner/relational_state.h"
#include "grrl/perception/perception.h"

GRRL_API_BEGIN

#define grrl_learner_init GRRL_SIZED(grrl_learner_init)

/* Memory for what is learned, the caller's. What the policy does not use may be NULL and 0. */
struct grrl_learner_memory {
    struct grrl_case *cases; /* LEARN: at least one */
    uint32_t cases_capacity;
    struct grrl_experience_state *states; /* PAPER: at least one state and one experience */
    uint32_t states_capacity;
    struct grrl_experience *experiences;
    uint32_t experiences_capacity;
};

struct grrl_learner_config {
    struct grrl_perception_config perception;
    struct grrl_grounding_config grounding;
    struct grrl_policy_config policy;
    float large_m; /* links at least this long have the property large; 0.15 */
    uint64_t seed;
};

/* A decision: what to push, how, and why. */
struct grrl_decision {
    struct grrl_choice choice;
    uint16_t body_number; /* of the chosen link: the n of fn */
    struct grrl_push push;
};

/* What a push taught. */
struct grrl_update {
    float reward;        /* links and joints newly revealed, plus the trial's reward at its end */
    float target;        /* LEARN: the reward; PAPER: r + gamma max Q(s', a') */
    uint32_t experience; /* PAPER: the entry updated; GRRL_NO_EXPERIENCE: the state is too symmetric
                            to have a canonical form in the budget */
    uint32_t updated_case; /* LEARN: the case updated, else GRRL_NO_CASE */
};

struct grrl_learner {
    struct grrl_learner_config config;
    struct grrl_perception perception;
    struct grrl_experience_store store; /* what the policy PAPER learns */
    struct grrl_case_base cases;        /* what the policy LEARN learns */
    /* private */
    struct grrl_random random;
    struct grrl_graph state;    /* believed now: vertex i is body i of the model */
    struct grrl_graph acted_on; /* believed when the last choice was made */
    struct grrl_recall recall;  /* of state, for the last choice or update */
    struct grrl_trial_attempts attempts;
    struct grrl_contexts contexts; /* of state, for the last choice */
    struct grrl_choice last_choice;
    uint32_t trial;
    uint32_t pushes;    /* in this trial */
    uint8_t most_links; /* revealed so far in this trial */
    uint8_t most_joints;
    uint8_t phase; /* where in the order of calls */
};

/* How full the memory of the policy in use is. */
struct grrl_learner_usage {
    uint32_t n; /* cases (LEARN) or experiences (PAPER) */
    uint32_t capacity;
    uint32_t evictions;
};

void grrl_learner_config_default(struct grrl_learner_config *config);

/* GRRL_ERR_ARGUMENT: a parameter outside its range, or no memory for the policy. */
GRRL_MUST_USE enum grrl_status grrl_learner_init(struct grrl_learner *learner,
                                                 const struct grrl_learner_config *config,
                                                 const struct grrl_learner_memory *memory);

/* Starts with a new object or a new pose; the random numbers start from (seed, trial). Ends an
 * unfinished trial as grrl_learner_abandon_trial.
 */
void grrl_learner_begin_trial(struct grrl_learner *learner, uint32_t trial);

/* Without a trial the frame is ignored. */
void grrl_learner_observe(struct grrl_learner *learner, const struct grrl_frame *frame,
                          bool pushing);

/* Brings the model and the state up to date; at rest. GRRL_ERR_ORDER: no trial; GRRL_ERR_NONE:
 * nothing was seen. */
GRRL_MUST_USE enum grrl_status grrl_learner_perceive(struct grrl_learner *learner);

/* Chooses the next push. GRRL_ERR_ORDER; GRRL_ERR_NONE: there is no link to push. */
GRRL_MUST_USE enum grrl_status grrl_learner_choose(struct grrl_learner *learner,
                                                   struct grrl_decision *decision);

/* Takes a push somebody else chose, so that its outcome is learned. GRRL_ERR_ORDER;
 * GRRL_ERR_ARGUMENT: no such direction; GRRL_ERR_NONE: the model has no body of this number. */
GRRL_MUST_USE enum grrl_status grrl_learner_adopt(struct grrl_learner *learner,
                                                  uint16_t body_number, uint8_t direction,
                                                  struct grrl_decision *decision);

/*
 * Learns from the outcome of the last choice; after perceive. ended: the supervisor's special
 * reward is added and nothing follows. GRRL_ERR_ORDER. With the random policy nothing is stored.
 */
GRRL_MUST_USE enum grrl_status grrl_learner_learn(struct grrl_learner *learner, bool ended,
                                                  struct grrl_update *update);

/* Forgets the trial, nothing is learned from a push without an outcome. */
void grrl_learner_abandon_trial(struct grrl_learner *learner);

struct grrl_learner_usage grrl_learner_usage_of(const struct grrl_learner *learner);

/*
 * All that was learned, whatever the policy, as bytes: what grrl_experience_save writes, then what
 * grrl_cases_save writes. Between trials, or a trial's own rewards count as an earlier one's when
 * loaded. GRRL_ERR_IO.
 */
GRRL_MUST_USE enum grrl_status grrl_learner_save(const struct grrl_learner *learner,
                                                 const struct grrl_io *io);

/* Replaces all that was learned; statuses as of grrl_experience_load. After a failure the learner
 * knows nothing. */
GRRL_MUST_USE enum grrl_status grrl_learner_load(struct grrl_learner *learner,
                                                 const struct grrl_io *io);

/*
 * As grrl_learner_load, for a file that ends early: after GRRL_ERR_IO, and only then, the learner
 * knows what the file held whole. *lost becomes how many records it announced beyond those; what
 * stood behind a header that is cut off is not counted.
 */
GRRL_MUST_USE enum grrl_status grrl_learner_load_torn(struct grrl_learner *learner,
                                                      const struct grrl_io *io, uint32_t *lost);

/* The believed structure as a term, D(lb, ..), links named fn with their properties. */
GRRL_MUST_USE enum grrl_status grrl_learner_term(const struct grrl_learner *learner,
                                                 struct grrl_term_store *store, grrl_term *term);

GRRL_API_END

#endif
