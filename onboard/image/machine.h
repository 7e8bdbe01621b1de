/*
 * machine.h: what the image needs from its machine: a serial line and a count of instructions, and
 * through semihosting a way to exit, a file to read and a text to write.
 */
#ifndef ONBOARD_MACHINE_H
#define ONBOARD_MACHINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Exit codes; a fault is EXIT_FAULT plus its number on the machine. */
enum { EXIT_FINE = 0, EXIT_DIFFERS = 1, EXIT_USAGE = 2, EXIT_ASSERT = 3, EXIT_FAULT = 16 };

_Noreturn void machine_exit(uint32_t code);

/* Copies the command line after the image's name, zero-terminated; returns its length. */
size_t machine_arguments(char *text, size_t capacity);

/* Returns a negative number if there is no such file. length: of the path. */
intptr_t machine_open(const char *path, size_t length);

/* Returns the number of bytes read. */
size_t machine_read(intptr_t file, void *bytes, size_t size);

void machine_write(const char *text);

/* Whether two texts are equal; strcmp takes 700 bytes of flash. */
bool machine_is(const char *text, const char *expected);

/* Waits for the next byte from the serial line; sends one. */
uint8_t machine_serial_get(void);
void machine_serial_put(uint8_t byte);

/* The instructions so far, in ticks; converts ticks to instructions. */
uint32_t machine_count(void);
uint64_t machine_instructions(uint64_t count);

/* The deepest use of the stack so far, and its size, in bytes. */
size_t machine_stack_used(void);
size_t machine_stack_size(void);

/* For the test of the fault handler: accesses an unmapped address, or causes another fault. */
void machine_provoke(const char *fault);

_Noreturn void onboard_fault(uint32_t number);

#endif
