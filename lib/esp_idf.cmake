# The library as a component of ESP-IDF. Its first pass over all components ends at the first line.
file(GLOB_RECURSE grrl_sources ${CMAKE_CURRENT_LIST_DIR}/src/*.c)
idf_component_register(SRCS ${grrl_sources} INCLUDE_DIRS include PRIV_INCLUDE_DIRS src)
include(${CMAKE_CURRENT_LIST_DIR}/kconfig.cmake)
grrl_kconfig_definitions(grrl_definitions)
target_compile_definitions(${COMPONENT_LIB} PUBLIC ${grrl_definitions})
target_compile_options(${COMPONENT_LIB} PRIVATE -ffp-contract=off) # the same decisions on every machine
