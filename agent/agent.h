/*
 * agent.h: connects the learner to LCM; driven by events.
 *
 * The core subscribes and publishes on the caller's lcm_t and asks the caller for the time; it
 * starts no thread, never blocks and accesses no file. docs/messages.md describes the protocol.
 *
 * Order of calls: grrl_agent_init; grrl_learner_load if there is a store; then alternate lcm_handle
 * and grrl_agent_tick (tick at least every 100 ms) until grrl_agent_finished; grrl_agent_close.
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
    GRRL_AGENT_NOTE,      /* a message for the user: text */
    GRRL_AGENT_PERCEIVED, /* at rest after a push: the learner has a model; trial_id, pushes */
    GRRL_AGENT_DECIDED,   /* decision */
    GRRL_AGENT_LEARNED,   /* update, trial_id, pushes */
    GRRL_AGENT_TRIAL_END  /* outcome, trial_id, pushes; a good time to save */
};

/* Why the agent has stopped. */
enum grrl_agent_end {
    GRRL_AGENT_GOES_ON,
    GRRL_AGENT_TRIALS_DONE, /* the supervisor has no further trials */
    GRRL_AGENT_SURE,        /* without a supervisor: every pair of links is decided */
    GRRL_AGENT_PUSHES_DONE, /* without a supervisor: all requested pushes are done */
    GRRL_AGENT_GAVE_WAY,    /* without a supervisor: the robot moves for another agent, and motion
                               would be attributed to the wrong push */
    GRRL_AGENT_STOPPED      /* somebody sent GRRL_STOP */
};

/* Mistakes of trackers and robots. Each kind is reported once, with a remedy, and then counted. */
enum grrl_agent_mistake {
    GRRL_MISTAKE_UNACKNOWLEDGED, /* commands sent again 2 s or more after the first */
    GRRL_MISTAKE_NO_TRIAL,       /* frames ignored because they belong to no trial */
    GRRL_MISTAKE_IDS,            /* frames whose ids differ from those of the previous frame */
    GRRL_MISTAKE_SPAN,           /* frames refused: the points span metres, and there is no table */
    GRRL_MISTAKE_OFF_TABLE,      /* points refused because they are off the table */
    GRRL_MISTAKE_PUSH_OFF_TABLE, /* pushes chosen but not sent because they would leave the table */
    GRRL_MISTAKE_SLOW,           /* periods of 2 s with fewer than 20 frames */
    GRRL_MISTAKE_REST,           /* frames at REST after 2 s of REST */
    GRRL_MISTAKE_MOVING,         /* frames of a push 5 s or more after its timeout */
    GRRL_AGENT_MISTAKES
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

/* A rectangle in the table plane, metres; all zero: not known. */
struct grrl_agent_table {
    float x0_m;
    float y0_m;
    float x1_m;
    float y1_m;
};

struct grrl_agent_config {
    struct grrl_learner_config learner;
    struct grrl_policy policy;
    int64_t session_id; /* random, above 0, different in each run */
    bool observe;       /* learn from the decisions on the wire, send nothing */

    /* Points off the table are refused, and so are pushes that would leave it. Without a table,
     * frames whose points (ignoring outliers) span more than 2 m are refused. */
    struct grrl_agent_table table;

    /* When a run without a supervisor ends; 0: never. */
    int32_t max_pushes;
    /* every pair of links is decided with this probability, and the last three pushes for each link
     * revealed nothing; needs pair */
    float until_sure;
    /* Library functions if the learner is in this process, else NULL: grrl_perception_pair (needed
     * by until_sure) and grrl_grounding_push (needed by a table). */
    enum grrl_status (*pair)(const struct grrl_perception *perception, uint8_t a, uint8_t b,
                             struct grrl_pair *pair);
    enum grrl_status (*ground)(const struct grrl_model *model,
                               const struct grrl_grounding_config *config, uint8_t body,
                               uint8_t direction, struct grrl_push *push);

