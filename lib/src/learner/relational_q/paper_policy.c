/* paper_policy.c: the policy `paper`: phi, Interval Estimation and Q-learning over experiences. */
#include "grrl/learner/relational_q/paper_policy.h"

#include <string.h>

#include "base/range.h"
#include "grrl/base/geometry.h"

_Static_assert(sizeof(struct grrl_paper_config) <= GRRL_POLICY_CONFIG_BYTES, "a configuration");
_Static_assert(sizeof(struct grrl_paper_policy) % _Alignof(struct grrl_experience_state) == 0 &&
                   sizeof(struct grrl_experience_state) % _Alignof(struct grrl_experience) == 0,
               "states and experiences follow");

void grrl_paper_config_default(struct grrl_paper_config *config)
{
    *config = (struct grrl_paper_config){.alpha = 0.3f,
                                         .gamma = 0.1f,
                                         .beta = 2.0f,
                                         .z = 0.25f,
                                         .prior_sd = 1.0f,
                                         .recall = {.deepest = GRRL_RECALL_SUBSTRUCTURE,
                                                    .budget = GRRL_MATCH_BUDGET,
                                                    .states = GRRL_RECALL_STATES}};
}

enum grrl_status grrl_paper_config_check(const struct grrl_paper_config *config, const char **field)
{
    const struct grrl_recall_config *recall = &config->recall;
    const struct grrl_range_check checks[] = {
        {"alpha", config->alpha > 0.0f && config->alpha <= 1.0f},
        {"gamma", config->gamma >= 0.0f && config->gamma < 1.0f},
        {"beta", grrl_is_within(config->beta, 0.0f, GRRL_PAPER_MAX)},
        {"z", grrl_is_within(config->z, 0.0f, GRRL_PAPER_MAX)},
        {"prior_sd", grrl_is_within(config->prior_sd, 0.0f, GRRL_PAPER_MAX)},
        {"recall.deepest", recall->deepest == GRRL_RECALL_EXACT ||
                               recall->deepest == GRRL_RECALL_RELAXED ||
                               recall->deepest == GRRL_RECALL_SUBSTRUCTURE},
        {"recall.budget", recall->budget >= 1},
        {"recall.states", recall->states >= 1 && recall->states <= GRRL_RECALL_STATES},
    };
    return grrl_range_first(checks, sizeof checks / sizeof checks[0], field);
}

void grrl_paper_bounds(const struct grrl_paper_config *config, const struct grrl_q *q, float *lower,
                       float *upper)
{
    /* n targets leave n - 1 degrees of freedom; the prior sample is one more. */
    float n = (float)q->n;
    float variance = (q->deviations + config->prior_sd * config->prior_sd) / n;
    float reach = config->z * grrl_sqrt(variance / n);
    *lower = q->value - reach;
    *upper = q->value + reach;
}

static const struct grrl_q *q_of(const struct grrl_experience_store *store,
                                 const struct grrl_recall_entry *entry)
{
    return entry->experience == GRRL_NO_EXPERIENCE ? NULL
                                                   : &store->experiences[entry->experience].q;
}

static unsigned count_known(const struct grrl_recall *recall)
{
    unsigned known = 0;
    for (uint8_t link = 0; link < recall->n_links; link++)
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++)
            known += recall->entry[link][direction].experience != GRRL_NO_EXPERIENCE;
    return known;
}

static struct grrl_source source_of(const struct grrl_recall_entry *entry)
{
    if (entry->experience == GRRL_NO_EXPERIENCE)
        return grrl_no_source();
    _Static_assert((int)GRRL_SOURCE_EXACT == (int)GRRL_RECALL_EXACT + 1 &&
                       (int)GRRL_SOURCE_SUBSTRUCTURE == (int)GRRL_RECALL_SUBSTRUCTURE + 1,
                   "sources are named in the order of levels");
    return (struct grrl_source){.kind = (uint8_t)(GRRL_SOURCE_EXACT + entry->level),
                                .distance = entry->distance,
                                .index = entry->experience};
}

