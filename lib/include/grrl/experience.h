/*
 * experience.h: the instance-based Q function (paper, section V-D).
 *
 * An experience is a state with variables for links, an action on one of them, and the statistics
 * of the Q values met with it. States are kept in canonical form, actions on the smallest link of
 * their orbit, so that isomorphic states and symmetric actions share one entry.
 *
 * Memory is the caller's: an array of states and an array of experiences. When either is full the
 * experience least recently used (updated or recalled for a decision taken) makes room, and its
 * state with its last experience.
 */
#ifndef GRRL_EXPERIENCE_H
#define GRRL_EXPERIENCE_H

#include <stddef.h>

#include "grrl/canonical.h"
#include "grrl/graph.h"
#include "grrl/match.h"

/* Q statistics of one experience. */
struct grrl_q {
    float value; /* the Q-learning estimate */
    float mean;  /* of the targets met, and their sum of squared deviations (Welford) */
    float deviations;
    uint32_t n; /* targets met */
};

struct grrl_experience_state {
    /* private */
    uint32_t hash;           /* of graph, all properties */
    uint16_t experiences;    /* that refer to this state; 0: the slot is free */
    struct grrl_graph graph; /* canonical */
};

struct grrl_experience {
    /* private */
    uint16_t state;
    uint8_t link; /* in the state's canonical graph */
    uint8_t direction;
    uint8_t in_use;
    uint32_t used_at; /* store clock */
    struct grrl_q q;
};

struct grrl_experience_store {
    /* private */
    struct grrl_experience_state *states;
    struct grrl_experience *experiences;
    uint16_t states_capacity;
    uint16_t experiences_capacity;
    uint32_t clock;
    /* readable */
    uint16_t n_states;
    uint16_t n_experiences;
    uint16_t high_water; /* most experiences at a time */
    uint32_t evictions;
};

/* How an experience was found, best first (paper, section V-D). */
enum grrl_recall_level {
    GRRL_RECALL_EXACT,       /* isomorphic, all properties */
    GRRL_RECALL_RELAXED,     /* isomorphic, some properties dropped */
    GRRL_RECALL_SUBSTRUCTURE /* one is a sub-structure of the other */
};

enum { GRRL_NO_EXPERIENCE = 0xffff };

/* What is known of one action of the current state. */
struct grrl_recall_entry {
    uint16_t experience; /* index, or GRRL_NO_EXPERIENCE */
    uint8_t level;       /* enum grrl_recall_level */
    uint8_t distance;    /* links and joints that only one of the two has; properties dropped */
    uint8_t stored_link; /* the stored variable that is bound to the link */
};

/* All actions of a state: entry[link][direction]. */
struct grrl_recall {
    uint8_t n_links;
    struct grrl_recall_entry entry[GRRL_MAX_LINKS][GRRL_DIRECTIONS];
};

/* How far retrieval may reach. */
struct grrl_recall_config {
    enum grrl_recall_level deepest; /* GRRL_RECALL_SUBSTRUCTURE: everything */
    uint32_t budget;                /* search steps for one stored state */
};

/* Serialised reading and writing: return 0 when all `size` bytes were transferred. */
struct grrl_experience_io {
    void *context;
    int (*write)(void *context, const void *bytes, size_t size);
    int (*read)(void *context, void *bytes, size_t size);
};

void grrl_experience_init(struct grrl_experience_store *store, struct grrl_experience_state *states,
                          uint16_t states_capacity, struct grrl_experience *experiences,
                          uint16_t experiences_capacity);

/*
 * For each action of the state the closest experience: exact matches first, then properties dropped
 * one place after another from the last to the first, then sub-structures (either may be the
 * larger), fewest differing links and joints first; ties go to the entry with more targets met,
 * then to the lower index. An experience whose stored link the match does not bind is no match.
 */
void grrl_experience_recall(const struct grrl_experience_store *store,
                            const struct grrl_graph *state, const struct grrl_recall_config *config,
                            struct grrl_recall *recall);

/*
 * Moves the estimate of (state, link, direction) towards a target: value <- (1 - alpha) value +
 * alpha target; a new entry starts with value = target. *index tells the entry.
 * GRRL_ERR_UNDECIDED: the state has no canonical form within the budget, nothing is stored.
 */
GRRL_MUST_USE enum grrl_status grrl_experience_update(struct grrl_experience_store *store,
                                                      const struct grrl_graph *state, uint8_t link,
                                                      uint8_t direction, float target, float alpha,
                                                      uint16_t *index);

/* Marks an experience as used now. */
void grrl_experience_touch(struct grrl_experience_store *store, uint16_t index);

/*
 * The store as bytes: a header (magic, version, limits), the states, the experiences, each with a
 * CRC-32, little-endian whatever the machine. Saving what was loaded gives the same bytes.
 * GRRL_ERR_IO.
 */
GRRL_MUST_USE enum grrl_status grrl_experience_save(const struct grrl_experience_store *store,
                                                    const struct grrl_experience_io *io);

/* Replaces the store's content. GRRL_ERR_IO (also for a file that ends early), GRRL_ERR_FORMAT,
 * GRRL_ERR_VERSION, GRRL_ERR_CORRUPT, GRRL_ERR_FULL; after a failure the store is empty. */
GRRL_MUST_USE enum grrl_status grrl_experience_load(struct grrl_experience_store *store,
                                                    const struct grrl_experience_io *io);

#endif
