/*
 * experience.h: the instance-based Q function (paper, section V-D).
 *
 * An experience is a state with variables for links, an action on one of them, and the statistics
 * of the Q values met with it. States are kept in canonical form, actions on the smallest link of
 * their orbit, so that isomorphic states and symmetric actions share one entry.
 *
 * Memory is the caller's: an array of states and an array of experiences, both filled from the
 * front without gaps, from one entry on a microcontroller to millions on a host in the same code;
 * and, for thousands of states or more, an index that keeps states of a size side by side.
 * A state is found by a hash table whose heads live in the states themselves.
 * Used means updated, or touched because a decision rests on it. When the
 * experiences are full, the one least recently used makes room, and a state goes with its last
 * experience; when the states are full, the one whose experiences were all used longest ago makes
 * room, with all of them. The last of an array moves into a gap, so that an eviction may change the
 * index of others: an index is good until the next update or load.
 */
#ifndef GRRL_EXPERIENCE_H
#define GRRL_EXPERIENCE_H

#include <stdbool.h>
#include <stddef.h>

#include "grrl/base/api.h"
#include "grrl/base/config.h"
#include "grrl/base/io.h"
#include "grrl/structure/canonical.h"
#include "grrl/structure/graph.h"
#include "grrl/structure/match.h"

GRRL_API_BEGIN

#define grrl_experience_init GRRL_SIZED(grrl_experience_init)

/* Q statistics of one experience. */
struct grrl_q {
    float value; /* the Q-learning estimate */
    float mean;  /* of the targets met, and their sum of squared deviations (Welford) */
    float deviations;
    uint32_t n; /* targets met */
};

/* Hash tables of states: by canonical form, by canonical form without properties. */
enum { GRRL_EXPERIENCE_TABLES = 2 };

/* At most 512 bytes for 32 links and 64 joints, with its share of the index. */
struct grrl_experience_state {
    /* private */
    struct grrl_paths paths; /* first, with the first word of the signature: what a scan reads */
    uint8_t n;               /* links */
    uint8_t joints[GRRL_JOINT_TYPES]; /* of each type */
    struct grrl_signature signature;
    uint32_t head[GRRL_EXPERIENCE_TABLES];  /* first state of the bucket with this state's number */
    uint32_t chain[GRRL_EXPERIENCE_TABLES]; /* next state of the bucket this state is in */
    uint32_t key[GRRL_EXPERIENCE_TABLES];   /* hash of the graph, all properties or none */
    uint32_t experiences;                   /* that refer to this state, at least one */
    uint32_t first;                         /* of them */
    uint16_t edge[GRRL_MAX_JOINTS]; /* canonical: type, link and lower link, 5 bits a link */
    grrl_label label[GRRL_MAX_LINKS];
};

struct grrl_experience {
    /* private */
    uint32_t state;
    uint32_t next; /* of the same state, or GRRL_NO_EXPERIENCE */
    uint8_t link;  /* in the state's canonical graph, smallest of its orbit */
    uint8_t direction;
    uint32_t used_at; /* store clock */
    struct grrl_q q;
};

/* What an index knows of a state. */
struct grrl_experience_row {
    /* private */
    uint64_t counts; /* of the signature, those of links and joints first */
    struct grrl_paths paths;
    uint32_t state;
};

/* An index of a store: the rows of all states, those of a cell side by side. */
struct grrl_experience_index {
    /* private */
    struct grrl_experience_row *rows;
    uint32_t start[GRRL_EXPERIENCE_CELLS + 1]; /* first row of each cell, end of the last */
    uint8_t most[1 + GRRL_JOINT_TYPES];        /* links, joints of each type in any row */
};

struct grrl_experience_store {
    /* private */
    struct grrl_experience_state *states;
    struct grrl_experience *experiences;
    struct grrl_experience_index *index; /* or NULL */
    uint32_t states_capacity;
    uint32_t experiences_capacity;
    uint32_t clock;
    /* readable */
    uint32_t n_states;
    uint32_t n_experiences;
    uint32_t high_water; /* most experiences at a time */
    uint32_t evictions;
};

/* How an experience was found, best first (paper, section V-D). */
enum grrl_recall_level {
    GRRL_RECALL_EXACT,       /* isomorphic, all properties */
    GRRL_RECALL_RELAXED,     /* isomorphic, some properties dropped */
    GRRL_RECALL_SUBSTRUCTURE /* one is a sub-structure of the other */
};

#define GRRL_NO_EXPERIENCE UINT32_MAX

/* Far beyond any sum of rewards, and small enough that no statistic overflows. */
#define GRRL_MAX_TARGET 1.0e6f

/* What is known of one action of the current state. */
struct grrl_recall_entry {
    uint32_t experience; /* index, or GRRL_NO_EXPERIENCE */
    uint8_t level;       /* enum grrl_recall_level */
    uint8_t distance;    /* links and joints that only one of the two has */
    uint8_t dropped;     /* properties dropped, counted from the last place in use */
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
    uint32_t budget;                /* search steps for one stored state, >= 1 */
    uint32_t states; /* to search for sub-structures, the closest; 1 to GRRL_RECALL_STATES */
    bool strict;     /* no property is ever dropped */
};