    int64_t (*now_us)(void *context);
    void (*on_event)(void *context, const struct grrl_agent_event *event);
    void *context;
};

struct grrl_agent_counts {
    int64_t received; /* messages on all channels */
    int64_t lost;     /* gaps in the frames' seq */
    int64_t repeated; /* seen before */
    int64_t rejected; /* malformed */
    int64_t foreign;  /* of another session */
};

enum { GRRL_AGENT_SUBSCRIPTIONS = 5 };

/* private: what agent_plant.c has observed of the tracker and the robot */
struct grrl_agent_plant {
    int64_t mistakes[GRRL_AGENT_MISTAKES];
    int64_t seq;              /* of the newest frame */
    int64_t window_us;        /* when counting frames began */
    int32_t window_n;         /* frames since then */
    int64_t ignored_us;       /* since when frames name no trial of ours; 0: they do */
    int64_t rest_us;          /* since when the phase is REST; 0: it is not */
    int32_t rest_n;           /* frames since then */
    int64_t commanded_us;     /* when the current push was first sent */
    grrl_push_status_t other; /* the newest status of a different push; session_id 0: none */
    int32_t strange_n;        /* consecutive frames with ids unlike those of the previous frame */
    int32_t n_points;         /* of the newest frame */
    int32_t id[GRRL_WIRE_MAX_POINTS];
    float x[GRRL_WIRE_MAX_POINTS];
    float y[GRRL_WIRE_MAX_POINTS];
};

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
    enum grrl_agent_end end;
    grrl_stop_t stop; /* as received; session_id 0: none, or malformed */
    bool rival_seen;  /* already reported */
    bool supervised;  /* already explained */
    bool blind;       /* nothing could be pushed last time; already reported */

    grrl_trial_t trial; /* the newest one accepted; revision 0: none */
    uint8_t phase;
    int32_t trial_id; /* of the learner's trial */
    int32_t cmd_seq;  /* the last push commanded (observing: seen) */
    int64_t seq;      /* the newest frame accepted */
    bool begun;       /* a frame of this trial has been accepted */
    bool adopted;     /* the learner knows push cmd_seq */
    int rest_frames;  /* since the last motion, for senders that do not report the phase */
    int32_t rest_ack;
    int32_t in_vain; /* consecutive pushes that revealed nothing */

    grrl_push_status_t status; /* the newest for a push of this trial; session_id 0: none */
    grrl_decision_t decision;  /* of cmd_seq; observing: the newest seen */
    grrl_push_command_t command;
    struct grrl_wire_model model;
    struct grrl_wire_points points;
    struct grrl_update update;
    struct grrl_agent_plant plant;
    struct grrl_learner before; /* with a table: a copy of the learner before it chose */
    int32_t replaced;           /* pushes chosen and replaced by others */
    char note[400];
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
};

/* GRRL_ERR_ARGUMENT: a parameter of the learner is out of range, or a function that the
 * configuration needs is missing; GRRL_ERR_IO: LCM refuses. The agent must not be moved before
 * grrl_agent_close. */
GRRL_MUST_USE enum grrl_status grrl_agent_init(struct grrl_agent *agent,
                                               const struct grrl_agent_config *config, lcm_t *lcm);

/* Sends what is due by the clock: the status at 2 Hz. */
void grrl_agent_tick(struct grrl_agent *agent);

/* Whether the agent continues, or why not; it then neither pushes nor learns any more. */
enum grrl_agent_end grrl_agent_end(const struct grrl_agent *agent);

/* Whether nothing is left to do: TRIALS_DONE, SURE or PUSHES_DONE. */
bool grrl_agent_finished(const struct grrl_agent *agent);

/* Who sent GRRL_STOP and why, in English; for STOPPED. Valid until grrl_agent_close. */
const char *grrl_agent_stop_text(struct grrl_agent *agent);

/* How often a mistake occurred, and in English what is counted. */
int64_t grrl_agent_mistakes(const struct grrl_agent *agent, enum grrl_agent_mistake mistake);
const char *grrl_agent_mistake_text(enum grrl_agent_mistake mistake);

/* How certain the model is: the smallest probability with which a pair of its links is decided, and
 * that pair (indices). 0: fewer than two links, an undetermined pair, or no config.pair. Valid
 * after GRRL_AGENT_PERCEIVED, before further frames. */
float grrl_agent_sureness(const struct grrl_agent *agent, uint8_t *a, uint8_t *b);

/* Time since the simulator or tracker was last heard, or since the start. */
int64_t grrl_agent_silence_us(const struct grrl_agent *agent);

/* Abandons the current trial and unsubscribes. */
void grrl_agent_close(struct grrl_agent *agent);

GRRL_API_END

#endif
