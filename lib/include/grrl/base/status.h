/*
 * status.h: the one result type of every function that can fail.
 *
 * Zero is success, negative is failure. A failure leaves the arguments unchanged unless the
 * function says otherwise. The library never prints: a status, and for terms and files a position,
 * says what is wrong with outside input.
 */
#ifndef GRRL_STATUS_H
#define GRRL_STATUS_H

#include "grrl/base/api.h"

GRRL_API_BEGIN

#if defined(__GNUC__)
#define GRRL_MUST_USE __attribute__((warn_unused_result))
#else
#define GRRL_MUST_USE
#endif

enum grrl_status {
    GRRL_OK = 0,
    GRRL_ERR_ARGUMENT = -1,  /* a parameter is outside its documented range */
    GRRL_ERR_FULL = -2,      /* a fixed capacity is reached */
    GRRL_ERR_SYNTAX = -3,    /* a text is not a term */
    GRRL_ERR_STRUCTURE = -4, /* a term or graph is not a kinematic structure */
    GRRL_ERR_NUMBER = -5,    /* a measured number is not finite or out of range */
    GRRL_ERR_UNDECIDED = -6, /* a search used up its budget */
    GRRL_ERR_NONE = -7,      /* no such thing: no match, no action, not in the store */
    GRRL_ERR_IO = -8,        /* a read or write callback failed */
    GRRL_ERR_FORMAT = -9,    /* not one of our files */
    GRRL_ERR_VERSION = -10,  /* our file, from an incompatible version or build */
    GRRL_ERR_CORRUPT = -11,  /* our file, damaged */
    GRRL_ERR_ORDER = -12,    /* a function was called out of order */
    GRRL_ERR_POLICY = -13    /* our file, from another policy */
};

/* A short English phrase without a full stop; never NULL. */
const char *grrl_status_text(enum grrl_status status);

GRRL_API_END

#endif
