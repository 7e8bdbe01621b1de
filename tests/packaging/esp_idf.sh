#!/bin/sh
# lib/ as a component of ESP-IDF: Espressif's tool packs it, and its CMake file builds with the functions
# that ESP-IDF offers, here by stand-ins of the same names, for RV32IMC. esp_idf.sh VERSION
set -eu
version=$1
# shellcheck source=tests/packaging/common.sh
. "$(dirname "$0")/common.sh"
need riscv64-unknown-elf-gcc gcc-riscv64-unknown-elf

# The first pass of ESP-IDF only asks for requirements, and returns at the first line.
cat >"$work/first.cmake" <<E2
macro(idf_component_register)
    set(registered TRUE)
    return()
endmacro()
function(component)
    include($source/lib/CMakeLists.txt)
endfunction()
component()
E2
quiet cmake -P "$work/first.cmake"

mkdir "$work/project"
cat >"$work/project/CMakeLists.txt" <<E2
cmake_minimum_required(VERSION 3.16)
project(firmware C)
set(CONFIG_GRRL_PROFILE_TINY y) # as sdkconfig.cmake has it
set(CONFIG_GRRL_MAX_LINKS 7)
set(CONFIG_GRRL_MAX_FEATURES 0)
macro(idf_component_register)
    cmake_parse_arguments(given "" "" "SRCS;INCLUDE_DIRS;PRIV_INCLUDE_DIRS" \${ARGN})
    if(given_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "not an argument: \${given_UNPARSED_ARGUMENTS}")
    endif()
    set(COMPONENT_LIB __idf_grrl)
    add_library(\${COMPONENT_LIB} STATIC \${given_SRCS})
    target_include_directories(\${COMPONENT_LIB} PUBLIC \${given_INCLUDE_DIRS}
        PRIVATE \${given_PRIV_INCLUDE_DIRS})
endmacro()
add_subdirectory($source/lib grrl)
add_library(caller OBJECT caller.c)
target_link_libraries(caller PRIVATE __idf_grrl)
E2
cat >"$work/project/caller.c" <<'E2'
#include "grrl/grrl.h"
static_assert(GRRL_MAX_LINKS == 7 && GRRL_MAX_FEATURES == 32, "what Kconfig chose");
E2
quiet cmake -S "$work/project" -B "$work/build" -DCMAKE_SYSTEM_NAME=Generic \
    -DCMAKE_C_COMPILER=riscv64-unknown-elf-gcc -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY \
    -DCMAKE_C_FLAGS="--specs=picolibc.specs -march=rv32imc -mabi=ilp32"
quiet cmake --build "$work/build" -j 2
riscv64-unknown-elf-nm "$work/build/grrl/lib__idf_grrl.a" 2>/dev/null |
    grep -q ' T grrl_learner_init_links7_joints2x_features32_' || wrong "the library has other capacities"

# The archive, where the tool is, from a copy: it writes beside what it packs.
compote=$(tool compote)
cp -R "$source/lib" "$work/grrl"
quiet "$compote" component pack --project-dir "$work/grrl" --name grrl --dest-dir "$work/dist"
tar tzf "$work/dist/grrl_$version.tgz" >"$work/files"
for file in CMakeLists.txt esp_idf.cmake kconfig.cmake Kconfig LICENSE idf_component.yml \
    include/grrl/grrl.h src/policies.c; do
    grep -qx "./$file" "$work/files" || wrong "$file is not in the archive"
done
