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
    GRRL_AGENT_NOTE,      /* something to tell the user: text */
    GRRL_AGENT_PERCEIVED, /* at rest after a push: the learner has a model; trial_id, pushes */
    GRRL_AGENT_DECIDED,   /* decision */
    GRRL_AGENT_LEARNED,   /* update, trial_id, pushes */
    GRRL_AGENT_TRIAL_END  /* outcome, trial_id, pushes; a good time to save */
};

/* Why the agent does no more. */
enum grrl_agent_end {
    GRRL_AGENT_GOES_ON,
    GRRL_AGENT_TRIALS_DONE, /* the supervisor has no further trial */
    GRRL_AGENT_SURE,        /* without a supervisor: every pair of links is decided */
    GRRL_AGENT_PUSHES_DONE, /* without a supervisor: all pushes that were wanted */
    GRRL_AGENT_GAVE_WAY,    /* the robot, which no supervisor watches, moves for another agent: what
                               moved would be attributed to the wrong push */
    GRRL_AGENT_STOPPED      /* somebody sent GRRL_STOP */
};

/* What trackers and robots do wrong. Each kind is told once, with what to do, and then counted. */
enum grrl_agent_mistake {
    GRRL_MISTAKE_UNACKNOWLEDGED, /* commands sent again, 2 s and more after the first */
    GRRL_MISTAKE_NO_TRIAL,       /* frames ignored for want of a trial */
    GRRL_MISTAKE_IDS,            /* frames whose ids are not those of the frame before */
    GRRL_MISTAKE_SPAN,           /* frames refused: the points span metres, and there is no table */
    GRRL_MISTAKE_OFF_TABLE,      /* points refused, beside the table */
    GRRL_MISTAKE_PUSH_OFF_TABLE, /* pushes chosen and not sent: they would leave the table */
    GRRL_MISTAKE_SLOW,           /* times of 2 s with fewer than 20 frames */
    GRRL_MISTAKE_REST,           /* frames at REST after 2 s of REST */
    GRRL_MISTAKE_MOVING,         /* frames of a push 5 s and more after its timeout */
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

/* A rectangle of the table plane, metres; all zero: none is known. */
struct grrl_agent_table {
    float x0_m;
    float y0_m;
    float x1_m;
    float y1_m;
};

struct grrl_agent_config {
    struct grrl_learner_config learner;
    struct grrl_policy policy;
    int64_t session_id; /* random, above 0, another one in each run */
    bool observe;       /* learn from the decisions on the wire, send nothing */

    /* Points beside the table are refused, and so are pushes that would leave it. Without a table
     * no frame is taken in whose points, but for outliers, span more than 2 m. */
    struct grrl_agent_table table;

    /* When a run without a supervisor is over; 0: never. */
    int32_t max_pushes;
    /* every pair of links is decided with this probability, and three pushes in a row for each
     * link revealed nothing; needs pair */
    float until_sure;
    /* Of the library, where the learner is in this process, else NULL: grrl_perception_pair, which
     * until_sure needs, and grrl_grounding_push, which a table needs. */
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
    int64_t received; /* messages of all channels */
    int64_t lost;     /* gaps in the frames' seq */
    int64_t repeated; /* seen before */
    int64_t rejected; /* malformed */
    int64_t foreign;  /* of another session */
};

enum { GRRL_AGENT_SUBSCRIPTIONS = 5 };

/* private: what agent_plant.c has seen of the tracker and the robot */
struct grrl_agent_plant {
    int64_t mistakes[GRRL_AGENT_MISTAKES];
    int64_t seq;              /* of the newest frame */
    int64_t window_us;        /* when counting frames began */
    int32_t window_n;         /* frames since then */
    int64_t ignored_us;       /* since when frames name no trial of ours, 0: they do */
    int64_t rest_us;          /* since when the phase is REST, 0: it is not */
    int32_t rest_n;           /* frames since then */
    int64_t commanded_us;     /* when the push under way was first sent */
    grrl_push_status_t other; /* the newest status that is not of this push; session_id 0: none */
    int32_t strange_n;        /* frames in a row with other ids than the frame before */
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
    grrl_stop_t stop; /* as it came; session_id 0: none, or a malformed one */
    bool rival_seen;  /* and told */
    bool supervised;  /* and told what that means */
    bool blind;       /* nothing could be pushed at the last look, and that was told */

    grrl_trial_t trial; /* the newest taken in; revision 0: none */
    uint8_t phase;
    int32_t trial_id; /* of the learner's trial */
    int32_t cmd_seq;  /* the last push commanded (observing: seen) */
    int64_t seq;      /* the newest frame taken in */
    bool begun;       /* a frame of this trial was */
    bool adopted;     /* the learner knows what push cmd_seq is */
    int rest_frames;  /* since the last motion, for senders that do not tell the phase */
    int32_t rest_ack;
    int32_t in_vain; /* pushes in a row that revealed nothing */

    grrl_push_status_t status; /* the newest of this trial's pushes; session_id 0: none */
    grrl_decision_t decision;  /* of cmd_seq; observing: the newest seen */
    grrl_push_command_t command;
    struct grrl_wire_model model;
    struct grrl_wire_points points;
    struct grrl_update update;
    struct grrl_agent_plant plant;
    struct grrl_learner before; /* with a table: the learner before it chose */
    int32_t replaced;           /* pushes chosen and replaced by others */
    char note[400];
    uint8_t bytes[GRRL_WIRE_MAX_BYTES];
};

/* GRRL_ERR_ARGUMENT: a parameter of the learner is out of range, or a function that the
 * configuration needs is missing; GRRL_ERR_IO: LCM refuses. The agent must stay where it is until
 * grrl_agent_close. */
GRRL_MUST_USE enum grrl_status grrl_agent_init(struct grrl_agent *agent,
                                               const struct grrl_agent_config *config, lcm_t *lcm);

/* What is due by the clock: the status at 2 Hz. */
void grrl_agent_tick(struct grrl_agent *agent);

/* Whether it goes on, or why not: it then pushes and learns no more. */
enum grrl_agent_end grrl_agent_end(const struct grrl_agent *agent);

/* There is nothing left to do: TRIALS_DONE, SURE or PUSHES_DONE. */
bool grrl_agent_finished(const struct grrl_agent *agent);

/* Who sent GRRL_STOP and why, in English; for STOPPED. Valid until grrl_agent_close. */
const char *grrl_agent_stop_text(struct grrl_agent *agent);

/* How often a mistake was made, and in English what was counted. */
int64_t grrl_agent_mistakes(const struct grrl_agent *agent, enum grrl_agent_mistake mistake);
const char *grrl_agent_mistake_text(enum grrl_agent_mistake mistake);

/* What the model leaves open: the smallest probability with which a pair of its links is decided,
 * and that pair (indices). 0: fewer than two links, a pair is undetermined, or there is no
 * config.pair. After GRRL_AGENT_PERCEIVED, before further frames. */
float grrl_agent_sureness(const struct grrl_agent *agent, uint8_t *a, uint8_t *b);

/* Since the simulator or tracker was last heard of, or since the start. */
int64_t grrl_agent_silence_us(const struct grrl_agent *agent);

/* Abandons the trial under way and unsubscribes. */
void grrl_agent_close(struct grrl_agent *agent);

GRRL_API_END

#endif
