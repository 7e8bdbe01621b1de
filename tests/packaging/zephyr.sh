#!/bin/sh
# The module of Zephyr: its description names files that exist, its Kconfig offers what it says, and its
# CMake file builds with the functions that Zephyr offers, here by stand-ins of the same names.
set -eu
# shellcheck source=tests/packaging/common.sh
. "$(dirname "$0")/common.sh"
need arm-none-eabi-gcc gcc-arm-none-eabi

grep -qx '  cmake: zephyr' "$source/zephyr/module.yml" || wrong "module.yml names no CMake folder"
grep -qx '  kconfig: zephyr/Kconfig' "$source/zephyr/module.yml" || wrong "module.yml names no Kconfig"

mkdir "$work/project"
cat >"$work/project/CMakeLists.txt" <<E2
cmake_minimum_required(VERSION 3.20)
project(firmware C)
set(CONFIG_GRRL y)
set(CONFIG_GRRL_PROFILE_SMALL y)
set(CONFIG_GRRL_MAX_KEYFRAMES 20)
add_library(zephyr_interface INTERFACE)
function(zephyr_library_named name)
    add_library(\${name} STATIC)
    target_link_libraries(\${name} PRIVATE zephyr_interface)
    set(ZEPHYR_CURRENT_LIBRARY \${name} PARENT_SCOPE)
endfunction()
function(zephyr_library_sources)
    target_sources(\${ZEPHYR_CURRENT_LIBRARY} PRIVATE \${ARGN})
endfunction()
function(zephyr_library_include_directories)
    target_include_directories(\${ZEPHYR_CURRENT_LIBRARY} PRIVATE \${ARGN})
endfunction()
function(zephyr_library_compile_options)
    target_compile_options(\${ZEPHYR_CURRENT_LIBRARY} PRIVATE \${ARGN})
endfunction()
function(zephyr_include_directories)
    target_include_directories(zephyr_interface INTERFACE \${ARGN})
endfunction()
function(zephyr_compile_definitions)
    target_compile_definitions(zephyr_interface INTERFACE \${ARGN})
endfunction()
add_subdirectory($source/zephyr module)
add_library(caller OBJECT caller.c)
target_link_libraries(caller PRIVATE zephyr_interface)
E2
cat >"$work/project/caller.c" <<'E2'
#include "grrl/grrl.h"
static_assert(GRRL_MAX_LINKS == 10 && GRRL_MAX_KEYFRAMES == 20, "what Kconfig chose");
E2
quiet cmake -S "$work/project" -B "$work/build" -DCMAKE_SYSTEM_NAME=Generic \
    -DCMAKE_C_COMPILER=arm-none-eabi-gcc -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY \
    -DCMAKE_C_FLAGS="-mcpu=cortex-m4 -mthumb"
quiet cmake --build "$work/build" -j 2
arm-none-eabi-nm "$work/build/module/libgrrl.a" 2>/dev/null |
    grep -q ' T grrl_learner_init_links10_joints2x_features96_frames20_' ||
    wrong "the library has other capacities"

pio=$(tool pio)
python=$(dirname "$pio")/python
"$python" "$here/kconfig.py" "$source" || wrong "Kconfig"
