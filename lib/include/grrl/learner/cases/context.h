/*
 * context.h: describes an action from the pushed link's point of view, independent of the object.
 *
 * What a push reveals depends on the link, its neighbours and earlier failed pushes, and hardly on
 * the rest of the object. A context encodes these in a few small numbers. They are the same for a
 * mirrored or rotated object, so a reward for one action carries over to every similar action.
 */
#ifndef GRRL_CONTEXT_H
#define GRRL_CONTEXT_H

#include "grrl/base/api.h"
#include "grrl/perception/perception.h"
#include "grrl/structure/term.h"

GRRL_API_BEGIN

/* The parts of a context. Lengths are in octaves relative to `large_m`: 0 below 0.6 of it, 1 below
 * 1.2, 2 below 2.4, 3 below 4.8, else 4. */
enum grrl_context_part {
    GRRL_CONTEXT_DIRECTION,        /* 0 axial, 1 diagonal, 2 perpendicular */
    GRRL_CONTEXT_LENGTH,           /* of the link, octave */
    GRRL_CONTEXT_TRIED,            /* earlier pushes of the link in this direction, up to 3 */
    GRRL_CONTEXT_NEIGHBOURS,       /* bit 0: a neighbour lies ahead, bit 1: behind */
    GRRL_CONTEXT_NEIGHBOUR_LENGTH, /* 0 without neighbours, else 1 + octave of the longest */
    GRRL_CONTEXT_REVOLUTE,         /* revolute joints of the link, up to 2 */
    GRRL_CONTEXT_PRISMATIC,        /* prismatic joints of the link, up to 2 */
    GRRL_CONTEXT_OTHERS_TRIED,     /* earlier pushes of the link in other directions, up to 2 */
    GRRL_CONTEXT_LONGER,           /* links at least 15% longer, up to 2 */
    GRRL_CONTEXT_ASPECT, /* of the link's width to its length: 0 up to 0.35, 1 up to 0.6, 2 */
    GRRL_CONTEXT_SKEW,   /* before any joint is known: the features thin out, 1 against the push, 2
                            along it, 0 neither */
    GRRL_CONTEXT_ELSEWHERE, /* bit 0: a revolute joint is known away from the link, bit 1: a
                               prismatic one */
    GRRL_CONTEXT_PARTS
};

struct grrl_context {
    uint8_t part[GRRL_CONTEXT_PARTS]; /* by enum grrl_context_part */
};

/* The largest value of each part of a context. */
extern const uint8_t grrl_context_max[GRRL_CONTEXT_PARTS];

/* A context in one number, 2 or 3 bits a part; equal contexts have equal keys. */
uint32_t grrl_context_key(const struct grrl_context *context);

/* One part of the context with this key. */
uint8_t grrl_context_part(uint32_t key, enum grrl_context_part part);

/* The bits of a key that hold the parts of this set (bit i: part i). */
uint32_t grrl_context_key_bits(uint16_t parts);

/* The number of parts in which two keys differ, within these bits. */
static inline unsigned grrl_context_differences(uint32_t a, uint32_t b, uint32_t bits)
{
    uint32_t x = (a ^ b) & bits;
    x = (x | x >> 1 | (x >> 2 & UINT32_C(0x440000))) & UINT32_C(0x4455555); /* lowest bits */
    x = (x & UINT32_C(0x33333333)) + (x >> 2 & UINT32_C(0x33333333));
    x = (x + (x >> 4)) & UINT32_C(0x0f0f0f0f);
    return (unsigned)(x * UINT32_C(0x01010101) >> 24);
}

/* Pushes of one link since its length or joints last changed. */
struct grrl_attempts {
    /* private */
    uint16_t number; /* of the body; 0: none */
    uint8_t length;
    uint8_t joints[GRRL_JOINT_TYPES];
    uint8_t tried[GRRL_DIRECTIONS];
};

/* Pushes of one trial, by link. All zero at the start of a trial. */
struct grrl_trial_attempts {
    /* private */
    struct grrl_attempts link[GRRL_MAX_LINKS];
};

/*
 * Updates the attempts to match the model. A link whose length (octave) or number of joints changed
 * starts again from zero; entries of links that no longer exist are removed.
 */
void grrl_attempts_update(struct grrl_trial_attempts *attempts, const struct grrl_model *model,
                          float large_m);

/* Counts a push of the body with this number, in the model of the last update. */
void grrl_attempts_add(struct grrl_trial_attempts *attempts, uint16_t body_number,
                       uint8_t direction);

/* Computes the contexts of all pushes of one body, by direction, in the model of the last update.
 * GRRL_ERR_ARGUMENT: no such body. Cost: linear in joints and bodies. */
GRRL_MUST_USE enum grrl_status grrl_context_of(const struct grrl_trial_attempts *attempts,
                                               const struct grrl_model *model, float large_m,
                                               uint8_t body,
                                               struct grrl_context contexts[GRRL_DIRECTIONS]);

GRRL_API_END

#endif
