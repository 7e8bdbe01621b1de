/*
 * A firmware without LCM: points come in on a serial line, pushes go out.
 *
 * Each frame on the line (link.h) holds a packet (packet.h). The host sends FRAME with the points
 * it tracks and whether something moves, 10 to 100 a second, and TRIAL when another object lies
 * there. Ten frames at rest, and the answer is DECISION: the push that the robot should make. A
 * damaged frame is dropped. A push that got lost has revealed nothing ten frames later, and the
 * next one follows.
 *
 * Replace machine_serial_get and machine_serial_put by your own UART.
 */
#include <stddef.h>

#include "grrl/base/settling.h"
#include "grrl/learner/cases/learn_policy.h"
#include "grrl/policies.h"
#include "link.h"
#include "machine.h"

static struct grrl_learner learner;
static _Alignas(max_align_t) unsigned char memory[GRRL_LEARN_POLICY_BYTES(ONBOARD_ENTRIES)];
static struct onboard_receiver receiver;
static struct onboard_packet packet; /* received, then to be sent */
static struct onboard_points points;
static uint8_t line[ONBOARD_LINK_BYTES];
static bool pushed; /* whether there is a push to learn from */

static enum grrl_status begin(void)
{
    struct grrl_policy policy;
    struct grrl_learner_config config;
    enum grrl_status status =
        grrl_policy_make(&grrl_policy_learn, memory, sizeof memory, ONBOARD_ENTRIES, NULL, &policy);
    grrl_learner_config_default(&config);
    onboard_link_init(&receiver, &packet);
    return status == GRRL_OK ? grrl_learner_init(&learner, &config, policy) : status;
}

static void begin_trial(uint32_t number)
{
    grrl_learner_begin_trial(&learner, number);
    pushed = false;
}

/* The scene is at rest: learns from the last push, and sends the next one. */
static void settled(void)
{
    struct grrl_update update;
    struct grrl_decision decision;
    if (grrl_learner_perceive(&learner) != GRRL_OK)
        return;
    if (pushed && grrl_learner_learn(&learner, false, &update) != GRRL_OK)
        return;
    pushed = grrl_learner_choose(&learner, &decision) == GRRL_OK;
    if (!pushed)
        return; /* nothing is seen that could be pushed */
    onboard_packet_begin(&packet, ONBOARD_DECISION);
    onboard_put_decision(&packet, &decision);
    size_t n = onboard_link_encode(0, packet.type, packet.bytes, packet.n, line);
    for (size_t i = 0; i < n; i++)
        machine_serial_put(line[i]);
}

int main(void);

int main(void)
{
    struct grrl_frame frame;
    bool moving;
    int at_rest = 0;
    if (begin() != GRRL_OK)
        return EXIT_DIFFERS;
    for (;;) {
        if (onboard_link_take(&receiver, machine_serial_get()) != ONBOARD_LINK_FRAME)
            continue;
        packet.at = 0;
        if (packet.type == ONBOARD_TRIAL)
            begin_trial((uint32_t)onboard_get(&packet, 4));
        if (packet.type != ONBOARD_FRAME || !onboard_get_frame(&packet, &points, &frame, &moving))
            continue;
        grrl_learner_observe(&learner, &frame, moving);
        at_rest = moving ? 0 : at_rest + 1;
        if (at_rest < GRRL_SETTLING_FRAMES)
            continue;
        at_rest = 0;
        settled();
    }
}
