/*
 * context.h: an action as the link that is pushed sees it, whatever object the link is part of.
 *
 * What a push reveals depends on the link, its neighbours and what it refused before, hardly on the
 * rest of the object. A context says that much in a few small numbers, the same for a mirrored or
 * turned object, so that experience with one action speaks for every other that looks like it.
 */
#ifndef GRRL_CONTEXT_H
#define GRRL_CONTEXT_H

#include "grrl/base/api.h"
#include "grrl/perception/perception.h"
#include "grrl/structure/term.h"

GRRL_API_BEGIN

/* The parts of a context. Lengths are in octaves of `large_m`: 0 below 0.6 of it, 1 below 1.2, 2
 * below 2.4, 3 below 4.8, 4 beyond. */
enum grrl_context_part {
    GRRL_CONTEXT_DIRECTION,        /* 0 axial, 1 diagonal, 2 perpendicular */
    GRRL_CONTEXT_LENGTH,           /* of the link, in octaves */
    GRRL_CONTEXT_TRIED,            /* this push of the link so far, up to 3 */
    GRRL_CONTEXT_NEIGHBOURS,       /* bit 0: a neighbour lies ahead, bit 1: behind */
    GRRL_CONTEXT_NEIGHBOUR_LENGTH, /* 0 without neighbours, else 1 + octaves of the longest */
    GRRL_CONTEXT_REVOLUTE,         /* revolute joints of the link, up to 2 */
    GRRL_CONTEXT_PRISMATIC,        /* prismatic joints of the link, up to 2 */
    GRRL_CONTEXT_OTHERS_TRIED,     /* its other pushes so far, up to 2 */
    GRRL_CONTEXT_LONGER,           /* links longer by 15% or more, up to 2 */
    GRRL_CONTEXT_PARTS
};

struct grrl_context {
    uint8_t part[GRRL_CONTEXT_PARTS]; /* by enum grrl_context_part */
};

/* The most that each part of a context can be. */
extern const uint8_t grrl_context_most[GRRL_CONTEXT_PARTS];

/* The pushes of one link since its own length or joints changed. */
struct grrl_attempts {
    /* private */
    uint16_t number; /* of the body, 0: of nobody */
    uint8_t length;
    uint8_t joints[GRRL_JOINT_TYPES];
    uint8_t tried[GRRL_DIRECTIONS];
};

/* The pushes of one trial, by link; all zero at its start. */
struct grrl_trial_attempts {
    /* private */
    struct grrl_attempts link[GRRL_MAX_LINKS];
};

/*
 * Brings the attempts up to date with the model: a link whose length (in octaves) or number of
 * joints changed has refused nothing yet, and what belongs to links that are gone is forgotten.
 */
void grrl_attempts_look(struct grrl_trial_attempts *attempts, const struct grrl_model *model,
                        float large_m);

/* Counts a push of the body with this number in the model last looked at. */
void grrl_attempts_add(struct grrl_trial_attempts *attempts, uint16_t body_number,
                       uint8_t direction);

/* The contexts of all pushes of one body of the model last looked at, by direction.
 * GRRL_ERR_ARGUMENT: no such body. Cost: linear in joints and bodies. */
GRRL_MUST_USE enum grrl_status grrl_context_of(const struct grrl_trial_attempts *attempts,
                                               const struct grrl_model *model, float large_m,
                                               uint8_t body,
                                               struct grrl_context contexts[GRRL_DIRECTIONS]);

GRRL_API_END

#endif
