/* options.h: the command line of grrl-agent. */
#ifndef GRRL_AGENT_OPTIONS_H
#define GRRL_AGENT_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "agent.h"
#include "cli/options.h"
#include "grrl/learner/learner.h"
#include "grrl/policies.h"

struct grrl_agent_options {
    struct grrl_learner_config learner;
    const struct grrl_policy_type *policy;
    void *policy_config; /* of the policy; NULL: it has none */
    const char *store;   /* NULL: nothing is kept */
    const char *start;   /* NULL: a new store starts empty */
    const char *lcm_url; /* NULL: LCM_DEFAULT_URL, or LCM's default */
    uint32_t experiences;
    double tracker_timeout_s; /* 0: wait forever */
    struct grrl_agent_table table;
    int pushes;       /* 0: no end */
    float until_sure; /* 0: never */
    bool observe;
    bool quiet;
    bool explain;
};

/* Prints help or the version to stdout (DONE), or an error message to stderr (BAD). */
enum grrl_options_result grrl_agent_options_parse(int argc, char **argv,
                                                  struct grrl_agent_options *options);

#endif
