/*
 * policy.h: how a policy plugs into the learner.
 *
 * A policy decides which link to push in which direction, and may learn from what the push reveals.
 * It is a table of operations (struct grrl_policy_type) and the memory they work on. The learner
 * calls the operations and knows no policy by name, so that firmware links the one it uses.
 * policies.h lists the policies of the library; docs/design.md shows how to write one.
 */
#ifndef GRRL_LEARNER_POLICY_H
#define GRRL_LEARNER_POLICY_H

#include "grrl/base/api.h"
#include "grrl/base/io.h"
#include "grrl/base/random.h"
#include "grrl/perception/perception.h"
#include "grrl/structure/graph.h"

GRRL_API_BEGIN

/* What a policy sees of the world: what perception estimates, now. */
struct grrl_view {
    const struct grrl_perception *perception;
    const struct grrl_model
        *model; /* of it, with one body at least when there is a choice to make */
    const struct grrl_graph *state; /* of the model: vertex i is body i */
    float large_m;                  /* length from which a link is large */
};

enum grrl_choice_reason {
    GRRL_CHOICE_RANDOM,  /* any action, whatever is known */
    GRRL_CHOICE_EXPLORE, /* an action without experience (for cases: in exactly this context) */
    GRRL_CHOICE_EXPLOIT, /* the best action, from experience */
    GRRL_CHOICE_ADOPTED, /* chosen by somebody else */
    GRRL_CHOICE_RULE     /* by a rule that does not learn */
};

/* What an estimate comes from. */
enum grrl_source_kind {
    GRRL_SOURCE_NONE,         /* nothing is known of the action */
    GRRL_SOURCE_EXACT,        /* an experience with the same structure and properties */
    GRRL_SOURCE_RELAXED,      /* the same structure, some properties ignored */
    GRRL_SOURCE_SUBSTRUCTURE, /* one structure contains the other */
    GRRL_SOURCE_CASES /* the mean over all cases; index and distance are the closest one's */
};

struct grrl_source {
    uint8_t kind; /* enum grrl_source_kind */
    uint8_t
        distance;   /* links and joints that differ; for cases: parts of the context that differ */
    uint32_t index; /* of the experience or case in its store; GRRL_NO_ENTRY without one */
};

#define GRRL_NO_ENTRY UINT32_MAX

/* An action of the state, and why. */
struct grrl_choice {
    uint8_t link;      /* a vertex of the state */
    uint8_t direction; /* an index into grrl_direction_deg */
    uint8_t reason;    /* enum grrl_choice_reason */
    struct grrl_source source;
    float value; /* estimated reward, or Q value; 0 without a source */
    float lower; /* its confidence bounds */
    float upper;
    float phi; /* share of the state's actions with experience (for cases: in exactly their context)
                */
};

/* What came of a choice. */
struct grrl_outcome {
    struct grrl_view view; /* after the push */
    struct grrl_choice choice;
    uint16_t body_number; /* of the link that was pushed */
    float reward;         /* links and joints revealed; at the trial's end also its reward */
    bool ended;           /* the trial ended, and nothing follows */
};

/* What a policy learned from an outcome. */
struct grrl_update {
    float reward;
    float target;   /* what the estimate moved towards: the reward, or r + gamma max Q(s', a') */
    uint32_t index; /* the entry updated, or GRRL_NO_ENTRY */
};

/* How full a policy's memory is. */
struct grrl_usage {
    uint32_t n;
    uint32_t capacity;
    uint32_t evictions;
};

/* A number in a policy's configuration that a user may set by name. */
struct grrl_parameter {
    const char *name;  /* "alpha" */
    const char *help;  /* "learning rate" */
    const char *range; /* "a number above 0 to 1" */
    size_t offset;     /* of the float in the configuration */
};

/* The most bytes of a configuration, so that programs can hold any. */
enum { GRRL_POLICY_CONFIG_BYTES = 128 };

/*
 * The operations of a policy. `self` is its memory. An operation that is NULL does nothing; name,
 * text, bytes, init and choose are required.
 */
struct grrl_policy_type {
    const char *name;    /* for command lines, at most GRRL_POLICY_NAME_BYTES with its zero */
    const char *text;    /* one line for --help */
    const char *entries; /* what it stores: "cases"; NULL: it does not learn */

    /* its configuration; parameters and config_bytes may be 0 */
    const struct grrl_parameter *parameters;
    size_t n_parameters;
    size_t config_bytes;
    void (*config_default)(void *config);
    /* GRRL_ERR_ARGUMENT for a value out of range; *field, if not NULL, names it */
    enum grrl_status (*config_check)(const void *config, const char **field);

    /* bytes of memory for `capacity` entries, aligned for any type */
    size_t (*bytes)(uint32_t capacity);
    /* prepares that memory. config NULL: the default. GRRL_ERR_ARGUMENT */
    enum grrl_status (*init)(void *self, uint32_t capacity, const void *config);

    /* forgets what belongs to one trial; another object or pose follows */
    void (*begin_trial)(void *self);
    /* fills in the choice; there is at least one link */
    void (*choose)(void *self, const struct grrl_view *view, struct grrl_random *random,
                   struct grrl_choice *choice);
    /* as choose, for choice->link and choice->direction that somebody else chose */
    void (*explain)(void *self, const struct grrl_view *view, struct grrl_choice *choice);
    /* a decision rested on choice->source */
    void (*used)(void *self, const struct grrl_choice *choice);
    /* after each push that was chosen or explained; update->reward and ->target are the reward and
     * update->index is GRRL_NO_ENTRY before */
    void (*learn)(void *self, const struct grrl_outcome *outcome, struct grrl_update *update);
    struct grrl_usage (*usage)(const void *self);
    /* forgets all that was learned */
    void (*clear)(void *self);
    /* what was learned as bytes. GRRL_ERR_IO */
    enum grrl_status (*save)(const void *self, const struct grrl_io *io);
    /* replaces what was learned; statuses as of grrl_learner_load_torn. Empty after a failure, but
     * after GRRL_ERR_IO it holds what was whole, and *lost counts the entries announced beyond */
    enum grrl_status (*load)(void *self, const struct grrl_io *io, uint32_t *lost);
};

enum { GRRL_POLICY_NAME_BYTES = 16 };

/* A policy at work. */
struct grrl_policy {
    const struct grrl_policy_type *type;
    void *self;
};

/* A policy of this type in `bytes` bytes of the caller's memory, which must be aligned for any
 * type. config NULL: the default. GRRL_ERR_FULL: less memory than type->bytes(capacity);
 * GRRL_ERR_ARGUMENT: a parameter out of range, or no capacity for a policy that learns. */
GRRL_MUST_USE enum grrl_status grrl_policy_make(const struct grrl_policy_type *type, void *memory,
                                                size_t bytes, uint32_t capacity, const void *config,
                                                struct grrl_policy *policy);

/* The source of an estimate that has none. */
static inline struct grrl_source grrl_no_source(void)
{
    struct grrl_source source = {GRRL_SOURCE_NONE, 0, GRRL_NO_ENTRY};
    return source;
}

GRRL_API_END

#endif
