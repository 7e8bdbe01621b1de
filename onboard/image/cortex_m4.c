/* Start-up, faults and the counter of a Cortex-M4F on the board MPS2 AN386. */
#include <stdint.h>

#include "machine.h"

extern uint32_t stack_bottom[], stack_top[];
extern uint32_t data_start[], data_end[], data_image[], bss_start[], bss_end[];

int main(void);
intptr_t semihost(intptr_t operation, const void *parameters);
_Noreturn void reset(void);
void fault(void);

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))
#define CPACR REGISTER(0xe000ed88) /* enables the floating-point unit */
#define SHCSR REGISTER(0xe000ed24) /* which faults have their own handlers */
#define CCR REGISTER(0xe000ed14)
#define MPU_CTRL REGISTER(0xe000ed94)
#define MPU_RNR REGISTER(0xe000ed98)
#define MPU_RBAR REGISTER(0xe000ed9c)
#define MPU_RASR REGISTER(0xe000eda0)
#define NVIC_ENABLE REGISTER(0xe000e100)
#define NVIC_DISABLE REGISTER(0xe000e180)
#define NVIC_CLEAR REGISTER(0xe000e280)
#define TIMER_CTRL REGISTER(0x40000000)
#define TIMER_VALUE REGISTER(0x40000004)
#define TIMER_RELOAD REGISTER(0x40000008)
#define UART_DATA REGISTER(0x40004000)
#define UART_STATE REGISTER(0x40004004) /* bit 0: transmitter full, bit 1: byte received */
#define UART_CTRL REGISTER(0x40004008)
#define UART_INTERRUPT REGISTER(0x4000400c)
#define UART_DIVIDER REGISTER(0x40004010)

__attribute__((section(".vectors"), used)) static const uintptr_t vectors[16] = {
    (uintptr_t)stack_top,
    (uintptr_t)reset,
    (uintptr_t)fault,
    (uintptr_t)fault,
    (uintptr_t)fault,
    (uintptr_t)fault,
    (uintptr_t)fault,
    0,
    0,
    0,
    0,
    (uintptr_t)fault,
    (uintptr_t)fault,
    0,
    (uintptr_t)fault,
    (uintptr_t)fault};

__attribute__((naked)) intptr_t semihost(intptr_t operation, const void *parameters)
{
    (void)operation;
    (void)parameters;
    __asm__ volatile("bkpt 0xab\n\tbx lr");
}

/* The stack may have caused the fault, so it starts afresh. */
__attribute__((naked)) void fault(void)
{
    __asm__ volatile("ldr r0, =stack_top\n\tmsr msp, r0\n\tmrs r0, ipsr\n\tb onboard_fault");
}

/* Forbids access to and execution of 2^bits bytes. */
static void forbid(uint32_t region, uintptr_t address, uint32_t bits)
{
    MPU_RNR = region;
    MPU_RBAR = (uint32_t)address;
    MPU_RASR = 1u << 28 | (bits - 1) << 1 | 1u;
}

/* Protects the first kilobyte, where null pointers point (the core can still read the vectors), and
 * 32 KiB below the stack, more than any frame. */
static void protect(void)
{
    forbid(0, 0, 10);
    forbid(1, (uintptr_t)stack_bottom - 0x8000, 15);
    MPU_CTRL = 5; /* enabled, with the default map for everything else */
    __asm__ volatile("dsb\n\tisb");
}

_Noreturn void reset(void)
{
    CPACR |= 0xfu << 20;
    __asm__ volatile("dsb\n\tisb");
    SHCSR |= 7u << 16; /* usage, bus and memory faults */
    CCR |= 1u << 4;    /* division by zero is a fault */
    uint32_t *here;
    __asm__ volatile("mov %0, sp" : "=r"(here));
    /* Volatile, so that the compiler does not make this a memset, which would paint
     * its own frame. */
    for (volatile uint32_t *word = stack_bottom; word < here; word++)
        *word = 0xa5a5a5a5u;
    const uint32_t *from = data_image;
    for (uint32_t *to = data_start; to < data_end; to++)
        *to = *from++;
    for (uint32_t *word = bss_start; word < bss_end; word++)
        *word = 0;
    protect();
    TIMER_RELOAD = UINT32_MAX;
    TIMER_VALUE = UINT32_MAX;
    TIMER_CTRL = 1;
    UART_DIVIDER = 217; /* 115200 baud */
    UART_CTRL = 1u | 1u << 1 | 1u << 3;
    machine_exit((uint32_t)main());
}

/* The interrupt of a received byte ends the wait but is never taken. Elsewhere it stays off,
 * because with interrupts masked every fault would become a hard fault. */
uint8_t machine_serial_get(void)
{
    __asm__ volatile("cpsid i");
    NVIC_ENABLE = 1;
    while ((UART_STATE & 2u) == 0)
        __asm__ volatile("wfi");
    NVIC_DISABLE = 1;
    UART_INTERRUPT = 2;
    NVIC_CLEAR = 1;
    __asm__ volatile("cpsie i");
    return (uint8_t)UART_DATA;
}

void machine_serial_put(uint8_t byte)
{
    while ((UART_STATE & 1u) != 0) {
    }
    UART_DATA = byte;
}

/* The timer counts down. */
uint32_t machine_count(void)
{
    return UINT32_MAX - TIMER_VALUE;
}

/* At 25 MHz a tick is 40 ns; with -icount shift=6 an instruction takes 64 ns. */
uint64_t machine_instructions(uint64_t count)
{
    return count * 40 / 64;
}
