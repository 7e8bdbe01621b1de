/* Implements grrl_learner_* by requests to the controller. */
#include "remote_learner.h"

#include <stdio.h>
#include <string.h>

/* The functions of grrl/learner.h have no parameter for it, and a process has one controller. */
static struct bridge_line *line;
static struct grrl_usage usage;

void bridge_learner_use(struct bridge_line *to)
{
    line = to;
}

static void fail(const char *why)
{
    line->failed = true;
    (void)snprintf(line->why, sizeof line->why, "%s", why);
}

/* Returns the status in the answer to line->request, which must be of this type. */
static enum grrl_status ask(enum onboard_packet_type wanted)
{
    if (!bridge_line_ask(line))
        return GRRL_ERR_IO;
    struct onboard_packet *answer = &line->answer;
    enum grrl_status status = (enum grrl_status)(int8_t)onboard_get(answer, 1);
    if (answer->type == wanted && !answer->bad)
        return status;
    if (answer->type == ONBOARD_REFUSED && status == GRRL_ERR_VERSION)
        fail("the controller was built with other capacities than this bridge; build both with the "
             "same GRRL_MAX_.. and ONBOARD_..");
    else if (answer->type == ONBOARD_REFUSED && status == GRRL_ERR_NONE)
        fail("the controller's image does not have this policy; build it with ONBOARD_POLICIES");
    else if (answer->type == ONBOARD_REFUSED && status == GRRL_ERR_ORDER)
        fail("the controller was restarted and lost what it learned; start the run again");
    else
        fail("the controller sent an invalid answer; does its image have this version?");
    return GRRL_ERR_IO;
}

static enum grrl_status ask_for(enum onboard_packet_type request, uint64_t value, unsigned bytes,
                                enum onboard_packet_type wanted)
{
    onboard_packet_begin(&line->request, (uint8_t)request);
    onboard_put(&line->request, value, bytes);
    return ask(wanted);
}

/* Rejects an answer that reports success but is malformed. */
static enum grrl_status check_answer(bool fine, enum grrl_status status)
{
    if (!fine && status == GRRL_OK) {
        fail("the controller sent an invalid answer; does its image have this version?");
        return GRRL_ERR_FORMAT;
    }
    return status;
}

enum grrl_status grrl_learner_init(struct grrl_learner *learner,
                                   const struct grrl_learner_config *config,
                                   struct grrl_policy policy)
{
    memset(learner, 0, sizeof *learner);
    learner->config = *config;
    learner->policy = policy; /* only its type: the memory is on the controller */
    usage = (struct grrl_usage){.capacity = ONBOARD_ENTRIES};
    onboard_put_open(&line->request, config->seed, policy.type->name);
    return ask(ONBOARD_DONE);
}

void grrl_learner_begin_trial(struct grrl_learner *learner, uint32_t trial)
{
    learner->trial = trial;
    (void)ask_for(ONBOARD_TRIAL, trial, 4, ONBOARD_DONE);
}

void grrl_learner_observe(struct grrl_learner *learner, const struct grrl_frame *frame,
                          bool pushing)
{
    struct grrl_frame fitting = *frame;
    if (fitting.n > GRRL_MAX_FEATURES) {
        learner->perception.counts.overflow += fitting.n - GRRL_MAX_FEATURES;
        fitting.n = GRRL_MAX_FEATURES;
    }
    onboard_put_frame(&line->request, &fitting, pushing);
    (void)ask(ONBOARD_DONE);
}

enum grrl_status grrl_learner_perceive(struct grrl_learner *learner)
{
    struct grrl_model *model = &learner->perception.model;
    enum grrl_status status = ask_for(ONBOARD_PERCEIVE, 0, 0, ONBOARD_MODEL);
    if (status != GRRL_OK)
        return status;
    bool fine = onboard_get_model(&line->answer, model);
    if (!fine)
        *model = (struct grrl_model){0};
    return check_answer(fine, status);
}

const struct grrl_model *grrl_perception_model(const struct grrl_perception *perception)
{
    return &perception->model;
}

enum grrl_status grrl_learner_choose(struct grrl_learner *learner, struct grrl_decision *decision)
{
    (void)learner;
    enum grrl_status status = ask_for(ONBOARD_CHOOSE, 0, 0, ONBOARD_DECISION);
    return check_answer(status != GRRL_OK || onboard_get_decision(&line->answer, decision), status);
}

enum grrl_status grrl_learner_learn(struct grrl_learner *learner, bool ended,
                                    struct grrl_update *update)
{
    (void)learner;
    enum grrl_status status = ask_for(ONBOARD_LEARN, ended, 1, ONBOARD_UPDATE);
    return check_answer(status != GRRL_OK || onboard_get_update(&line->answer, update, &usage),
                        status);
}

/* The controller drops the trial when the next one begins; no request is sent until then. */
void grrl_learner_abandon_trial(struct grrl_learner *learner)
{
    (void)learner;
}

struct grrl_usage grrl_learner_usage(const struct grrl_learner *learner)
{
    (void)learner;
    return usage;
}

/* The core calls this to observe other agents; the bridge never does. */
enum grrl_status grrl_learner_adopt(struct grrl_learner *learner, uint16_t body_number,
                                    uint8_t direction, bool exploited,
                                    struct grrl_decision *decision)
{
    (void)learner, (void)body_number, (void)direction, (void)exploited, (void)decision;
    return GRRL_ERR_ORDER;
}

bool bridge_learner_close(struct bridge_result *result)
{
    if (ask_for(ONBOARD_CLOSE, 0, 0, ONBOARD_STORE) != GRRL_OK)
        return false;
    result->models = onboard_get(&line->answer, 8);
    result->decisions = onboard_get(&line->answer, 8);
    result->updates = onboard_get(&line->answer, 8);
    result->store = onboard_get(&line->answer, 8);
    if (!onboard_packet_used_up(&line->answer))
        fail("the controller's last answer has the wrong length");
    return !line->failed;
}
