/*
 * Messages. The first byte is the type; its highest bit puts the right fingerprint before the
 * rest. What is accepted must mean the same to the decoder that lcm-gen wrote, and encode to the
 * same bytes.
 */
#include <string.h>

#include "fuzz.h"
#include "wire.h"

enum { RIGHT_FINGERPRINT = 0x80, FINGERPRINT_BYTES = 8 };

static uint8_t again[UINT16_MAX + 8]; /* the longest input */
static struct grrl_wire_why why;

/* Decodes, encodes, lets the generated decoder read it, and compares. */
#define CHECK(type, storage, message)                                                              \
    static void check_##type(const uint8_t *data, uint32_t size)                                   \
    {                                                                                              \
        grrl_##type##_t other;                                                                     \
        if (!grrl_wire_decode_##type(data, size, &(storage), &why)) {                              \
            REQUIRE(why.text[0] != '\0');                                                          \
            return;                                                                                \
        }                                                                                          \
        REQUIRE(grrl_wire_encode_##type(&(message), sizeof again, again, &why) == (int)size);      \
        REQUIRE(memcmp(again, data, size) == 0);                                                   \
        REQUIRE(grrl_##type##_t_decode(data, 0, (int)size, &other) == (int)size);                  \
        (void)grrl_##type##_t_decode_cleanup(&other);                                              \
    }

static struct grrl_wire_points points;
static struct grrl_wire_model model;
static grrl_push_command_t push_command;
static grrl_push_status_t push_status;
static grrl_trial_t trial;
static grrl_decision_t decision;
static grrl_agent_status_t agent_status;
static struct grrl_wire_image image;
static grrl_stop_t stop;

CHECK(points, points, points.message)
CHECK(model, model, model.message)
CHECK(push_command, push_command, push_command)
CHECK(push_status, push_status, push_status)
CHECK(trial, trial, trial)
CHECK(decision, decision, decision)
CHECK(agent_status, agent_status, agent_status)
CHECK(image, image, image.message)
CHECK(stop, stop, stop)

static const struct {
    void (*check)(const uint8_t *data, uint32_t size);
    int64_t (*fingerprint)(void);
} types[] = {
    {check_points, __grrl_points_t_get_hash},
    {check_model, __grrl_model_t_get_hash},
    {check_push_command, __grrl_push_command_t_get_hash},
    {check_push_status, __grrl_push_status_t_get_hash},
    {check_trial, __grrl_trial_t_get_hash},
    {check_decision, __grrl_decision_t_get_hash},
    {check_agent_status, __grrl_agent_status_t_get_hash},
    {check_image, __grrl_image_t_get_hash},
    {check_stop, __grrl_stop_t_get_hash},
};

enum { N_TYPES = sizeof types / sizeof types[0] };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0 || size > UINT16_MAX)
        return 0;
    unsigned type = (data[0] & ~(unsigned)RIGHT_FINGERPRINT) % N_TYPES;
    size_t head = (data[0] & RIGHT_FINGERPRINT) != 0 ? FINGERPRINT_BYTES : 0;
    size_t n = head + size - 1;
    uint8_t *message = malloc(n > 0 ? n : 1);
    REQUIRE(message != NULL);
    uint64_t fingerprint = (uint64_t)types[type].fingerprint();
    for (size_t i = 0; i < head; i++)
        message[i] = (uint8_t)(fingerprint >> (56 - 8 * i));
    memcpy(message + head, data + 1, size - 1);
    types[type].check(message, (uint32_t)n);
    free(message);
    return 0;
}
