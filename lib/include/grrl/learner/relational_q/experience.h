/*
 * experience.h: the instance-based Q function (paper, section V-D).
 *
 * An experience is a state with variables for links, an action on one of them, and the statistics
 * of the Q targets met with it. States are kept in canonical form and actions on the smallest link
 * of their orbit, so that isomorphic states and symmetric actions share one entry.
 *
 * The caller owns the memory: an array of states and an array of experiences, both filled from the
 * front without gaps. The same code handles one entry on a microcontroller and millions on a host.
 * With thousands of states or more, add an index, which keeps states of one size side by side. A
 * hash table finds a state; its bucket heads live in the states themselves.
 *
 * An experience is used when it is updated, or touched because a decision rests on it. When the
 * experiences are full, the least recently used one is evicted; a state is removed with its last
 * experience. When the states are full, the state whose experiences were all used longest ago is
 * evicted with them. The last element of an array moves into the gap, so an eviction may change
 * other indices: an index is valid until the next update or load.
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
    float mean;  /* of the targets met; `deviations` is their sum of squared deviations (Welford) */
    float deviations;
    uint32_t n; /* targets met */
};

/* Hash tables of states: by canonical form, and by canonical form without properties. */
enum { GRRL_EXPERIENCE_TABLES = 2 };

/* At most 512 bytes for 32 links and 64 joints, including its share of the index. */
struct grrl_experience_state {
    /* private */
    /* first, beside the first word of the signature, because a scan reads these two */
    struct grrl_paths paths;
    uint8_t n;                        /* links */
    uint8_t joints[GRRL_JOINT_TYPES]; /* of each type */
    struct grrl_signature signature;
    uint32_t head[GRRL_EXPERIENCE_TABLES];  /* first state of the bucket with this state's number */
    uint32_t chain[GRRL_EXPERIENCE_TABLES]; /* next state of the bucket this state is in */
    uint32_t key[GRRL_EXPERIENCE_TABLES];   /* hash of the graph, all properties or none */
    uint32_t experiences; /* number of experiences that refer to this state, at least one */
    uint32_t first;       /* first of these experiences */
    uint16_t edge[GRRL_MAX_JOINTS]; /* canonical: type, link and lower link, 5 bits per link */
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

/* What the index stores about a state. */
struct grrl_experience_row {
    /* private */
    uint64_t counts; /* first word of the signature: links, joints and other counts of the shape */
    struct grrl_paths paths;
    uint32_t state;
};

/* An index of a store: the rows of all states, those of one cell side by side. */
struct grrl_experience_index {
    /* private */
    struct grrl_experience_row *rows;
    uint32_t start[GRRL_EXPERIENCE_CELLS + 1]; /* first row of each cell, end of the last */
    uint8_t most[1 + GRRL_JOINT_TYPES]; /* most links, and most joints of each type, in any row */
    int8_t fewest_spare;                /* joints beyond one per link, in any row */
    int8_t most_spare;
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
    uint32_t high_water; /* largest number of experiences so far */
    uint32_t evictions;
};

/* How an experience was found, best match first (paper, section V-D). */
enum grrl_recall_level {
    GRRL_RECALL_EXACT,       /* isomorphic, with all properties */
    GRRL_RECALL_RELAXED,     /* isomorphic, with some properties dropped */
    GRRL_RECALL_SUBSTRUCTURE /* one is a sub-structure of the other */
};

#define GRRL_NO_EXPERIENCE UINT32_MAX

/* Far above any sum of rewards, and small enough that no statistic overflows. */
#define GRRL_MAX_TARGET 1.0e6f

/* What the store knows about one action of the current state. */
struct grrl_recall_entry {
    uint32_t experience; /* index, or GRRL_NO_EXPERIENCE */
    uint8_t level;       /* enum grrl_recall_level */
    uint8_t distance;    /* links and joints that only one of the two structures has */
    uint8_t dropped;     /* properties dropped, counting from the last place in use */
    uint8_t stored_link; /* the stored variable bound to the link */
};

/* All actions of a state: entry[link][direction]. */
struct grrl_recall {
    uint8_t n_links;
    struct grrl_recall_entry entry[GRRL_MAX_LINKS][GRRL_DIRECTIONS];
};

/* How far a recall may search. */
struct grrl_recall_config {
    enum grrl_recall_level deepest; /* GRRL_RECALL_SUBSTRUCTURE: search all levels */
    uint32_t budget;                /* search steps per stored state, >= 1 */
    uint32_t states; /* closest states searched for sub-structures; 1 to GRRL_RECALL_STATES */
    bool strict;     /* never drop a property */
};

/* Makes an empty store without an index. Capacities must be below GRRL_NO_EXPERIENCE. With a
 * capacity of 0 (its memory may be NULL) nothing is stored. */
void grrl_experience_init(struct grrl_experience_store *store, struct grrl_experience_state *states,
                          uint32_t states_capacity, struct grrl_experience *experiences,
                          uint32_t experiences_capacity);

/* Forgets all experiences; keeps the memory and the index. */
void grrl_experience_clear(struct grrl_experience_store *store);

/*
 * Gives the store an index with states_capacity rows of 32 bytes each. Recalls give the same
 * results, but look only at states with a similar number of links and joints. May be called at any
 * time; from then on, adding a state takes a few microseconds longer.
 */
void grrl_experience_use_index(struct grrl_experience_store *store,
                               struct grrl_experience_index *index,
                               struct grrl_experience_row *rows);

/* The structure of a stored state, in canonical form. */
void grrl_experience_graph(const struct grrl_experience_state *state, struct grrl_graph *graph);

/*
 * Finds the closest experience for each action of the state. Exact matches come first, then matches
 * with properties dropped one place after another, from the last to the first, then sub-structures
 * (either may be the larger). Sub-structures are ordered by overlap: fewest links and joints that
 * only one of the two has. Of equal overlaps, those that agree in all properties come before those
 * that agree in none. Ties go to the experience with more targets met, then to the lower index,
 * which is the older one until the first eviction. Every link that some mapping binds to the stored
 * one counts. An experience is no match if no mapping binds its stored link, or if the search stays
 * undecided. A state without a canonical form matches nothing.
 *
 * Cost: exact and relaxed matches are found by hash, independent of the number of states.
 * Signatures rule out most sub-structures at a few nanoseconds each, for all states or, with an
 * index, for those of similar size. Then at most config->states of the remaining states are
 * searched, config->budget steps each, the closest first and of equally close ones the lower
 * indices first. The search stops once every action has an entry that only a closer state could
 * replace.
 */
void grrl_experience_recall(const struct grrl_experience_store *store,
                            const struct grrl_graph *state, const struct grrl_recall_config *config,
                            struct grrl_recall *recall);

/*
 * Moves the estimate of (state, link, direction) towards a target: value <- (1 - alpha) value +
 * alpha target. A new experience starts with value = target. *index (may be NULL) is set to the
 * experience. GRRL_ERR_ARGUMENT: no such link or direction, or alpha outside (0, 1].
 * GRRL_ERR_NUMBER: the target is not finite or beyond +-GRRL_MAX_TARGET. GRRL_ERR_FULL: the
 * capacity is 0. GRRL_ERR_UNDECIDED: the state has no canonical form within the budget. After a
 * failure nothing is stored.
 */
GRRL_MUST_USE enum grrl_status grrl_experience_update(struct grrl_experience_store *store,
                                                      const struct grrl_graph *state, uint8_t link,
                                                      uint8_t direction, float target, float alpha,
                                                      uint32_t *index);

/* Marks an experience as used now. */
void grrl_experience_touch(struct grrl_experience_store *store, uint32_t index);

/*
 * Writes the store as bytes, little-endian on every machine. Header: magic "GRRLexp" and zero,
 * version (2 bytes), GRRL_MAX_PROPERTIES (1), GRRL_DIRECTIONS (1), states (4), experiences (4),
 * clock (4). Each state: links (1), then for each link its label (8) and its neighbours, revolute
 * (4) and prismatic (4). Each experience: state (4), link (1), direction (1), used at (4), value
 * (4), mean (4), deviations (4), n (4). A CRC-32 (4) follows the header and each record. It
 * continues from the previous one, so records cannot be swapped either. Saving what was loaded
 * gives the same bytes. GRRL_ERR_IO.
 */
GRRL_MUST_USE enum grrl_status grrl_experience_save(const struct grrl_experience_store *store,
                                                    const struct grrl_io *io);

/*
 * Replaces the store's content. A record is checked before it is used; bytes after the last record
 * are not read. GRRL_ERR_IO: also for a file that ends early. GRRL_ERR_FORMAT: another magic.
 * GRRL_ERR_VERSION: a newer version, other properties or directions, or more links than this build
 * has. GRRL_ERR_CORRUPT: a wrong CRC, or content that save never writes. GRRL_ERR_FULL: more
 * records than fit. After a failure the store is empty, except after GRRL_ERR_IO: then it holds the
 * experiences that were complete, and *lost is set to the number of further ones that the header
 * announced. Otherwise *lost is 0.
 */
GRRL_MUST_USE enum grrl_status grrl_experience_load(struct grrl_experience_store *store,
                                                    const struct grrl_io *io, uint32_t *lost);

GRRL_API_END

#endif
