/* controller.c: executes packets, answers them, and hashes each answer. */
#include "controller.h"

#include <string.h>

/* FNV-1a. */
#define HASH_START UINT64_C(0xcbf29ce484222325)

static uint64_t hash_on(uint64_t hash, const void *bytes, size_t n)
{
    const uint8_t *byte = bytes;
    for (size_t i = 0; i < n; i++)
        hash = (hash ^ byte[i]) * UINT64_C(0x100000001b3);
    return hash;
}

void onboard_controller_init(struct onboard_controller *controller, uint32_t (*count)(void))
{
    controller->open = false;
    controller->count = count;
    controller->hashes = (struct onboard_hashes){HASH_START, HASH_START, HASH_START};
    controller->store_hash = HASH_START;
    controller->store_bytes = 0;
    for (int i = 0; i < ONBOARD_STEPS; i++)
        controller->cost[i] = (struct onboard_cost){0};
}

static uint32_t now(const struct onboard_controller *controller)
{
    return controller->count != NULL ? controller->count() : 0;
}

static void count(struct onboard_controller *controller, enum onboard_step step, uint32_t since)
{
    struct onboard_cost *cost = &controller->cost[step];
    uint32_t spent = now(controller) - since;
    cost->sum += spent;
    cost->n++;
    if (spent > cost->most)
        cost->most = spent;
}

static void begin_answer(struct onboard_controller *controller, enum onboard_packet_type type,
                         enum grrl_status status)
{
    onboard_packet_begin(&controller->answer, (uint8_t)type);
    onboard_put(&controller->answer, (uint8_t)status, 1);
}

static void add_answer(const struct onboard_controller *controller, uint64_t *hash)
{
    *hash = hash_on(*hash, controller->answer.bytes, controller->answer.n);
}

/* The image's policy with this name, or NULL. */
static const struct grrl_policy_type *find_policy(const char *name)
{
    static const struct grrl_policy_type *const offered[] = {ONBOARD_POLICIES};
    for (size_t i = 0; i < sizeof offered / sizeof offered[0]; i++)
        if (strncmp(offered[i]->name, name, GRRL_POLICY_NAME_BYTES) == 0)
            return offered[i];
    return NULL;
}

static enum grrl_status open_run(struct onboard_controller *controller,
                                 struct onboard_packet *packet)
{
    uint64_t links = onboard_get(packet, 1);
    uint64_t features = onboard_get(packet, 2);
    uint64_t keyframes = onboard_get(packet, 1);
    uint64_t entries = onboard_get(packet, 2);
    struct grrl_learner_config config;
    grrl_learner_config_default(&config);
    config.seed = onboard_get(packet, 8);
    char name[GRRL_POLICY_NAME_BYTES];
    for (size_t i = 0; i < sizeof name; i++)
        name[i] = (char)onboard_get(packet, 1);
    if (!onboard_packet_used_up(packet) || name[sizeof name - 1] != '\0')
        return GRRL_ERR_FORMAT;
    if (links != GRRL_MAX_LINKS || features != GRRL_MAX_FEATURES ||
        keyframes != GRRL_MAX_KEYFRAMES || entries != ONBOARD_ENTRIES)
        return GRRL_ERR_VERSION;
    const struct grrl_policy_type *type = find_policy(name);
    if (type == NULL)
        return GRRL_ERR_NONE;
    onboard_controller_init(controller, controller->count);
    struct grrl_policy policy;
    enum grrl_status status =
        grrl_policy_make(type, controller->policy.bytes, sizeof controller->policy.bytes,
                         ONBOARD_ENTRIES, NULL, &policy);
    if (status == GRRL_OK)
        status = grrl_learner_init(&controller->learner, &config, policy);
    controller->open = status == GRRL_OK;
    begin_answer(controller, ONBOARD_DONE, status);
    return status;
}

static enum grrl_status take_frame(struct onboard_controller *controller,
                                   struct onboard_packet *packet)
{
    struct grrl_frame frame;
    bool pushing;
    if (!onboard_get_frame(packet, &controller->points, &frame, &pushing))
        return GRRL_ERR_FORMAT;
    uint32_t start = now(controller);
    grrl_learner_observe(&controller->learner, &frame, pushing);
    count(controller, ONBOARD_STEP_FRAME, start);
    begin_answer(controller, ONBOARD_DONE, GRRL_OK);
    return GRRL_OK;
}

/* The estimated structure as text; it counts as a part of the model. */
static enum grrl_status print_term(struct onboard_controller *controller, size_t *length)
{
    grrl_term term;
    grrl_term_store_init(&controller->terms, controller->nodes, ONBOARD_TERM_NODES);
    enum grrl_status status = grrl_learner_term(&controller->learner, &controller->terms, &term);
    return status != GRRL_OK ? status
                             : grrl_term_print(&controller->terms, term, ONBOARD_TERM_BYTES,
                                               controller->text, length);
}

