/* The machine-independent part: semihosting, stack, assertions. */
#include "machine.h"

enum {
    SYS_OPEN = 0x01,
    SYS_WRITE0 = 0x04,
    SYS_READ = 0x06,
    SYS_GET_CMDLINE = 0x15,
    SYS_EXIT_EXTENDED = 0x20
};

#define ADP_STOPPED_APPLICATION_EXIT 0x20026
#define STACK_PAINT 0xa5a5a5a5u

/* Both are defined in the machine's startup code. */
extern intptr_t semihost(intptr_t operation, const void *parameters);
extern uint32_t stack_bottom[], stack_top[];

_Noreturn void machine_exit(uint32_t code)
{
    const uintptr_t parameters[2] = {ADP_STOPPED_APPLICATION_EXIT, code};
    (void)semihost(SYS_EXIT_EXTENDED, parameters);
    for (;;) {
    }
}

size_t machine_arguments(char *text, size_t capacity)
{
    uintptr_t parameters[2] = {(uintptr_t)text, capacity};
    text[0] = '\0';
    return semihost(SYS_GET_CMDLINE, parameters) == 0 ? parameters[1] : 0;
}

intptr_t machine_open(const char *path, size_t length)
{
    const uintptr_t parameters[3] = {(uintptr_t)path, 1 /* "rb" */, length};
    return semihost(SYS_OPEN, parameters);
}

size_t machine_read(intptr_t file, void *bytes, size_t size)
{
    const uintptr_t parameters[3] = {(uintptr_t)file, (uintptr_t)bytes, size};
    size_t missing = (size_t)semihost(SYS_READ, parameters);
    return missing <= size ? size - missing : 0;
}

void machine_write(const char *text)
{
    (void)semihost(SYS_WRITE0, text);
}

size_t machine_stack_size(void)
{
    return (size_t)((uintptr_t)stack_top - (uintptr_t)stack_bottom);
}

/* The startup code painted the stack. */
size_t machine_stack_used(void)
{
    const uint32_t *word = stack_bottom;
    while (word < stack_top && *word == STACK_PAINT)
        word++;
    return (size_t)((uintptr_t)stack_top - (uintptr_t)word);
}

_Noreturn void onboard_fault(uint32_t number)
{
    machine_exit(EXIT_FAULT + number);
}

/* Replaces the C library's version, which prints. */
_Noreturn void __assert_func(const char *file, int line, const char *function, const char *text);

_Noreturn void __assert_func(const char *file, int line, const char *function, const char *text)
{
    (void)line;
    (void)function;
    machine_write(file);
    machine_write(": assertion failed: ");
    machine_write(text);
    machine_write("\n");
    machine_exit(EXIT_ASSERT);
}

/* Uses a frame larger than the stack, to test the fault handler; excluded from stack use. */
__attribute__((noinline)) static uint32_t overflow_stack(uint32_t at)
{
    volatile uint32_t hole[8192];
    hole[at] = at;
    return hole[at];
}

bool machine_is(const char *text, const char *expected)
{
    while (*text == *expected && *text != '\0') {
        text++;
        expected++;
    }
    return *text == *expected;
}

void machine_provoke(const char *fault)
{
    volatile uint32_t zero = 0;
    volatile uint32_t seven = 7;
    if (machine_is(fault, "null"))
        zero = *(volatile uint32_t *)(uintptr_t)(16 + zero);
    else if (machine_is(fault, "address"))
        *(volatile uint32_t *)(uintptr_t)(0xd0000000u + zero) = 1;
    else if (machine_is(fault, "stack"))
        zero = overflow_stack(zero);
    else if (machine_is(fault, "divide"))
        seven = seven / zero;
    else if (machine_is(fault, "assert"))
        __assert_func(__FILE__, __LINE__, __func__, "provoked");
}
