/* options.h: the command line of grrl-perceive. */
#ifndef GRRL_PERCEIVE_OPTIONS_H
#define GRRL_PERCEIVE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "run.h"

#include "cli/options.h"

struct grrl_perceive_options {
    const char *tracks; /* CSV; exactly one of the first three is set */
    const char *log;    /* LCM log */
    const char *handle; /* a single trajectory */
    enum grrl_unit unit;
    enum grrl_profile profile;
    float noise; /* in the unit of the file; 0: that of the profile */
    bool noise_from_points;
    bool rectifies;
    struct grrl_rectify rectify;
    int trial; /* of a log; 0: the last */
    bool json;
    const char *svg;    /* NULL: no picture */
    const char *motion; /* CSV of the joints' motion; NULL: none */
};

/* Prints help or the version to stdout (DONE), or an error message to stderr (BAD). */
enum grrl_options_result grrl_perceive_options_parse(int argc, char **argv,
                                                     struct grrl_perceive_options *options);

#endif
