/*
 * machine.h: what the image needs of its machine: a serial line and a count of instructions, and,
 * through semihosting from whoever runs the image, a way out, a file to read and a text to write.
 */
#ifndef ONBOARD_MACHINE_H
#define ONBOARD_MACHINE_H

#include <stddef.h>
#include <stdint.h>

/* Exit codes; a fault is EXIT_FAULT plus its number on the machine. */
enum { EXIT_FINE = 0, EXIT_DIFFERS = 1, EXIT_USAGE = 2, EXIT_ASSERT = 3, EXIT_FAULT = 16 };

_Noreturn void machine_exit(uint32_t code);

/* The command line after the image's name, zero-terminated; its length. */
size_t machine_arguments(char *text, size_t capacity);

/* A negative number if there is no such file. */
intptr_t machine_open(const char *path);

/* The bytes read. */
size_t machine_read(intptr_t file, void *bytes, size_t size);

void machine_write(const char *text);

/* The next byte from the serial line, which is waited for; and one to it. */
uint8_t machine_serial_get(void);
void machine_serial_put(uint8_t byte);

/* Instructions so far in some unit, and how many of them are that many units. */
uint32_t machine_count(void);
uint64_t machine_instructions(uint64_t count);

/* The deepest the stack has been, and all of it, in bytes. */
size_t machine_stack_used(void);
size_t machine_stack_size(void);

/* For the test of the fault handler: an access to an address where nothing is, or another fault. */
void machine_provoke(const char *fault);

_Noreturn void onboard_fault(uint32_t number);

#endif
