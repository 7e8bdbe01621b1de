/*
 * learner.h: the whole agent, independent of transport.
 *
 * Order of calls, for each trial:
 *
 *   grrl_learner_begin_trial
 *   grrl_learner_observe     every frame, at rest
 *   grrl_learner_perceive    the model before the first push
 *   repeat
 *       grrl_learner_choose  (or grrl_learner_adopt, if the caller chose)
 *       grrl_learner_observe every frame, while pushing and then at rest
 *       grrl_learner_perceive
 *       grrl_learner_learn   ended = false, or true when the supervisor ends the trial
 *   until ended, or grrl_learner_abandon_trial
 *
 * The learner has no clock. Its random numbers depend only on the seed and the trial number, so the
 * same frames and outcomes give the same choices, bit for bit.
 */
#ifndef GRRL_LEARNER_H
#define GRRL_LEARNER_H

#include "grrl/base/api.h"
#include "grrl/learner/grounding.h"
#include "grrl/learner/policy.h"
#include "grrl/learner/relational_state.h"
#include "grrl/perception/perception.h"

GRRL_API_BEGIN

#define grrl_learner_init GRRL_SIZED(grrl_learner_init)

struct grrl_learner_config {
    struct grrl_perception_config perception;
    struct grrl_grounding_config grounding;
    float large_m;      /* links at least this long have the property large (l); 0.15 */
    float trial_reward; /* added to the last reward of a trial, 0 to GRRL_MAX_TRIAL_REWARD; 1 */
    uint64_t seed;
};

#define GRRL_MAX_TRIAL_REWARD 1000.0f

/* A decision: what to push, how, and why. */
struct grrl_decision {
    struct grrl_choice choice;
    uint16_t body_number; /* of the chosen link: the n of fn */
    struct grrl_push push;
};

struct grrl_learner {
    struct grrl_learner_config config;
    struct grrl_perception perception;
    struct grrl_policy policy;
    /* private */
    struct grrl_random random;
    struct grrl_graph state; /* current estimate; vertex i is body i of the model */
    struct grrl_choice last_choice;
    uint16_t last_number; /* of the body pushed last */
    uint32_t trial;
    uint8_t most_links; /* most links revealed so far in this trial */
    uint8_t most_joints;
    uint8_t phase; /* position in the order of calls */
};

void grrl_learner_config_default(struct grrl_learner_config *config);

/* The policy's memory must outlive the learner. GRRL_ERR_ARGUMENT: a parameter is outside its
 * range. */
GRRL_MUST_USE enum grrl_status grrl_learner_init(struct grrl_learner *learner,
                                                 const struct grrl_learner_config *config,
                                                 struct grrl_policy policy);

/* Starts a trial with a new object or a new pose, and seeds the random numbers from (seed, trial).
 * Abandons an unfinished trial. */
void grrl_learner_begin_trial(struct grrl_learner *learner, uint32_t trial);

/* Outside a trial the frame is ignored. */
void grrl_learner_observe(struct grrl_learner *learner, const struct grrl_frame *frame,
                          bool pushing);

/* Updates the model and the state; call it at rest. GRRL_ERR_ORDER: no trial; GRRL_ERR_NONE:
 * nothing was seen. */
GRRL_MUST_USE enum grrl_status grrl_learner_perceive(struct grrl_learner *learner);

/* Chooses the next push. GRRL_ERR_ORDER; GRRL_ERR_NONE: no link to push. */
GRRL_MUST_USE enum grrl_status grrl_learner_choose(struct grrl_learner *learner,
                                                   struct grrl_decision *decision);

/* Accepts a push that the caller chose, so that its outcome is learned. exploited: the choice rests
 * on stored entries, and so counts as a use of them. GRRL_ERR_ORDER; GRRL_ERR_ARGUMENT: no such
 * direction; GRRL_ERR_NONE: the model has no body of this number. */
GRRL_MUST_USE enum grrl_status grrl_learner_adopt(struct grrl_learner *learner,
                                                  uint16_t body_number, uint8_t direction,
                                                  bool exploited, struct grrl_decision *decision);

/*
 * Learns from the outcome of the last choice; call it after perceive. ended: adds the supervisor's
 * special reward and ends the trial. GRRL_ERR_ORDER.
 */
GRRL_MUST_USE enum grrl_status grrl_learner_learn(struct grrl_learner *learner, bool ended,
                                                  struct grrl_update *update);

/* Drops the trial. A push without an outcome teaches nothing. */
void grrl_learner_abandon_trial(struct grrl_learner *learner);

/* How full the policy's memory is; zeros for a policy that does not learn. */
struct grrl_usage grrl_learner_usage(const struct grrl_learner *learner);

/*
 * Writes what the policy learned, as bytes. Save between trials: once loaded, rewards of an
 * unfinished trial count as those of an earlier one. GRRL_ERR_IO; GRRL_ERR_NONE: the policy does
 * not learn.
 */
GRRL_MUST_USE enum grrl_status grrl_learner_save(const struct grrl_learner *learner,
                                                 const struct grrl_io *io);

/*
 * Replaces what was learned. A record is checked before it is used. GRRL_ERR_IO: also for a file
 * that ends early. GRRL_ERR_FORMAT: not one of our files. GRRL_ERR_VERSION: from another version or
 * build. GRRL_ERR_POLICY: from another policy. GRRL_ERR_CORRUPT: damaged. GRRL_ERR_FULL: it holds
 * more than fits. GRRL_ERR_NONE: the policy does not learn. After a failure the learner's memory is
 * empty.
 */
GRRL_MUST_USE enum grrl_status grrl_learner_load(struct grrl_learner *learner,
                                                 const struct grrl_io *io);

/*
 * Like grrl_learner_load, but salvages a file that ends early: after GRRL_ERR_IO, and only then,
 * the learner holds the records that were complete. *lost is set to the number of further entries
 * that the file announced; entries behind a truncated header are not counted.
 */
GRRL_MUST_USE enum grrl_status grrl_learner_load_torn(struct grrl_learner *learner,
                                                      const struct grrl_io *io, uint32_t *lost);

/* Forgets everything learned. */
void grrl_learner_clear(struct grrl_learner *learner);

/* The estimated structure as a term, D(lb, ..), with links named fn and their properties. */
GRRL_MUST_USE enum grrl_status grrl_learner_term(const struct grrl_learner *learner,
                                                 struct grrl_term_store *store, grrl_term *term);

GRRL_API_END

#endif