void grrl_paper_explain(const struct grrl_paper_config *config,
                        const struct grrl_experience_store *store, const struct grrl_recall *recall,
                        struct grrl_choice *choice)
{
    const struct grrl_recall_entry *entry = &recall->entry[choice->link][choice->direction];
    const struct grrl_q *q = q_of(store, entry);
    choice->source = source_of(entry);
    choice->phi = (float)count_known(recall) / (float)(recall->n_links * GRRL_DIRECTIONS);
    choice->value = 0.0f;
    choice->lower = 0.0f;
    choice->upper = 0.0f;
    if (q != NULL) {
        choice->value = q->value;
        grrl_paper_bounds(config, q, &choice->lower, &choice->upper);
    }
}

/* Picks the nth action without an experience. */
static void pick_unknown(const struct grrl_recall *recall, uint32_t nth, struct grrl_choice *choice)
{
    for (uint8_t link = 0; link < recall->n_links; link++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            if (recall->entry[link][direction].experience == GRRL_NO_EXPERIENCE && nth-- == 0) {
                choice->link = link;
                choice->direction = direction;
                return;
            }
        }
    }
}

/* Picks the highest upper bound; the kth of equal actions replaces the choice with probability 1 /
 * k. */
static void pick_best(const struct grrl_paper_config *config,
                      const struct grrl_experience_store *store, const struct grrl_recall *recall,
                      struct grrl_random *random, struct grrl_choice *choice)
{
    uint32_t equals = 0;
    float best = 0.0f;
    for (uint8_t link = 0; link < recall->n_links; link++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            const struct grrl_q *q = q_of(store, &recall->entry[link][direction]);
            if (q == NULL)
                continue;
            float lower, upper;
            grrl_paper_bounds(config, q, &lower, &upper);
            if (equals == 0 || upper > best) {
                equals = 0;
                best = upper;
            }
            if (upper == best && grrl_random_below(random, ++equals) == 0) {
                choice->link = link;
                choice->direction = direction;
            }
        }
    }
}

void grrl_paper_choose(const struct grrl_paper_config *config,
                       const struct grrl_experience_store *store, const struct grrl_recall *recall,
                       struct grrl_random *random, struct grrl_choice *choice)
{
    uint32_t all = (uint32_t)recall->n_links * GRRL_DIRECTIONS;
    uint32_t known = count_known(recall);
    float phi = (float)known / (float)all;
    bool explore = grrl_random_uniform(random) < grrl_exp(-config->beta * phi);
    *choice = (struct grrl_choice){.reason = GRRL_CHOICE_EXPLOIT};
    if (known == 0 || (explore && known < all)) {
        pick_unknown(recall, grrl_random_below(random, all - known), choice);
        choice->reason = GRRL_CHOICE_EXPLORE;
    } else {
        pick_best(config, store, recall, random, choice);
    }
    grrl_paper_explain(config, store, recall, choice);
}

float grrl_paper_best_value(const struct grrl_experience_store *store,
                            const struct grrl_recall *recall)
{
    bool any = false;
    float best = 0.0f;
    for (uint8_t link = 0; link < recall->n_links; link++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            const struct grrl_q *q = q_of(store, &recall->entry[link][direction]);
            if (q != NULL && (!any || q->value > best)) {
                best = q->value;
                any = true;
            }
        }
    }
    return best;
}

/* --- the operations --------------------------------------------------------------------------- */

static void config_default(void *config)
{
    grrl_paper_config_default(config);
}

static enum grrl_status config_check(const void *config, const char **field)
{
    return grrl_paper_config_check(config, field);
}

static size_t bytes(uint32_t capacity)
{
    return GRRL_PAPER_POLICY_BYTES((size_t)capacity);
}

static enum grrl_status init(void *self, uint32_t capacity, const void *config)
{
    struct grrl_paper_policy *policy = self;
    memset(policy, 0, sizeof *policy);
    if (config != NULL)
        policy->config = *(const struct grrl_paper_config *)config;
    else
        grrl_paper_config_default(&policy->config);
    struct grrl_experience_state *states = (struct grrl_experience_state *)(void *)(policy + 1);
    struct grrl_experience *experiences = (struct grrl_experience *)(void *)(states + capacity);
    grrl_experience_init(&policy->store, states, capacity, experiences, capacity);
    return grrl_paper_config_check(&policy->config, NULL);
}

