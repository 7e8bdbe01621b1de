# One run of each policy is recorded; each target then replays both. Targets whose tools are not
# installed are skipped.
set(checks ${CMAKE_CURRENT_LIST_DIR})
set(folder ${CMAKE_CURRENT_BINARY_DIR}/runs)
function(onboard_check name)
    add_test(NAME onboard_${name} COMMAND ${ARGN})
    set_tests_properties(onboard_${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1200
        FIXTURES_REQUIRED onboard_recording)
endfunction()

add_test(NAME onboard_record COMMAND ${checks}/record.sh $<TARGET_FILE:grrl-record>
         $<TARGET_FILE:grrl-replay> ${folder})
set_tests_properties(onboard_record PROPERTIES FIXTURES_SETUP onboard_recording)
foreach(compiler gcc clang)
    foreach(level -O0 -O2)
        onboard_check(same_${compiler}${level} ${checks}/same_host.sh ${folder} ${compiler} ${level})
    endforeach()
endforeach()
foreach(target cortex-m4 riscv64)
    onboard_check(same_${target} ${checks}/same_image.sh ${folder} ${target})
    set_tests_properties(onboard_same_${target} PROPERTIES FIXTURES_SETUP onboard_${target})
    foreach(check faults budget)
        onboard_check(${check}_${target} ${checks}/${check}.sh ${folder} ${target})
        set_tests_properties(onboard_${check}_${target} PROPERTIES
            FIXTURES_REQUIRED "onboard_recording;onboard_${target}")
    endforeach()
endforeach()
onboard_check(units_riscv64 ${checks}/units.sh ${folder} riscv64)
set_tests_properties(onboard_units_riscv64 PROPERTIES FIXTURES_REQUIRED onboard_riscv64)
onboard_check(live ${checks}/live.sh ${folder} $<TARGET_FILE:grrl-agent>
              $<TARGET_FILE:grrl-bridge> $<TARGET_FILE:grrl-sim>
              $<TARGET_FILE:grrl-record> $<TARGET_FILE:grrl-replay>)
set_tests_properties(onboard_live PROPERTIES FIXTURES_REQUIRED onboard_cortex-m4)
# What the profiles of capacities take, and the example firmware: the table of docs/firmware.md.
add_test(NAME onboard_profiles COMMAND ${PROJECT_SOURCE_DIR}/tools/profiles --check)
set_tests_properties(onboard_profiles PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 3600)
