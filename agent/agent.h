/*
 * agent.h: the learner on its wires, driven by events.
 *
 * The core subscribes and publishes on an lcm_t of the caller and asks the caller for the time; it
 * starts no thread, waits for nothing and touches no file. docs/messages.md has the protocol.
 *
 * Order of calls: grrl_agent_init; grrl_learner_load if there is experience; then lcm_handle and
 * grrl_agent_tick in turns (tick at least every 100 ms) until grrl_agent_finished;
 * grrl_agent_close.
 */
#ifndef GRRL_AGENT_H
#define GRRL_AGENT_H

#include <stdbool.h>
#include <stdint.h>

#include <lcm/lcm.h>

#include "grrl/learner/learner.h"
#include "wire.h"

GRRL_API_BEGIN

enum grrl_agent_event_kind {
    GRRL_AGENT_NOTE,     /* something to tell the user: text */
    GRRL_AGENT_DECIDED,  /* decision */
    GRRL_AGENT_LEARNED,  /* update, trial_id, pushes */
    GRRL_AGENT_TRIAL_END /* outcome, trial_id, pushes; a good time to save */
};

struct grrl_agent_event {
    enum grrl_agent_event_kind kind;
    const char *text;
    const grrl_decision_t *decision;
    const struct grrl_update *update;
    int32_t trial_id;
    int32_t pushes;
    int8_t outcome; /* GRRL_TRIAL_T_.. */
};

struct grrl_agent_config {
    struct grrl_learner_config learner;
    struct grrl_policy policy;
    int64_t session_id; /* random, above 0, another one in each run */
    bool observe;       /* learn from the decisions on the wire, send nothing */
    int64_t (*now_us)(void *context);
    void (*on_event)(void *context, const struct grrl_agent_event *event);
    void *context;
};

struct grrl_agent_counts {
    int64_t received; /* messages of all channels */
    int64_t lost;     /* gaps in the frames' seq */
    int64_t repeated; /* seen before */
    int64_t rejected; /* malformed */
    int64_t foreign;  /* of another session */
};

enum { GRRL_AGENT_SUBSCRIPTIONS = 4 };

struct grrl_agent {
    struct grrl_learner learner;
    struct grrl_agent_counts counts;

    /* private */
    struct grrl_agent_config config;
    lcm_t *lcm;
    lcm_subscription_t *subscriptions[GRRL_AGENT_SUBSCRIPTIONS];
    int64_t status_us;   /* when the last agent_status_t went out */
    int64_t answered_us; /* when the last answer went out */

    int64_t plant_session_id; /* 0: none yet */
    int64_t plant_heard_us;   /* observing: by the clock of the messages */
    int64_t heard_us;
    bool lock_step;
    bool finished;
    bool gave_way;
    bool rival_seen; /* and told */
    bool blind;      /* nothing could be pushed at the last look, and that was told */

    grrl_trial_t trial; /* the newest taken in; revision 0: none */
    uint8_t stage;
    int32_t trial_id; /* of the learner's trial */
    int32_t cmd_seq;  /* the last push commanded (observing: seen) */
    int64_t seq;      /* the newest frame taken in */
    bool adopted;     /* the learner knows what push cmd_seq is */
    int rest_frames;  /* since the last motion, for senders that do not tell the phase */
    int32_t rest_ack;

    grrl_push_status_t status; /* the newest of this trial's pushes; session_id 0: none */
    grrl_decision_t decision;  /* of cmd_seq; observing: the newest seen */
    grrl_push_command_t command;
    struct grrl_wire_model model;
    struct grrl_wire_points points;
    struct grrl_update update;
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
};

/* GRRL_ERR_ARGUMENT: a parameter of the learner is out of range; GRRL_ERR_IO: LCM refuses. The
 * agent must stay where it is until grrl_agent_close. */
GRRL_MUST_USE enum grrl_status grrl_agent_init(struct grrl_agent *agent,
                                               const struct grrl_agent_config *config, lcm_t *lcm);

/* What is due by the clock: the status at 2 Hz. */
void grrl_agent_tick(struct grrl_agent *agent);

/* The supervisor has no further trial. */
bool grrl_agent_finished(const struct grrl_agent *agent);

/* The robot, which no supervisor watches, moves for another agent: what moved would be put down to
 * the wrong push. This agent pushes and learns no more. */
bool grrl_agent_gave_way(const struct grrl_agent *agent);

/* Since the simulator or tracker was last heard of, or since the start. */
int64_t grrl_agent_silence_us(const struct grrl_agent *agent);

/* Abandons the trial under way and unsubscribes. */
void grrl_agent_close(struct grrl_agent *agent);

GRRL_API_END

#endif