static void begin_trial(void *self)
{
    struct grrl_paper_policy *policy = self;
    grrl_graph_clear(&policy->acted_on);
    memset(&policy->recall, 0, sizeof policy->recall);
}

static void recall_state(struct grrl_paper_policy *policy, const struct grrl_graph *state)
{
    grrl_experience_recall(&policy->store, state, &policy->config.recall, &policy->recall);
}

static void choose(void *self, const struct grrl_view *view, struct grrl_random *random,
                   struct grrl_choice *choice)
{
    struct grrl_paper_policy *policy = self;
    recall_state(policy, view->state);
    policy->acted_on = *view->state;
    grrl_paper_choose(&policy->config, &policy->store, &policy->recall, random, choice);
}

static void explain(void *self, const struct grrl_view *view, struct grrl_choice *choice)
{
    struct grrl_paper_policy *policy = self;
    recall_state(policy, view->state);
    policy->acted_on = *view->state;
    grrl_paper_explain(&policy->config, &policy->store, &policy->recall, choice);
}

static void used(void *self, const struct grrl_choice *choice)
{
    grrl_experience_touch(&((struct grrl_paper_policy *)self)->store, choice->source.index);
}

static float limit(float x)
{
    return x > GRRL_MAX_TARGET ? GRRL_MAX_TARGET : x;
}

/* Q-learning with the instance-based Q function; sections V-C and V-D. */
static void learn(void *self, const struct grrl_outcome *outcome, struct grrl_update *update)
{
    struct grrl_paper_policy *policy = self;
    const struct grrl_choice *choice = &outcome->choice;
    if (!outcome->ended) {
        recall_state(policy, outcome->view.state);
        update->target +=
            policy->config.gamma * grrl_paper_best_value(&policy->store, &policy->recall);
    }
    update->target =
        limit(update->target); /* with a discount close to 1 the sum may grow without limit */
    uint32_t index;
    if (grrl_experience_update(&policy->store, &policy->acted_on, choice->link, choice->direction,
                               update->target, policy->config.alpha, &index) == GRRL_OK)
        update->index = index; /* on failure the state is too symmetric for a canonical form */
}

static struct grrl_usage usage(const void *self)
{
    const struct grrl_experience_store *store = &((const struct grrl_paper_policy *)self)->store;
    return (struct grrl_usage){store->n_experiences, store->experiences_capacity, store->evictions};
}

static void clear(void *self)
{
    grrl_experience_clear(&((struct grrl_paper_policy *)self)->store);
}

static enum grrl_status save(const void *self, const struct grrl_io *io)
{
    return grrl_experience_save(&((const struct grrl_paper_policy *)self)->store, io);
}

static enum grrl_status load(void *self, const struct grrl_io *io, uint32_t *lost)
{
    return grrl_experience_load(&((struct grrl_paper_policy *)self)->store, io, lost);
}

static const struct grrl_parameter parameters[] = {
    {"alpha", "learning rate", "a number above 0 to 1", offsetof(struct grrl_paper_config, alpha)},
    {"gamma", "discount of later rewards", "a number from 0 to below 1",
     offsetof(struct grrl_paper_config, gamma)},
    {"beta", "a new action has probability exp(-beta phi)", "a number from 0 to 1000",
     offsetof(struct grrl_paper_config, beta)},
    {"z", "width of the bounds of Interval Estimation", "a number from 0 to 1000",
     offsetof(struct grrl_paper_config, z)},
};

GRRL_POLICY_TYPE grrl_policy_paper = {
    .name = "paper",
    .text = "the paper's learner: closest experience, phi, Interval Estimation",
    .entries = "experiences",
    .parameters = parameters,
    .n_parameters = sizeof parameters / sizeof parameters[0],
    .config_bytes = sizeof(struct grrl_paper_config),
    .config_default = config_default,
    .config_check = config_check,
    .bytes = bytes,
    .init = init,
    .begin_trial = begin_trial,
    .choose = choose,
    .explain = explain,
    .used = used,
    .learn = learn,
    .usage = usage,
    .clear = clear,
    .save = save,
    .load = load,
};
