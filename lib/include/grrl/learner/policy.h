/*
 * policy.h: how a policy plugs into the learner.
 *
 * A policy decides which link to push in which direction, and may learn from what the push reveals.
 * It is a table of operations (struct grrl_policy_type) and the memory they work on. The learner
 * calls the operations and refers to no policy by name, so firmware links only the policy it uses.
 * policies.h lists the library's policies; docs/design.md shows how to write one.
 */
#ifndef GRRL_LEARNER_POLICY_H
#define GRRL_LEARNER_POLICY_H

#include "grrl/base/api.h"
#include "grrl/base/io.h"
#include "grrl/base/random.h"
#include "grrl/perception/perception.h"
#include "grrl/structure/graph.h"

GRRL_API_BEGIN

/* What a policy sees of the world: the current estimate of perception. */
struct grrl_view {
    const struct grrl_perception *perception;
    const struct grrl_model *model; /* has at least one body when there is a choice to make */
    const struct grrl_graph *state; /* of the model: vertex i is body i */
    float large_m;                  /* links at least this long are large */
};

enum grrl_choice_reason {
    GRRL_CHOICE_RANDOM,  /* any action, regardless of what is known */
    GRRL_CHOICE_EXPLORE, /* an action without an entry (cases: none in exactly this context) */
    GRRL_CHOICE_EXPLOIT, /* the best action, according to the entries */
    GRRL_CHOICE_ADOPTED, /* chosen outside the learner */
    GRRL_CHOICE_RULE     /* chosen by a rule that does not learn */
};

/* What an estimate is based on. */
enum grrl_source_kind {
    GRRL_SOURCE_NONE,         /* nothing is known of the action */
    GRRL_SOURCE_EXACT,        /* an experience with the same structure and properties */
    GRRL_SOURCE_RELAXED,      /* the same structure, some properties ignored */
    GRRL_SOURCE_SUBSTRUCTURE, /* one structure contains the other */
    GRRL_SOURCE_CASES         /* the mean over all cases; index and distance refer to the closest */
};

struct grrl_source {
    uint8_t kind;     /* enum grrl_source_kind */
    uint8_t distance; /* links and joints that differ; cases: parts of the context that differ */
    uint32_t index;   /* of the experience or case in its store; GRRL_NO_ENTRY if none */
};

#define GRRL_NO_ENTRY UINT32_MAX

/* An action in the current state, and the reason for it. */
struct grrl_choice {
    uint8_t link;      /* a vertex of the state */
    uint8_t direction; /* an index into grrl_direction_deg */
    uint8_t reason;    /* enum grrl_choice_reason */
    struct grrl_source source;
    float value; /* estimated reward, or Q value; 0 without a source */
    float lower; /* confidence bounds of value */
    float upper;
    float phi; /* share of the state's actions with an entry (cases: in exactly their context) */
};

/* The outcome of a choice. */
struct grrl_outcome {
    struct grrl_view view; /* after the push */
    struct grrl_choice choice;
    uint16_t body_number; /* of the link that was pushed */
    float reward; /* links and joints revealed; the last push of a trial adds the trial's reward */
    bool ended;   /* the trial ended; no push follows */
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

/* A number in a policy's configuration that users set by name. */
struct grrl_parameter {
    const char *name;  /* "alpha" */
    const char *help;  /* "learning rate" */
    const char *range; /* "a number above 0 to 1" */
    size_t offset;     /* of the float in the configuration */
};

/* The largest configuration, in bytes, so that a program can hold any of them. */
enum { GRRL_POLICY_CONFIG_BYTES = 128 };

/*
 * The operations of a policy. `self` is its memory. A NULL operation does nothing; name, text,
 * bytes, init and choose are required.
 */
struct grrl_policy_type {
    const char *name;    /* for command lines, shorter than GRRL_POLICY_NAME_BYTES */
    const char *text;    /* one line for --help */
    const char *entries; /* what it stores, such as "cases"; NULL: it does not learn */

    /* its configuration; parameters and config_bytes may be 0 */
    const struct grrl_parameter *parameters;
    size_t n_parameters;
    size_t config_bytes;
    void (*config_default)(void *config);
    /* GRRL_ERR_ARGUMENT for a value out of range; *field, if not NULL, is set to its name */
    enum grrl_status (*config_check)(const void *config, const char **field);

    /* bytes of memory for `capacity` entries; the memory is aligned for any type */
    size_t (*bytes)(uint32_t capacity);
    /* prepares that memory. config NULL: the default. GRRL_ERR_ARGUMENT */
    enum grrl_status (*init)(void *self, uint32_t capacity, const void *config);

    /* clears what belongs to one trial; another object or pose follows */
    void (*begin_trial)(void *self);
    /* fills in the choice; the state has at least one link */
    void (*choose)(void *self, const struct grrl_view *view, struct grrl_random *random,
                   struct grrl_choice *choice);
    /* like choose, for a choice->link and choice->direction that the caller chose */
    void (*explain)(void *self, const struct grrl_view *view, struct grrl_choice *choice);
    /* records that a decision used choice->source */
    void (*used)(void *self, const struct grrl_choice *choice);
    /* called after each push that was chosen or explained. On entry, update->reward and
     * update->target are the reward and update->index is GRRL_NO_ENTRY */
    void (*learn)(void *self, const struct grrl_outcome *outcome, struct grrl_update *update);
    struct grrl_usage (*usage)(const void *self);
    /* forgets everything learned */
    void (*clear)(void *self);
    /* writes what was learned as bytes. GRRL_ERR_IO */
    enum grrl_status (*save)(const void *self, const struct grrl_io *io);
    /* replaces what was learned; statuses as for grrl_learner_load_torn. After a failure the memory
     * is empty, except after GRRL_ERR_IO: then it holds the complete records, and *lost counts the
     * further entries that were announced */
    enum grrl_status (*load)(void *self, const struct grrl_io *io, uint32_t *lost);
};

enum { GRRL_POLICY_NAME_BYTES = 16 };

/* Opens the definition of a policy's type, so that a shared library exports it. */
#if defined(__GNUC__)
#define GRRL_POLICY_TYPE __attribute__((visibility("default"))) const struct grrl_policy_type
#else
#define GRRL_POLICY_TYPE const struct grrl_policy_type
#endif

/* A policy and its memory. */
struct grrl_policy {
    const struct grrl_policy_type *type;
    void *self;
};

/* Makes a policy of this type in `bytes` bytes of the caller's memory, which must be aligned for
 * any type. config NULL: the default. GRRL_ERR_FULL: less memory than type->bytes(capacity);
 * GRRL_ERR_ARGUMENT: a parameter out of range, or capacity 0 for a policy that learns. */
GRRL_MUST_USE enum grrl_status grrl_policy_make(const struct grrl_policy_type *type, void *memory,
                                                size_t bytes, uint32_t capacity, const void *config,
                                                struct grrl_policy *policy);

/* The source of an estimate that is based on nothing. */
static inline struct grrl_source grrl_no_source(void)
{
    struct grrl_source source = {GRRL_SOURCE_NONE, 0, GRRL_NO_ENTRY};
    return source;
}

GRRL_API_END

#endif
