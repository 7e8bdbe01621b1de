# A 64-bit RISC-V with a single-precision unit, no operating system, picolibc.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR riscv64)
set(CMAKE_C_COMPILER riscv64-unknown-elf-gcc)
set(CMAKE_ASM_COMPILER riscv64-unknown-elf-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(GRRL_ONBOARD_TARGET riscv64)
set(grrl_machine --specs=picolibc.specs -march=rv64imafc -mabi=lp64f -mcmodel=medany)
add_compile_options(${grrl_machine} -ffunction-sections -fdata-sections -fno-math-errno)
add_link_options(${grrl_machine})
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-system-riscv64 -M virt -m 64M -bios none -display none
    -monitor none -serial none -semihosting-config enable=on,target=native -kernel)
