# Warnings and floating-point rules for all our targets: call grrl_configure(<target>).
# -Wno-enum-float-conversion: clang 19 has it in -Wextra; unnamed enums are our integer constants.
# -ffp-contract=off: the same seeds must give the same run on every machine.
function(grrl_configure target)
    set(common -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wvla -Wundef -Wcast-qual
        -Wdouble-promotion)
    target_compile_options(${target} PRIVATE ${common} -ffp-contract=off -fno-trapping-math
        $<$<COMPILE_LANGUAGE:C>:-Wmissing-prototypes -Wstrict-prototypes
            -Wno-enum-float-conversion>
        $<$<BOOL:${GRRL_WERROR}>:-Werror>)
    if(GRRL_FUZZ)
        target_compile_options(${target} PRIVATE -fno-sanitize-recover=all -fno-omit-frame-pointer
            -fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow)
        target_link_options(${target} PUBLIC -fsanitize=address,undefined)
    elseif(GRRL_SANITIZE)
        target_compile_options(${target} PRIVATE -fsanitize=address,undefined
            -fno-sanitize-recover=all -fno-omit-frame-pointer)
        target_link_options(${target} PUBLIC -fsanitize=address,undefined)
    endif()
endfunction()
