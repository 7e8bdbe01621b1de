# A Cortex-M4F with its single-precision unit, no operating system, newlib.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(GRRL_ONBOARD_TARGET cortex-m4)
set(grrl_machine -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16)
add_compile_options(${grrl_machine} -ffunction-sections -fdata-sections -fno-math-errno)
add_link_options(${grrl_machine})
