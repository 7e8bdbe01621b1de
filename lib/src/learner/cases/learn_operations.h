/* learn_operations.h (private): the operations of the policy `learn`, for policies that differ from
 * it only slightly. */
#ifndef GRRL_LEARN_OPERATIONS_H
#define GRRL_LEARN_OPERATIONS_H

#include "grrl/learner/cases/learn_policy.h"

void grrl_learn_config_default(void *config);
enum grrl_status grrl_learn_config_check(const void *config, const char **field);
size_t grrl_learn_bytes(uint32_t capacity);
enum grrl_status grrl_learn_init(void *self, uint32_t capacity, const void *config);
void grrl_learn_begin_trial(void *self);
void grrl_learn_choose(void *self, const struct grrl_view *view, struct grrl_random *random,
                       struct grrl_choice *choice);
void grrl_learn_explain(void *self, const struct grrl_view *view, struct grrl_choice *choice);
void grrl_learn_learn(void *self, const struct grrl_outcome *outcome, struct grrl_update *update);
struct grrl_usage grrl_learn_usage(const void *self);
void grrl_learn_clear(void *self);
enum grrl_status grrl_learn_save(const void *self, const struct grrl_io *io);
enum grrl_status grrl_learn_load(void *self, const struct grrl_io *io, uint32_t *lost);

/* All operations except init and config_default. */
#define GRRL_LEARN_OPERATIONS                                                                      \
    .entries = "cases", .config_bytes = sizeof(struct grrl_case_config),                           \
    .config_check = grrl_learn_config_check, .bytes = grrl_learn_bytes,                            \
    .begin_trial = grrl_learn_begin_trial, .choose = grrl_learn_choose,                            \
    .explain = grrl_learn_explain, .learn = grrl_learn_learn, .usage = grrl_learn_usage,           \
    .clear = grrl_learn_clear, .save = grrl_learn_save, .load = grrl_learn_load

#endif