/* Capacities below GRRL_NO_EXPERIENCE; with one of 0 (its memory may be NULL) nothing is stored.
 * Without an index. */
void grrl_experience_init(struct grrl_experience_store *store, struct grrl_experience_state *states,
                          uint32_t states_capacity, struct grrl_experience *experiences,
                          uint32_t experiences_capacity);

/* Forgets everything; memory and index stay. */
void grrl_experience_clear(struct grrl_experience_store *store);

/*
 * Gives the store an index with states_capacity rows, 32 bytes each. What is recalled stays the
 * same, but only states with about as many links and joints as the current one are looked at. At
 * any time; from then on a new state costs some microseconds more.
 */
void grrl_experience_use_index(struct grrl_experience_store *store,
                               struct grrl_experience_index *index,
                               struct grrl_experience_row *rows);

/* The structure of a stored state, in canonical form. */
void grrl_experience_graph(const struct grrl_experience_state *state, struct grrl_graph *graph);

/*
 * For each action of the state the closest experience: exact matches first, then properties dropped
 * one place after another from the last to the first, then sub-structures (either may be the
 * larger): the largest overlap first, which is the fewest links and joints that only one of the two
 * has, then those that agree in all properties before those that agree in none; ties go to the
 * entry with more targets met, then to the lower index, which is the older one as long as nothing
 * was evicted. All links some mapping binds to the stored one count; an experience whose stored
 * link no mapping binds is no match, nor is what a search left undecided. Nothing is known of a
 * state without a canonical form.
 *
 * Cost: exact and relaxed states are found by hash, whatever the number of states. What could be a
 * sub-structure is told by signatures: of all states, or with an index of those of the sizes next
 * to the current one, some nanoseconds each. Then at most config->states of them are searched, the
 * closest first and of equally close ones those with lower indices, config->budget steps each; none
 * once every action has an entry that only a closer state could replace.
 */
void grrl_experience_recall(const struct grrl_experience_store *store,
                            const struct grrl_graph *state, const struct grrl_recall_config *config,
                            struct grrl_recall *recall);

/*
 * Moves the estimate of (state, link, direction) towards a target: value <- (1 - alpha) value +
 * alpha target; a new entry starts with value = target. *index (may be NULL) tells the entry.
 * GRRL_ERR_ARGUMENT: no such link or direction, alpha outside (0, 1]. GRRL_ERR_NUMBER: a target
 * that is not finite or beyond +-GRRL_MAX_TARGET. GRRL_ERR_FULL: a capacity of 0.
 * GRRL_ERR_UNDECIDED: the state has no canonical form within the budget. After a failure nothing is
 * stored.
 */
GRRL_MUST_USE enum grrl_status grrl_experience_update(struct grrl_experience_store *store,
                                                      const struct grrl_graph *state, uint8_t link,
                                                      uint8_t direction, float target, float alpha,
                                                      uint32_t *index);

/* Marks an experience as used now. */
void grrl_experience_touch(struct grrl_experience_store *store, uint32_t index);

/*
 * The store as bytes, little-endian whatever the machine. A header: magic "GRRLexp" and zero,
 * version (2 bytes), GRRL_MAX_PROPERTIES (1), GRRL_DIRECTIONS (1), states (4), experiences (4),
 * clock (4). A state: links (1), then for each link its label (8) and its neighbours, revolute (4)
 * and prismatic (4). An experience: state (4), link (1), direction (1), used at (4), value (4),
 * mean (4), deviations (4), n (4). A CRC-32 (4) follows the header and each record; it runs on from
 * the one before, so that records cannot be exchanged either. Saving what was loaded gives the same
 * bytes. GRRL_ERR_IO.
 */
GRRL_MUST_USE enum grrl_status grrl_experience_save(const struct grrl_experience_store *store,
                                                    const struct grrl_io *io);

/*
 * Replaces the store's content. Nothing of a file is used before it is checked; bytes after the
 * last record are not read. GRRL_ERR_IO: also for a file that ends early. GRRL_ERR_FORMAT: another
 * magic. GRRL_ERR_VERSION: a newer version, other properties or directions, more links than this
 * build has. GRRL_ERR_CORRUPT: a wrong CRC, or content that save never writes. GRRL_ERR_FULL: more
 * records than the store has room for. After a failure the store is empty.
 */
GRRL_MUST_USE enum grrl_status grrl_experience_load(struct grrl_experience_store *store,
                                                    const struct grrl_io *io);

/* As grrl_experience_load, but after GRRL_ERR_IO, and only then, the store holds the experiences
 * that were whole; *lost becomes the number of those the header announced beyond them. */
GRRL_MUST_USE enum grrl_status grrl_experience_load_torn(struct grrl_experience_store *store,
                                                         const struct grrl_io *io, uint32_t *lost);

GRRL_API_END

#endif
