/*
 * The image's main program. Its arguments:
 *
 *   replay FILE   runs a recording and prints its hashes and its cost, one name with numbers a line
 *   serve         is the controller behind the serial line; prints the cost after each run
 *   worst         prints the cost of decisions at full capacity
 *   fault NAME    provokes a fault
 */
#include <string.h>

#include "machine.h"
#include "replay.h"
#include "server.h"
#include "worst.h"

static struct onboard_controller controller;
static struct onboard_server server;
static char arguments[512];
static struct {
    intptr_t file;
    size_t n, at;
    uint8_t bytes[4096];
} input;

static int read_input(void *context, void *bytes, size_t size)
{
    (void)context;
    uint8_t *to = bytes;
    while (size > 0) {
        if (input.at == input.n) {
            input.n = machine_read(input.file, input.bytes, sizeof input.bytes);
            input.at = 0;
            if (input.n == 0)
                return -1;
        }
        size_t n = input.n - input.at < size ? input.n - input.at : size;
        memcpy(to, input.bytes + input.at, n);
        input.at += n;
        to += n;
        size -= n;
    }
    return 0;
}

static void write_hash(const char *name, uint64_t hash)
{
    char digits[20] = " 0123456789abcdef\n";
    for (int i = 0; i < 16; i++)
        digits[16 - i] = "0123456789abcdef"[hash >> (4 * i) & 15];
    machine_write(name);
    machine_write(digits);
}

static void write_number(size_t number)
{
    char digits[24];
    int at = 23;
    digits[at] = '\0';
    do {
        digits[--at] = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    digits[--at] = ' ';
    machine_write(digits + at);
}

static void write_line(const char *name, size_t number)
{
    machine_write(name);
    write_number(number);
    machine_write("\n");
}

/* Bit by bit: the C library's division of 64 bits takes 700 bytes. The result must fit. */
static uint32_t divide(uint64_t number, uint32_t by)
{
    uint64_t rest = 0;
    uint32_t result = 0;
    for (int i = 0; i < 64; i++) {
        rest = rest << 1 | number >> 63;
        number <<= 1;
        result <<= 1;
        if (rest >= by) {
            rest -= by;
            result |= 1u;
        }
    }
    return result;
}

/* The number of steps, and the mean and maximum of instructions. */
static void write_costs(void)
{
    static const char *const names[ONBOARD_STEPS] = {"frame", "perceive", "choose", "learn"};
    for (int i = 0; i < ONBOARD_STEPS; i++) {
        const struct onboard_cost *cost = &controller.cost[i];
        machine_write("cost ");
        machine_write(names[i]);
        write_number(cost->n);
        write_number(divide(machine_instructions(cost->sum), cost->n > 0 ? cost->n : 1));
        write_number((uint32_t)machine_instructions(cost->most));
        machine_write("\n");
    }
}

static void write_memory(void)
{
    write_line("ram learner", sizeof controller.learner);
    write_line("ram policy", sizeof controller.policy);
    write_line("ram terms",
               sizeof controller.terms + sizeof controller.nodes + sizeof controller.text);
    write_line("ram packets", sizeof controller.points + sizeof controller.answer + sizeof server);
    write_line("ram input", sizeof input + sizeof arguments);
    write_line("ram stack", machine_stack_size());
    write_line("stack painted", machine_stack_used());
    if (!controller.open)
        return; /* there is no learner yet */
    const struct grrl_usage used = grrl_learner_usage(&controller.learner);
    write_line("used entries", used.n);
    write_line("used features", controller.learner.perception.counts.features_high);
    write_line("used keyframes", controller.learner.perception.counts.keyframes_high);
    write_line("evictions", used.evictions);
}

static int replay(const char *path, size_t length)
{
    input.file = machine_open(path, length);
    if (input.file < 0) {
        machine_write("there is no such recording\n");
        return EXIT_USAGE;
    }
    const struct onboard_source source = {NULL, read_input};
    struct onboard_progress progress;
    onboard_controller_init(&controller, machine_count);
    enum grrl_status status = onboard_replay(&controller, &source, &server.request, &progress);
    write_line("packets", progress.packets);
    write_line("trials", progress.trials);
    write_line("pushes", progress.pushes);
    write_hash("models", controller.hashes.models);
    write_hash("decisions", controller.hashes.decisions);
    write_hash("updates", controller.hashes.updates);
    write_hash("store", controller.store_hash);
    write_costs();
    write_memory();
    if (status != GRRL_OK) {
        machine_write("stopped there: ");
        machine_write(grrl_status_text(status));
        machine_write("\n");
    }
    return status == GRRL_OK ? EXIT_FINE : EXIT_DIFFERS;
}

/* For each policy in the image. */
static void write_worst(void)
{
    static const struct grrl_policy_type *const offered[] = {ONBOARD_POLICIES};
    for (size_t i = 0; i < sizeof offered / sizeof offered[0]; i++) {
        machine_write("worst ");
        write_line(offered[i]->name, (uint32_t)machine_instructions(
                                         worst_decision(&controller, offered[i], machine_count)));
    }
}

/* Runs until the machine is switched off. */
static _Noreturn void serve(void)
{
    onboard_controller_init(&controller, NULL);
    onboard_server_init(&server, &controller);
    for (;;) {
        size_t n = onboard_server_take(&server, machine_serial_get());
        for (size_t i = 0; i < n; i++)
            machine_serial_put(server.line[i]);
        if (n > 0 && controller.answer.type == ONBOARD_STORE) {
            write_line("damaged", server.damaged);
            write_line("repeated", server.repeated);
            write_memory();
        }
    }
}

int main(void);

int main(void)
{
    size_t length = machine_arguments(arguments, sizeof arguments);
    const char *first = arguments; /* after the image's name */
    while (*first != ' ' && *first != '\0')
        first++;
    first += *first == ' ' ? 1 : 0;
    if (machine_is(first, "serve"))
        serve();
    if (strncmp(first, "fault ", 6) == 0) {
        machine_provoke(first + 6);
        return EXIT_FINE;
    }
    if (strncmp(first, "replay ", 7) == 0)
        return replay(first + 7, length - (size_t)(first + 7 - arguments));
    if (machine_is(first, "worst")) {
        write_worst();
        return EXIT_FINE;
    }
    machine_write("arguments: replay FILE, serve, worst, or fault NAME\n");
    return EXIT_USAGE;
}
