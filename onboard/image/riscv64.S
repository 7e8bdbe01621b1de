/* Start-up, faults, semihosting, counter and serial line of a 64-bit RISC-V in machine mode. */
    .section .start, "ax"
    .globl reset
reset:
    .option push
    .option norelax
    la gp, __global_pointer$
    .option pop
    la sp, stack_top
    la t0, trap
    csrw mtvec, t0
    li t0, 0x6000 /* enables the floating-point unit */
    csrs mstatus, t0
    /* Forbids access to the 32 KiB below the stack, also in machine mode (locked). */
    la t0, stack_bottom
    li t1, 0x8000
    sub t0, t0, t1
    srli t0, t0, 2
    li t1, 0xfff
    or t0, t0, t1
    csrw pmpaddr0, t0
    li t0, 0x98
    csrw pmpcfg0, t0
    li t1, 0xa5a5a5a5
    la t0, stack_bottom
1:  sw t1, 0(t0)
    addi t0, t0, 4
    bltu t0, sp, 1b
    la t0, bss_start
    la t1, bss_end
2:  bgeu t0, t1, 3f
    sd zero, 0(t0)
    addi t0, t0, 8
    j 2b
3:  call main
    call machine_exit

    .balign 4
trap:
    la sp, stack_top
    csrr a0, mcause
    call onboard_fault

    .text
    .balign 16
    .globl semihost
    .option push
    .option norvc
semihost:
    slli zero, zero, 0x1f
    ebreak
    srai zero, zero, 7
    ret
    .option pop

    .globl machine_count
machine_count: /* QEMU's minstret is its clock in ns: 64 per instruction with -icount shift=6 */
    csrr a0, minstret
    srli a0, a0, 6
    sext.w a0, a0
    ret

    .globl machine_instructions
machine_instructions:
    ret

    .globl machine_serial_get
machine_serial_get: /* a 16550: byte 5 is its state, bit 0 a byte received, bit 5 room for one */
    li t0, 0x10000000
1:  lbu t1, 5(t0)
    andi t1, t1, 0x01
    beqz t1, 1b
    lbu a0, 0(t0)
    ret

    .globl machine_serial_put
machine_serial_put:
    li t0, 0x10000000
2:  lbu t1, 5(t0)
    andi t1, t1, 0x20
    beqz t1, 2b
    sb a0, 0(t0)
    ret