static void perceive(struct onboard_controller *controller)
{
    uint32_t start = now(controller);
    enum grrl_status status = grrl_learner_perceive(&controller->learner);
    count(controller, ONBOARD_STEP_PERCEIVE, start);
    begin_answer(controller, ONBOARD_MODEL, status);
    size_t length = 0;
    if (status == GRRL_OK) {
        onboard_put_model(&controller->answer,
                          grrl_perception_model(&controller->learner.perception));
        if (print_term(controller, &length) != GRRL_OK)
            length = 0; /* no body yet, or the structure is too large for the text */
    }
    add_answer(controller, &controller->hashes.models);
    controller->hashes.models = hash_on(controller->hashes.models, controller->text, length);
}

static void choose(struct onboard_controller *controller)
{
    struct grrl_decision decision;
    uint32_t start = now(controller);
    enum grrl_status status = grrl_learner_choose(&controller->learner, &decision);
    count(controller, ONBOARD_STEP_CHOOSE, start);
    begin_answer(controller, ONBOARD_DECISION, status);
    if (status == GRRL_OK)
        onboard_put_decision(&controller->answer, &decision);
    add_answer(controller, &controller->hashes.decisions);
}

static void learn(struct onboard_controller *controller, struct onboard_packet *packet)
{
    bool ended = onboard_get(packet, 1) != 0;
    struct grrl_update update;
    uint32_t start = now(controller);
    enum grrl_status status = grrl_learner_learn(&controller->learner, ended, &update);
    count(controller, ONBOARD_STEP_LEARN, start);
    begin_answer(controller, ONBOARD_UPDATE, status);
    if (status == GRRL_OK) {
        const struct grrl_usage usage = grrl_learner_usage(&controller->learner);
        onboard_put_update(&controller->answer, &update, &usage);
    }
    add_answer(controller, &controller->hashes.updates);
}

static int hash_bytes(void *context, const void *bytes, size_t size)
{
    struct onboard_controller *controller = context;
    controller->store_hash = hash_on(controller->store_hash, bytes, size);
    controller->store_bytes += (uint32_t)size;
    return 0;
}

static void close_run(struct onboard_controller *controller)
{
    struct grrl_io io = {.context = controller, .write = hash_bytes};
    controller->store_hash = HASH_START;
    controller->store_bytes = 0;
    enum grrl_status status = grrl_learner_save(&controller->learner, &io);
    begin_answer(controller, ONBOARD_STORE, status);
    onboard_put(&controller->answer, controller->hashes.models, 8);
    onboard_put(&controller->answer, controller->hashes.decisions, 8);
    onboard_put(&controller->answer, controller->hashes.updates, 8);
    onboard_put(&controller->answer, controller->store_hash, 8);
}

static enum grrl_status compare(struct onboard_controller *controller,
                                struct onboard_packet *packet)
{
    uint64_t models = onboard_get(packet, 8);
    uint64_t decisions = onboard_get(packet, 8);
    uint64_t updates = onboard_get(packet, 8);
    bool same = models == controller->hashes.models && decisions == controller->hashes.decisions &&
                updates == controller->hashes.updates;
    begin_answer(controller, ONBOARD_DONE, GRRL_OK);
    return same ? GRRL_OK : GRRL_ERR_CORRUPT;
}

static enum grrl_status take(struct onboard_controller *controller, struct onboard_packet *packet)
{
    packet->at = 0;
    packet->bad = false;
    if (packet->type == ONBOARD_OPEN)
        return open_run(controller, packet);
    if (!controller->open)
        return GRRL_ERR_ORDER;
    static const uint8_t lengths[ONBOARD_EXPECT + 1] = {
        [ONBOARD_TRIAL] = 4, [ONBOARD_LEARN] = 1, [ONBOARD_EXPECT] = 24};
    if (packet->type == ONBOARD_FRAME)
        return take_frame(controller, packet);
    if (packet->type == 0 || packet->type > ONBOARD_EXPECT || packet->n != lengths[packet->type])
        return GRRL_ERR_FORMAT;
    switch (packet->type) {
    case ONBOARD_TRIAL:
        grrl_learner_begin_trial(&controller->learner, (uint32_t)onboard_get(packet, 4));
        begin_answer(controller, ONBOARD_DONE, GRRL_OK);
        break;
    case ONBOARD_PERCEIVE:
        perceive(controller);
        break;
    case ONBOARD_CHOOSE:
        choose(controller);
        break;
    case ONBOARD_LEARN:
        learn(controller, packet);
        break;
    case ONBOARD_CLOSE:
        close_run(controller);
        break;
    default:
        return compare(controller, packet);
    }
    return GRRL_OK;
}

enum grrl_status onboard_controller_take(struct onboard_controller *controller,
                                         struct onboard_packet *packet)
{
    enum grrl_status status = take(controller, packet);
    if (status != GRRL_OK)
        begin_answer(controller, ONBOARD_REFUSED, status);
    return status;
}
